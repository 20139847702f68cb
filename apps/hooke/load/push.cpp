#include "hooke/load/push.h"

#include "hooke/text_of.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace hooke::app {

namespace {

Error push_error(const std::string& where, const std::string& message) {
  return {ErrorCode::kOutOfRange, where, message};
}

/// A word of --on, such as "rope:15", split at its last colon if a number or `last` follows.
struct PushWord {
  std::string name = {};
  bool last = false;
  std::optional<std::uint32_t> index = {};
};

PushWord split_word(const std::string& word) {
  const std::size_t colon = word.rfind(':');
  if (colon == std::string::npos) return {.name = word};
  const std::string tail = word.substr(colon + 1);
  if (tail == "last") return {.name = word.substr(0, colon), .last = true};
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(tail.data(), tail.data() + tail.size(), index);
  if (error != std::errc() || end != tail.data() + tail.size()) return {.name = word};
  return {.name = word.substr(0, colon), .index = index};
}

const Mover* mover_of(const Movers& movers, const std::string& name) {
  for (const Mover& mover : movers.all()) {
    if (mover.name == name) return &mover;
  }
  return nullptr;
}

/// Says why an object cannot be pushed, and which could.
Error no_mover(const Simulation& simulation, const Movers& movers, const std::string& name) {
  std::string could;
  for (std::size_t i = 0; i < movers.all().size() && i < 8; ++i)
    could += (i > 0 ? ", '" : "'") + movers.all()[i].name + "'";
  if (movers.all().size() > 8) could += ", ...";
  const char* what = simulation.find(name) == nullptr ? "there is no object of that name" : "it cannot move";
  return push_error("--on " + name,
                    what + std::string("; what can be loaded: ") + (could.empty() ? "nothing" : could));
}

Quaternion<double> in_double(Quat q) {
  return {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z),
          static_cast<double>(q.w)};
}

/// Returns the points of a mover that are not pinned.
std::vector<std::size_t> loadable_points(const Mover& mover) {
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < mover.masses.size(); ++i) {
    if (mover.masses[i] > 0) points.push_back(i);
  }
  return points;
}

std::size_t nearest_point(const World& world, const Mover& mover, DVec3 place) {
  std::size_t nearest = 0;
  double best = 1e300;
  for (const std::size_t i : loadable_points(mover)) {
    const double distance = length(place_of(world, mover, i) - place);
    if (!(distance < best)) continue;
    best = distance;
    nearest = i;
  }
  return nearest;
}

}  // namespace

Result<void> Push::add(const Simulation& simulation, const Movers& movers, const std::string& word,
                       const std::optional<DVec3>& at) {
  const World& world = simulation.world();
  const Mover* whole = mover_of(movers, word);
  const PushWord words = whole != nullptr ? PushWord{.name = word} : split_word(word);
  const Mover* mover = whole != nullptr ? whole : mover_of(movers, words.name);
  if (mover == nullptr) return no_mover(simulation, movers, words.name);
  const bool numbered = words.index || words.last;
  objects_.push_back(mover->object);
  const std::size_t object = objects_.size() - 1;
  if (mover->body) {
    if (numbered) return push_error("--on " + word, "a body has no points; --at says a place on it");
    const Pose pose = world.pose(mover->body);
    const DVec3 local = at ? rotate(conjugate(in_double(pose.rotation)), *at - pose.position) : DVec3{};
    targets_.push_back({mover->body, local, !at, object, {}, 1});
    return {};
  }
  std::vector<std::size_t> points;
  const std::size_t count = mover->masses.size();
  if (numbered) {
    points.push_back(words.last ? count - 1 : *words.index);
    if (points[0] >= count) return push_error("--on " + word, text_of("its points are 0 to %zu", count - 1));
  } else if (at) {
    points.push_back(nearest_point(world, *mover, *at));
  } else {
    points = loadable_points(*mover);
  }
  for (const std::size_t i : points) {
    if (!(mover->masses[i] > 0))
      return push_error("--on " + word, "the point is pinned; name one that moves");
    targets_.push_back(
        {{}, {}, false, object, point_of(mover->object, i), 1 / static_cast<double>(points.size())});
  }
  return {};
}

Result<Push> Push::create(const Simulation& simulation, const Movers& movers,
                          const std::vector<std::string>& names, const std::optional<DVec3>& at,
                          DVec3 direction) {
  Push push;
  if (!(length(direction) > 0)) {
    return push_error("--direction", "has no length; needed is a direction such as 0,-1,0");
  }
  if (at && names.size() > 1) return push_error("--at", "is a place on one object, but --on names several");
  push.direction_ = normalize(direction);
  for (const std::string& name : names) {
    if (auto added = push.add(simulation, movers, name, at); !added) return added.error();
  }
  for (Target& target : push.targets_) target.share /= static_cast<double>(names.size());
  return push;
}

std::vector<std::string> Push::names() const {
  std::vector<std::string> names;
  for (const SceneObject& object : objects_) names.push_back(object.name);
  return names;
}

Result<void> Push::apply(World& world, double force) const {
  for (const Target& target : targets_) {
    const Vec3 part = vector_cast<Real>(target.share * force * direction_);
    auto done = target.body ? world.apply_force(target.body, part, place_of(world, target))
                            : world.apply_force(target.point, part);
    if (!done) return done;
  }
  return {};
}

DVec3 Push::place_of(const World& world, const Target& target) const {
  if (!target.body) return positions_of(world, objects_[target.object])[target.point.index];
  if (target.at_center) return world.center_of_mass(target.body);
  const Pose pose = world.pose(target.body);
  return pose.position + rotate(in_double(pose.rotation), target.local);
}

std::vector<DVec3> Push::places(const World& world) const {
  std::vector<DVec3> places;
  for (const Target& target : targets_) places.push_back(place_of(world, target));
  return places;
}

DVec3 Push::place(const World& world) const {
  DVec3 mean;
  for (const Target& target : targets_) mean += target.share * place_of(world, target);
  return mean;
}

double Push::farthest(const World& world, const std::vector<DVec3>& before) const {
  double most = 0;
  for (std::size_t i = 0; i < targets_.size(); ++i)
    most = std::max(most, length(place_of(world, targets_[i]) - before[i]));
  return most;
}

}  // namespace hooke::app
