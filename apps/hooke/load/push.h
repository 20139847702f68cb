#pragma once

#include "hooke/load/movers.h"

#include <optional>
#include <string>
#include <vector>

namespace hooke::app {

/// A Push is a force on named objects, as a dead load: its direction never changes.
class Push {
 public:
  /// Finds what is to be pushed. A name is "BODY", "ROPE:3", "ROPE:last" or "ROPE", and the same for cloths,
  /// solids and particles; all points of one without a number share its force evenly, but for pinned ones.
  /// `at` is a place [m] on the one body that is named, or near the point that is meant of another object.
  /// Errors: a name that no object has, that cannot move or is no point, a direction of no length, `at` with
  /// several names.
  static Result<Push> create(const Simulation& simulation, const Movers& movers,
                             const std::vector<std::string>& names, const std::optional<DVec3>& at,
                             DVec3 direction);

  /// Pushes for the next step with `force` [N] in all, shared evenly by the names.
  [[nodiscard]] Result<void> apply(World& world, double force) const;

  /// Where the force acts: its mean place [m].
  [[nodiscard]] DVec3 place(const World& world) const;
  /// Distance of the place that moved farthest since then from where it was [m]; `before` is from places().
  [[nodiscard]] double farthest(const World& world, const std::vector<DVec3>& before) const;
  /// Every place at which the force acts [m].
  [[nodiscard]] std::vector<DVec3> places(const World& world) const;

  [[nodiscard]] DVec3 direction() const { return direction_; }
  /// Names of the objects that are pushed.
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  struct Target {
    BodyId body = {};
    DVec3 local = {};        ///< Place in the body's frame [m].
    bool at_center = true;   ///< Whether it is the center of mass instead.
    std::size_t object = 0;  ///< Index of what is pushed in `objects_`.
    PointRef point = {};     ///< The point, if it is no body.
    double share = 0;        ///< Share of the force.
  };

  /// Adds what one word of `--on` means.
  Result<void> add(const Simulation& simulation, const Movers& movers, const std::string& word,
                   const std::optional<DVec3>& at);
  [[nodiscard]] DVec3 place_of(const World& world, const Target& target) const;

  std::vector<Target> targets_;
  std::vector<SceneObject> objects_;
  DVec3 direction_ = {};
};

}  // namespace hooke::app
