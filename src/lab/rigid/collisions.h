#pragma once

#include "lab/methods/part.h"
#include "lab/rigid/region.h"

#include <cstdint>
#include <vector>

namespace hooke::lab {

/// Bodies that collide are kept in regions. A region consists of bodies that meet within a step; they take it
/// together, and only they take it again where it has to be canceled (the paper's 4.5.1).
class Collisions {
 public:
  /// Errors are those of rigid_bodies.
  static Result<Collisions> create(const state::Tables& tables, const Options& options);

  /// Moves the parts that collide from `t` by an output step `dt`. Regions whose swept boxes overlap are
  /// joined and begin the step again. After an Error of a method the parts must not be used.
  Result<void> advance(double t, double dt, std::vector<Part>& parts);

  /// Tells whether a part collides; the others move freely.
  [[nodiscard]] bool collides(std::size_t part) const {
    return part < collides_.size() && collides_[part] != 0;
  }
  [[nodiscard]] const CollisionReport& report() const { return report_; }

 private:
  /// This is the result of one region after its step.
  struct Outcome {
    std::vector<std::uint32_t> members = {};
    std::vector<Box> swept = {};
    CollisionReport report = {};
    bool done = false;
  };

  Result<void> run(Outcome& region, double t, double dt, std::vector<Part>& parts) const;
  [[nodiscard]] bool may_collide(const Outcome& a, const Outcome& b) const;
  bool join_crossing(std::vector<Outcome>& regions) const;
  void add(const CollisionReport& report);

  CollisionSetting setting_ = {};
  std::vector<RigidBody> bodies_ = {};
  std::vector<std::uint32_t> movers_ = {}, still_ = {};
  std::vector<std::uint8_t> collides_ = {};
  CollisionReport report_ = {};
};

}  // namespace hooke::lab
