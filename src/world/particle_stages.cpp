#include "world/particle_stages.h"

#include "base/assert.h"
#include "build/cloth_tears.h"
#include "build/solid_tears.h"
#include "solver/check_routes.h"
#include "solver/soft/particle_kernels.h"
#include "solver/soft/pressed_points.h"
#include "solver/soft/soft_tuning.h"
#include "solver/soft/spring_solve.h"
#include "solver/solid/shape_matching.h"
#include "solver/solid/stiff_solution.h"
#include "solver/solid/tetrahedron_solve.h"
#include "solver/surface/joined_solids.h"
#include "solver/surface/rope_loads.h"
#include "solver/surface/solid_loads.h"
#include "solver/surface/surface_contacts.h"
#include "state/check_tables.h"
#include "state/rope_chains.h"
#include "world/events.h"
#include "world/force_stages.h"
#include "world/point_contact_stages.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace hooke::world {

namespace {

using parallel::for_ranges;
using parallel::Range;

constexpr int kMotionGrain = 2048;
constexpr int kTriangleGrain = 512;
constexpr int kTetrahedronGrain = 8;
constexpr int kYieldGrain = 64;
constexpr int kBlockGrain = 16;
constexpr std::size_t kFewRows = 4096;

/// An object gets a new origin when its first particle is farther than this from the old one along an axis
/// [m].
constexpr Real kFarFromOrigin = Real(64);

/// Whether all of the numbers are finite. A finite number times zero is zero, any other is not. There are
/// eight sums so that compilers use vectors.
bool all_finite(const Real* numbers, std::size_t count) {
  constexpr std::size_t kSums = 8;
  Real sums[kSums] = {};
  std::size_t i = 0;
  for (; i + kSums <= count; i += kSums) {
    for (std::size_t k = 0; k < kSums; ++k) sums[k] += Real(0) * numbers[i + k];
  }
  for (; i < count; ++i) sums[0] += Real(0) * numbers[i];
  return std::all_of(std::begin(sums), std::end(sums), [](Real sum) { return sum == Real(0); });
}

bool all_finite(const state::Particles& particles) {
  const std::size_t count = 4 * particles.position.size();
  return all_finite(reinterpret_cast<const Real*>(particles.position.data()), count) &&
         all_finite(reinterpret_cast<const Real*>(particles.velocity.data()), count);
}

bool all_finite(const std::vector<Real>& numbers) {
  return all_finite(numbers.data(), numbers.size());
}

/// Divides rows among the threads, or leaves them to the one that asks.
struct Division {
  parallel::ThreadPool* pool = nullptr;  ///< Null to leave them.

  /// Calls `work` with ranges that cover the rows [first, end) of a table.
  template <class Work>
  void for_rows(int first, int end, int grain, Work work) const {
    if (pool == nullptr) return work(Range{first, end});
    for_ranges(*pool, end - first, grain, [&](Range range) {
      work(Range{first + range.begin, first + range.end});
    });
  }
};

/// Calls `work` with each group of soft objects and how to divide its rows. Groups share no particle.
template <class Work>
void for_soft_groups(WorldData& world, Work work) {
  solver::SoftGroups& soft = world.derived.soft;
  const auto call_whole = [&](int i) { work(soft.groups[soft.whole[i]], Division{}); };
  const auto count = static_cast<int>(soft.whole.size());
  if (soft.whole_size < kFewRows) {
    for (int i = 0; i < count; ++i) call_whole(i);
  } else {
    parallel::for_items(*world.pool, count, call_whole);
  }
  for (const std::uint32_t i : soft.divided) work(soft.groups[i], Division{world.pool.get()});
}

/// Solves the passes of a group's rows one after the other, in jobs of at least `grain` blocks. Rows of a
/// pass share no particle.
template <class Rows, class Solve>
void solve_passes(Rows& rows, Division division, int grain, state::Particles& particles, Solve solve) {
  for (const auto& pass : rows.passes) {
    division.for_rows(pass.first, pass.end, grain,
                      [&](Range blocks) { solve(rows, pass, blocks, particles); });
  }
}

/// Lets go of what does not stay where it touches the solids of a system, and where it `may_hold`, holds what
/// does again. Returns whether anything changed.
bool renew_touched(state::Tables& tables, const std::vector<int>& pressing, Real h, bool may_hold,
                   solver::StiffSystem& system) {
  bool any = solver::renew_stiff_rows(may_hold, system);
  any = solver::renew_ties(system) || any;
  for (solver::TetrahedronBlocks* part : system.parts)
    any = solver::renew_pressed_points(pressing, tables, h, may_hold, *part) || any;
  return any;
}

/// Solves the rows of solids at once, with what presses on their points and with each other. What does not
/// stay where it touches is let go, and the solution goes on from there.
void solve_stiff_solids(state::Tables& tables, const std::vector<int>& pressing, Real h, Division division,
                        solver::StiffSystem system) {
  const bool is_one = system.parts.size() == 1;
  const auto pass = [&](auto solve) {
    if (is_one) return solve_passes(*system.parts[0], division, kTetrahedronGrain, tables.particles, solve);
    division.for_rows(0, static_cast<int>(system.parts.size()), 1, [&](Range range) {
      for (int i = range.begin; i < range.end; ++i)
        solve_passes(*system.parts[i], Division{}, kTetrahedronGrain, tables.particles, solve);
    });
  };
  for (solver::TetrahedronBlocks* part : system.parts) {
    solver::begin_stiff_solution(*part);
    solver::note_pressed_points(tables, pressing, h, *part);
  }
  pass(solver::linearize_tetrahedra);
  solver::prepare_stiff_rows(tables, system);
  solver::prepare_ties(tables, system);
  bool is_last = false;
  bool is_new = true;
  for (int round = 1;; ++round) {
    if (is_new) solver::begin_directions(tables.particles, system, pass);
    solver::follow_directions(system, pass);
    for (solver::TetrahedronBlocks* part : system.parts) solver::find_pressed_impulses(*part);
    if (is_last || round == 2 * solver::kMostPressedRounds) break;
    // Where directions run out, contacts that pull or rub too hard are let go once more.
    is_last = !solver::may_solve_again(system);
    const bool may_hold = !is_last && round < solver::kMostPressedRounds;
    const bool any = renew_touched(tables, pressing, h, may_hold, system);
    if (!solver::sharpen(system) && !any) break;
    is_new = any;  // Otherwise directions go on from where they were.
  }
  for (solver::TetrahedronBlocks* part : system.parts)
    solver::finish_stiff_solution(solver::is_solved(system), *part, tables.particles);
  solver::release_ties(system, tables.particles);
}

/// Calls `kernel` for each solid that is solved by shape matching.
template <class Kernel>
void for_matched(WorldData& world, Real h, Kernel kernel) {
  state::Tables& tables = world.tables;
  for_ranges(*world.pool, static_cast<int>(world.derived.matched_objects.size()), 1, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i)
      kernel(tables.objects[world.derived.matched_objects[i]], static_cast<double>(h), tables.particles);
  });
}

/// Gives the bodies of coupled groups their gravity in equal shares, one in each particle substep, as ropes
/// get theirs. accelerate_bodies has given them the gravity of the whole substep at once. Without shares,
/// ropes would feel all of it in the first particle substep and none in the others.
void share_out_gravity(WorldData& world, Real h, bool first) {
  state::Tables& tables = world.tables;
  const auto others = static_cast<Real>(tables.desc.particle_substeps - 1);
  if (others == Real(0)) return;
  const Real time = first ? -others * h : h;
  for (const solver::CoupledGroup& group : world.derived.coupled_groups.live()) {
    for (const std::uint32_t body : group.bodies) {
      const Vec3 change = (time * tables.bodies.traits[body].gravity_scale) * tables.desc.gravity;
      tables.bodies.motion[body].v += change;
      tables.bodies.free_motion[body].v += change;
    }
  }
}

/// Marks the bodies that contacts between bodies push in this step, other than those of coupled groups.
void find_pushed(const solver::BodyContacts& contacts, std::size_t count, std::vector<std::uint8_t>& pushed) {
  pushed.assign(count, 0);
  for (const solver::ContactBlock& block : contacts.blocks) {
    if (block.is_coupled()) continue;
    for (int lane = 0; lane < block.count; ++lane) {
      HOOKE_ASSERT(block.record_a[lane] / 16 < count);
      HOOKE_ASSERT(block.anchored || block.record_b[lane] / 16 < count);
      pushed[block.record_a[lane] / 16] = 1;
      if (!block.anchored) pushed[block.record_b[lane] / 16] = 1;
    }
  }
}

/// Gives the bodies of coupled groups what contacts did to them in shares, too. Without shares, a standing
/// body with a load hooked to it would rise and fall in each substep. A body gets all of its shares, even if
/// it leaves its coupled group meanwhile.
void share_out_contacts(WorldData& world, bool first) {
  state::Bodies& bodies = world.tables.bodies;
  const auto count = static_cast<Real>(world.tables.desc.particle_substeps);
  if (count == Real(1)) return;
  const auto give = [&bodies](const ContactShare& share, Real times) {
    bodies.motion[share.body].v += times * share.v;
    bodies.motion[share.body].omega_scaled += times * share.omega_scaled;
  };
  if (!first) {
    for (const ContactShare& share : world.frame.contact_shares) give(share, Real(1));
    return;
  }
  world.frame.contact_shares.clear();
  find_pushed(world.frame.body_contacts, bodies.motion.size(), world.frame.body_marks);
  for (const solver::CoupledGroup& group : world.derived.coupled_groups.live()) {
    for (const std::uint32_t body : group.bodies) {
      if (world.frame.body_marks[body] == 0) continue;
      const state::MotionRecord& m = bodies.motion[body];
      const state::FreeMotionRecord& free = bodies.free_motion[body];
      world.frame.contact_shares.push_back(
          {.body = body,
           .v = (Real(1) / count) * (m.v - free.v),
           .omega_scaled = (Real(1) / count) * (m.omega_scaled - free.omega_scaled)});
      give(world.frame.contact_shares.back(), Real(1) - count);
    }
  }
}

/// Finds again where pins and hooks hold ropes against bending and twist, if pins or hooks changed.
void refresh_clamps(WorldData& world) {
  const std::uint64_t revision = world.tables.revision + world.tables.hook_revision;
  if (world.derived.clamps_revision == revision) return;
  world.derived.clamps_revision = revision;
  const std::vector<solver::Holder> supports = solver::list_holders(world.tables);
  solver::note_clamps(supports, world.tables);
  solver::find_twist_spans(supports, world.tables);
}

}  // namespace

void refresh_derived(WorldData& world) {
  state::Tables& tables = world.tables;
  refresh_clamps(world);
  if (world.derived.revision == tables.revision) return;
  world.derived.revision = tables.revision;
  solver::refresh_soft_groups(tables, world.pool->workers(), world.derived.soft);
  world.derived.cloth_bearings = solver::find_bearings(tables);
  world.derived.gas_objects.clear();
  world.derived.matched_objects.clear();
  for (std::uint32_t i = 0; i < tables.objects.size(); ++i) {
    if (tables.objects[i].gas > 0) world.derived.gas_objects.push_back(i);
    if (tables.objects[i].rest_shape) world.derived.matched_objects.push_back(i);
  }
  world.frame.gas_volumes.resize(world.derived.gas_objects.size());
  world.derived.rope_systems.clear();
  for (std::uint32_t i = 0; i < tables.objects.size(); ++i) {
    const state::Deformable& object = tables.objects[i];
    if (object.kind != PointRef::Kind::kRope) continue;
    state::for_each_chain(object, tables.segments, [&](std::uint32_t first, std::uint32_t count) {
      world.derived.rope_systems.push_back(
          {.first_particle = object.particles.first + first,
           .node_count = count,
           .first_segment = object.segments.first + first,
           .bend_stiffness = count > 2 ? static_cast<double>(object.bend_stiffness) : 0,
           .bend_damping = static_cast<double>(object.bend_damping),
           .object = i});
    });
  }
  const auto count = static_cast<std::size_t>(tables.particles.count());
  world.frame.velocity_before.assign(count, state::VelocityRecord{});
  world.frame.wind.assign(count, solver::AirRecord{});
  world.frame.law_force.assign(count, Vec3{});
}

void prepare_particle_rows(WorldData& world, Real h) {
  state::check_tables(world.tables);  // By now all contacts have been found.
  const auto prepare = [h](solver::SoftGroup& group, Division) { solver::prepare_soft_group(group, h); };
  for_soft_groups(world, prepare);
  if (solver::separate_stiff_solids(world.tables, world.pool->workers(), world.derived.soft))
    for_soft_groups(world, prepare);
}

void begin_step(WorldData& world, double dt) {
  state::Tables& tables = world.tables;
  solver::mark_stiff_solids(tables, world.derived.soft, world.frame.surfaces);
  solver::begin_surface_step(tables, tables.desc.substeps * tables.desc.particle_substeps,
                             world.frame.surfaces);
  read_wind(world, tables.time + 0.5 * dt);
  begin_body_forces(world);

  std::fill(tables.segments.mean_tension.begin(), tables.segments.mean_tension.end(), Real(0));
  for (state::TwistSpan& span : tables.twists) span.mean_torque = Real(0);
  std::size_t row = 0;
  const state::Contacts& contacts = tables.contacts;
  for (solver::RopeSystem& rope_system : world.derived.rope_systems) {
    const auto begins = [&](std::uint32_t particle) {
      return row < contacts.particle.size() && contacts.particle[row] < particle;
    };
    HOOKE_ASSERT(row == 0 || contacts.particle[row - 1] < rope_system.first_particle);  // ropes ascend
    while (begins(rope_system.first_particle)) ++row;
    rope_system.first_contact = static_cast<std::uint32_t>(row);
    while (begins(rope_system.first_particle + rope_system.node_count)) ++row;
    rope_system.end_contact = static_cast<std::uint32_t>(row);
    rope_system.solves = 0;
    rope_system.unconverged = false;
  }
}

void begin_particle_substep(WorldData& world, Real h) {
  solver::begin_surface_substep(world.tables, world.frame.surfaces);
  for_soft_groups(world, [&world](const solver::SoftGroup& group, Division division) {
    if (!group.tetrahedra.any_damping) return;
    solve_passes(group.tetrahedra, division, kTetrahedronGrain, world.tables.particles,
                 solver::damp_tetrahedra);
  });
  for_matched(world, h, solver::damp_shape);
  for (const solver::RopeSystem& rope_system : world.derived.rope_systems) {
    const auto first = world.tables.particles.velocity.begin() + rope_system.first_particle;
    std::copy(first, first + rope_system.node_count,
              world.frame.velocity_before.begin() + rope_system.first_particle);
  }
}

void solve_springs(WorldData& world, Real h, state::SpringClass first, state::SpringClass last) {
  for_soft_groups(world, [&](const solver::SoftGroup& group, Division division) {
    for (const solver::SpringPass& pass : group.springs.passes) {
      if (pass.kind < first || pass.kind > last) continue;
      division.for_rows(pass.first, pass.end, kBlockGrain, [&](Range blocks) {
        solver::solve_springs(group.springs, pass, blocks, h, world.tables.particles);
      });
    }
  });
}

void solve_yarns(WorldData& world) {
  for_soft_groups(world, [&world](solver::SoftGroup& group, Division division) {
    solve_passes(group.yarns, division, 1, world.tables.particles, solver::solve_yarns);
  });
}

void find_pressed_cloths(WorldData& world, Real h) {
  solver::SurfaceContacts& surfaces = world.frame.surfaces;
  solver::list_solid_loads(world.tables, h, surfaces);
  world.frame.cloths_left_to_contacts += solver::find_pressed_cloths(
      world.derived.cloth_bearings, world.tables, h, surfaces.solid_loads, world.frame.loaded_cloths);
}

void find_loaded_cloths(WorldData& world) {
  solver::LoadedCloths& loaded = world.frame.loaded_cloths;
  loaded.lent.clear();
  for (const solver::PassMass& mass : world.frame.pass_masses) loaded.lent.push_back(mass.particle);
  for (const solver::HookedPoint& point : world.frame.hooked_points) loaded.lent.push_back(point.particle);
  solver::find_loaded_cloths(world.derived.cloth_bearings, world.tables, loaded);
}

void solve_loaded_cloths(WorldData& world, Real h) {
  solver::LoadedCloths& loaded = world.frame.loaded_cloths;
  const auto count = static_cast<int>(loaded.cloths.size());
  if (count == 0) return;
  loaded.solutions.resize(static_cast<std::size_t>(world.pool->workers()));
  loaded.is_unconverged.assign(loaded.cloths.size(), 0);
  solver::SurfaceContacts& surfaces = world.frame.surfaces;
  solver::note_solid_motion(world.tables, surfaces);
  for_ranges(*world.pool, count, 1, [&](Range range, int part) {
    for (int i = range.begin; i < range.end; ++i) {
      const auto cloth = static_cast<std::size_t>(i);
      solver::solve_loaded_cloth(cloth, part, h, surfaces.solid_loads, world.tables, loaded);
    }
  });
  solver::release_cloth_presses(loaded.presses, world.tables);
  solver::release_solid_loads(surfaces.solid_loads, world.tables);
  for (const std::uint8_t unconverged : loaded.is_unconverged) world.frame.cloths_unconverged += unconverged;
}

void solve_bends(WorldData& world) {
  state::Particles& particles = world.tables.particles;
  solver::begin_outside_forces(solver::OutsideForces::kBends, world.tables, world.frame.loaded_cloths);
  for_soft_groups(world, [&particles](solver::SoftGroup& group, Division division) {
    solve_passes(group.bends, division, kBlockGrain, particles, solver::solve_bends);
    solve_passes(group.isometric_bends, division, kBlockGrain, particles, solver::solve_isometric_bends);
    solve_passes(group.yarns, division, 1, particles, solver::bend_yarns);
  });
  solver::end_outside_forces(solver::OutsideForces::kBends, world.tables, world.frame.loaded_cloths);
}

std::uint32_t quarantine_non_finite(WorldData& world) {
  state::Particles& particles = world.tables.particles;
  if (all_finite(particles) && all_finite(world.tables.segments.tension)) return 0;
  HOOKE_ASSERT(world.frame.start_position.size() == particles.position.size());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < particles.position.size(); ++i) {
    if (is_finite(particles.position[i].x) && is_finite(particles.velocity[i].v)) continue;
    particles.position[i].x = world.frame.start_position[i].x;
    particles.velocity[i].v = {};
    ++count;
  }
  for (Real& tension : world.tables.segments.tension) tension = std::isfinite(tension) ? tension : Real(0);
  return count;
}

void rebase_origins(WorldData& world) {
  state::Particles& particles = world.tables.particles;
  for (state::Deformable& object : world.tables.objects) {
    HOOKE_ASSERT(object.particles.count > 0);
    const Vec3 first = particles.position[object.particles.first].x;
    const Real size = std::max({std::abs(first.x), std::abs(first.y), std::abs(first.z)});
    if (size <= kFarFromOrigin) continue;
    const Vec3 shift = {std::floor(first.x + Real(0.5)), std::floor(first.y + Real(0.5)),
                        std::floor(first.z + Real(0.5))};
    object.origin += vector_cast<double>(shift);
    for (std::uint32_t i = object.particles.first; i < object.particles.end(); ++i)
      particles.position[i].x -= shift;
  }
}

void solve_solids(WorldData& world, Real h) {
  state::Tables& tables = world.tables;
  std::vector<int>& pressing = world.frame.pressing_points;
  if (world.frame.surfaces.any_stiff)
    solver::count_pressing_points(tables, world.frame.surfaces.stiff, h, pressing);
  solver::JoinedSolids& joined = world.frame.joined_solids;
  find_pressed_faces(world, h);
  std::vector<state::ElementContact>& faces = world.frame.pressed_faces;
  solver::list_joined_solids(tables, world.frame.surfaces, faces, h, world.derived.soft, joined);
  for (const solver::JoinedSolids::System& system : joined.systems)
    solve_stiff_solids(tables, pressing, h, Division{world.pool.get()}, joined.at(system));
  for_soft_groups(world, [&](solver::SoftGroup& group, Division division) {
    solver::TetrahedronBlocks& tetrahedra = group.tetrahedra;
    if (tetrahedra.blocks.empty() || joined.has(world.derived.soft, group)) return;
    if (group.tetrahedra.any_stiff) {
      solver::TetrahedronBlocks* const part[] = {&tetrahedra};
      solve_stiff_solids(tables, pressing, h, division, {.parts = part, .rows = {}, .ties = {}});
    } else {
      solve_passes(tetrahedra, division, kTetrahedronGrain, tables.particles, solver::solve_tetrahedra);
    }
  });
  for (const solver::JoinedSolids::System& system : joined.systems)
    solver::release_stiff_rows(h, joined.at(system), faces, tables);
  add_pass_impulses(world, h, faces);
  for (solver::SoftGroup& group : world.derived.soft.groups)
    solver::release_pressed_points(h, group.tetrahedra, tables);
  for_matched(world, h, solver::match_shape);
  HOOKE_ASSERT(world.frame.gas_volumes.size() == world.derived.gas_objects.size());
  solver::begin_outside_forces(solver::OutsideForces::kGas, tables, world.frame.loaded_cloths);
  for_ranges(*world.pool, static_cast<int>(world.derived.gas_objects.size()), 1, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) {
      solver::press_gas(tables.objects[world.derived.gas_objects[i]], static_cast<double>(h),
                        world.frame.gas_volumes[i], tables);
    }
  });
  solver::end_outside_forces(solver::OutsideForces::kGas, tables, world.frame.loaded_cloths);
}

void move_particles(WorldData& world, Real h) {
  for_ranges(*world.pool, world.tables.particles.count(), kMotionGrain,
             [&](Range rows) { solver::wide::move(h, rows, world.tables.particles); });
  solver::truncate_surfaces(*world.pool, h, world.frame.surfaces, world.tables);
  add_touch_impulses(world, h);
  for_soft_groups(world, [&](solver::SoftGroup& group, Division division) {
    division.for_rows(0, static_cast<int>(group.yields.tetrahedra.size()), kYieldGrain, [&](Range rows) {
      solver::flow_tetrahedra(group.yields, rows, h, world.tables, group.tetrahedra);
    });
  });
}

void flow_cloths(WorldData& world) {
  for_soft_groups(world, [&world](solver::SoftGroup& group, Division division) {
    division.for_rows(0, static_cast<int>(group.yields.bends.size()), kTriangleGrain,
                      [&](Range rows) { solver::flow_bends(group.yields, rows, world.tables, group.bends); });
  });
}

void tear_deformables(WorldData& world, double dt) {
  state::Tables& t = world.tables;
  Events& events = world.last_step.events;
  events.tears.clear();
  events.solid_tears.clear();
  for (std::uint32_t i = 0; i < t.objects.size(); ++i) {
    if (t.objects[i].tear_strain < kRigid) build::tear_cloth(i, t.time + dt, t, events.tears);
    if (t.objects[i].tear_stress < kRigid) build::tear_solid(i, t.time + dt, t, events.solid_tears);
  }
}

void begin_coupled_groups(WorldData& world, Real h, bool first) {
  if (world.tables.objects.empty() && world.tables.pairs.coupled.empty() &&
      world.derived.coupled_groups.count == 0)
    return;
  std::fill(world.tables.contacts.coupled.begin(), world.tables.contacts.coupled.end(), std::uint8_t{0});
  if (!first) solver::twist_bodies(static_cast<double>(h), world.tables, world.frame.twist_rows);
  solver::slide_hooks(world.tables);
  solver::build_coupled_groups(world.tables, world.derived.rope_systems, world.derived.coupled_groups);
  HOOKE_VALIDATE(solver::find_in_coupled_groups(world.tables, world.derived.rope_systems,
                                                world.derived.coupled_groups, world.frame.check_marks));
  share_out_contacts(world, first);
  share_out_gravity(world, h, first);
  solver::apply_mass_shares(world.derived.coupled_groups, world.frame.surfaces.stiff, world.tables,
                            world.frame.hooked_points);
}

void solve_ropes(WorldData& world, double end_time, Real h, bool first) {
  state::Tables& tables = world.tables;
  solver::remove_mass_shares(world.frame.hooked_points, tables.particles);
  solver::twist_nodes(world.frame.twist_rows, tables);
  world.frame.rope_system_scratch.resize(static_cast<std::size_t>(world.pool->workers()));
  HOOKE_ASSERT(world.frame.velocity_before.size() == tables.particles.velocity.size());
  solver::list_rope_loads(tables, h, world.frame.surfaces);
  for_ranges(*world.pool, static_cast<int>(world.derived.rope_systems.size()), 1, [&](Range rows, int part) {
    solver::solve_rope_systems(std::span(world.derived.rope_systems).subspan(rows.begin, rows.count()),
                               world.derived.coupled_groups.anchors,
                               {h, world.frame.velocity_before, world.frame.surfaces},
                               world.frame.rope_system_scratch[part], tables);
  });
  for_ranges(*world.pool, static_cast<int>(world.derived.coupled_groups.count), 1, [&](Range rows) {
    for (int i = rows.begin; i < rows.end; ++i) {
      solver::solve_coupled_group(world.frame.velocity_before,
                                  {.h = h,
                                   .end_time = end_time,
                                   .first = first,
                                   .loaded_at_points = world.frame.loaded_cloths.loaded_at_points,
                                   .surfaces = world.frame.surfaces},
                                  world.derived.coupled_groups.groups[i], world.derived.rope_systems,
                                  world.frame.body_contacts, tables);
    }
  });
  solver::note_twist_rates(static_cast<double>(h), world.frame.twist_rows, tables);
}

}  // namespace hooke::world
