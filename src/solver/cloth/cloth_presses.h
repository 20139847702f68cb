#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// \file
/// Bodies that press on points of cloths which are solved as a whole. They move in that solution, too: points
/// that stick go along with their body, those that slide do so along the normal. A body's whole weight is
/// felt by all springs at once; with a pass for springs and one for contacts, 4 kg on a cloth of 0.3 kg with
/// a limit of 5 % stretched it by 192 %. Contacts come after that, and find what is left.

namespace hooke::solver {

/// A contact of a point of a cloth with a body.
struct ClothPress {
  std::uint32_t particle = 0;
  std::uint32_t body = 0;
  DVec3 normal = {};        ///< Unit vector from the body to the point.
  DVec3 lever = {};         ///< From the body's center of mass to the point [m].
  DVec3 belt = {};          ///< Velocity of the surface relative to the body [m/s].
  double closing = 0;       ///< Speed that closes the gap within the substep [m/s].
  double friction = 0;      ///< Coefficient.
  double drag = 0;          ///< Friction of a point that slid in the substep before, over its speed now [kg].
  bool gives_way = false;   ///< The body does.
  bool presses = false;     ///< It did in the substep before, or is about to.
  bool slides = false;      ///< It did in the substep before.
  double share = 0;         ///< Mass of the body over the number of its presses, 0 if it does not press [kg].
  std::size_t contact = 0;  ///< Row in state::Contacts.
  int cloths = 1;           ///< Number of cloths that hold the body; each takes that part of its mass.
  DVec3 impulse = {};       ///< What the body gives to the point by the solution [N s].
  /// What the cloth gives to the body in all, written to the first of its presses: impulse [N s] and angular
  /// impulse about its center [N m s]. It is what slows the body in the solution, and not the sum of the
  /// others, which is without measure where the solution has come to no end.
  DVec3 push = {}, turn = {};
};

/// Lists the contacts of points of cloths with bodies, in order of particles, at the start of a
/// substep of `h` [s].
void find_cloth_presses(const state::Tables& tables, Real h, std::vector<ClothPress>& presses);

/// Shares out the mass of each body to its presses. `pressing` is scratch.
void share_out_bodies(const state::Tables& tables, std::span<ClothPress> presses,
                      std::vector<std::uint32_t>& pressing);

/// Gives bodies the impulses of the solutions. Call it before contacts are solved.
void release_cloth_presses(std::span<const ClothPress> presses, state::Tables& tables);

/// Adds these impulses to the forces of contacts. Call it after contacts, in a substep of `h` [s].
void settle_cloth_presses(std::span<const ClothPress> presses, Real h, state::Contacts& contacts);

/// The bodies on one cloth. Velocities and impulses of all unknowns stand in one list: those of points first,
/// then two vectors of each body, of its center and of its scaled rotation (state::MotionRecord).
class PressingBodies {
 public:
  /// Takes the bodies of `presses`, and lists their velocities and masses behind those of `points` points.
  void take(std::uint32_t first_particle, std::span<const ClothPress> presses, const state::Tables& tables,
            std::vector<DVec3>& velocities, std::vector<double>& masses);

  [[nodiscard]] bool empty() const { return presses_.empty(); }
  /// Whether what does not give way holds the cloth.
  [[nodiscard]] bool is_held() const { return is_held_; }
  /// Mass of the bodies that press [kg].
  [[nodiscard]] double mass() const;

  /// Gives points that bodies hold the change that goes along with changes of bodies.
  void follow(std::span<DVec3> changes) const;
  /// The same for velocities: gaps close, and belts move.
  void move_along(std::span<DVec3> velocities) const;
  /// Hands over to bodies what acts on the points that they hold.
  void gather(std::span<DVec3> impulses) const;
  /// Restricts the resistances of points to their freedom, and adds those that bodies feel to theirs.
  void restrict_resistances(std::span<math::Symmetric3<double>> resistances) const;

  /// What friction of points that slide dissipates [J], the impulses that it gives, which are added with the
  /// resistances of the points, and how it resists changes.
  [[nodiscard]] double friction_energy(std::span<const DVec3> velocities) const;
  void add_friction(std::span<const DVec3> velocities, std::span<DVec3> impulses,
                    std::span<math::Symmetric3<double>> resistances) const;
  void resist(std::span<const DVec3> changes, std::span<DVec3> impulses) const;

  /// Lets go points that are pulled, takes hold of those that would pass, and finds which slide. `residual`
  /// and `resistances` are what acts on each point by itself and how it resists, friction included. Returns
  /// whether anything changed.
  [[nodiscard]] bool renew(std::span<const DVec3> velocities, std::span<const DVec3> residual,
                           std::span<const math::Symmetric3<double>> resistances);

  /// Writes what bodies and points give each other to those taken, for the same residual. `before` are
  /// velocities without the cloth. Points of what is not solved to the end share evenly.
  void note_impulses(std::span<const DVec3> velocities, std::span<const DVec3> before,
                     std::span<const DVec3> residual, bool is_solved, std::span<ClothPress> presses);

 private:
  static constexpr std::size_t kHeld = std::numeric_limits<std::size_t>::max();

  enum class Touch : std::uint8_t { kFree, kSlides, kSticks };
  struct Press {
    ClothPress of;
    std::size_t index = 0;  ///< In the list that was taken.
    std::size_t point = 0;
    std::size_t row = 0;  ///< Of the body's first vector.
    std::size_t body = 0;
    Touch touch = Touch::kFree;
    double drag = 0;  ///< Friction over speed, while it slides [kg].
  };
  struct Body {
    std::uint32_t row = 0;  ///< In the table.
    math::Symmetric3<double> scale = {};
    double mass = 0;  ///< [kg]
    bool presses = false;
  };

  [[nodiscard]] DVec3 motion_at(const Press& press, std::span<const DVec3> of) const;
  [[nodiscard]] DVec3 sliding(const Press& press, std::span<const DVec3> velocities) const;
  void push_body(const Press& press, DVec3 impulse, std::span<DVec3> impulses) const;
  [[nodiscard]] bool renew(Press& press, std::span<const DVec3> velocities, DVec3 residual,
                           double resistance) const;

  std::vector<Press> presses_;
  std::vector<Body> bodies_;
  std::vector<std::uint8_t> is_noted_;  ///< Scratch: by body.
  std::vector<int> held_;               ///< Scratch: by body, points that it holds.
  bool is_held_ = false;
};

}  // namespace hooke::solver
