#pragma once

#include "hooke/math.h"

#include "geometry/point_grid.h"
#include "parallel/thread_pool.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Ropes with a repulsion, hair above all, keep points of others at a distance. It gives them thickness at
/// little cost.

namespace hooke::solver {

/// Memory of `repel`. It does not change a bit of the result.
struct Repulsion {
  struct Point {
    std::uint32_t row = 0;     ///< Row of the particle.
    std::uint32_t object = 0;  ///< Row of the rope.
    Vec3 v = {};               ///< Velocity [m/s].
    Real inverse_mass = Real(0);
    Real root_strength = Real(0);  ///< sqrt(s) [m sqrt(N)].
    Real range = Real(0);          ///< Range of the repulsion [m].
    Real arc = Real(0);            ///< Distance along the rope from its start, at rest [m].
    Real neighbors = Real(0);      ///< Number of points that push it.
  };
  /// Two points, seen from `point`, which is pushed along the normal.
  struct Pair {
    std::uint32_t point = 0;
    std::uint32_t other = 0;
    Vec3 normal = {};
    Real strength = Real(0);  ///< Strength of the pair [N m^2].
    Real range = Real(0);     ///< Range of the pair [m].
    Real free = Real(0);      ///< Distance that they would have after the substep [m].
  };
  /// What one worker finds for a range of the points.
  struct Part {
    std::vector<std::uint32_t> end;     ///< By point: end of its entries in `others`.
    std::vector<std::uint32_t> others;  ///< What may push each point, in ascending order.
    std::vector<Pair> pairs;            ///< Pairs of this substep.
  };
  std::vector<Point> points;    ///< In order of rows.
  std::vector<DVec3> places;    ///< Place of each point [m].
  std::vector<DVec3> found_at;  ///< Places when `others` were found [m].
  std::uint64_t revision = 0;   ///< Revision of the tables at that time.
  geometry::PointGrid grid;
  std::vector<Part> parts;
};

/// Pushes points of ropes with a repulsion apart, in a substep of length `h` [s] (elements/repulsion.h). Let
/// r be the mean of the ranges of two points. They push each other if they are nearer than r at the
/// substep's end and nearer than 1.5 r at its start, with the geometric mean of their strengths. Points of
/// one rope with less than pi / 2 r of it between them do not push each other: a rope that turns with such a
/// radius comes as near to itself.
///
/// Each pair is solved for the force at the end of the substep. Both ends find the same bits with opposite
/// sign, so that momentum stays. A point with n neighbors has 1/n of its mass in each pair (mass splitting,
/// Tonge, Benevolenski and Voroshilov 2012, "Mass splitting for jitter-free parallel rigid body
/// simulation"), so that all together are as stable as one.
void repel(parallel::ThreadPool& pool, Real h, Repulsion& memory, state::Tables& tables);

/// Energy of all such pairs [J]; it is zero out of range.
double repulsion_energy(const state::Tables& tables);

}  // namespace hooke::solver
