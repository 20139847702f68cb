#pragma once

#include "hooke/scene_io.h"

#include <string>
#include <vector>

namespace hooke::app {

/// A Mover is an object that forces move: a dynamic body, or a rope, cloth, solid or particles.
struct Mover {
  std::string name;
  BodyId body = {};                ///< Id of a body; null for other kinds.
  SceneObject object = {};         ///< What it is, with its ids.
  std::vector<double> masses;      ///< Mass of each point, or of the body [kg]; 0 for a pinned point.
  bool loose = false;              ///< Whether it has come off, so that its fall no longer counts.
  std::vector<DVec3> places = {};  ///< Where its points, or the body's center of mass, were at the last mark.
};

/// How far something has moved since the last mark.
struct Move {
  std::string name = {};
  DVec3 way = {};  ///< [m]
};

/// A Movers is all that moves in a simulation. It knows the ids of objects, and must not outlive them.
class Movers {
 public:
  /// Reads the masses, for which it makes a step that it takes back.
  explicit Movers(Simulation& simulation);

  /// Returns what moves now; what is loose does not count.
  [[nodiscard]] Unrest unrest(const World& world, double dt) const;
  /// Takes all speed from everything that is not loose.
  void stop(World& world) const;

  /// Remembers where everything is.
  void mark(const World& world);
  /// Lists how far each object moved since the mark, by its point that moved most, the farthest first; those
  /// that are loose are left out.
  [[nodiscard]] std::vector<Move> moves(const World& world) const;

  /// Marks as loose what has moved more than `way` [m] since the mark, if no hook joins it to the world, to a
  /// body that does not move, to a pinned point or to one of `held`, and if no body touches it. Returns the
  /// names of those that are newly loose.
  std::vector<std::string> find_loose(const Simulation& simulation, const std::vector<std::string>& held,
                                      double way);

  /// Mass of all [kg].
  [[nodiscard]] double mass() const;
  /// Largest side of the box around everything that moves and what its hooks hold it by [m].
  [[nodiscard]] double extent(const Simulation& simulation) const;
  [[nodiscard]] const std::vector<Mover>& all() const { return movers_; }
  [[nodiscard]] std::vector<bool> loose() const;
  void set_loose(const std::vector<bool>& loose);

 private:
  /// What is loose.
  [[nodiscard]] LeftOut left_out() const;

  std::vector<Mover> movers_;
};

/// Place of point `index` of a mover, or of its center of mass if it is a body [m].
[[nodiscard]] DVec3 place_of(const World& world, const Mover& mover, std::size_t index);

}  // namespace hooke::app
