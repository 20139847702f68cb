#pragma once

#include "hooke/math.h"

#include "geometry/point_grid.h"
#include "parallel/thread_pool.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Ropes with a repulsion, hair above all, keep points of others at a distance: thickness at little cost.

namespace hooke::solver {

/// Memory of `repel`. Nothing in it changes a bit of the result.
struct Repulsion {
  struct Point {
    std::uint32_t row = 0;     ///< Of the particle.
    std::uint32_t object = 0;  ///< Row.
    Vec3 v = {};               ///< [m/s]
    Real inverse_mass = Real(0);
    Real root_strength = Real(0);  ///< sqrt(s) [m sqrt(N)].
    Real range = Real(0);          ///< [m]
    Real arc = Real(0);            ///< Along its rope, at rest [m].
    Real neighbors = Real(0);      ///< Those that push it.
  };
  /// Seen from `point`, which it pushes along the normal.
  struct Pair {
    std::uint32_t point = 0;
    std::uint32_t other = 0;
    Vec3 normal = {};
    Real strength = Real(0);  ///< [N m^2]
    Real range = Real(0);     ///< [m]
    Real free = Real(0);      ///< How far apart they would be after the substep [m].
  };
  /// Of some of the points, one after the other.
  struct Part {
    std::vector<std::uint32_t> end;     ///< Of what may push each, in `others`.
    std::vector<std::uint32_t> others;  ///< In ascending order for each point.
    std::vector<Pair> pairs;            ///< In this substep.
  };
  std::vector<Point> points;    ///< In order of rows.
  std::vector<DVec3> places;    ///< Of each [m].
  std::vector<DVec3> found_at;  ///< Places when `others` were found [m].
  std::uint64_t revision = 0;   ///< Of the tables then.
  geometry::PointGrid grid;
  std::vector<Part> parts;
};

/// Pushes points of ropes with a repulsion apart, in a substep of length `h` [s] (elements/repulsion.h):
/// those nearer to each other than r, the mean of their ranges, at the substep's end, and than 1.5 r at its
/// start, with the geometric mean of their strengths. Points with less than pi / 2 r of one rope between them
/// do not push each other: as near as it comes to itself in a turn so wide.
///
/// Each pair is solved for the force at the end of the substep, from both ends to the same bits and opposite:
/// momentum stays. A point with n neighbors has 1/n of its mass in each pair (mass splitting, Tonge,
/// Benevolenski and Voroshilov 2012, "Mass splitting for jitter-free parallel rigid body simulation"), so
/// that all together are as stable as one.
void repel(parallel::ThreadPool& pool, Real h, Repulsion& memory, state::Tables& tables);

/// Of all such pairs [J]; zero out of range.
double repulsion_energy(const state::Tables& tables);

}  // namespace hooke::solver
