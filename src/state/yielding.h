#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include "state/bodies.h"
#include "state/hooks.h"
#include "state/objects.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

/// \file
/// Bodies that become soft where they are hit hard, and rigid again (BodyDesc::yields).

namespace hooke::state {

/// The tetrahedra that a body becomes. A SoftForm never changes after it was made.
struct SoftForm {
  std::vector<Vec3> points;  ///< From the center of mass, in the body's frame [m].
  std::vector<Real> mass;    ///< [kg]; mass, center and inertia of all are those of the body.
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::shared_ptr<const Skin> skin;  ///< The surface that is seen.
};

/// A body that yields. Rows stand in order of creation.
struct Yielding {
  std::uint32_t body = 0;  ///< Row of the body; it stays the same as long as the body lives.
  YieldsDesc desc = {};
  std::shared_ptr<const SoftForm> form;  ///< As it was made, or as it froze last.
  bool reshaped = false;                 ///< It has been soft: its colliders are hulls of parts of the form.
  std::uint32_t solid = 0;               ///< Slot of the solid that it is now; 0 while it is rigid.
  // The fields below count while it is soft.
  Real impulse = Real(0);              ///< The impulse for which it yielded [N s].
  Real calm = Real(0);                 ///< Time for which it has been at rest in itself [s].
  BodyKind kind = BodyKind::kDynamic;  ///< Of the body while it is rigid.
  BodyMass mass = {};                  ///< Of the body while it is rigid.

  [[nodiscard]] bool is_soft() const { return solid != 0; }
};

/// A hook of a body that is soft, as it was while the body was rigid. It is a ball or a distance meanwhile.
struct HeldHook {
  Hook hook = {};
  std::array<std::uint32_t, 2> helpers = {};  ///< Slots of the balls that hold what the kind holds besides; 0
                                              ///< for none.
};

}  // namespace hooke::state
