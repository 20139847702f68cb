#pragma once

#include "hooke/desc.h"
#include "hooke/id.h"
#include "hooke/math.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// \file
/// The owners of rows in the tables: deformable objects, pins, fields.

namespace hooke::state {

inline constexpr double kAirPressure = 101325;  ///< Pressure of the air around closed cloths [Pa].

/// Rows [first, first + count) of a table.
struct Rows {
  std::uint32_t first = 0;
  std::uint32_t count = 0;

  [[nodiscard]] std::uint32_t end() const { return first + count; }
};

/// Vertices that follow the points of a solid, and the triangles between them. A Skin never changes after it
/// was made.
struct Skin {
  struct Anchor {
    std::array<std::uint32_t, 4> points = {};  ///< Points of the solid, in the maker's order.
    std::array<Real, 4> weights = {};          ///< Weights of the points, with the sum 1.
  };
  std::vector<Anchor> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A named place of an object (ConnectionPointDesc). It never changes after it was made.
struct NamedPlace {
  std::string name;
  Vec3 position = {};                        ///< For a body: offset from its center of mass, in its frame
                                             ///< [m].
  std::array<std::uint32_t, 4> points = {};  ///< For a deformable: points in the maker's order.
  std::array<Real, 4> weights = {};          ///< Weights of the points, with the sum 1; 0 for entries that
                                             ///< are not used.
};
using NamedPlaces = std::vector<NamedPlace>;

/// x_b - x_a, x_c - x_a, x_d - x_a of each tetrahedron when it was made [m].
using RestEdges = std::vector<std::array<Vec3, 3>>;

/// The rest shape of a solid that is solved by shape matching (solver/solid/shape_matching.h). It never
/// changes after it was made.
struct RestShape {
  std::vector<DVec3> place;  ///< Rest position of each row, from the center of mass [m].
  double mass = 0;           ///< Mass of all points, pinned ones too [kg].
  double volume = 0;         ///< [m^3]; 0 for points alone.
  double inertia = 0;        ///< sum m q^2 [kg m^2].
  double stiffness = 0;      ///< k over mass, w^2 [1/s^2]; kRigid for a rigid body.
  double damping = 0;        ///< c over mass [1/s].
};

/// How a deformable touches others and itself (solver/surface). The three lengths follow from the description
/// and the form at rest.
struct Surface {
  /// Positions at rest by row [m]: which parts are near each other. Set where there are triangles.
  std::shared_ptr<const std::vector<Vec3>> rest_points = {};
  bool self_contact = false;     ///< It touches itself.
  FilterDesc filter = {};        ///< Which other deformables it touches.
  Real radius = Real(0);         ///< Distance that it keeps, of the sum of two [m].
  Real self_distance = Real(0);  ///< Distance that it keeps from itself [m].
  Real edge = Real(0);           ///< Mean length of an edge at rest [m].
  /// It may go through others or itself: it is new, was placed by hand, or went through something a step ago.
  bool may_cross = true;
};

/// One rope, cloth, solid or group of particles: its origin and its rows. Objects stand in order of creation.
struct Deformable {
  PointRef::Kind kind = PointRef::Kind::kNone;
  std::uint32_t slot = 0;      ///< Slot of the object's id.
  std::uint64_t revision = 0;  ///< Tables::revision when the object's rows or what they join last changed; no
                               ///< two objects of a World have the same.
  DVec3 origin = {};           ///< Positions of its particles are offsets from here [m].
  Rows particles = {};
  Rows springs = {};
  Rows bends = {};
  Rows triangles = {};
  Rows segments = {};
  Rows tetrahedra = {};
  std::shared_ptr<const Skin> skin = {};  ///< Set for a solid.
  std::shared_ptr<const NamedPlaces> connection_points = {};
  std::shared_ptr<const RestShape> rest_shape = {};  ///< Set for a solid without tetrahedra.
  std::uint32_t columns = 0;                         ///< Number of columns of a cloth on a grid; 0 for
                                                     ///< others.
  double gas = 0;                  ///< For a closed cloth, absolute pressure times volume [J]; 0 without gas.
  double gas_volume = 0;           ///< Volume V when the cloth was filled [m^3].
  Real bend_stiffness = Real(0);   ///< EI of a rope [N m^2].
  Real bend_damping = Real(0);     ///< Damping of bends over EI [s].
  Real twist_stiffness = Real(0);  ///< GJ of a rope [N m^2].
  Real twist_rate = Real(0);       ///< Twist per length that a rope was made with [rad/m]; 0 once spans have
                                   ///< it.
  Real strength = kRigid;          ///< Tension that a rope can take [N].
  bool has_gaps = false;           ///< Some segment of the rope is gone.
  Real tear_strain = kRigid;       ///< Strain at which a cloth tears.
  Real tear_stress = kRigid;       ///< Principal stress at which a solid tears [Pa].
  /// For each point that a cloth or a solid got by tearing or cutting: the point that it split from, in the
  /// maker's order.
  std::vector<std::uint32_t> split_from = {};
  /// Pairs of triangles or tetrahedra that a blade has parted, but which still have an edge or a face in
  /// common, because all around it holds; counted from the object's first one, the lower first, in order.
  std::vector<std::array<std::uint32_t, 2>> scored = {};
  Real yield_angle = kRigid;                         ///< Yield angle of a cloth's bends [rad].
  Real yield_stress = kRigid;                        ///< Yield stress of a solid [Pa].
  std::shared_ptr<const RestEdges> rest_edges = {};  ///< Set for a solid that yields; by its tetrahedra.
  bool touches_surfaces = false;      ///< The rope touches cloths, solids and ropes that have this flag.
  bool touches_ropes = false;         ///< The rope touches itself and all ropes that have this flag.
  Real repulsion_strength = Real(0);  ///< Repulsion of a rope [N m^2]; 0: none.
  Real repulsion_range = Real(0);     ///< Range of the repulsion [m].
  Real friction = Real(0);
  Real drag_coefficient = Real(0);
  Real lift_coefficient = Real(0);
  Surface surface = {};  ///< How it touches other deformables and itself.
  bool reports_contacts = false;
  Real hit_speed = kRigid;   ///< Speed from which on what meets it is reported [m/s].
  bool points_drag = false;  ///< Some particle feels the air by itself: as a sphere, or by air friction.

  [[nodiscard]] bool feels_air() const {
    return points_drag || drag_coefficient > Real(0) || lift_coefficient > Real(0);
  }
};

/// The rows of objects that stand next to each other, in one of the tables.
[[nodiscard]] inline Rows rows_of(std::span<const Deformable> objects, Rows Deformable::*table) {
  if (objects.empty()) return {};
  const std::uint32_t first = (objects.front().*table).first;
  return {first, (objects.back().*table).end() - first};
}

/// A point that is held, and the motion it is given.
struct Pin {
  std::uint32_t object = 0;  ///< Row of the deformable.
  std::uint32_t particle = 0;
  DVec3 start = {};         ///< Position when the motion began [m].
  double start_time = 0.0;  ///< Time when the motion began [s].
  MotionDesc motion = {};
};

struct Field {
  FieldDesc desc = {};
  std::uint32_t slot = 0;
};

/// Exactly one of the two laws is a function.
struct ForceLawEntry {
  ForceLaw law = {};
  BodyForceLaw body_law = {};
  std::uint32_t slot = 0;
};

}  // namespace hooke::state
