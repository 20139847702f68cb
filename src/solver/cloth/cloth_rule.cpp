#include "solver/cloth/cloth_rule.h"

#include "base/assert.h"
#include "solver/cloth/cloth_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::Deformable;
using state::SpringClass;

constexpr Real kRounding = Real(4e-7);  ///< Error of a length over the coordinates of its ends [ratio].

/// By what share of its length a row is too long: now, where sweeps solve it, or else after a sweep, which
/// carries h^2 T / m of its tension T.
Real excess_of(const state::Tables& t, std::size_t row, Real h, bool solved) {
  const state::Springs& springs = t.springs;
  const SpringClass kind = springs.kind[row];
  if (kind != SpringClass::kStretch && kind != SpringClass::kLimit) return Real(0);
  const std::uint32_t a = springs.particle_a[row];
  const std::uint32_t b = springs.particle_b[row];
  const Vec3 d = t.particles.position[a].x - t.particles.position[b].x;
  const Real rest = springs.rest_length[row];
  const Real l2 = dot(d, d);
  if (!(l2 > rest * rest)) return Real(0);
  const Real answer = h * h * (t.particles.velocity[a].inverse_mass + t.particles.velocity[b].inverse_mass);
  const Real stiffness = springs.stiffness[row] * answer;
  if (!(stiffness > Real(1))) return Real(0);  // a sweep carries it
  const Real longer = std::sqrt(l2) - rest;
  if (!solved) return longer / rest;
  const Vec3 x = t.particles.position[a].x;
  const Real exact = longer - kRounding * (std::abs(x.x) + std::abs(x.y) + std::abs(x.z));
  return std::min(stiffness, kMostRowStiffness) * std::max(exact, Real(0)) / rest;
}

Real largest_excess(const state::Tables& t, const Deformable& object, Real h) {
  Real largest = Real(0);
  for (std::size_t row = object.springs.first; row < object.springs.end(); ++row)
    largest = std::max(largest, excess_of(t, row, h, object.stretch.solved));
  return largest;
}

/// Whether something that the solution does not know acts on a cloth: hooks, or a body that moves and presses
/// on it. The solution would find the tension of the cloth alone, and move points that are light.
bool bears_others(const state::Tables& t, std::uint32_t object) {
  for (const state::Hook& hook : t.hooks) {
    for (const state::HookPlace* end : {&hook.a, &hook.b}) {
      if (end->is_point() && end->object == object) return true;
    }
  }
  const state::Contacts& contacts = t.contacts;
  const state::Rows rows = t.objects[object].particles;
  const auto first = std::lower_bound(contacts.particle.begin(), contacts.particle.end(), rows.first);
  for (auto row = static_cast<std::size_t>(first - contacts.particle.begin());
       row < contacts.particle.size() && contacts.particle[row] < rows.end(); ++row) {
    if (state::gives_way(t.bodies, contacts.body[row]) && contacts.normal_force[row] > Real(0)) return true;
  }
  return false;
}

/// Whether a cloth is held and has so many points that sweeps need help. Without pins, what a solution that
/// ends early lacks would be momentum; closed cloths are held by their gas.
bool may_be_solved(const state::Tables& t, std::uint32_t object) {
  const Deformable& cloth = t.objects[object];
  if (!cloth.stretch.asked || cloth.kind != PointRef::Kind::kCloth || cloth.springs.count == 0 ||
      cloth.gas > 0)
    return false;
  if (cloth.particles.count < kLeastClothPoints) return false;
  return std::any_of(t.pins.begin(), t.pins.end(),
                     [&](const state::Pin& pin) { return pin.object == object; });
}

}  // namespace

void choose_stretch_solutions(Real h, Real dt, state::Tables& t) {
  for (std::uint32_t i = 0; i < t.objects.size(); ++i) {
    Deformable& object = t.objects[i];
    state::Stretch& stretch = object.stretch;
    if (!stretch.solved && !may_be_solved(t, i)) continue;
    const bool bears = bears_others(t, i) || !may_be_solved(t, i);
    const bool is_loaded =
        !bears && largest_excess(t, object, h) > (stretch.solved ? kStretchUntil : kStretchFrom);
    stretch.calm = is_loaded || !stretch.solved ? Real(0) : stretch.calm + dt;
    const bool solved = is_loaded || (!bears && stretch.solved && stretch.calm < kCalmTime);
    if (solved == stretch.solved) continue;
    stretch.solved = solved;
    stretch.calm = Real(0);
    stretch.change.assign(solved ? object.particles.count : 0, Vec3{});
    state::note_change(t, object);
  }
}

}  // namespace hooke::solver
