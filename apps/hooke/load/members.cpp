#include "hooke/load/members.h"

#include "hooke/scene_path.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace hooke::app {

namespace {

using Kind = SceneObject::Kind;

/// Places nearer than this are one end of a bar [m].
constexpr double kOnePlace = 1e-4;

double limit_of(Real limit) {
  const auto value = static_cast<double>(limit);
  return std::isfinite(value) ? value : 0;
}

/// Area of a section [m^2], and its least second moment [m^4]; 0 where it is not known.
struct SectionMoments {
  double area = 0;
  double second = 0;
};

SectionMoments moments_of(const SceneSection& section) {
  const auto value = [](const std::optional<Real>& number) {
    return static_cast<double>(number.value_or(Real(0)));
  };
  if (section.area) return {value(section.area), value(section.second_moment)};
  const double wall = value(section.thickness);
  if (section.radius) {
    const double outer = value(section.radius);
    const double inner = wall > 0 ? outer - wall : 0;
    return {std::numbers::pi * (outer * outer - inner * inner),
            std::numbers::pi / 4 * (outer * outer * outer * outer - inner * inner * inner * inner)};
  }
  const double broad = std::max(value(section.width), value(section.height));
  const double thin = std::min(value(section.width), value(section.height));
  const double broad_hole = wall > 0 ? broad - 2 * wall : 0;
  const double thin_hole = wall > 0 ? thin - 2 * wall : 0;
  return {broad * thin - broad_hole * thin_hole,
          (broad * thin * thin * thin - broad_hole * thin_hole * thin_hole * thin_hole) / 12};
}

/// Sets the forces at which a bar of this length [m] yields and buckles: A s, and Euler's pi^2 E I / (K L)^2.
void set_limits(const SceneSection& section, const SceneMaterial& look, double length, Member& member) {
  const SectionMoments moments = moments_of(section);
  member.yield_force = moments.area * static_cast<double>(section.yield_stress.value_or(Real(0)));
  const Real young = section.young_modulus.value_or(look.young_modulus.value_or(Real(0)));
  const double free_length = static_cast<double>(section.length_factor) * length;
  if (!(free_length > 0)) return;
  member.buckling_force = std::numbers::pi * std::numbers::pi * static_cast<double>(young) * moments.second /
                          (free_length * free_length);
}

/// Evaluates a force along a member [N], tension positive, by its section.
void evaluate_section(const Member& member, MemberForce& force) {
  if (member.yield_force > 0) force.yielding = std::abs(force.force) / member.yield_force;
  if (member.buckling_force > 0) force.buckling = std::max(0.0, -force.force) / member.buckling_force;
  force.utilization = std::max({force.utilization, force.yielding, force.buckling});
}

/// Makes the member of a hook or rope.
Member member_of(const Simulation& simulation, const SceneObject& object) {
  Member member;
  member.name = object.name;
  member.hook = object.hook;
  member.rope = object.rope;
  std::size_t row = 0;
  const SceneObjects& all = objects_of(simulation, object.path, row);
  if (object.kind == Kind::kRope) {
    member.kind = MemberKind::kRope;
    if (row < all.ropes.size() && all.ropes[row].desc.strength)
      member.strength = limit_of(*all.ropes[row].desc.strength);
    return member;
  }
  const auto [a, b] = simulation.world().hook_anchors(object.hook);
  const bool is_rod = object.hook_kind == HookKind::kDistance && length(b - a) > kOnePlace;
  member.kind = is_rod ? MemberKind::kRod : MemberKind::kJoint;
  // A stitch of a seam has the path of the seam, and no limit that the scene says in newtons.
  if (object.path.find("hooks[") != std::string::npos && row < all.hooks.size()) {
    member.strength = limit_of(all.hooks[row].desc.break_force);
    member.torque_strength = limit_of(all.hooks[row].desc.break_torque);
    if (is_rod && all.hooks[row].section)
      set_limits(*all.hooks[row].section, object.look, length(b - a), member);
  }
  return member;
}

/// A place at which a hook holds a body.
struct HeldPlace {
  DVec3 place;
  std::size_t hook;
  bool on_b;
};

/// Returns the bar that a body is, if it is held at exactly two places, and its length [m].
bool make_bar(const std::vector<HeldPlace>& held, Member& bar, double& bar_length) {
  DVec3 places[2];
  std::size_t count = 0;
  for (const HeldPlace& one : held) {
    std::size_t end = 0;
    while (end < count && length(one.place - places[end]) > kOnePlace) ++end;
    if (end == 2) return false;
    if (end == count) places[count++] = one.place;
    bar.ends[end].hooks.push_back(one.hook);
    bar.ends[end].on_b.push_back(one.on_b);
  }
  if (count == 2) bar_length = length(places[1] - places[0]);
  return count == 2;
}

double weaker(double a, double b) {
  return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b);
}

double utilization_of(const Member& member, double force, double torque) {
  const double by_force = member.strength > 0 ? force / member.strength : 0;
  const double by_torque = member.torque_strength > 0 ? torque / member.torque_strength : 0;
  return std::max(by_force, by_torque);
}

MemberForce force_of_hook(const World& world, const Member& member, bool broken) {
  MemberForce result = {.broken = broken};
  if (broken) return result;
  const HookForce on_b = world.hook_force(member.hook);
  const auto size = static_cast<double>(length(on_b.force));
  result.force = size;
  result.moment = static_cast<double>(length(on_b.torque));
  result.utilization = utilization_of(member, size, result.moment);
  const auto [a, b] = world.hook_anchors(member.hook);
  if (member.kind == MemberKind::kRod && length(b - a) > 0) {
    result.force = -dot(vector_cast<double>(on_b.force), normalize(b - a));
    result.moment = 0;
    evaluate_section(member, result);
  }
  return result;
}

MemberForce force_of_rope(const World& world, const Member& member) {
  MemberForce result;
  for (const Real tension : world.tensions(member.rope))
    result.force = std::max(result.force, static_cast<double>(tension));
  result.utilization = utilization_of(member, result.force, 0);
  result.broken = !world.broken_segments(member.rope).empty();
  return result;
}

MemberForce force_of_bar(const World& world, const std::vector<Member>& members,
                         const std::vector<MemberForce>& forces, const Member& bar) {
  DVec3 pull[2];
  DVec3 places[2];
  MemberForce result;
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t i = 0; i < bar.ends[end].hooks.size(); ++i) {
      const std::size_t hook = bar.ends[end].hooks[i];
      const bool on_b = bar.ends[end].on_b[i];
      const HookForce force = world.hook_force(members[hook].hook);
      pull[end] += (on_b ? 1.0 : -1.0) * vector_cast<double>(force.force);
      places[end] = world.hook_anchors(members[hook].hook)[on_b ? 1 : 0];
      result.moment = std::max(result.moment, forces[hook].moment);
      result.utilization = std::max(result.utilization, forces[hook].utilization);
      result.broken = result.broken || forces[hook].broken;
    }
  }
  const DVec3 way = places[1] - places[0];
  if (result.broken || !(length(way) > 0)) return result;
  const DVec3 along = normalize(way);
  result.force = 0.5 * (dot(pull[1], along) - dot(pull[0], along));
  for (const DVec3 force : pull)
    result.shear = std::max(result.shear, length(force - dot(force, along) * along));
  evaluate_section(bar, result);
  return result;
}

}  // namespace

std::vector<Member> find_members(const Simulation& simulation) {
  const World& world = simulation.world();
  std::vector<Member> members;
  std::map<std::string, std::vector<HeldPlace>> held;
  for (const SceneObject& object : simulation.objects()) {
    if (object.kind == Kind::kRope) members.push_back(member_of(simulation, object));
    if (object.kind != Kind::kHook || object.broken) continue;
    const auto anchors = world.hook_anchors(object.hook);
    for (std::size_t side = 0; side < 2; ++side)
      held[object.hooked[side]].push_back({anchors[side], members.size(), side == 1});
    members.push_back(member_of(simulation, object));
  }
  for (const SceneObject& object : simulation.objects()) {
    if (object.kind != Kind::kBody || !(world.mass(object.body) > Real(0))) continue;
    Member bar;
    bar.name = object.name;
    bar.kind = MemberKind::kBar;
    double bar_length = 0;
    if (!make_bar(held[object.name], bar, bar_length)) continue;
    std::size_t row = 0;
    const SceneObjects& all = objects_of(simulation, object.path, row);
    if (row < all.bodies.size() && all.bodies[row].section)
      set_limits(*all.bodies[row].section, object.look, bar_length, bar);
    for (const BarEnd& end : bar.ends) {
      for (const std::size_t hook : end.hooks) {
        bar.strength = weaker(bar.strength, members[hook].strength);
        bar.torque_strength = weaker(bar.torque_strength, members[hook].torque_strength);
        members[hook].is_end = members[hook].is_end || members[hook].kind == MemberKind::kJoint;
      }
    }
    members.push_back(std::move(bar));
  }
  return members;
}

std::vector<MemberForce> member_forces(const Simulation& simulation, const std::vector<Member>& members) {
  const World& world = simulation.world();
  std::set<std::string> broken;
  for (const SceneObject& object : simulation.objects()) {
    if (object.broken) broken.insert(object.name);
  }
  std::vector<MemberForce> forces(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& member = members[i];
    if (member.kind == MemberKind::kRope) {
      forces[i] = force_of_rope(world, member);
    } else {
      // A bar comes after its joints.
      forces[i] = member.kind == MemberKind::kBar
                      ? force_of_bar(world, members, forces, member)
                      : force_of_hook(world, member, broken.contains(member.name));
    }
  }
  return forces;
}

const char* word_of(MemberKind kind) {
  static constexpr const char* kWords[] = {"bar", "rod", "rope", "joint"};
  return kWords[static_cast<std::size_t>(kind)];
}

}  // namespace hooke::app
