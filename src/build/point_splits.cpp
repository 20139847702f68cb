#include "build/point_splits.h"

#include "base/assert.h"
#include "state/particle_numbers.h"

#include <memory>

namespace hooke::build {

namespace {

/// Raises the numbers of particles behind those of an object, for those that are added to it. Only later
/// objects, and what holds them, have such numbers.
void shift_particles(std::uint32_t object, std::uint32_t count, state::Tables& t) {
  if (object + 1 == t.objects.size()) return;
  const std::uint32_t at = t.objects[object].particles.end();
  const auto shift = [at, count](std::uint32_t& p) { p += p >= at ? count : 0; };
  state::for_each_particle_number(t, t.objects[object + 1], shift);
  for (std::uint32_t& p : t.contacts.particle) shift(p);
  for (state::ElementContact& contact : t.element_contacts) {
    for (std::uint32_t i = 0; i < contact.count; ++i) shift(contact.particle[i]);
  }
  for (state::RopeContact& contact : t.rope_contacts) {
    for (std::uint32_t& p : contact.particle) shift(p);
  }
  for (std::size_t i = object + 1; i < t.objects.size(); ++i) t.objects[i].particles.first += count;
}

/// Divides a value so that the sum of both parts is the same to the bit: the smaller part is what is left of
/// the larger one, which rounding has met already.
void divide(std::vector<Real>& column, std::uint32_t from, std::uint32_t to, double share) {
  const Real all = column[from];
  const bool gives_more = share > 0.5;
  const double larger = gives_more ? share : 1 - share;
  const Real most = static_cast<Real>(larger * static_cast<double>(all));
  column[from] = gives_more ? all - most : most;
  column[to] = gives_more ? most : all - most;
}

/// Added points of what is hooked to a body do not touch it, if those that they split from did not.
void add_inside(std::uint32_t object, std::span<const PointSplit> splits, state::Tables& t) {
  const state::Rows particles = t.objects[object].particles;
  for (state::Hook& hook : t.hooks) {
    if (hook.inside.empty() || !hook.holds_point() || hook.point_end().object != object) continue;
    for (std::uint32_t i = 0; i < splits.size(); ++i) {
      const std::uint32_t from = splits[i].particle - particles.first;
      if (std::find(hook.inside.begin(), hook.inside.end(), from) != hook.inside.end())
        hook.inside.push_back(particles.count + i);
    }
  }
}

}  // namespace

ElementMesh<3> triangles_of(const state::Tables& t, const state::Deformable& cloth) {
  std::vector<std::array<std::uint32_t, 3>> corners;
  corners.reserve(cloth.triangles.count);
  for (std::uint32_t i = cloth.triangles.first; i < cloth.triangles.end(); ++i) {
    const auto [a, b, c] = t.triangles.corners[i];
    corners.push_back({a, b, c});
  }
  const Incidence incidence(std::span<const std::array<std::uint32_t, 3>>(corners), cloth.particles);
  return {std::move(corners),
          std::span(t.triangles.mass).subspan(cloth.triangles.first, cloth.triangles.count), incidence};
}

ElementMesh<4> tetrahedra_of(const state::Tables& t, const state::Deformable& solid) {
  std::vector<std::array<std::uint32_t, 4>> corners;
  corners.reserve(solid.tetrahedra.count);
  for (std::uint32_t i = solid.tetrahedra.first; i < solid.tetrahedra.end(); ++i) {
    const auto [a, b, c, d] = t.tetrahedra.corners[i];
    corners.push_back({a, b, c, d});
  }
  const Incidence incidence(std::span<const std::array<std::uint32_t, 4>>(corners), solid.particles);
  return {std::move(corners),
          std::span(t.tetrahedra.volume).subspan(solid.tetrahedra.first, solid.tetrahedra.count), incidence};
}

std::vector<std::uint32_t> indices_of(const state::Tables& t, const state::Deformable& object) {
  std::vector<std::uint32_t> index(object.particles.count);
  for (std::uint32_t i = 0; i < index.size(); ++i) index[t.particles.row_of[object.particles.first + i]] = i;
  return index;
}

std::uint32_t count_held(const state::Tables& t, std::span<const PointSplit> splits) {
  std::vector<std::uint32_t> held;
  for (const state::Pin& pin : t.pins) held.push_back(pin.particle);
  for (const state::Hook& hook : t.hooks) {
    for (const state::HookPlace* end : {&hook.a, &hook.b})
      held.insert(held.end(), end->particle.begin(), end->particle.begin() + end->particle_count);
  }
  std::sort(held.begin(), held.end());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < splits.size(); ++i) {
    const bool is_first = i == 0 || splits[i - 1].particle != splits[i].particle;
    if (is_first && std::binary_search(held.begin(), held.end(), splits[i].particle)) ++count;
  }
  return count;
}

void append_split_particles(std::uint32_t object, std::span<const PointSplit> splits, state::Tables& t) {
  const auto count = static_cast<std::uint32_t>(splits.size());
  const std::vector<std::uint32_t> index = indices_of(t, t.objects[object]);
  add_inside(object, splits, t);
  shift_particles(object, count, t);
  state::Deformable& split = t.objects[object];
  state::Particles& particles = t.particles;
  const std::uint32_t first_added = split.particles.end();
  std::vector<std::uint32_t> from;
  for (const PointSplit& one : splits) from.push_back(one.particle);
  insert_copies(particles, from, first_added);
  auto rest = std::make_shared<std::vector<Vec3>>(*split.surface.rest_points);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t p = splits[i].particle;
    const std::uint32_t added = first_added + i;
    HOOKE_ASSERT(splits[i].share > 0 && splits[i].share < 1);
    particles.row_of[added] = split.particles.count + i;
    for (std::vector<Real>* column :
         {&particles.mass, &particles.charge, &particles.viscous_drag, &particles.drag_area})
      divide(*column, p, added, splits[i].share);
    particles.force[added] = static_cast<Real>(splits[i].share) * particles.force[p];
    particles.force[p] -= particles.force[added];
    const bool held = !(particles.velocity[p].inverse_mass > Real(0));
    particles.velocity[added].inverse_mass = Real(1) / particles.mass[added];
    if (!held) particles.velocity[p].inverse_mass = Real(1) / particles.mass[p];
    rest->push_back((*rest)[p - split.particles.first]);
    split.split_from.push_back(index[p - split.particles.first]);
  }
  split.particles.count += count;
  split.surface.rest_points = std::move(rest);
}

}  // namespace hooke::build
