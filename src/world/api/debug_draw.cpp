#include "hooke/debug_draw.h"

#include "build/checks.h"
#include "collision/continuous/shape_bounds.h"
#include "solver/joint_rows/hook_rows.h"
#include "state/body_frames.h"
#include "state/sleeping_pairs.h"
#include "world/api/debug_loads.h"
#include "world/claim.h"
#include "world/object_edits.h"
#include "world/world_data.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace hooke {

namespace {

using state::Tables;

constexpr double kLargestScale = 1e6;
constexpr double kFar = 1e6;  ///< Boxes of what reaches farther are not drawn [m].

constexpr DebugColor kPlace = {0.95F, 0.95F, 0.95F};
constexpr DebugColor kNormal = {0.30F, 0.85F, 0.35F};
constexpr DebugColor kForce = {1.00F, 0.35F, 0.20F};
constexpr DebugColor kFriction = {1.00F, 0.85F, 0.20F};
constexpr DebugColor kVelocity = {0.30F, 0.75F, 1.00F};
constexpr DebugColor kBodyBox = {0.40F, 0.85F, 0.95F};
constexpr DebugColor kObjectBox = {0.85F, 0.60F, 1.00F};
constexpr DebugColor kAsleep = {0.35F, 0.45F, 0.95F};
constexpr DebugColor kAwake = {0.45F, 0.90F, 0.45F};
constexpr DebugColor kAnchor = {1.00F, 0.80F, 0.20F};
constexpr DebugColor kGap = {1.00F, 0.20F, 0.80F};
constexpr std::array<DebugColor, 3> kAxes = {
    {{0.95F, 0.25F, 0.25F}, {0.30F, 0.85F, 0.30F}, {0.30F, 0.45F, 1.00F}}};

constexpr std::array<DebugRoute, 3> kContactRoutes = {
    {{"soft", {0.45F, 0.85F, 0.45F}}, {"direct", {1.00F, 0.55F, 0.15F}}, {"coupled", {0.90F, 0.25F, 0.85F}}}};
constexpr std::array<DebugRoute, 6> kHookRoutes = {{{"tree", {0.30F, 0.65F, 1.00F}},
                                                    {"approximate tree", {0.35F, 0.90F, 0.95F}},
                                                    {"loop", {1.00F, 0.85F, 0.20F}},
                                                    {"block", {0.85F, 0.35F, 0.25F}},
                                                    {"iterative", {0.60F, 0.15F, 0.15F}},
                                                    {"coupled", {0.90F, 0.25F, 0.85F}}}};

/// Hands out the shapes of one picture.
class Picture {
 public:
  Picture(const Tables& tables, DebugDraw& draw, const DebugDrawDesc& desc)
      : t_(tables), draw_(draw), desc_(desc) {}

  [[nodiscard]] const DebugDrawLegend& legend() const { return legend_; }

  void add_body_contacts(const std::vector<BodyContact>& contacts);
  void add_point_contacts();
  void add_element_contacts();
  void add_rope_contacts();
  void add_velocities();
  void add_bounds();
  void add_loads();
  void add_hooks();
  void add_sleep();
  void add_routes();

 private:
  void write(DebugSubject subject, DVec3 place, const char* format, double value, DebugColor color);
  void add_contact(DVec3 place, Vec3 normal, Real normal_force, Vec3 friction);
  void add_velocity(DVec3 place, Vec3 velocity, bool named);
  void add_box(DebugSubject subject, DVec3 lower, DVec3 upper, DebugColor color);
  void add_boxes(DebugSubject subject, std::uint32_t body, DebugColor color);
  void add_loads(const world::Loads& loads, bool is_rope);
  [[nodiscard]] DVec3 place_of(std::uint32_t object, std::uint32_t particle) const;

  const Tables& t_;
  DebugDraw& draw_;
  const DebugDrawDesc& desc_;
  DebugDrawLegend legend_;
};

void Picture::write(DebugSubject subject, DVec3 place, const char* format, double value, DebugColor color) {
  if (!desc_.texts) return;
  char text[48];
  std::snprintf(text, sizeof(text), format, value);
  draw_.text(subject, place, text, color);
}

DVec3 Picture::place_of(std::uint32_t object, std::uint32_t particle) const {
  return t_.objects[object].origin + vector_cast<double>(t_.particles.position[particle].x);
}

/// `normal` leads to what the forces act on.
void Picture::add_contact(DVec3 place, Vec3 normal, Real normal_force, Vec3 friction) {
  constexpr auto kSubject = DebugSubject::kContacts;
  const DVec3 up = vector_cast<double>(normal);
  const auto force = static_cast<double>(normal_force);
  draw_.point(kSubject, place, kPlace);
  draw_.line(kSubject, place, place + desc_.axis_length * up, kNormal);
  if (force > 0) {
    draw_.line(kSubject, place, place + desc_.meters_per_newton * force * up, kForce);
    write(kSubject, place, "%.3g N", force, kForce);
  }
  if (length_squared(friction) > Real(0))
    draw_.line(kSubject, place, place + desc_.meters_per_newton * vector_cast<double>(friction), kFriction);
  legend_.force = std::max(legend_.force, force);
  ++legend_.contacts;
}

void Picture::add_body_contacts(const std::vector<BodyContact>& contacts) {
  for (const BodyContact& c : contacts) add_contact(c.point, c.normal, c.normal_force, c.friction_force);
}

void Picture::add_point_contacts() {
  const state::Contacts& c = t_.contacts;
  for (std::size_t i = 0; i < c.particle.size(); ++i) {
    if (!(c.normal_force[i] > Real(0))) continue;
    const DVec3 center = place_of(c.object[i], c.particle[i]);
    const auto radius = static_cast<double>(t_.particles.position[c.particle[i]].radius);
    add_contact(center - radius * vector_cast<double>(c.normal[i]), c.normal[i], c.normal_force[i],
                c.friction_force[i]);
  }
}

void Picture::add_element_contacts() {
  for (const state::ElementContact& c : t_.element_contacts) {
    if (!(c.normal_force > Real(0))) continue;
    DVec3 place;
    for (std::uint32_t k = 0; k < c.count; ++k)
      place += static_cast<double>(c.weight[k]) * place_of(c.object, c.particle[k]);
    add_contact(place, c.normal, c.normal_force, c.friction_force);
  }
}

void Picture::add_rope_contacts() {
  for (const state::RopeContact& c : t_.rope_contacts) {
    if (!(c.normal_force > Real(0))) continue;
    const DVec3 place = static_cast<double>(c.weight[0]) * place_of(c.object_a, c.particle[0]) +
                        static_cast<double>(c.weight[1]) * place_of(c.object_a, c.particle[1]);
    add_contact(place, c.normal, c.normal_force, c.friction_force);
  }
}

void Picture::add_velocity(DVec3 place, Vec3 velocity, bool named) {
  const DVec3 v = vector_cast<double>(velocity);
  const double speed = length(v);
  if (!(speed > 0)) return;
  draw_.line(DebugSubject::kVelocities, place, place + desc_.seconds * v, kVelocity);
  if (named) write(DebugSubject::kVelocities, place, "%.3g m/s", speed, kVelocity);
  legend_.speed = std::max(legend_.speed, speed);
}

void Picture::add_velocities() {
  for (const std::uint32_t body : t_.moving_bodies)
    add_velocity(t_.bodies.center[body], t_.bodies.motion[body].v, true);
  for (std::uint32_t row = 0; row < t_.objects.size(); ++row) {
    const state::Rows particles = t_.objects[row].particles;
    for (std::uint32_t p = particles.first; p < particles.end(); ++p)
      add_velocity(place_of(row, p), t_.particles.velocity[p].v, false);
  }
}

/// Draws the twelve edges of a box, unless it is empty or as large as a half-space.
void Picture::add_box(DebugSubject subject, DVec3 lower, DVec3 upper, DebugColor color) {
  const DVec3 size = upper - lower;
  if (!(size.x >= 0 && size.y >= 0 && size.z >= 0 && length(size) < kFar)) return;
  const auto corner = [&](unsigned i) {
    return DVec3{(i & 1U) != 0 ? upper.x : lower.x, (i & 2U) != 0 ? upper.y : lower.y,
                 (i & 4U) != 0 ? upper.z : lower.z};
  };
  for (unsigned i = 0; i < 8; ++i) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((i & axis) == 0) draw_.line(subject, corner(i), corner(i | axis), color);
    }
  }
}

void Picture::add_boxes(DebugSubject subject, std::uint32_t body, DebugColor color) {
  for (const std::uint32_t collider : colliders_of(t_.bodies, body)) {
    const geometry::Box box = collision::bounds_of(
        t_.colliders.shape[collider], state::frame_of_collider(t_.bodies, t_.colliders, collider));
    add_box(subject, vector_cast<double>(box.lower), vector_cast<double>(box.upper), color);
  }
}

void Picture::add_bounds() {
  for (std::uint32_t body = 0; body < t_.bodies.traits.size(); ++body) {
    if (t_.bodies.traits[body].alive) add_boxes(DebugSubject::kBounds, body, kBodyBox);
  }
  for (std::uint32_t row = 0; row < t_.objects.size(); ++row) {
    geometry::Box3<double> box;
    const state::Rows particles = t_.objects[row].particles;
    for (std::uint32_t p = particles.first; p < particles.end(); ++p) {
      const auto r = static_cast<double>(t_.particles.position[p].radius);
      const DVec3 x = place_of(row, p);
      box = merge(box, {x - DVec3{r, r, r}, x + DVec3{r, r, r}});
    }
    add_box(DebugSubject::kBounds, box.lower, box.upper, kObjectBox);
  }
}

void Picture::add_loads(const world::Loads& loads, bool is_rope) {
  constexpr auto kSubject = DebugSubject::kLoads;
  const double full = is_rope ? legend_.full_tension : legend_.full_strain;
  const auto color = [&](double load) { return load_color(full > 0 ? load / full : 0); };
  double most = 0;
  DVec3 place;
  const auto note = [&](double load, DVec3 where) {
    if (!(std::abs(load) > std::abs(most))) return;
    most = load;
    place = where;
  };
  for (const world::LoadedLine& line : loads.lines) {
    draw_.line(kSubject, line.from, line.to, color(line.load));
    note(line.load, 0.5 * (line.from + line.to));
  }
  for (const world::LoadedTriangle& triangle : loads.triangles) {
    draw_.triangle(kSubject, triangle.corners, color(triangle.load));
    note(triangle.load, triangle.corners[0]);
  }
  if (most == 0) return;
  write(kSubject, place, is_rope ? "%.3g N" : "%.3g %%", is_rope ? most : 100 * most, color(most));
}

void Picture::add_loads() {
  std::vector<world::Loads> loads;
  for (const state::Deformable& object : t_.objects) {
    loads.push_back(world::loads_of(t_, object));
    double& most = object.kind == PointRef::Kind::kRope ? legend_.tension : legend_.strain;
    for (const world::LoadedLine& line : loads.back().lines) most = std::max(most, std::abs(line.load));
    for (const world::LoadedTriangle& part : loads.back().triangles)
      most = std::max(most, std::abs(part.load));
  }
  legend_.full_tension = desc_.full_tension > 0 ? desc_.full_tension : legend_.tension;
  legend_.full_strain = desc_.full_strain > 0 ? desc_.full_strain : legend_.strain;
  for (std::size_t row = 0; row < loads.size(); ++row)
    add_loads(loads[row], t_.objects[row].kind == PointRef::Kind::kRope);
}

void Picture::add_hooks() {
  constexpr auto kSubject = DebugSubject::kHooks;
  for (const state::Hook& hook : t_.hooks) {
    const solver::JointBody a = solver::joint_end(t_, hook.a);
    const solver::JointBody b = solver::joint_end(t_, hook.b);
    const DVec3 on_a = a.center + rotate(a.rotation, hook.a.anchor);
    const DVec3 on_b = b.center + rotate(b.rotation, hook.b.anchor);
    draw_.point(kSubject, on_a, kAnchor);
    draw_.point(kSubject, on_b, kAnchor);
    if (on_a != on_b) draw_.line(kSubject, on_a, on_b, kGap);
    if (!hook.a.is_point()) {
      const std::array<Vec3, 3> units = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
      for (std::size_t k = 0; k < 3; ++k) {
        const DVec3 in_body = vector_cast<double>(rotate(hook.a.axes, units[k]));
        draw_.line(kSubject, on_a, on_a + desc_.axis_length * rotate(a.rotation, in_body), kAxes[k]);
      }
    }
    const auto force = static_cast<double>(length(hook.force));
    if (force > 0) write(kSubject, on_b, "%.3g N", force, kAnchor);
  }
}

void Picture::add_sleep() {
  for (const std::uint32_t body : t_.moving_bodies) {
    if (!state::is_dynamic(t_.bodies, body)) continue;
    const bool asleep = t_.bodies.asleep[body] != 0;
    draw_.point(DebugSubject::kSleep, t_.bodies.center[body], asleep ? kAsleep : kAwake);
    if (!asleep) continue;
    add_boxes(DebugSubject::kSleep, body, kAsleep);
    if (desc_.texts) draw_.text(DebugSubject::kSleep, t_.bodies.center[body], "asleep", kAsleep);
    ++legend_.asleep;
  }
}

void Picture::add_routes() {
  constexpr auto kSubject = DebugSubject::kRoutes;
  const auto is_fixed = [&](std::uint32_t body) { return !state::is_dynamic(t_.bodies, body); };
  state::for_each_manifold(t_.pairs, [&](const state::Manifold& m) {
    const bool rests = !state::gives_way(t_.bodies, m.body_a) && !state::gives_way(t_.bodies, m.body_b);
    if (rests || m.point_count == 0 || m.route == state::ContactRoute::kNone) return;
    const DVec3 a = t_.bodies.center[m.body_a];
    const DVec3 b = t_.bodies.center[m.body_b];
    const DVec3 place = a + vector_cast<double>(m.point[0].anchor_a);
    draw_.line(kSubject, is_fixed(m.body_a) ? place : a, is_fixed(m.body_b) ? place : b,
               kContactRoutes[static_cast<std::size_t>(m.route) - 1].color);
  });
  for (const state::Hook& hook : t_.hooks) {
    if (hook.route == state::JointRoute::kNone && !hook.holds_point()) continue;
    const auto route = hook.holds_point() ? state::JointRoute::kCoupled : hook.route;
    const DebugColor color = kHookRoutes[static_cast<std::size_t>(route) - 1].color;
    for (const state::HookPlace* end : {&hook.a, &hook.b}) {
      if (end->body == state::HookPlace::kWorld) continue;
      const solver::JointBody body = solver::joint_end(t_, *end);
      draw_.line(kSubject, body.center, body.center + rotate(body.rotation, end->anchor), color);
    }
    if (hook.holds_point()) draw_.point(kSubject, solver::joint_end(t_, hook.point_end()).center, color);
  }
}

}  // namespace

DebugColor load_color(double share) {
  constexpr int kSteps = 64;
  constexpr std::array<DebugColor, 5> kStops = {{{0.08F, 0.22F, 0.75F},
                                                 {0.40F, 0.68F, 0.95F},
                                                 {0.93F, 0.93F, 0.90F},
                                                 {0.98F, 0.68F, 0.25F},
                                                 {0.80F, 0.06F, 0.08F}}};
  if (std::isnan(share)) return {0, 0, 0};
  const double step = std::floor(kSteps * std::clamp(share, -1.0, 1.0) + 0.5);
  const double at = 2 + 2 * step / kSteps;
  const auto first = std::min(static_cast<std::size_t>(at), std::size_t{3});
  const auto part = static_cast<float>(at - static_cast<double>(first));
  const DebugColor a = kStops[first];
  const DebugColor b = kStops[first + 1];
  const auto mix = [part](float from, float to) { return from + part * (to - from); };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

std::array<DebugRoute, 3> debug_routes_of_contacts() {
  return kContactRoutes;
}

std::array<DebugRoute, 6> debug_routes_of_hooks() {
  return kHookRoutes;
}

Result<DebugDrawLegend> World::debug_draw(DebugDraw& draw, const DebugDrawDesc& desc) const {
  const world::Reading reading(data_);
  const auto checked = build::Checks("debug_draw")
                           .up_to("meters_per_newton", desc.meters_per_newton, kLargestScale)
                           .up_to("seconds", desc.seconds, kLargestScale)
                           .up_to("axis_length", desc.axis_length, kLargestScale)
                           .not_negative("full_tension", desc.full_tension)
                           .not_negative("full_strain", desc.full_strain)
                           .result();
  if (!checked) return checked.error();
  Picture picture(reading.tables(), draw, desc);
  if (desc.contacts) {
    picture.add_body_contacts(body_contacts());
    picture.add_point_contacts();
    picture.add_element_contacts();
    picture.add_rope_contacts();
  }
  if (desc.velocities) picture.add_velocities();
  if (desc.bounds) picture.add_bounds();
  if (desc.loads) picture.add_loads();
  if (desc.hooks) picture.add_hooks();
  if (desc.sleep) picture.add_sleep();
  if (desc.routes) picture.add_routes();
  return picture.legend();
}

}  // namespace hooke
