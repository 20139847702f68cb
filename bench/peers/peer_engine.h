#pragma once

#include "peer_scene.h"

#include <cstdint>
#include <memory>

namespace hooke::bench {

/// A PeerEngine is an engine with a scene in it. Settings are those of docs/benchmarks.md.
class PeerEngine {
 public:
  PeerEngine() = default;
  PeerEngine(const PeerEngine&) = delete;
  PeerEngine& operator=(const PeerEngine&) = delete;
  virtual ~PeerEngine() = default;

  /// Sets how a kinematic body moves in the next step, from one motion to the other.
  virtual void drive(std::size_t body, const PeerMotion& from, const PeerMotion& to) = 0;
  virtual void step(double dt) = 0;
  [[nodiscard]] virtual PeerMotion motion(std::size_t body) const = 0;
  /// Returns the number of points at which bodies touched in the last step, as the engine counts them.
  [[nodiscard]] virtual std::uint32_t contacts() const = 0;
};

/// The Error kUnsupported names a shape that the engine does not have.
Result<std::unique_ptr<PeerEngine>> make_bullet(const PeerScene& scene);
Result<std::unique_ptr<PeerEngine>> make_ode(const PeerScene& scene);

}  // namespace hooke::bench
