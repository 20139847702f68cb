#pragma once

#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hooke::state {

/// Particles near shapes, found by detect. Rows stand in order of particle, then collider, then feature.
struct Contacts {
  std::vector<std::uint32_t> particle;
  std::vector<std::uint32_t> collider;  ///< Row of the collider table.
  std::vector<std::uint32_t>
      feature;  ///< Of a mesh: the triangle, or behind all of those the ridge or peak; 0 otherwise.
  std::vector<std::uint32_t> object;   ///< Row of the deformable.
  std::vector<std::uint32_t> body;     ///< Row of the body touched.
  std::vector<Real> friction;          ///< Of the pair.
  std::vector<Vec3> normal;            ///< From the shape to the particle; written by update_contacts.
  std::vector<Real> separation;        ///< Gap less the particle's radius [m]; written by update_contacts.
  std::vector<Vec3> lever;             ///< From the body's center of mass to the particle [m]; written by
                                       ///< update_contacts.
  std::vector<Vec3> belt_velocity;     ///< Of a conveyor's surface against its body [m/s]; written by
                                       ///< update_contacts.
  std::vector<Vec3> surface_velocity;  ///< Of the body there, with that of conveyors [m/s]; written by
                                       ///< update_contacts.
  std::vector<Real> normal_force;      ///< [N], 0 or more; carried from substep to substep.
  std::vector<Vec3> friction_force;    ///< [N]; carried for ropes.

  [[nodiscard]] int count() const { return static_cast<int>(particle.size()); }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.particle);
    visit(self.collider);
    visit(self.feature);
    visit(self.object);
    visit(self.body);
    visit(self.friction);
    visit(self.normal);
    visit(self.separation);
    visit(self.lever);
    visit(self.belt_velocity);
    visit(self.surface_velocity);
    visit(self.normal_force);
    visit(self.friction_force);
  }
};

/// A shape inside a segment of a rope or a triangle of a cloth: between its points, where none of them
/// touches. The place is sum weight x of the points, and what acts there acts on them in these shares. Rows
/// stand in order of object, collider and element.
struct ElementContact {
  std::uint32_t object = 0;  ///< Row of the deformable.
  std::uint32_t collider = 0;
  std::uint32_t element = 0;  ///< Row of the segment or the triangle.
  std::uint32_t edge = 0;     ///< 1 + k: only the triangle's edge from corner k; 0: all of it.
  std::uint32_t feature = 0;  ///< Of a mesh: the ridge or the peak (geometry/mesh/protrusions.h).
  std::uint32_t body = 0;
  std::uint32_t count = 0;                     ///< Of points: 2 or 3.
  std::array<std::uint32_t, 3> particle = {};  ///< In ascending order.
  bool few = false;                            ///< The object has few of them with bodies that forces move.
  Real friction = Real(0);                     ///< Of the pair.
  /// It has been near enough to act since the step began, or in the last substep of the step before: it
  /// counts for who is solved with whom, and what only might come near costs nothing.
  bool joined = false;
  // Written by update_inner_contacts.
  std::array<Real, 3> weight = {};  ///< With the sum 1.
  Vec3 normal = {};                 ///< From the shape to the element; zero before it was first known.
  Real separation = Real(0);        ///< Gap less the element's thickness between its points [m].
  Vec3 lever = {};                  ///< From the body's center of mass to the place [m].
  Vec3 belt_velocity = {};          ///< As of Contacts [m/s].
  Vec3 surface_velocity = {};       ///< As of Contacts [m/s].
  Real normal_force = Real(0);      ///< [N], 0 or more; carried from substep to substep.
  Vec3 friction_force = {};         ///< [N]; carried from substep to substep.
  Real clearance = Real(0);         ///< By how much the two are apart, at least; 0 where it is not known [m].
};

/// Two segments of ropes that touch ropes, of one or of two. The places that touch are sum weight x of the
/// first two particles and minus that of the last two: what acts there acts on the four in these shares. Rows
/// stand in order of segment_a, then of segment_b.
struct RopeContact {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::uint32_t segment_a = 0, segment_b = 0;  ///< Rows; a < b.
  std::uint32_t object_a = 0, object_b = 0;    ///< Rows of the ropes.
  std::array<std::uint32_t, 4> particle = {};  ///< Ends of a, ends of b: in ascending order.
  Real friction = Real(0);                     ///< Of the pair.
  Real thickness = Real(0);                    ///< Sum of both radii [m].
  /// Rows of the segments before and behind a with b, then of a with those before and behind b; or kNone.
  std::array<std::uint32_t, 4> neighbor = {kNone, kNone, kNone, kNone};
  Real least = Real(0);  ///< So near the lines in their middles never come [m].
  bool adjacent =
      false;  ///< Neighbors along a rope: they do not touch, but do not pass through each other either.
  bool joined = false;  ///< As of InnerContact.
  // Written by update_rope_contacts.
  std::array<Real, 4> weight = {};  ///< Of a positive with the sum 1, of b negative with the sum -1.
  Vec3 normal = {};                 ///< From b to a; zero where it does not hold.
  Real separation = Real(0);        ///< Gap [m].
  Real normal_force = Real(0);      ///< [N], 0 or more; carried from substep to substep.
  Vec3 friction_force = {};         ///< On a [N]; carried from substep to substep.
  Real clearance = Real(0);         ///< By how much the two are apart, at least; 0 where it is not known [m].
  std::uint32_t successor = kNone;  ///< Row of the neighbor that is nearer, and holds in its place; or kNone.
};

}  // namespace hooke::state
