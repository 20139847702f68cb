#pragma once

#include "parallel/thread_pool.h"
#include "solver/body/body_motion.h"
#include "solver/contact/body_contacts.h"
#include "state/bodies.h"
#include "state/manifolds.h"

#include <cmath>
#include <functional>
#include <vector>

/// \file
/// A world of bodies with hand-made contacts: what the solver needs, and nothing of collision detection.

namespace hooke::solver::testing {

using state::Manifold;

struct Solid {
  Real mass = Real(1);
  Vec3 inertia = {};
};

inline Solid solid_sphere(Real mass, Real radius) {
  const Real i = Real(0.4) * mass * radius * radius;
  return {mass, {i, i, i}};
}

inline Solid solid_box(Real mass, Vec3 half) {
  const auto sum = [&](Real a, Real b) { return mass / Real(3) * (a * a + b * b); };
  return {mass, {sum(half.y, half.z), sum(half.x, half.z), sum(half.x, half.y)}};
}

/// Surface of a pair, in place of materials.
struct Surface {
  Real friction = Real(0.5);
  Real restitution = Real(0);
};

struct BodyScene {
  explicit BodyScene(int workers = 1) : pool(workers) {}

  /// Mass 0: a body that stands.
  std::uint32_t add(const Solid& solid, DVec3 center, Quat rotation = {}) {
    const std::uint32_t row = static_cast<std::uint32_t>(bodies.motion.size());
    state::Bodies::for_each_column(bodies, [](auto& column) { column.emplace_back(); });
    const bool moves = solid.mass > Real(0);
    bodies.center[row] = center;
    bodies.rotation[row] = rotation;
    bodies.mass[row] = {
        .inertia = solid.inertia, .mass = solid.mass, .inverse_mass = moves ? Real(1) / solid.mass : Real(0)};
    bodies.motion[row].inverse_mass = bodies.mass[row].inverse_mass;
    bodies.traits[row] = {.kind = moves ? BodyKind::kDynamic : BodyKind::kStatic, .alive = true};
    if (moves) awake.push_back(row);
    return row;
  }

  void spin(std::uint32_t row, Vec3 omega) {
    const Quat axes = bodies.rotation[row] * bodies.mass[row].principal;
    const Vec3 local = rotate(conjugate(axes), omega);
    const Vec3 i = bodies.mass[row].inertia;
    bodies.angular_velocity[row] = omega;
    bodies.angular_momentum[row] = rotate(axes, {i.x * local.x, i.y * local.y, i.z * local.z});
  }

  /// Adds a manifold that `place` keeps up to date: called at the start of each step.
  Manifold& add_contact(std::uint32_t a, std::uint32_t b, const Surface& surface,
                        std::function<void(BodyScene&, Manifold&)> place) {
    Manifold m;
    m.collider_a = m.body_a = a;
    m.collider_b = m.body_b = b;
    m.friction = m.static_friction = surface.friction;
    m.restitution = surface.restitution;
    manifolds.push_back(m);
    places.push_back(std::move(place));
    return manifolds.back();
  }

  template <class Kernel>
  void each_color(Kernel&& kernel) {
    for (int c = 0; c < contacts.color_count(); ++c) {
      const int first = contacts.color_begin[c];
      parallel::for_ranges(pool, contacts.color_begin[c + 1] - first, 1, [&](parallel::Range r) {
        kernel(parallel::Range{first + r.begin, first + r.end});
      });
    }
  }

  void substep(bool first) {
    accelerate_bodies(awake, {.gravity = settings.gravity, .h = settings.h, .first = first}, bodies);
    for (int sweep = 0; sweep < settings.sweeps; ++sweep)
      each_color([&](parallel::Range r) { solve_body_contacts(r, settings, contacts, bodies); });
    move_bodies(awake, settings.h, bodies);
    each_color([&](parallel::Range r) { relax_body_contacts(r, settings, contacts, bodies); });
  }

  void step() {
    settings.h = dt / static_cast<Real>(substeps);
    for (std::size_t i = 0; i < manifolds.size(); ++i) places[i](*this, manifolds[i]);
    prepare_bodies(awake, bodies);
    for (Manifold& m : manifolds)
      m.route = has_contact_rows(m, bodies) ? state::ContactRoute::kSoft : state::ContactRoute::kNone;
    prepare_body_contacts(pool, manifolds, bodies, settings, contacts);
    for (int i = 0; i < substeps; ++i) substep(i == 0);
    finish_bodies(awake, bodies);
    each_color([&](parallel::Range r) { store_body_contacts(r, contacts, manifolds); });
  }

  void run(int steps) {
    for (int i = 0; i < steps; ++i) step();
  }

  [[nodiscard]] Vec3 velocity(std::uint32_t row) const { return bodies.motion[row].v; }

  state::Bodies bodies;
  std::vector<std::uint32_t> awake;
  std::vector<Manifold> manifolds;
  std::vector<std::function<void(BodyScene&, Manifold&)>> places;
  BodyContacts contacts;
  ContactStep settings = {.gravity = {Real(0), Real(-9.81), Real(0)}};
  Real dt = Real(1) / Real(60);
  int substeps = 8;
  parallel::ThreadPool pool;
};

/// Nothing there: the next contact starts without impulses.
inline void clear(Manifold& m) {
  m.point_count = 0;
  m.friction_impulse = {};
  m.twist_impulse = Real(0);
  m.rolling_impulse = {};
  for (auto& p : m.point) p.normal_impulse = Real(0);
}

/// Places the manifold of spheres A and B, or of plane A through its center (radius 0) with normal `plane`.
inline void place_sphere(BodyScene& scene, Manifold& m, Vec3 plane, Real radius_a, Real radius_b) {
  const Vec3 d = vector_cast<Real>(scene.bodies.center[m.body_b] - scene.bodies.center[m.body_a]);
  m.normal = radius_a > Real(0) ? normalize(d) : plane;
  const Real s = dot(d, m.normal) - radius_a - radius_b;
  const Real reach = Real(0.02) + scene.dt * length(scene.velocity(m.body_b) - scene.velocity(m.body_a));
  if (s > reach) return clear(m);
  m.point_count = 1;
  m.point[0].separation = s;
  m.point[0].anchor_b = -(radius_b * m.normal);
  m.point[0].anchor_a = d + m.point[0].anchor_b - s * m.normal;
}

/// Places the manifold of the lower face of box B on a plane through `on_a` of A's frame, normal `up` there.
inline void place_box(BodyScene& scene, Manifold& m, Vec3 on_a, Vec3 up, Vec3 half) {
  const state::Bodies& b = scene.bodies;
  m.normal = rotate(b.rotation[m.body_a], up);
  m.point_count = 4;
  const Vec3 d = vector_cast<Real>(b.center[m.body_b] - b.center[m.body_a]);
  for (int k = 0; k < 4; ++k) {
    const Vec3 corner = {k % 2 == 0 ? -half.x : half.x, -half.y, k / 2 == 0 ? -half.z : half.z};
    state::ContactPoint& p = m.point[k];
    p.key = static_cast<std::uint32_t>(k);
    p.anchor_b = rotate(b.rotation[m.body_b], corner);
    p.separation = dot(m.normal, d + p.anchor_b - rotate(b.rotation[m.body_a], on_a));
    p.anchor_a = d + p.anchor_b - p.separation * m.normal;
  }
}

}  // namespace hooke::solver::testing
