#pragma once

#include "hooke/math.h"

#include "solver/cloth/cloth_loads.h"
#include "solver/cloth/cloth_presses.h"
#include "solver/cloth/cloth_solution.h"
#include "solver/soft/pass_masses.h"
#include "state/tables.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Cloths that bear what is much heavier than their yarns. Passes over yarns and springs each know only of
/// their own points there: 5 kg on one point of a flag of 0.2 kg stretched it by 122 %, whatever its limit
/// was, and had seven times its energy. Such cloths are solved as a whole (solver/cloth/cloth_solution.h).
/// Passes give them their first guess.

namespace hooke::solver {

/// How much a cloth can bear by its yarns.
struct ClothBearing {
  std::uint32_t object = 0;       ///< Row of the cloth.
  Real most_mass = kRigid;        ///< Largest mass of a point with what it bears [kg].
  bool has_heavy_points = false;  ///< Points of its own have more.
  double link_length = 0;         ///< Mean length of its springs along edges [m].
  /// Its isometric bends have springs of their own (solver/soft/isometric_bending.h): both are to be solved
  /// in one, as passes over bends would count these springs twice.
  bool bends_have_springs = false;
};

/// A cloth that is solved as a whole in this substep.
struct LoadedCloth {
  std::uint32_t object = 0;  ///< Row of the cloth.
  std::size_t first = 0;     ///< Of its points in LoadedCloths::unsprung.
  bool with_bends = false;   ///< Its isometric bends are solved with its springs.
};

struct LoadedCloths {
  /// Rows of the particles to which what presses on them, or what they are hooked to, has lent its mass.
  std::vector<std::uint32_t> lent;
  std::vector<ClothPress> presses;     ///< In order of particles.
  std::vector<PressingBody> pressing;  ///< What presses on points of loaded cloths, in ascending order.
  std::vector<LoadedCloth> cloths;     ///< In the order of objects.
  /// By object, 1 for those of these cloths that bear too much at single points; empty if there are none.
  std::vector<std::uint8_t> loaded_at_points;
  std::vector<Vec3> unsprung;  ///< What their points would do without springs [m/s].
  std::vector<Vec3> sprung;    ///< Velocities of the points, set aside by begin_outside_forces [m/s].
  std::vector<ClothSolution> solutions;      ///< Memory, one for each part of a parallel loop.
  std::vector<std::uint8_t> is_unconverged;  ///< By cloth, 1 for what was not solved to the end.
  std::vector<std::uint8_t> marks;           ///< Scratch: by bearing, how it is loaded, or 0.
  std::vector<double> pressing_masses;       ///< Scratch: by bearing, the mass that presses on it [kg].
  std::vector<std::uint8_t> is_left;         ///< Scratch: by bearing, 1 where contacts alone bear too much.
  std::vector<std::uint32_t> bodies;         ///< Scratch: rows of bodies.
  std::vector<PressingBody> pairs;           ///< Scratch: cloths with bodies.
};

/// Finds what each cloth can bear; call it when tables change.
[[nodiscard]] std::vector<ClothBearing> find_bearings(const state::Tables& tables);

/// Finds the cloths that are loaded by bodies which press on points, in this substep of length `h` [s], and
/// which bodies these are. Not among them are bodies that would move by more than half a link within the
/// substep, those hooked to the cloth, and what presses on tangled cloths or on those that hold gas. Returns
/// the number of cloths on which such a body presses with more mass than they bear, except by hooks. `loads`
/// are the solids that press on cloths; those that are to be left to contacts are marked.
[[nodiscard]] std::uint32_t find_pressed_cloths(std::span<const ClothBearing> bearings,
                                                const state::Tables& tables, Real h,
                                                std::span<ClothLoad> loads, LoadedCloths& loaded);

/// Adds those that are loaded by points of their own or by LoadedCloths::lent, and notes the velocities of
/// the points of all. Call it after find_pressed_cloths.
void find_loaded_cloths(std::span<const ClothBearing> bearings, const state::Tables& tables,
                        LoadedCloths& loaded);

/// Forces that are no springs act on what points would do without springs: gas, and bends where they are not
/// solved with the springs. The first function gives points these velocities, before such forces are solved;
/// after what springs have done to light points they would be without measure. The second function notes what
/// came of it, and gives points the velocities from before with the same changes.
enum class OutsideForces : std::uint8_t { kBends, kGas };
void begin_outside_forces(OutsideForces forces, state::Tables& tables, LoadedCloths& loaded);
void end_outside_forces(OutsideForces forces, state::Tables& tables, LoadedCloths& loaded);

/// Solves cloth `i` of those loaded for a substep of length `h` [s], and writes to `loads` what solids give
/// it. `part` says whose memory it may use.
void solve_loaded_cloth(std::size_t i, int part, Real h, std::span<ClothLoad> loads, state::Tables& tables,
                        LoadedCloths& loaded);

}  // namespace hooke::solver
