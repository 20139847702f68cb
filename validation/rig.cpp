#include "validation/rig.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace hooke::check {

namespace {

PlacedWorld make_world(const CheckSetting& setting, WorldDesc desc) {
  desc.gravity = real(setting.gravity_scale) * desc.gravity;
  desc.substeps = setting.substeps;
  const bool turned = setting.turned != 0 && !setting.laboratory();
  const Placement at = turned ? random_placement(setting.turned, desc.gravity) : Placement{};
  return {must(World::create(placed(desc, at))), at};
}

}  // namespace

CheckSetting finer(CheckSetting setting) {
  if (setting.laboratory()) {
    setting.dt /= 2;
  } else {
    setting.substeps *= 2;
  }
  return setting;
}

Rig::Rig(const CheckSetting& setting, const WorldDesc& desc)
    : world_(make_world(setting, desc)), setting_(setting) {}

BodyId Rig::add(BodyDesc desc) {
  // A contact uses the geometric mean of two coefficients: the square of the scale in one of them.
  if (desc.kind != BodyKind::kDynamic) {
    desc.contact.friction *= real(setting_.friction_scale * setting_.friction_scale);
  }
  return must(world_.add_body(desc));
}

bool Rig::step() {
  if (setting_.laboratory()) {
    if (!run_)
      run_ = must(lab::Run::create(world_.in_its_frame(), {.stepper = setting_.stepper, .dt = setting_.dt}));
    must(run_->advance());
    return true;
  }
  healthy_ = world_.in_its_frame().step(real(setting_.dt)).healthy() && healthy_;
  return healthy_;
}

DVec3 Rig::center(BodyId id) const {
  return run_ ? must(run_->body(id)).center : world_.center_of_mass(id);
}

DVec3 Rig::velocity(BodyId id) const {
  return run_ ? must(run_->body(id)).velocity : world_.velocity(id);
}

DVec3 Rig::spin(BodyId id) const {
  return run_ ? must(run_->body(id)).angular_velocity : world_.angular_velocity(id);
}

DVec3 Rig::own_spin(BodyId id) const {
  if (run_) return rotate(conjugate(must(run_->body(id)).rotation), spin(id));
  const World& world = world_.in_its_frame();
  return vector_cast<double>(rotate(conjugate(world.pose(id).rotation), world.angular_velocity(id)));
}

DVec3 Rig::direction(BodyId id, DVec3 own) const {
  if (run_) return rotate(must(run_->body(id)).rotation, own);
  return world_.direction(id, own);
}

std::uint64_t Rig::state_hash() const {
  if (!run_) return world_.in_its_frame().state_hash();
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a, over whole numbers
  for (const auto& points : {run_->positions(), run_->velocities()}) {
    for (const DVec3 p : points) {
      for (const double coordinate : {p.x, p.y, p.z}) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate)) * 1099511628211U;
      }
    }
  }
  return hash;
}

bool Rig::run(double seconds, const std::function<void()>& after_each) {
  const auto frames = static_cast<long>(std::lround(seconds / setting_.dt));
  for (long i = 0; i < frames; ++i) {
    step();
    if (after_each) after_each();
  }
  return healthy_;
}

WorldDesc weightless() {
  WorldDesc desc;
  desc.gravity = {};
  return desc;
}

WorldDesc sleepless() {
  WorldDesc desc;
  desc.sleeping = false;
  return desc;
}

WorldDesc without_air() {
  WorldDesc desc = sleepless();
  desc.wind.air_density = real(0);
  return desc;
}

BodyDesc moving(const Shape& shape, DVec3 position) {
  return {.kind = BodyKind::kDynamic, .shape = shape, .position = position};
}

BodyDesc level_ground(double friction, double restitution) {
  return {.shape = Shape::half_space(),
          .contact = {.friction = real(friction), .restitution = real(restitution)}};
}

Shape box_of(DVec3 half_extents) {
  return Shape::box(real(half_extents));
}

CheckRow relative_row(std::string title, std::string unit, double expected, double achieved,
                      double tolerance) {
  return {.title = std::move(title),
          .unit = std::move(unit),
          .expected = expected,
          .achieved = achieved,
          .tolerance = tolerance,
          .solver = "bodies"};
}

CheckRow absolute_row(std::string title, std::string unit, double expected, double achieved,
                      double tolerance) {
  CheckRow row = relative_row(std::move(title), std::move(unit), expected, achieved, tolerance);
  row.measure = CheckRow::Measure::kAbsolute;
  return row;
}

CheckRow known_miss(CheckRow row, std::string reason) {
  row.known_miss = std::move(reason);
  return row;
}

CheckRow known_miss_turned(const CheckSetting& setting, CheckRow row, std::string reason) {
  return setting.turned != 0 ? known_miss(std::move(row), std::move(reason)) : row;
}

double Curve::cubic(std::size_t left, double time) const {
  const std::size_t count = samples_.size();
  const std::size_t first = left == 0 ? 0 : std::min(left - 1, count < 4 ? 0 : count - 4);
  const std::size_t last = std::min(first + 4, count);
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) {
    double weight = 1;
    for (std::size_t j = first; j < last; ++j) {
      if (j != i) weight *= (time - samples_[j].time) / (samples_[i].time - samples_[j].time);
    }
    sum += weight * samples_[i].value;
  }
  return sum;
}

std::vector<double> Curve::zero_crossings() const {
  std::vector<double> times;
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
    const bool up = samples_[i].value < 0 && samples_[i + 1].value >= 0;
    const bool down = samples_[i].value > 0 && samples_[i + 1].value <= 0;
    if (!up && !down) continue;
    double low = samples_[i].time;
    double high = samples_[i + 1].time;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      const bool before = up ? cubic(i, middle) < 0 : cubic(i, middle) > 0;
      (before ? low : high) = middle;
    }
    times.push_back(0.5 * (low + high));
  }
  return times;
}

double Curve::at(double time) const {
  const auto after = std::find_if(samples_.begin(), samples_.end(), [&](Sample s) { return s.time > time; });
  const auto left = std::distance(samples_.begin(), after);
  return cubic(static_cast<std::size_t>(std::max<std::ptrdiff_t>(left, 1) - 1), time);
}

std::vector<double> Curve::peaks() const {
  std::vector<double> found;
  for (std::size_t i = 1; i + 1 < samples_.size(); ++i) {
    const double a = std::abs(samples_[i - 1].value);
    const double b = std::abs(samples_[i].value);
    const double c = std::abs(samples_[i + 1].value);
    if (!(b > a) || !(b >= c)) continue;
    const double bend = a - 2 * b + c;
    found.push_back(b - (a - c) * (a - c) / (8 * bend));
  }
  return found;
}

double Curve::period() const {
  const std::vector<double> times = zero_crossings();
  if (times.size() < 3) return std::numeric_limits<double>::quiet_NaN();
  return 2 * (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

Curve record(Rig& rig, double seconds, const std::function<double()>& value) {
  Curve curve;
  curve.add(rig.time(), value());
  rig.run(seconds, [&] { curve.add(rig.time(), value()); });
  return curve;
}

double bisect(double holds, double fails, int halvings, const std::function<bool(double)>& stands) {
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (holds + fails);
    (stands(middle) ? holds : fails) = middle;
  }
  return 0.5 * (holds + fails);
}

}  // namespace hooke::check
