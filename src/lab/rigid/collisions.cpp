#include "lab/rigid/collisions.h"

#include <algorithm>
#include <utility>

namespace hooke::lab {

Result<Collisions> Collisions::create(const state::Tables& tables, const Options& options) {
  Collisions collisions;
  collisions.setting_ = {options.collisions, tables.desc.materials, options.dt};
  const bool is_off = options.collisions.collider == CollisionOptions::Collider::kNone;
  if (!options.contacts || is_off) return collisions;
  const auto collides = [](const state::BodyTraits& t) { return t.alive && t.collides && !t.sensor; };
  const auto& traits = tables.bodies.traits;
  if (tables.moving_bodies.empty() || std::count_if(traits.begin(), traits.end(), collides) < 2)
    return collisions;
  Result<std::vector<RigidBody>> bodies = rigid_bodies(tables);
  if (!bodies) return bodies.error();
  collisions.bodies_ = std::move(bodies).value();
  collisions.collides_.resize(tables.moving_bodies.size());
  for (std::uint32_t i = 0; i < collisions.bodies_.size(); ++i) {
    collisions.setting_.volumes.push_back(
        make_body_volumes(collisions.bodies_[i], options.collisions.preselection));
    const int part = collisions.bodies_[i].part;
    (part < 0 ? collisions.still_ : collisions.movers_).push_back(i);
    if (part >= 0) collisions.collides_[static_cast<std::size_t>(part)] = 1;
  }
  return collisions;
}

Result<void> Collisions::advance(double t, double dt, std::vector<Part>& parts) {
  if (movers_.empty()) return {};
  const std::vector<Part> before = parts;
  std::vector<Outcome> regions;
  const bool all = setting_.options.preselection == Preselection::kAllPairs;
  if (setting_.options.regional && !all) {
    for (const std::uint32_t body : movers_) regions.push_back({.members = {body}});
  } else {
    regions.push_back({.members = movers_});
  }
  do {
    for (Outcome& region : regions) {
      if (region.done) continue;
      for (const std::uint32_t body : region.members) {
        const auto part = static_cast<std::size_t>(bodies_[body].part);
        parts[part] = before[part];
        if (region.members.size() > 1) parts[part].work.reset();
      }
      if (const auto moved = run(region, t, dt, parts); !moved) return moved.error();
    }
  } while (join_crossing(regions));
  for (const Outcome& region : regions) add(region.report);
  for (const std::uint32_t body : movers_) ++parts[static_cast<std::size_t>(bodies_[body].part)].outputs;
  return {};
}

Result<void> Collisions::run(Outcome& outcome, double t, double dt, std::vector<Part>& parts) const {
  outcome.report = {};
  Region region(setting_, bodies_, outcome.members, still_, parts, outcome.report);
  if (const auto moved = region.advance(t, dt); !moved) return moved.error();
  outcome.swept = region.swept();
  outcome.done = true;
  return {};
}

bool Collisions::may_collide(const Outcome& a, const Outcome& b) const {
  for (std::size_t i = 0; i < a.members.size(); ++i) {
    for (std::size_t j = 0; j < b.members.size(); ++j) {
      const RigidBody& of_a = bodies_[a.members[i]];
      const RigidBody& of_b = bodies_[b.members[j]];
      if (!of_a.is_free && !of_b.is_free) continue;
      if (!state::filters_agree(of_a.filter, of_b.filter)) continue;
      const double near = setting_.options.epsilon;
      Box grown = a.swept[i];
      grown.lower = grown.lower - DVec3{near, near, near};
      grown.upper = grown.upper + DVec3{near, near, near};
      if (overlap(grown, b.swept[j])) return true;
    }
  }
  return false;
}

/// Joins regions whose swept boxes overlap. \return Whether any were joined; those must run again.
bool Collisions::join_crossing(std::vector<Outcome>& regions) const {
  bool joined = false;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (std::size_t j = i + 1; j < regions.size();) {
      if (!may_collide(regions[i], regions[j])) {
        ++j;
        continue;
      }
      Outcome& into = regions[i];
      into.members.insert(into.members.end(), regions[j].members.begin(), regions[j].members.end());
      into.swept.insert(into.swept.end(), regions[j].swept.begin(), regions[j].swept.end());
      into.done = false;
      regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(j));
      joined = true;
      j = i + 1;  // The joined region may overlap earlier ones.
    }
    if (!regions[i].done) std::sort(regions[i].members.begin(), regions[i].members.end());
  }
  return joined;
}

void Collisions::add(const CollisionReport& report) {
  report_.rollbacks += report.rollbacks;
  report_.resimulated_seconds += report.resimulated_seconds;
  report_.hits += report.hits;
  report_.limit_reached += report.limit_reached;
  report_.zeno += report.zeno;
  report_.candidates += report.candidates;
  report_.touching += report.touching;
  report_.deepest = std::max(report_.deepest, report.deepest);
  report_.last_hit = std::max(report_.last_hit, report.last_hit);
  report_.backward_error = std::max(report_.backward_error, report.backward_error);
}

}  // namespace hooke::lab
