#include "hooke/load/movers.h"

#include "hooke/shape_radius.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace hooke::app {

namespace {

using Kind = SceneObject::Kind;
using SlotKey = std::pair<PointRef::Kind, std::uint32_t>;

/// Asks a force law for the masses of all points: nothing else tells them one by one.
std::map<SlotKey, std::vector<double>> masses_of_points(Simulation& simulation) {
  std::map<SlotKey, std::vector<double>> masses;
  const SimulationSnapshot start = simulation.snapshot();
  const auto law = simulation.world().add_force_law(ForceLaw([&](ForceView& view) {
    std::vector<double>& list = masses[{view.kind(), view.slot()}];
    list.resize(view.size());
    for (std::size_t i = 0; i < view.size(); ++i) list[i] = static_cast<double>(view.mass(i));
  }));
  if (law) simulation.world().step(Real(1e-6));
  (void)simulation.restore(start);  // It is not empty.
  return masses;
}

std::size_t point_count(const World& world, const Mover& mover) {
  return mover.body ? 1 : positions_of(world, mover.object).size();
}

/// Radius of a ball about the origin of a body that holds it [m]; meshes count as points.
double body_radius(const SceneObject& object) {
  double radius = radius_of(object.shape, 0);
  for (const SceneObject::Part& part : object.parts) {
    radius = std::max(radius, static_cast<double>(length(part.position)) + radius_of(part.shape, 0));
  }
  return radius;
}

/// Names of everything that hooks join to what holds still or is held.
std::set<std::string> joined_names(const Simulation& simulation, const std::vector<Mover>& movers,
                                   const std::vector<std::string>& held) {
  std::set<std::string> moving;
  std::set<std::string> joined(held.begin(), held.end());
  joined.insert("");  // the world
  for (const Mover& mover : movers) {
    moving.insert(mover.name);
    const bool pinned = std::find(mover.masses.begin(), mover.masses.end(), 0.0) != mover.masses.end();
    if (pinned) joined.insert(mover.name);
  }
  for (bool grew = true; grew;) {
    grew = false;
    for (const SceneObject& hook : simulation.objects()) {
      if (hook.kind != Kind::kHook || hook.broken) continue;
      const auto holds = [&](const std::string& name) {
        return joined.contains(name) || !moving.contains(name);
      };
      const auto& [a, b] = hook.hooked;
      if (holds(a) && !holds(b)) grew = joined.insert(b).second || grew;
      if (holds(b) && !holds(a)) grew = joined.insert(a).second || grew;
    }
  }
  return joined;
}

}  // namespace

DVec3 place_of(const World& world, const Mover& mover, std::size_t index) {
  return mover.body ? world.center_of_mass(mover.body) : positions_of(world, mover.object)[index];
}

Movers::Movers(Simulation& simulation) {
  const auto masses = masses_of_points(simulation);
  const World& world = simulation.world();
  for (const SceneObject& object : simulation.objects()) {
    Mover mover = {.name = object.name, .body = object.body, .object = object, .masses = {}};
    if (object.kind == Kind::kBody) {
      const auto mass = static_cast<double>(world.mass(object.body));
      if (!(mass > 0)) continue;
      mover.masses = {mass};
    } else {
      const PointRef first = point_of(object, 0);
      const auto found = masses.find({first.kind, first.slot});
      if (first.kind == PointRef::Kind::kNone || found == masses.end()) continue;
      mover.masses = found->second;
    }
    movers_.push_back(std::move(mover));
  }
  mark(world);
}

LeftOut Movers::left_out() const {
  LeftOut left_out;
  for (const Mover& mover : movers_) {
    if (!mover.loose) continue;
    if (mover.body) {
      left_out.bodies.push_back(mover.body);
    } else {
      left_out.objects.push_back(point_of(mover.object, 0));
    }
  }
  return left_out;
}

Unrest Movers::unrest(const World& world, double dt) const {
  return world.unrest(dt, left_out());
}

void Movers::stop(World& world) const {
  (void)world.stop(left_out());  // No step runs.
}

void Movers::mark(const World& world) {
  for (Mover& mover : movers_) {
    mover.places.resize(point_count(world, mover));
    for (std::size_t i = 0; i < mover.places.size(); ++i) mover.places[i] = place_of(world, mover, i);
  }
}

std::vector<Move> Movers::moves(const World& world) const {
  std::vector<Move> moves;
  for (const Mover& mover : movers_) {
    if (mover.loose) continue;
    Move move = {.name = mover.name};
    for (std::size_t i = 0; i < mover.places.size(); ++i) {
      const DVec3 way = place_of(world, mover, i) - mover.places[i];
      if (length(way) > length(move.way)) move.way = way;
    }
    moves.push_back(std::move(move));
  }
  std::stable_sort(moves.begin(), moves.end(),
                   [](const Move& a, const Move& b) { return length(a.way) > length(b.way); });
  return moves;
}

std::vector<std::string> Movers::find_loose(const Simulation& simulation,
                                            const std::vector<std::string>& held, double way) {
  const World& world = simulation.world();
  const std::set<std::string> joined = joined_names(simulation, movers_, held);
  std::vector<std::string> names;
  for (Mover& mover : movers_) {
    if (mover.loose || joined.contains(mover.name)) continue;
    const bool is_far = !mover.places.empty() && length(place_of(world, mover, 0) - mover.places[0]) > way;
    if (!is_far || (mover.body && !world.body_contacts(mover.body).empty())) continue;
    mover.loose = true;
    names.push_back(mover.name);
  }
  return names;
}

double Movers::mass() const {
  double mass = 0;
  for (const Mover& mover : movers_) {
    for (const double part : mover.masses) mass += part;
  }
  return mass;
}

double Movers::extent(const Simulation& simulation) const {
  const World& world = simulation.world();
  DVec3 lower = {1e300, 1e300, 1e300};
  DVec3 upper = {-1e300, -1e300, -1e300};
  const auto include = [&](DVec3 place, double radius) {
    lower = {std::min(lower.x, place.x - radius), std::min(lower.y, place.y - radius),
             std::min(lower.z, place.z - radius)};
    upper = {std::max(upper.x, place.x + radius), std::max(upper.y, place.y + radius),
             std::max(upper.z, place.z + radius)};
  };
  for (const Mover& mover : movers_) {
    const double radius = mover.body ? body_radius(mover.object) : 0;
    for (std::size_t i = 0; i < point_count(world, mover); ++i) include(place_of(world, mover, i), radius);
  }
  for (const SceneObject& hook : simulation.objects()) {
    if (hook.kind != Kind::kHook || hook.broken) continue;
    for (const DVec3 anchor : world.hook_anchors(hook.hook)) include(anchor, 0);
  }
  const DVec3 size = upper - lower;
  return std::max({size.x, size.y, size.z, 0.0});
}

std::vector<bool> Movers::loose() const {
  std::vector<bool> loose;
  for (const Mover& mover : movers_) loose.push_back(mover.loose);
  return loose;
}

void Movers::set_loose(const std::vector<bool>& loose) {
  for (std::size_t i = 0; i < movers_.size(); ++i) movers_[i].loose = loose[i];
}

}  // namespace hooke::app
