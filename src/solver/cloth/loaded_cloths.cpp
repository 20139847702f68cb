#include "solver/cloth/loaded_cloths.h"

#include "base/assert.h"
#include "solver/cloth/cloth_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

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
          .bends_have_springs = bends_have_springs(tables, cloth)};
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

void find_loaded_cloths(std::span<const ClothBearing> bearings, const state::Tables& tables,
                        LoadedCloths& loaded) {
  loaded.cloths.clear();
  loaded.unsprung.clear();
  loaded.marks.assign(bearings.size(), 0);
  const auto look_at = [&](std::uint32_t particle) {
    const auto behind = std::upper_bound(bearings.begin(), bearings.end(), particle,
                                         [&](std::uint32_t row, const ClothBearing& bearing) {
                                           return row < tables.objects[bearing.object].particles.first;
                                         });
    if (behind == bearings.begin()) return;
    const ClothBearing& bearing = *std::prev(behind);
    if (particle >= tables.objects[bearing.object].particles.end()) return;
    const Real mass = mass_of(tables, particle);
    // What does not give way holds the cloth, and is no load.
    if (mass > bearing.most_mass &&
        mass < static_cast<Real>(kMassThatHolds) * tables.particles.mass[particle])
      loaded.marks[static_cast<std::size_t>(std::prev(behind) - bearings.begin())] = 1;
  };
  for (const std::uint32_t particle : loaded.lent) look_at(particle);
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    if (loaded.marks[i] == 0 && !bearings[i].has_heavy_points) continue;
    const state::Rows points = tables.objects[bearings[i].object].particles;
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

void solve_loaded_cloth(std::size_t i, int part, Real h, state::Tables& tables, LoadedCloths& loaded) {
  HOOKE_ASSERT(i < loaded.cloths.size() && static_cast<std::size_t>(part) < loaded.solutions.size());
  const LoadedCloth& cloth = loaded.cloths[i];
  const state::Deformable& object = tables.objects[cloth.object];
  const auto unsprung = std::span(loaded.unsprung).subspan(cloth.first, object.particles.count);
  if (!loaded.solutions[static_cast<std::size_t>(part)].solve(object, unsprung, cloth.with_bends,
                                                              static_cast<double>(h), tables))
    loaded.is_unconverged[i] = 1;
}

}  // namespace hooke::solver
