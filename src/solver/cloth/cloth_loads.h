#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"
#include "state/tables.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// \file
/// Solids that press on cloths which are solved as a whole. Each point of a solid weighs on a cloth through a
/// row of contact of surfaces, whose impulses the solution finds with its springs: after a solution without
/// them, rows would push light points of the cloth aside, and its springs would throw back what lies on it.
/// Rows begin with these impulses (solver/surface/solid_loads.h).
///
/// Stiff solids weigh on it as wholes, and move in the solution as bodies do: impulses on single points of
/// them would strain them, and they would throw that back.

namespace hooke::solver {

/// The side of a row of contact that faces a cloth, with the solid on its other side.
struct ClothLoad {
  std::uint32_t object = 0;                    ///< Row of the cloth.
  std::array<std::uint32_t, 3> particle = {};  ///< Rows of its points in the contact.
  std::array<double, 3> weight = {};           ///< Of each point; they are positive, or 0 for what is unused.
  std::uint32_t block = 0;                     ///< Block of the row in its group.
  int lane = 0;                                ///< Its lane there.
  bool cloth_is_first = true;                  ///< Whether the cloth is the first side of the row.
  DVec3 normal = {};                           ///< Unit vector from the solid to the cloth.
  double inverse_mass = 0;  ///< Of the solid there along any direction [1/kg]; 0 if it is held.
  double separation = 0;    ///< Distance to go until the row acts [m], not negative.
  double friction = 0;      ///< Coefficient.
  DVec3 surface = {};       ///< Velocity of the solid there [m/s].
  std::uint32_t solid = 0;  ///< Row of the solid.
  bool is_whole = false;    ///< It weighs as a whole: it is stiff, and nothing pins it.
  DVec3 place = {};         ///< Where it touches, from the solid's origin [m].
  bool is_left = false;     ///< The cloth is not solved with it: the row alone acts.
  bool is_solved = false;   ///< The cloth was.
  DVec3 impulse = {};       ///< What the solid gives to the cloth by the solution [N s].
  /// What the cloth gives to a solid that is whole, written to the first of its loads on the cloth: impulse
  /// [N s] and angular impulse about its center [N m s], as ClothPress::push.
  DVec3 push = {}, turn = {};
  DVec3 lever = {};  ///< From that center to where it touches [m]; 0 for solids that are not whole.
};

/// A solid that moves as a whole.
struct WholeSolid {
  double mass = 0;                        ///< [kg]
  DVec3 center = {};                      ///< Of mass, from its origin [m].
  DVec3 velocity = {};                    ///< Of its center [m/s].
  DVec3 spin = {};                        ///< Angular momentum about it [N m s].
  math::Symmetric3<double> inertia = {};  ///< About it [kg m^2].
};
[[nodiscard]] WholeSolid whole_solid(std::uint32_t object, const state::Tables& tables);

/// Gives solids that are whole the impulses of the solutions.
void release_solid_loads(std::span<const ClothLoad> loads, state::Tables& tables);

/// The loads of one cloth in its solution. Each is a contact whose stiffness is the mass of the other side:
/// an impulse p along n with p = m max(0, n.s - g / h - n.v), v and s being velocities of the cloth and the
/// solid and g the gap, and friction that stops sliding, or has the size of mu p. A solid that is whole adds
/// two vectors to the unknowns of the solution: velocity of its center and its rotation, scaled so that half
/// of its square is its energy [J^0.5].
class ClothLoads {
 public:
  /// Takes those of the cloth `object` in a substep of `h` [s], and lists the velocities and masses of whole
  /// solids behind the unknowns of the solution, of which the points of the cloth come first.
  void take(std::uint32_t object, std::span<const ClothLoad> loads, double h, const state::Tables& tables,
            std::vector<DVec3>& velocities, std::vector<double>& masses);

  [[nodiscard]] bool empty() const { return loads_.empty(); }
  /// Sum of the masses that press [kg].
  [[nodiscard]] double mass() const;

  /// Lets all stick that press at these velocities.
  void begin(std::span<const DVec3> velocities);
  /// The sum of m (n.(v - s))^2 / 2 of what presses, and of what friction dissipates [J].
  [[nodiscard]] double energy(std::span<const DVec3> velocities) const;
  /// Adds the impulses, and how they resist changes to the resistances of the points.
  void add(std::span<const DVec3> velocities, std::span<DVec3> impulses,
           std::span<math::Symmetric3<double>> resistances);
  /// Adds how the loads resist changes, as they were added last.
  void resist(std::span<const DVec3> changes, std::span<DVec3> impulses) const;
  /// Finds which loads slide, and by how much drag. Returns whether anything changed.
  [[nodiscard]] bool renew(std::span<const DVec3> velocities);
  /// Writes the impulses to those taken. `before` are velocities without the cloth.
  void note_impulses(std::span<const DVec3> velocities, std::span<const DVec3> before,
                     std::span<ClothLoad> loads);

 private:
  struct Load {
    std::size_t index = 0;  ///< In the list that was taken.
    std::array<std::size_t, 3> point = {};
    std::array<double, 3> weight = {};
    DVec3 normal = {};
    DVec3 surface = {};         ///< Velocity of the solid there, 0 if it is an unknown [m/s].
    double least_speed = 0;     ///< Along the normal, of the cloth relative to unknowns [m/s].
    double mass = 0;            ///< [kg]
    std::size_t solid = kNone;  ///< In `solids_`, if it is whole.
    DVec3 lever = {};           ///< From its center [m].
    double friction = 0;
    double drag = 0;   ///< Of friction [kg]: the mass where it sticks.
    double along = 0;  ///< Resistance along the normal [kg]: the mass, or 0 where the solid does not press.
  };

  struct Solid {
    std::uint32_t object = 0;
    WholeSolid whole = {};
    Matrix3<double> scale = {};  ///< Angular velocity over scaled rotation.
    int cloths = 1;              ///< Number of cloths that it presses on; each takes that part of its mass.
    std::size_t row = 0;         ///< Of its first vector among the unknowns.
    bool is_noted = false;
  };
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] std::size_t take_solid(const ClothLoad& of, std::span<const ClothLoad> loads,
                                       const state::Tables& tables, std::vector<DVec3>& velocities,
                                       std::vector<double>& masses);
  [[nodiscard]] DVec3 motion_of(const Load& load, std::span<const DVec3> of) const;
  [[nodiscard]] DVec3 turned(const Load& load, DVec3 scaled_rotation) const;
  void push(const Load& load, DVec3 impulse, std::span<DVec3> impulses) const;
  [[nodiscard]] static double push_of(const Load& load, DVec3 motion);
  [[nodiscard]] static DVec3 sliding(const Load& load, DVec3 motion);
  void add_resistance(const Load& load, std::span<math::Symmetric3<double>> resistances) const;

  std::vector<Load> loads_;
  std::vector<Solid> solids_;
};

}  // namespace hooke::solver
