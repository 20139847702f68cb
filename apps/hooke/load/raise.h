#pragma once

#include "hooke/load/members.h"
#include "hooke/load/movers.h"
#include "hooke/load/push.h"

#include <optional>
#include <string>
#include <vector>

namespace hooke::app {

/// How a load is raised.
struct RaiseOptions {
  double first = 0;          ///< First step of the load [N].
  double most = 0;           ///< Load at which it ends [N].
  double tolerance = 1e-3;   ///< Relative width of the interval to which a breaking load is narrowed.
  double way = 0;            ///< A loaded place that moves farther in one step of the load has collapsed [m].
  double patience = 30;      ///< Time to come to rest in, for each step of the load [s].
  bool until_break = false;  ///< Whether to end at the first break.
  bool until_limit = false;  ///< Whether to end where the first member yields or buckles, too.
};

/// One equilibrium.
struct Equilibrium {
  double load = 0;          ///< [N]
  DVec3 way = {};           ///< Move of the loaded place since the equilibrium without load [m].
  double residual = 0;      ///< Force that is not balanced: the largest on any body or point [N].
  std::uint64_t steps = 0;  ///< Steps that it took to come to rest.
  std::vector<MemberForce> forces = {};
};

/// Something that broke.
struct LoadBreak {
  std::string object;
  std::string what;  ///< "hook", "rope, segment 3", "cloth, point 17", "solid, point 4".
  double force = 0;  ///< What it needed [N]; of a cloth its strain, of a solid its stress [Pa].
  double held = 0;   ///< Largest load that held before [N].
  double load = 0;   ///< Load at which it broke [N]; 0 if its weight did it.
  double share = 1;  ///< Share of the weight that acted.
};

/// Where a member first reached a limit of its section.
struct LoadLimit {
  std::string member;
  double held = 0;  ///< Load of the last equilibrium before [N].
  double load = 0;  ///< Load of the first equilibrium beyond [N]; equal to `held` if it is so without load.
  double at = 0;    ///< The load between, by linear interpolation of the utilization [N].
};

/// How the search for an equilibrium ended without one.
struct Collapse {
  /// Whether the loaded place moved too far; otherwise there was motion for too long.
  bool ran = false;
  double held = 0;               ///< Largest load that held [N].
  double load = 0;               ///< Load under which there was no equilibrium [N].
  std::string why = {};          ///< What showed it, in words.
  std::vector<Move> moves = {};  ///< What moved, the farthest first.
};

/// What raising a load showed.
struct Raised {
  std::vector<Member> members = {};
  std::vector<Equilibrium> equilibria = {};  ///< The first is that without load.
  std::vector<Move> settling = {};           ///< Moves until there was rest without load.
  /// Whether there was no rest without load, or only after something had moved by more than
  /// RaiseOptions::way.
  bool is_mechanism = false;
  std::vector<LoadBreak> breaks = {};
  std::vector<std::string> fell_off = {};  ///< Names of what came off and fell.
  std::optional<Collapse> collapse = {};   ///< With a load of 0 if there is no equilibrium without load.
  std::uint64_t steps = 0;                 ///< Steps in all, with those taken back.
  double weight = 0;                       ///< Weight of all that moves [N].
  double largest_residual = 0;             ///< Of all equilibria [N].
  SimulationSnapshot whole = {};  ///< State at the last equilibrium before the first break by the load.
};

/// Finds where the first member reached 1 of a ratio, MemberForce::yielding or MemberForce::buckling; the
/// member that did so at the least load.
[[nodiscard]] std::optional<LoadLimit> first_limit(const Raised& raised, double MemberForce::*ratio);
/// The last equilibrium before the first break by the load; there is one at least.
[[nodiscard]] const Equilibrium& last_whole(const Raised& raised);

/// Returns the first thing that broke by the load; null if nothing did. What broke without any does not
/// count.
[[nodiscard]] const LoadBreak* first_break(const Raised& raised);

/// Brings the simulation to rest and raises the force of `push`, as docs/load.md tells. The Error says that
/// the world could not step.
[[nodiscard]] Result<Raised> raise_load(Simulation& simulation, Movers& movers, const Push& push,
                                        const RaiseOptions& options);

}  // namespace hooke::app
