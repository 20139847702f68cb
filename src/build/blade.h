#pragma once

#include "hooke/cut.h"
#include "hooke/math.h"

#include "geometry/box.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// Cuts by a blade that sweeps two triangles. Two neighbors part if the straight way from the middle of the
/// one to that of the other crosses the swept surface. These ways are a graph: whoever goes along them from
/// one side of the blade to the other crosses it, so that a blade which goes all through an object always
/// separates it; signs of exact determinants decide. Points become as many as their elements form parts then.
/// Compare the cuts along faces of Molino, Bao and Fedkiw 2004, "A virtual node algorithm for changing mesh
/// topology during simulation".

namespace hooke::build {

/// What the edge of a blade sweeps.
class SweptBlade {
 public:
  SweptBlade(const std::array<DVec3, 2>& from, const std::array<DVec3, 2>& to);

  /// Whether the way from `p` to `q` crosses the surface an odd number of times.
  [[nodiscard]] bool crosses(DVec3 p, DVec3 q) const;
  /// Whether a box comes near the surface.
  [[nodiscard]] bool may_meet(const geometry::Box3<double>& box) const;

 private:
  DVec3 a_, b_, c_, d_;  ///< The triangles a b c and a c d.
  geometry::Box3<double> box_;
};

/// Segments of a rope that the surface crosses and that still hold, in ascending order.
[[nodiscard]] std::vector<std::uint32_t> find_cut_segments(const state::Deformable& rope,
                                                           const SweptBlade& blade,
                                                           const state::Tables& tables);

/// Cuts a cloth; nothing if the blade parts no edge of it. The caller sets ClothCut::cloth.
std::optional<ClothCut> cut_cloth(std::uint32_t object, const SweptBlade& blade, state::Tables& tables);

/// Cuts a solid of tetrahedra likewise, at its faces.
std::optional<SolidCut> cut_solid(std::uint32_t object, const SweptBlade& blade, state::Tables& tables);

}  // namespace hooke::build
