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
  std::vector<std::uint32_t> feature;   ///< For a mesh, the number of the triangle; ridges and peaks count on
                                        ///< after the triangles. 0 otherwise.
  std::vector<std::uint32_t> object;    ///< Row of the deformable.
  std::vector<std::uint32_t> body;      ///< Row of the body that the particle touches.
  std::vector<Real> friction;           ///< Friction coefficient of the pair.
  std::vector<Vec3> normal;             ///< Unit vector from the shape to the particle; written by
                                        ///< update_contacts.
  std::vector<Real> separation;         ///< Gap less the particle's radius [m]; written by update_contacts.
  std::vector<Vec3> lever;             ///< Vector from the body's center of mass to the particle [m]; written
                                       ///< by update_contacts.
  std::vector<Vec3> belt_velocity;     ///< Velocity of a conveyor's surface relative to its body [m/s];
                                       ///< written by update_contacts.
  std::vector<Vec3> surface_velocity;  ///< Velocity of the body's surface there, conveyors included [m/s];
                                       ///< written by update_contacts.
  std::vector<Real> normal_force;      ///< [N], 0 or more; carried from substep to substep.
  std::vector<Vec3> friction_force;    ///< [N]; carried for ropes, and to tell which points of solids stick.
  std::vector<std::uint8_t> coupled;   ///< 1 for rows that a coupled group has solved in this substep.

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
    visit(self.coupled);
  }
};

/// A contact of a shape with a segment of a rope or a triangle of a cloth, between its points, where none of
/// them touches. The contact is at sum weight x of the points, and its forces act on them in these shares.
/// Rows stand in order of object, collider and element.
struct ElementContact {
  std::uint32_t object = 0;  ///< Row of the deformable.
  std::uint32_t collider = 0;
  std::uint32_t element = 0;  ///< Row of the segment or the triangle.
  std::uint32_t edge = 0;     ///< 1 + k: only the triangle's edge from corner k; 0: the whole element.
  std::uint32_t feature = 0;  ///< For a mesh, the ridge or the peak (geometry/mesh/protrusions.h).
  std::uint32_t body = 0;
  std::uint32_t count = 0;                     ///< Number of points: 2 or 3.
  std::array<std::uint32_t, 3> particle = {};  ///< In ascending order.
  bool few = false;                            ///< The object has few element contacts with dynamic bodies.
  Real friction = Real(0);                     ///< Friction coefficient of the pair.
  /// The contact has been near enough to act since the step began, or in the last substep of the step before.
  /// Only such contacts join what is solved together, so that contacts which merely might come near cost
  /// nothing.
  bool joined = false;
  // The columns below are written by update_element_contacts.
  std::array<Real, 3> weight = {};  ///< Weights of the points, with the sum 1.
  Vec3 normal = {};                 ///< Unit vector from the shape to the element; zero before it was first
                                    ///< known.
  Real separation = Real(0);        ///< Gap less the element's thickness between its points [m].
  Vec3 lever = {};                  ///< Vector from the body's center of mass to the contact [m].
  Vec3 belt_velocity = {};          ///< As in Contacts [m/s].
  Vec3 surface_velocity = {};       ///< As in Contacts [m/s].
  Real normal_force = Real(0);      ///< [N], 0 or more; carried from substep to substep.
  Vec3 friction_force = {};         ///< [N]; carried from substep to substep.
  Real clearance = Real(0);         ///< Lower bound of the distance between the two; 0 where it is not known
                                    ///< [m].
};

/// A contact of two segments of ropes that touch ropes, of one rope or of two. The points that touch differ
/// by sum weight x of the four particles: the weights of the first two are positive, those of the last two
/// negative. Forces act on the four in these shares. Rows stand in order of segment_a, then of segment_b.
struct RopeContact {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::uint32_t segment_a = 0, segment_b = 0;  ///< Rows of the segments; a < b.
  std::uint32_t object_a = 0, object_b = 0;    ///< Rows of the ropes.
  std::array<std::uint32_t, 4> particle = {};  ///< Ends of a, then ends of b, in ascending order.
  Real friction = Real(0);                     ///< Friction coefficient of the pair.
  Real thickness = Real(0);                    ///< Sum of both radii [m].
  /// Rows of the contacts of b with the segments before and behind a, then of a with those before and behind
  /// b; or kNone.
  std::array<std::uint32_t, 4> neighbor = {kNone, kNone, kNone, kNone};
  Real least = Real(0);   ///< Least distance that the center lines keep [m].
  bool adjacent = false;  ///< The segments are neighbors along a rope: they do not touch, but they do not
                          ///< pass through each other either.
  bool joined = false;    ///< As in ElementContact.
  // The columns below are written by update_rope_contacts.
  std::array<Real, 4> weight = {};  ///< Weights of the points of a, with the sum 1, and of b, with the sum
                                    ///< -1.
  Vec3 normal = {};                 ///< Unit vector from b to a; zero where the contact does not act.
  Real separation = Real(0);        ///< Gap [m].
  Real normal_force = Real(0);      ///< [N], 0 or more; carried from substep to substep.
  Vec3 friction_force = {};         ///< Friction on a [N]; carried from substep to substep.
  Real clearance = Real(0);         ///< Lower bound of the distance between the two; 0 where it is not known
                                    ///< [m].
  std::uint32_t successor = kNone;  ///< Row of the neighbor that is nearer and acts in place of this one; or
                                    ///< kNone.
};

}  // namespace hooke::state
