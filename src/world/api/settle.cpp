#include "hooke/settle.h"

#include "build/checks.h"
#include "world/claim.h"
#include "world/object_edits.h"
#include "world/world_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace hooke {

namespace {

using state::Bodies;
using state::Tables;

/// Flags of bodies and of deformable objects that do not count, by row.
struct LeftOutRows {
  std::vector<bool> bodies;
  std::vector<bool> objects;
};

LeftOutRows rows_left_out(const Tables& t, const LeftOut& left_out) {
  LeftOutRows rows = {std::vector<bool>(t.bodies.mass.size(), false),
                      std::vector<bool>(t.objects.size(), false)};
  for (const BodyId id : left_out.bodies) {
    const std::uint32_t row = t.body_slots.find(id);
    if (row != state::SlotTable<BodyId>::kNone) rows.bodies[row] = true;
  }
  for (const PointRef& point : left_out.objects) {
    const std::uint32_t row = state::object_row(t, point);
    if (row != state::SlotTable<RopeId>::kNone) rows.objects[row] = true;
  }
  return rows;
}

double kinetic_of_body(const Tables& t, std::uint32_t body) {
  const state::BodyMass& mass = t.bodies.mass[body];
  const DVec3 v = vector_cast<double>(t.bodies.motion[body].v);
  const Quat axes = t.bodies.rotation[body] * mass.principal;
  const DVec3 l = vector_cast<double>(rotate(conjugate(axes), t.bodies.angular_momentum[body]));
  const DVec3 inertia = vector_cast<double>(mass.inertia);
  return 0.5 * static_cast<double>(mass.mass) * length_squared(v) +
         0.5 * (l.x * l.x / inertia.x + l.y * l.y / inertia.y + l.z * l.z / inertia.z);
}

/// Adds a body or point. Returns whether it is the fastest so far.
bool add_motion(Unrest& unrest, double mass, double kinetic, double dt) {
  unrest.kinetic += kinetic;
  const double force = std::sqrt(2 * mass * kinetic) / dt;
  unrest.residual = std::max(unrest.residual, force);
  unrest.sum += force;
  const double speed = std::sqrt(2 * kinetic / mass);
  if (!(speed > unrest.speed)) return false;
  unrest.speed = speed;
  return true;
}

/// Number of the point of an object whose row is `row`, both from the object's first.
std::uint32_t number_of(const Tables& t, const state::Deformable& object, std::uint32_t row) {
  const auto first = t.particles.row_of.begin() + object.particles.first;
  const auto found = std::find(first, first + object.particles.count, row);
  return static_cast<std::uint32_t>(found - first);
}

/// Calls `visit(row)` for every dynamic body that counts.
template <class Visit>
void for_each_body(const Tables& t, const LeftOutRows& left_out, Visit&& visit) {
  for (const std::uint32_t row : t.moving_bodies) {
    if (t.bodies.mass[row].mass > Real(0) && !left_out.bodies[row]) visit(row);
  }
}

/// Calls `visit(object, row)` for every free point of the objects that count.
template <class Visit>
void for_each_point(const Tables& t, const LeftOutRows& left_out, Visit&& visit) {
  for (std::size_t i = 0; i < t.objects.size(); ++i) {
    if (left_out.objects[i]) continue;
    const state::Deformable& object = t.objects[i];
    for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
      if (t.particles.velocity[p].inverse_mass > Real(0)) visit(object, p);
    }
  }
}

/// Places of all that moves [m], to see how far it drifts.
std::vector<DVec3> places_of(const Tables& t) {
  std::vector<DVec3> places;
  const LeftOutRows none = rows_left_out(t, {});
  for_each_body(t, none, [&](std::uint32_t row) { places.push_back(t.bodies.center[row]); });
  for_each_point(t, none, [&](const state::Deformable& object, std::uint32_t p) {
    places.push_back(object.origin + vector_cast<double>(t.particles.position[p].x));
  });
  return places;
}

double farthest_between(const std::vector<DVec3>& a, const std::vector<DVec3>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();  // Something tore.
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, length(a[i] - b[i]));
  return most;
}

double weight_of(const Tables& t) {
  double mass = 0;
  const LeftOutRows none = rows_left_out(t, {});
  for_each_body(t, none, [&](std::uint32_t row) {
    mass += static_cast<double>(t.bodies.mass[row].mass) *
            std::abs(static_cast<double>(t.bodies.traits[row].gravity_scale));
  });
  for_each_point(t, none, [&](const state::Deformable&, std::uint32_t p) {
    mass += static_cast<double>(t.particles.mass[p]);
  });
  return mass * static_cast<double>(length(t.desc.gravity));
}

/// Keeps bodies awake and undamped as long as it lives, and puts time back: a damping of c takes c h of the
/// weight of a body at rest within a substep of h seconds, and who sleeps is not known to be balanced.
class Undisturbed {
 public:
  explicit Undisturbed(std::shared_ptr<WorldData> data)
      : data_(std::move(data)),
        traits_(tables().bodies.traits),
        sleeping_(tables().desc.sleeping),
        time_(tables().time),
        steps_(tables().step_count) {
    tables().desc.sleeping = false;
    for (state::BodyTraits& traits : tables().bodies.traits) {
      traits.linear_damping = Real(0);
      traits.angular_damping = Real(0);
    }
    world::wake_all(tables());
  }
  Undisturbed(const Undisturbed&) = delete;
  Undisturbed& operator=(const Undisturbed&) = delete;
  ~Undisturbed() {
    tables().desc.sleeping = sleeping_;
    tables().time = time_;
    tables().step_count = steps_;
    std::vector<state::BodyTraits>& traits = tables().bodies.traits;
    for (std::size_t i = 0; i < std::min(traits.size(), traits_.size()); ++i) {
      traits[i].linear_damping = traits_[i].linear_damping;
      traits[i].angular_damping = traits_[i].angular_damping;
    }
  }

 private:
  [[nodiscard]] Tables& tables() const { return data_->tables; }

  std::shared_ptr<WorldData> data_;
  std::vector<state::BodyTraits> traits_;
  bool sleeping_;
  double time_;
  std::uint64_t steps_;
};

Result<void> check_settling(const SettleDesc& desc, double weight) {
  const auto refuse = [](const char* where, const char* what) {
    return Error{ErrorCode::kOutOfRange, where, what};
  };
  if (!(desc.dt >= Real(1e-6)) || !(desc.dt <= Real(1)))
    return refuse("settle.dt", "must be from 1e-6 to 1 s");
  if (!(desc.residual >= 1e-9) || !(desc.residual <= 1)) {
    return refuse("settle.residual", "must be from 1e-9 to 1");
  }
  if (!(desc.seconds > 0) || !(desc.seconds <= 1e5))
    return refuse("settle.seconds", "must be above 0, up to 1e5");
  if (!(desc.drift >= 0)) return refuse("settle.drift", "must be 0 or more");
  if (!(desc.force >= 0) || !std::isfinite(desc.force))
    return refuse("settle.force", "must be 0 or more, and finite");
  if (!(desc.force > 0) && !(weight > 0)) {
    return refuse("settle.force",
                  "is needed where nothing has weight: the force that unbalanced ones are compared with");
  }
  return {};
}

bool anything_broke(const Events& events) {
  return !events.breaks.empty() || !events.rope_breaks.empty() || !events.tears.empty() ||
         !events.solid_tears.empty();
}

/// Steps until there is rest, or none to be had, and says in the report which. The tables are those of the
/// world.
Result<void> relax(World& world, const Tables& tables, Real dt, const RestWatch::Limits& limits,
                   SettleReport& report) {
  const auto second = static_cast<std::uint64_t>(std::max(1.0, std::round(1 / static_cast<double>(dt))));
  RestWatch watch(limits);
  std::vector<DVec3> places = places_of(tables);
  while (watch.steps() < limits.steps) {
    const StepReport stepped = world.step(dt);
    if (!stepped.moved) return Error{ErrorCode::kOutOfRange, "settle", "a step did not move"};
    report.unrest = world.unrest(static_cast<double>(dt));
    report.end = SettleEnd::kOutOfTime;
    const bool broke = anything_broke(world.events());
    const RestWatch::Verdict verdict = watch.observe(report.unrest, broke);
    report.steps = watch.steps();
    if (verdict == RestWatch::Verdict::kAtRest) report.end = SettleEnd::kBalanced;
    if (broke) report.end = SettleEnd::kBroke;
    if (!stepped.healthy()) report.end = SettleEnd::kDiverged;
    if (report.end != SettleEnd::kOutOfTime) return {};
    if (verdict == RestWatch::Verdict::kPeak) (void)world.stop({});
    if (watch.steps() % second != 0) continue;
    std::vector<DVec3> now = places_of(tables);
    if (watch.is_still(farthest_between(now, places))) {
      report.end = SettleEnd::kStill;
      return {};
    }
    places = std::move(now);
  }
  return {};
}

}  // namespace

Unrest World::unrest(double dt, const LeftOut& left_out) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  Unrest unrest;
  if (!(dt > 0)) return unrest;
  const LeftOutRows rows = rows_left_out(t, left_out);
  for_each_body(t, rows, [&](std::uint32_t row) {
    if (!add_motion(unrest, static_cast<double>(t.bodies.mass[row].mass), kinetic_of_body(t, row), dt))
      return;
    unrest.body = world::id_of(t, row);
  });
  const state::Deformable* owner = nullptr;
  std::uint32_t fastest = 0;
  for_each_point(t, rows, [&](const state::Deformable& object, std::uint32_t p) {
    const auto mass = static_cast<double>(t.particles.mass[p]);
    const DVec3 v = vector_cast<double>(t.particles.velocity[p].v);
    if (!add_motion(unrest, mass, 0.5 * mass * length_squared(v), dt)) return;
    owner = &object;
    fastest = p;
  });
  if (owner == nullptr) return unrest;
  unrest.body = {};
  unrest.point = world::point_of(t, *owner, number_of(t, *owner, fastest - owner->particles.first));
  return unrest;
}

Result<void> World::stop(const LeftOut& left_out) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Tables& t = claim.tables();
  const LeftOutRows rows = rows_left_out(t, left_out);
  for_each_body(t, rows, [&](std::uint32_t row) {
    t.bodies.motion[row].v = {};
    t.bodies.angular_velocity[row] = {};
    t.bodies.angular_momentum[row] = {};
  });
  for_each_point(t, rows, [&](const state::Deformable&, std::uint32_t p) { t.particles.velocity[p].v = {}; });
  return {};
}

Result<SettleReport> World::settle(const SettleDesc& desc) {
  double weight = 0;
  {
    const world::Claim claim(data_);
    if (!claim) return claim.error();
    weight = weight_of(claim.tables());
    if (auto checked = check_settling(desc, weight); !checked) return checked.error();
  }
  const double scale = desc.force > 0 ? desc.force : weight;
  const double steps = std::round(desc.seconds / static_cast<double>(desc.dt));
  const RestWatch::Limits limits = {.residual = desc.residual * scale,
                                    .speed = std::numeric_limits<double>::infinity(),
                                    .drift = desc.drift,
                                    .steps = static_cast<std::uint64_t>(std::max(1.0, steps))};
  SettleReport report;
  {
    const std::shared_ptr<WorldData> data = data_;
    const Undisturbed undisturbed(data);
    if (auto relaxed = relax(*this, data->tables, desc.dt, limits, report); !relaxed) return relaxed.error();
  }
  report.residual = report.unrest.residual / scale;
  report.sum = report.unrest.sum / scale;
  if (report.end != SettleEnd::kBroke) (void)stop({});
  return report;
}

}  // namespace hooke
