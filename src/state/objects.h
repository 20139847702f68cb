#pragma once

#include "hooke/desc.h"
#include "hooke/id.h"
#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// \file
/// What the tables of rows belong to: deformable objects, pins, fields.

namespace hooke::state {

inline constexpr double kAirPressure = 101325;  ///< Of the air around closed cloths [Pa].

/// Rows [first, first + count) of a table.
struct Rows {
  std::uint32_t first = 0;
  std::uint32_t count = 0;

  [[nodiscard]] std::uint32_t end() const { return first + count; }
};

/// Vertices that a solid carries along, and the triangles between them. Never changes after it was made.
struct Skin {
  struct Anchor {
    std::array<std::uint32_t, 4> points = {};  ///< Of the solid, in the maker's order.
    std::array<Real, 4> weights = {};          ///< With the sum 1.
  };
  std::vector<Anchor> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A place of an object under its name (ConnectionPointDesc). Never changes after it was made.
struct NamedPlace {
  std::string name;
  Vec3 position = {};                        ///< Of a body: from its center of mass, in its frame [m].
  std::array<std::uint32_t, 4> points = {};  ///< Of a deformable: points in the maker's order,
  std::array<Real, 4> weights = {};          ///< with the sum 1; 0 for places that are not used.
};
using NamedPlaces = std::vector<NamedPlace>;

/// x_b - x_a, x_c - x_a, x_d - x_a of each tetrahedron when it was made [m].
using RestEdges = std::vector<std::array<Vec3, 3>>;

/// The form at rest of a solid that is matched to it (solver/soft/shape_matching.h). Never changes after it
/// was made.
struct RestShape {
  std::vector<DVec3> place;  ///< Of each row, from the center of mass [m].
  double mass = 0;           ///< Of all points, pinned ones too [kg].
  double volume = 0;         ///< [m^3]; 0 of points alone.
  double inertia = 0;        ///< sum m q^2 [kg m^2].
  double stiffness = 0;      ///< k over mass, w^2 [1/s^2]; kRigid for a rigid body.
  double damping = 0;        ///< c over mass [1/s].
};

/// One rope, cloth, solid or group of particles: its origin and its rows. Objects stand in order of creation.
struct Deformable {
  PointRef::Kind kind = PointRef::Kind::kNone;
  std::uint32_t slot = 0;  ///< Of its id.
  DVec3 origin = {};       ///< Positions of its particles are offsets from here [m].
  Rows particles = {};
  Rows springs = {};
  Rows bends = {};
  Rows triangles = {};
  Rows segments = {};
  Rows tetrahedra = {};
  std::shared_ptr<const Skin> skin = {};  ///< Of a solid.
  std::shared_ptr<const NamedPlaces> connection_points = {};
  std::shared_ptr<const RestShape> rest_shape = {};  ///< Of a solid without tetrahedra.
  std::uint32_t columns = 0;                         ///< Of a cloth on a grid; 0 for others.
  double gas = 0;                  ///< Of a closed cloth: absolute pressure times volume [J]; 0 without.
  double gas_volume = 0;           ///< V when it was filled [m^3].
  Real bend_stiffness = Real(0);   ///< Of a rope: EI [N m^2].
  Real bend_damping = Real(0);     ///< Over EI [s].
  Real twist_stiffness = Real(0);  ///< Of a rope: GJ [N m^2].
  Real twist_rate = Real(0);       ///< Twist per length that it was made with [rad/m]; 0 once spans have it.
  Real yield_angle = kRigid;       ///< Of a cloth's bends [rad].
  Real yield_stress = kRigid;      ///< Of a solid [Pa].
  std::shared_ptr<const RestEdges> rest_edges = {};  ///< Of a solid that yields; by its tetrahedra.
  bool touches_ropes = false;         ///< Of a rope: it touches those that do so too, and itself.
  Real repulsion_strength = Real(0);  ///< Of a rope [N m^2]; 0: none.
  Real repulsion_range = Real(0);     ///< [m]
  Real friction = Real(0);
  Real drag_coefficient = Real(0);
  Real lift_coefficient = Real(0);
  bool points_drag = false;  ///< Some particle feels the air by itself: as a sphere, or by air friction.

  [[nodiscard]] bool feels_air() const {
    return points_drag || drag_coefficient > Real(0) || lift_coefficient > Real(0);
  }
};

/// A point that is held, and how it moves.
struct Pin {
  std::uint32_t object = 0;  ///< Row of the deformable.
  std::uint32_t particle = 0;
  DVec3 start = {};         ///< Where it was when the motion began [m].
  double start_time = 0.0;  ///< [s]
  MotionDesc motion = {};
};

struct Field {
  FieldDesc desc = {};
  std::uint32_t slot = 0;
};

/// One of the two is a function.
struct ForceLawEntry {
  ForceLaw law = {};
  BodyForceLaw body_law = {};
  std::uint32_t slot = 0;
};

}  // namespace hooke::state
