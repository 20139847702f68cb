#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include "build/build.h"
#include "parallel/thread_pool.h"
#include "solver/body/body_motion.h"
#include "solver/joint/joints.h"
#include "state/tables.h"

#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <numeric>
#include <vector>

namespace hooke::solver {

struct RigBody {
  DVec3 center = {};
  Real mass = Real(1);  ///< 0: a body that nothing moves.
  Vec3 inertia = {Real(1), Real(1), Real(1)};
  Vec3 velocity = {};
  Vec3 angular_velocity = {};
  Quat rotation = {};
};

/// Bodies without shapes, hooks between them, and nothing else of the step.
struct JointRig {
  state::Tables t;
  Joints joints;
  std::vector<std::uint32_t> rows;
  parallel::ThreadPool pool;
  std::uint64_t built = ~std::uint64_t{0};
  Vec3 gravity = {Real(0), Real(-9.81), Real(0)};

  double budget = kArticulationBudget;  ///< 0: everything is a net.

  explicit JointRig(int workers = 1) : pool(workers) {}

  BodyId add(const RigBody& d) {
    const auto row = static_cast<std::uint32_t>(t.bodies.motion.size());
    state::Bodies::for_each_column(t.bodies, [&](auto& column) { column.resize(row + 1); });
    const bool moves = d.mass > Real(0);
    const Real inverse = moves ? Real(1) / d.mass : Real(0);
    t.bodies.traits[row].kind = moves ? BodyKind::kDynamic : BodyKind::kKinematic;
    t.bodies.traits[row].alive = true;
    t.bodies.center[row] = d.center;
    t.bodies.rotation[row] = d.rotation;
    t.bodies.motion[row].v = d.velocity;
    t.bodies.motion[row].inverse_mass = inverse;
    t.bodies.angular_velocity[row] = d.angular_velocity;
    if (moves) {
      t.bodies.mass[row] = {.inertia = d.inertia, .mass = d.mass, .inverse_mass = inverse};
      const Vec3 w = rotate(conjugate(d.rotation), d.angular_velocity);
      t.bodies.angular_momentum[row] =
          rotate(d.rotation, {d.inertia.x * w.x, d.inertia.y * w.y, d.inertia.z * w.z});
    }
    rows.push_back(row);
    return t.body_slots.add(row);
  }

  /// The row of the new hook.
  std::size_t hook(const HookDesc& desc) {
    const Result<void> added = build::add_hook(desc, t);
    REQUIRE_MESSAGE(added.has_value(), added.error().message);
    return t.hooks.size() - 1;
  }

  void step(Real dt, int substeps) {
    if (built != t.hook_revision) build_joints(t.hooks, t.bodies, budget, joints);
    built = t.hook_revision;
    const Real h = dt / static_cast<Real>(substeps);
    prepare_bodies(rows, t.bodies);
    evaluate_ragdolls(pool, t.hooks, t.bodies, joints);
    prepare_joints(pool, h, t.hooks, t.bodies, joints);
    for (int i = 0; i < substeps; ++i) {
      accelerate_bodies(rows, {.gravity = gravity, .h = h, .first = i == 0}, t.bodies);
      solve_joints(pool, h, t.hooks, t.bodies, joints);
      move_bodies(rows, h, t.bodies);
      relax_joints(pool, h, t.hooks, t.bodies, joints);
    }
    finish_bodies(rows, t.bodies);
    finish_joints(pool, dt, substeps, t.bodies, joints, t.hooks);
  }

  void run(double seconds, int substeps = 8, Real dt = Real(1) / Real(60)) {
    const int steps = static_cast<int>(std::lround(seconds / static_cast<double>(dt)));
    for (int i = 0; i < steps; ++i) step(dt, substeps);
  }

  [[nodiscard]] DVec3 center(BodyId id) const { return t.bodies.center[t.body_slots.find(id)]; }
  [[nodiscard]] Vec3 velocity(BodyId id) const { return t.bodies.motion[t.body_slots.find(id)].v; }
  [[nodiscard]] Vec3 omega(BodyId id) const { return t.bodies.angular_velocity[t.body_slots.find(id)]; }
  [[nodiscard]] DVec3 place_of(BodyId id, DVec3 local) const {
    const Quat q = t.bodies.rotation[t.body_slots.find(id)];
    const Quaternion<double> r = {static_cast<double>(q.x), static_cast<double>(q.y),
                                  static_cast<double>(q.z), static_cast<double>(q.w)};
    return center(id) + rotate(r, local);
  }

  [[nodiscard]] DVec3 momentum() const {
    DVec3 sum;
    for (const std::uint32_t i : rows)
      sum += static_cast<double>(t.bodies.mass[i].mass) * vector_cast<double>(t.bodies.motion[i].v);
    return sum;
  }
  [[nodiscard]] DVec3 angular_momentum() const {
    DVec3 sum;
    for (const std::uint32_t i : rows) {
      const DVec3 p = static_cast<double>(t.bodies.mass[i].mass) * vector_cast<double>(t.bodies.motion[i].v);
      sum += vector_cast<double>(t.bodies.angular_momentum[i]) + cross(t.bodies.center[i], p);
    }
    return sum;
  }
};

/// Moments of a solid box of half extents h about its center.
inline Vec3 box_inertia(Real mass, Vec3 h) {
  const Real third = mass / Real(3);
  return {third * (h.y * h.y + h.z * h.z), third * (h.x * h.x + h.z * h.z), third * (h.x * h.x + h.y * h.y)};
}

inline double d(Real x) {
  return static_cast<double>(x);
}

}  // namespace hooke::solver
