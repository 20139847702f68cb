#include "io/scene/scene_data.h"
#include "io/scene/scene_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

namespace hooke::io {

namespace {

using Quantity = SceneExpectation::Quantity;
using Op = SceneExpectation::Op;

constexpr double kDegreesPerRadian = 57.29577951308232;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double coordinate(DVec3 position, Quantity quantity) {
  if (quantity == Quantity::kX) return position.x;
  return quantity == Quantity::kZ ? position.z : position.y;
}

double body_figure(const SimulationData& data, BodyId body, Quantity quantity) {
  const World& world = data.world;
  const Pose pose = world.pose(body);
  switch (quantity) {
    case Quantity::kSpeed:
      return length(vector_cast<double>(world.velocity(body)));
    case Quantity::kAngularSpeed:
      return length(vector_cast<double>(world.angular_velocity(body)));
    case Quantity::kTilt: {
      const DVec3 up = data.placement.own_direction(
          vector_cast<double>(rotate(pose.rotation, Vec3{Real(0), Real(1), Real(0)})));
      return std::atan2(std::hypot(up.x, up.z), up.y) * kDegreesPerRadian;
    }
    default:
      return coordinate(data.placement.own_point(pose.position), quantity);
  }
}

double point_figure(const SimulationData& data, const SceneObject& object, const SceneExpectation& wanted) {
  if (object.kind == SceneObject::Kind::kBody) return body_figure(data, object.body, wanted.quantity);
  const bool speed = wanted.quantity == Quantity::kSpeed;
  const PointView view = speed ? velocities_of(data.world, object) : positions_of(data.world, object);
  if (view.empty() || !wanted.point.has_value()) return kNothing;
  const std::size_t index = wanted.point->last ? view.size() - 1 : wanted.point->index;
  if (index >= view.size()) return kNothing;
  if (!speed) return coordinate(data.placement.own_point(view[index]), wanted.quantity);
  return length(vector_cast<double>(view.offset(index)));
}

/// Returns the figure of the segment that is asked for. For the whole rope it is the largest tension or
/// torque, or the sum of twists.
double segment_figure(const World& world, RopeId rope, const SceneExpectation& wanted) {
  const std::vector<Real> figures = wanted.quantity == Quantity::kTension ? world.tensions(rope)
                                    : wanted.quantity == Quantity::kTwist ? world.twists(rope)
                                                                          : world.torques(rope);
  if (figures.empty()) return kNothing;
  if (wanted.point.has_value()) {
    const std::size_t index = wanted.point->last ? figures.size() - 1 : wanted.point->index;
    return index < figures.size() ? static_cast<double>(figures[index]) : kNothing;
  }
  if (wanted.quantity == Quantity::kTwist) return std::accumulate(figures.begin(), figures.end(), 0.0);
  const bool signs_count = wanted.quantity == Quantity::kTension;
  const auto less = [&](Real a, Real b) { return signs_count ? a < b : std::abs(a) < std::abs(b); };
  return static_cast<double>(*std::max_element(figures.begin(), figures.end(), less));
}

double extension_of(const World& world, const SceneObject& object) {
  const PointView view = world.positions(object.rope);
  if (view.empty()) return kNothing;
  double sum = 0;
  for (std::size_t i = 1; i < view.size(); ++i) sum += length(view[i] - view[i - 1]);
  for (const std::uint32_t i : world.broken_segments(object.rope)) sum -= length(view[i + 1] - view[i]);
  return sum - object.rest_length;
}

double extreme_height(const SimulationData& data, const SceneObject& object, bool highest) {
  const PointView view = positions_of(data.world, object);
  double extreme = kNothing;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const double y = data.placement.own_point(view[i]).y;
    if (i == 0 || (highest ? y > extreme : y < extreme)) extreme = y;
  }
  return extreme;
}

/// How many segments of a rope have broken or were cut, how many points of a cloth or a solid have split, or
/// whether a hook broke.
double count_broken(const World& world, const SceneObject& object) {
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      return static_cast<double>(world.broken_segments(object.rope).size());
    case SceneObject::Kind::kCloth:
      return static_cast<double>(world.splits(object.cloth).size());
    case SceneObject::Kind::kSolid:
      return static_cast<double>(world.splits(object.solid).size());
    default:
      return object.broken ? 1 : 0;
  }
}

/// 1 for a body that is soft now, 0 for others.
double count_soft(const World& world, const SceneObject& object) {
  return world.soft_form(object.body) != SolidId{} ? 1 : 0;
}

double hook_figure(const World& world, const SceneObject& object, Quantity quantity) {
  switch (quantity) {
    case Quantity::kForce:
      return length(vector_cast<double>(world.hook_force(object.hook).force));
    case Quantity::kTorque:
      return length(vector_cast<double>(world.hook_force(object.hook).torque));
    case Quantity::kGap:
      return static_cast<double>(world.hook_gap(object.hook));
    case Quantity::kBroken:
      return count_broken(world, object);
    default:
      return static_cast<double>(world.hook_value(object.hook));
  }
}

double object_figure(const SimulationData& data, const SceneObject& object, const SceneExpectation& wanted) {
  const World& world = data.world;
  if (object.kind == SceneObject::Kind::kHook) return hook_figure(world, object, wanted.quantity);
  switch (wanted.quantity) {
    case Quantity::kLowest:
    case Quantity::kHighest:
      return extreme_height(data, object, wanted.quantity == Quantity::kHighest);
    case Quantity::kExtension:
      return extension_of(world, object);
    case Quantity::kBroken:
      return count_broken(world, object);
    case Quantity::kYielded:
      return object.yielded;
    case Quantity::kSoft:
      return count_soft(world, object);
    case Quantity::kTension:
    case Quantity::kTwist:
    case Quantity::kTorque:
      return segment_figure(world, object.rope, wanted);
    default:
      return point_figure(data, object, wanted);
  }
}

template <class Figure>
double sum_of(const SimulationData& data, const Figure& figure) {
  double sum = 0;
  for (const SceneObject& object : data.objects) sum += figure(object);
  return sum;
}

double world_figure(const SimulationData& data, Quantity quantity) {
  const Measurement measured = data.world.measure();
  switch (quantity) {
    case Quantity::kLargestStretch:
      return measured.largest_stretch;
    case Quantity::kMeanStretch:
      return measured.mean_stretch;
    case Quantity::kTotalEnergy:
      return measured.energy.total();
    case Quantity::kKineticEnergy:
      return measured.energy.kinetic;
    case Quantity::kPotentialEnergy:
      return measured.energy.potential;
    case Quantity::kElasticEnergy:
      return measured.energy.elastic;
    case Quantity::kMomentum:
      return length(measured.momentum);
    case Quantity::kPenetration:
      return measured.largest_penetration;
    case Quantity::kContacts:
      return static_cast<double>(data.contacts);
    case Quantity::kAsleep:
      return static_cast<double>(
          std::count_if(data.objects.begin(), data.objects.end(), [&](const SceneObject& object) {
            return object.kind == SceneObject::Kind::kBody && data.world.asleep(object.body);
          }));
    case Quantity::kGap:
      return measured.largest_gap;
    case Quantity::kBroken:
      return sum_of(data, [&](const SceneObject& object) { return count_broken(data.world, object); });
    case Quantity::kYielded:
      return sum_of(data, [](const SceneObject& object) { return object.yielded; });
    case Quantity::kSoft:
      return sum_of(data, [&](const SceneObject& object) { return count_soft(data.world, object); });
    default:
      return kNothing;
  }
}

bool holds(const SceneExpectation& wanted, double achieved) {
  const double distance = std::abs(achieved - wanted.value);
  switch (wanted.op) {
    case Op::kLess:
      return achieved < wanted.value;
    case Op::kLessOrEqual:
      return achieved <= wanted.value;
    case Op::kGreater:
      return achieved > wanted.value;
    case Op::kGreaterOrEqual:
      return achieved >= wanted.value;
    case Op::kEqual:
      return distance <= wanted.tolerance;
    case Op::kWithin:
      return distance <= wanted.tolerance * std::abs(wanted.value);
  }
  return false;
}

std::string short_digits(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value, std::chars_format::general, 6);
  return {text, end.ptr};
}

/// Returns the word of the scene file, with spaces.
template <class E>
std::string word_of(E value) {
  std::string word = Codec<E>::write(value).text;
  std::replace(word.begin(), word.end(), '_', ' ');
  return word;
}

std::string sentence(const SceneExpectation& wanted, double achieved) {
  std::string text = word_of(wanted.quantity);
  if (!wanted.of.empty()) text += " of " + in_quotes(wanted.of);
  if (wanted.point.has_value()) {
    const bool segment = wanted.quantity == Quantity::kTension || wanted.quantity == Quantity::kTwist ||
                         wanted.quantity == Quantity::kTorque;
    text += segment ? " segment " : " point ";
    text += wanted.point->last ? "last" : std::to_string(wanted.point->index);
  }
  text += " = " + short_digits(achieved) + ", expected ";
  if (wanted.op == Op::kWithin) {
    return text + short_digits(wanted.value) + " within " + short_digits(100 * wanted.tolerance) + " %";
  }
  if (wanted.op == Op::kEqual)
    return text + short_digits(wanted.value) + " +- " + short_digits(wanted.tolerance);
  return text + word_of(wanted.op) + " " + short_digits(wanted.value);
}

}  // namespace

SceneVerdict measure_expectation(const SimulationData& data, std::size_t index) {
  const SceneExpectation& wanted = data.scene.expect[index];
  SceneVerdict verdict = {.index = index, .achieved = kNothing, .step = data.world.step_count()};
  if (wanted.of.empty()) {
    verdict.achieved = world_figure(data, wanted.quantity);
  } else if (const auto found = data.row_of.find(wanted.of); found != data.row_of.end()) {
    verdict.achieved = object_figure(data, data.objects[found->second], wanted);
  }
  verdict.passed = holds(wanted, verdict.achieved);
  verdict.text = sentence(wanted, verdict.achieved);
  return verdict;
}

std::uint32_t due_step(const Scene& scene, const SceneExpectation& expectation) {
  return expectation.at_step.value_or(scene.step_count());
}

}  // namespace hooke::io

namespace hooke {

PointView positions_of(const World& world, const SceneObject& object) {
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      return world.positions(object.rope);
    case SceneObject::Kind::kCloth:
      return world.positions(object.cloth);
    case SceneObject::Kind::kSolid:
      return world.positions(object.solid);
    case SceneObject::Kind::kParticles:
      return world.positions(object.particles);
    default:
      return {};
  }
}

PointView velocities_of(const World& world, const SceneObject& object) {
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      return world.velocities(object.rope);
    case SceneObject::Kind::kCloth:
      return world.velocities(object.cloth);
    case SceneObject::Kind::kSolid:
      return world.velocities(object.solid);
    case SceneObject::Kind::kParticles:
      return world.velocities(object.particles);
    default:
      return {};
  }
}

PointRef point_of(const SceneObject& object, std::size_t index) {
  const auto made = [&](PointRef::Kind kind, const auto& id) -> PointRef {
    return {kind, id.slot, id.generation, static_cast<std::uint32_t>(index), id.world};
  };
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      return made(PointRef::Kind::kRope, object.rope);
    case SceneObject::Kind::kCloth:
      return made(PointRef::Kind::kCloth, object.cloth);
    case SceneObject::Kind::kSolid:
      return made(PointRef::Kind::kSolid, object.solid);
    case SceneObject::Kind::kParticles:
      return made(PointRef::Kind::kParticles, object.particles);
    default:
      return {};
  }
}

bool has_point(const SceneObject& object, PointRef point) {
  return point.kind != PointRef::Kind::kNone && point_of(object, point.index) == point;
}

}  // namespace hooke
