#include "solver/cloth/loaded_cloths.h"

#include "base/assert.h"
#include "solver/cloth/cloth_tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

// Marks of LoadedCloths::marks, 0 for what is not loaded. The larger one counts.
constexpr std::uint8_t kPressed = 1;
constexpr std::uint8_t kLoadedAtPoints = 2;

Real mass_of(const state::Tables& tables, std::uint32_t particle) {
  const Real inverse_mass = tables.particles.velocity[particle].inverse_mass;
  return inverse_mass > Real(0) ? Real(1) / inverse_mass : Real(0);
}

/// Whether it has isometric bends, and they are not those of yarns.
bool bends_have_springs(const state::Tables& tables, const state::Deformable& cloth) {
  bool any = false;
  for (std::uint32_t row = cloth.bends.first; row < cloth.bends.end(); ++row) {
    if (tables.bends.is_along_yarn(row)) return false;
    any = any || tables.bends.is_isometric(row);
  }
  return any;
}

/// Calls `visit(velocity, i)` for the points of loaded cloths that feel these forces, with their index in the
/// lists.
template <class Visit>
void for_points(OutsideForces forces, state::Tables& tables, const LoadedCloths& loaded, Visit visit) {
  for (const LoadedCloth& cloth : loaded.cloths) {
    if (cloth.with_bends && forces == OutsideForces::kBends) continue;
    const state::Rows points = tables.objects[cloth.object].particles;
    for (std::uint32_t i = 0; i < points.count; ++i)
      visit(tables.particles.velocity[points.first + i].v, cloth.first + i);
  }
}

/// Mean length at rest of the springs along edges of a cloth [m].
double mean_link(const state::Tables& tables, const state::Deformable& cloth) {
  double sum = 0;
  int count = 0;
  for (std::uint32_t row = cloth.springs.first; row < cloth.springs.end(); ++row) {
    if (tables.springs.kind[row] != state::SpringClass::kStretch) continue;
    sum += static_cast<double>(tables.springs.rest_length[row]);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// What a yarn of the cloth can bear. A cloth of n points has yarns of about sqrt(n), each of the median
/// mass, so that loads do not make it stronger.
ClothBearing bearing_of(const state::Tables& tables, std::uint32_t row, std::vector<Real>& masses) {
  const state::Deformable& cloth = tables.objects[row];
  masses.clear();
  for (std::uint32_t i = cloth.particles.first; i < cloth.particles.end(); ++i) {
    const Real mass = mass_of(tables, i);
    if (mass > Real(0)) masses.push_back(mass);
  }
  if (masses.empty()) return {.object = row};
  const auto typical = masses.begin() + static_cast<std::ptrdiff_t>(masses.size() / 2);
  std::nth_element(masses.begin(), typical, masses.end());
  const double yarn = std::sqrt(static_cast<double>(masses.size())) * static_cast<double>(*typical);
  const auto most = static_cast<Real>(kLoadOfYarns * yarn);
  const bool heavy = std::any_of(typical, masses.end(), [most](Real mass) { return mass > most; });
  return {.object = row,
          .most_mass = most,
          .has_heavy_points = heavy,
          .link_length = mean_link(tables, cloth),
          .bends_have_springs = bends_have_springs(tables, cloth)};
}

/// The index of the bearing of the cloth that has a particle, or the number of bearings if none has.
std::size_t bearing_with(std::span<const ClothBearing> bearings, const state::Tables& tables,
                         std::uint32_t particle) {
  const auto behind = std::upper_bound(bearings.begin(), bearings.end(), particle,
                                       [&](std::uint32_t row, const ClothBearing& bearing) {
                                         return row < tables.objects[bearing.object].particles.first;
                                       });
  if (behind == bearings.begin()) return bearings.size();
  const auto found = std::prev(behind);
  const bool has_it = particle < tables.objects[found->object].particles.end();
  return has_it ? static_cast<std::size_t>(found - bearings.begin()) : bearings.size();
}

/// Marks the cloths that bear too much at a single point.
void mark_points(std::span<const ClothBearing> bearings, const state::Tables& tables, LoadedCloths& loaded) {
  for (const std::uint32_t particle : loaded.lent) {
    const std::size_t i = bearing_with(bearings, tables, particle);
    if (i == bearings.size()) continue;
    const Real mass = mass_of(tables, particle);
    // What does not give way holds the cloth, and is no load.
    if (mass > bearings[i].most_mass &&
        mass < static_cast<Real>(kMassThatHolds) * tables.particles.mass[particle])
      loaded.marks[i] = kLoadedAtPoints;
  }
}

/// Mean velocity of the points of a cloth [m/s].
DVec3 mean_velocity(const state::Tables& tables, const state::Deformable& cloth) {
  DVec3 sum;
  for (std::uint32_t i = cloth.particles.first; i < cloth.particles.end(); ++i)
    sum += vector_cast<double>(tables.particles.velocity[i].v);
  return (1.0 / static_cast<double>(cloth.particles.count)) * sum;
}

/// Whether a spring along an edge is so long that the cloth may be tangled.
bool is_drawn_out(const state::Tables& tables, const state::Deformable& cloth) {
  const state::Springs& springs = tables.springs;
  const auto x = [&](std::uint32_t particle) { return tables.particles.position[particle].x; };
  for (std::uint32_t row = cloth.springs.first; row < cloth.springs.end(); ++row) {
    if (springs.kind[row] != state::SpringClass::kStretch) continue;
    const Real most = static_cast<Real>(kMostPressedLength) * springs.rest_length[row];
    if (length_squared(x(springs.particle_b[row]) - x(springs.particle_a[row])) > most * most) return true;
  }
  return false;
}

/// Says what a linear problem says nothing of: what moves too far against its cloth within the substep, what
/// presses on tangled cloths, and on those that bear by their gas, which knows of nothing that presses.
class WildPresses {
 public:
  WildPresses(std::span<const ClothBearing> bearings, const state::Tables& tables, Real h)
      : bearings_(bearings), t_(tables), h_(static_cast<double>(h)) {}

  /// Whether that holds for what presses on the cloth of bearing `i` with this velocity [m/s].
  [[nodiscard]] bool has(std::size_t i, DVec3 velocity) {
    if (i != known_) {
      known_ = i;
      const state::Deformable& cloth = t_.objects[bearings_[i].object];
      velocity_ = mean_velocity(t_, cloth);
      is_wild_ = cloth.gas > 0 || is_drawn_out(t_, cloth);
    }
    return is_wild_ || length(velocity - velocity_) * h_ > kMostPressWay * bearings_[i].link_length;
  }

 private:
  std::span<const ClothBearing> bearings_;
  const state::Tables& t_;
  double h_;
  std::size_t known_ = std::numeric_limits<std::size_t>::max();  ///< Bearing of what follows.
  DVec3 velocity_ = {};                                          ///< Of the cloth [m/s].
  bool is_wild_ = false;
};

/// Drops what is wild of bodies, and marks the cloths for which that is too heavy.
void drop_wild_presses(std::span<const ClothBearing> bearings, const state::Tables& tables, Real h,
                       LoadedCloths& loaded) {
  loaded.is_left.assign(bearings.size(), 0);
  WildPresses wild(bearings, tables, h);
  std::erase_if(loaded.presses, [&](const ClothPress& press) {
    const std::size_t i = bearing_with(bearings, tables, press.particle);
    if (i == bearings.size()) return true;
    if (!wild.has(i, vector_cast<double>(tables.bodies.motion[press.body].v))) return false;
    const Real inverse_mass = tables.bodies.motion[press.body].inverse_mass;
    if (press.presses && press.gives_way && inverse_mass * bearings[i].most_mass < Real(1))
      loaded.is_left[i] = 1;
    return true;
  });
}

/// Drops bodies that are hooked to the cloth: its points have got their mass already.
void drop_hooked_presses(const state::Tables& tables, LoadedCloths& loaded) {
  std::vector<PressingBody>& hooked = loaded.pairs;
  hooked.clear();
  for (const state::Hook& hook : tables.hooks) {
    if (hook.broken || hook.a.is_point() == hook.b.is_point()) continue;
    const state::HookPlace& point = hook.a.is_point() ? hook.a : hook.b;
    const state::HookPlace& body = hook.a.is_point() ? hook.b : hook.a;
    hooked.push_back({.object = point.object, .body = body.body});
  }
  if (hooked.empty()) return;
  std::sort(hooked.begin(), hooked.end());
  std::erase_if(loaded.presses, [&](const ClothPress& press) {
    const PressingBody pressing = {tables.contacts.object[press.contact], press.body};
    return std::binary_search(hooked.begin(), hooked.end(), pressing);
  });
}

/// Lists the bodies that press on points which something bears from below, or from the other side where
/// nothing is below: it bears these bodies, too.
void find_borne(std::span<const ClothPress> presses, DVec3 gravity, std::vector<std::uint32_t>& borne) {
  const bool is_weightless = !(length_squared(gravity) > 0);
  borne.clear();
  for (std::size_t first = 0; first < presses.size();) {
    std::size_t end = first;
    const DVec3 up = is_weightless ? presses[first].normal : -gravity;
    bool is_borne = false;
    for (; end < presses.size() && presses[end].particle == presses[first].particle; ++end) {
      const double along = dot(presses[end].normal, up);
      is_borne = is_borne || (presses[end].presses && (is_weightless ? along < 0 : along > 0));
    }
    for (; first < end; ++first) {
      if (is_borne && presses[first].gives_way) borne.push_back(presses[first].body);
    }
  }
  std::sort(borne.begin(), borne.end());
}

/// Marks the cloths on which too much lies: what gravity presses on them, and nothing else bears.
void mark_pressed(std::span<const ClothBearing> bearings, const state::Tables& tables, LoadedCloths& loaded) {
  const auto gravity = vector_cast<double>(tables.desc.gravity);
  const double size = length(gravity);
  std::vector<std::uint32_t>& borne = loaded.bodies;
  find_borne(loaded.presses, gravity, borne);
  loaded.pressing_masses.assign(bearings.size(), 0);
  for (const ClothPress& press : loaded.presses) {
    if (std::binary_search(borne.begin(), borne.end(), press.body)) continue;
    const std::size_t i = bearing_with(bearings, tables, press.particle);
    double& mass = loaded.pressing_masses[i];
    mass += press.share * (size > 0 ? std::max(0.0, dot(press.normal, gravity)) / size : 1);
    if (mass > static_cast<double>(bearings[i].most_mass))
      loaded.marks[i] = std::max(loaded.marks[i], kPressed);
  }
}

/// Leaves to contacts what is wild of solids.
void leave_wild_loads(std::span<const ClothBearing> bearings, const state::Tables& tables, Real h,
                      std::span<ClothLoad> loads) {
  WildPresses wild(bearings, tables, h);
  for (ClothLoad& load : loads) {
    const std::size_t i = bearing_with(bearings, tables, load.particle[0]);
    load.is_left = i == bearings.size() || wild.has(i, load.surface);
  }
}

/// Marks the cloths on which too much of solids lies, and leaves what lies on others to contacts.
void mark_loads(std::span<const ClothBearing> bearings, const state::Tables& tables, Real h,
                std::span<ClothLoad> loads, LoadedCloths& loaded) {
  if (loads.empty()) return;
  leave_wild_loads(bearings, tables, h, loads);
  const auto gravity = vector_cast<double>(tables.desc.gravity);
  const double size = length(gravity);
  loaded.pressing_masses.assign(bearings.size(), 0);
  for (const ClothLoad& load : loads) {
    if (load.is_left || !(load.inverse_mass > 0)) continue;
    const std::size_t i = bearing_with(bearings, tables, load.particle[0]);
    double& mass = loaded.pressing_masses[i];
    mass += (size > 0 ? std::max(0.0, dot(load.normal, gravity)) / size : 1) / load.inverse_mass;
    if (mass > static_cast<double>(bearings[i].most_mass))
      loaded.marks[i] = std::max(loaded.marks[i], kPressed);
  }
}

/// Whether anything but points of its own may load a cloth in this substep.
bool may_be_loaded(const state::Tables& tables) {
  return !tables.hooks.empty() ||
         std::any_of(tables.moving_bodies.begin(), tables.moving_bodies.end(),
                     [&](std::uint32_t body) { return state::gives_way(tables.bodies, body); });
}

/// Drops what presses on other cloths, and counts the cloths that hold each body.
void keep_presses_of_loaded(std::span<const ClothBearing> bearings, const state::Tables& tables,
                            LoadedCloths& loaded) {
  std::vector<PressingBody>& holds = loaded.pairs;  // Of which body which cloth.
  holds.clear();
  std::erase_if(loaded.presses, [&](const ClothPress& press) {
    const std::size_t i = bearing_with(bearings, tables, press.particle);
    const bool is_loaded = i < bearings.size() && loaded.marks[i] != 0;
    if (is_loaded) holds.push_back({.object = bearings[i].object, .body = press.body});
    return !is_loaded;
  });
  std::sort(holds.begin(), holds.end());
  holds.erase(std::unique(holds.begin(), holds.end()), holds.end());
  for (ClothPress& press : loaded.presses) {
    const auto of_body = [&](const PressingBody& hold) { return hold.body == press.body; };
    press.cloths = static_cast<int>(std::count_if(holds.begin(), holds.end(), of_body));
  }
}

}  // namespace

std::vector<ClothBearing> find_bearings(const state::Tables& tables) {
  std::vector<ClothBearing> bearings;
  std::vector<Real> masses;
  for (std::uint32_t row = 0; row < tables.objects.size(); ++row) {
    const state::Deformable& object = tables.objects[row];
    if (object.kind == PointRef::Kind::kCloth && object.springs.count > 0)
      bearings.push_back(bearing_of(tables, row, masses));
  }
  return bearings;
}

std::uint32_t find_pressed_cloths(std::span<const ClothBearing> bearings, const state::Tables& tables, Real h,
                                  std::span<ClothLoad> loads, LoadedCloths& loaded) {
  loaded.presses.clear();
  loaded.marks.clear();
  for (const ClothBearing& bearing : bearings)
    loaded.marks.push_back(bearing.has_heavy_points ? kLoadedAtPoints : 0);
  loaded.pressing.clear();
  const bool any_heavy = std::any_of(bearings.begin(), bearings.end(),
                                     [](const ClothBearing& bearing) { return bearing.has_heavy_points; });
  if (bearings.empty()) return 0;
  mark_loads(bearings, tables, h, loads, loaded);
  if (loads.empty() && !any_heavy && !may_be_loaded(tables)) return 0;
  find_cloth_presses(tables, h, loaded.presses);
  drop_wild_presses(bearings, tables, h, loaded);
  drop_hooked_presses(tables, loaded);
  share_out_bodies(tables, loaded.presses, loaded.bodies);
  mark_pressed(bearings, tables, loaded);
  for (const ClothPress& press : loaded.presses) {
    const std::size_t i = bearing_with(bearings, tables, press.particle);
    if (press.presses && press.gives_way && loaded.marks[i] != 0)
      loaded.pressing.push_back({.object = bearings[i].object, .body = press.body});
  }
  std::sort(loaded.pressing.begin(), loaded.pressing.end());
  loaded.pressing.erase(std::unique(loaded.pressing.begin(), loaded.pressing.end()), loaded.pressing.end());
  return static_cast<std::uint32_t>(std::count(loaded.is_left.begin(), loaded.is_left.end(), 1));
}

void find_loaded_cloths(std::span<const ClothBearing> bearings, const state::Tables& tables,
                        LoadedCloths& loaded) {
  loaded.cloths.clear();
  loaded.unsprung.clear();
  loaded.loaded_at_points.clear();
  if (bearings.empty()) return;
  mark_points(bearings, tables, loaded);
  keep_presses_of_loaded(bearings, tables, loaded);
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    if (loaded.marks[i] == 0) continue;
    const state::Rows points = tables.objects[bearings[i].object].particles;
    loaded.loaded_at_points.resize(tables.objects.size(), 0);
    if (loaded.marks[i] == kLoadedAtPoints) loaded.loaded_at_points[bearings[i].object] = 1;
    loaded.cloths.push_back({.object = bearings[i].object,
                             .first = loaded.unsprung.size(),
                             .with_bends = bearings[i].bends_have_springs});
    for (std::uint32_t row = points.first; row < points.end(); ++row)
      loaded.unsprung.push_back(tables.particles.velocity[row].v);
  }
}

void begin_outside_forces(OutsideForces forces, state::Tables& tables, LoadedCloths& loaded) {
  loaded.sprung.resize(loaded.unsprung.size());
  for_points(forces, tables, loaded, [&loaded](Vec3& v, std::size_t i) {
    loaded.sprung[i] = v;
    v = loaded.unsprung[i];
  });
}

void end_outside_forces(OutsideForces forces, state::Tables& tables, LoadedCloths& loaded) {
  for_points(forces, tables, loaded, [&loaded](Vec3& v, std::size_t i) {
    const Vec3 change = v - loaded.unsprung[i];
    loaded.unsprung[i] = v;
    v = loaded.sprung[i] + change;
  });
}

void solve_loaded_cloth(std::size_t i, int part, Real h, std::span<ClothLoad> loads, state::Tables& tables,
                        LoadedCloths& loaded) {
  HOOKE_ASSERT(i < loaded.cloths.size() && static_cast<std::size_t>(part) < loaded.solutions.size());
  const LoadedCloth& cloth = loaded.cloths[i];
  const state::Rows points = tables.objects[cloth.object].particles;
  const auto comes_before = [](const ClothPress& press, std::uint32_t row) { return press.particle < row; };
  const auto first =
      std::lower_bound(loaded.presses.begin(), loaded.presses.end(), points.first, comes_before);
  const auto end = std::lower_bound(first, loaded.presses.end(), points.end(), comes_before);
  if (!loaded.solutions[static_cast<std::size_t>(part)].solve(
          {.object = cloth.object,
           .unsprung = std::span(loaded.unsprung).subspan(cloth.first, points.count),
           .presses = std::span(first, end),
           .loads = loads,
           .with_bends = cloth.with_bends,
           .h = static_cast<double>(h)},
          tables))
    loaded.is_unconverged[i] = 1;
}

}  // namespace hooke::solver
