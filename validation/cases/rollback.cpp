/// Tests bodies in the laboratory: the times of their impacts, by rollback.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::check {

namespace {

using Search = lab::CollisionOptions::Search;

constexpr double kStep = 1.0 / 60;
const double kHeld = static_cast<double>(real(kGravity));  ///< Gravity in the precision of a World.

lab::Run run_of(Rig& rig, Search search, double epsilon) {
  return must(
      lab::Run::create(rig.world().in_its_frame(),
                       {.stepper = "rk4",
                        .dt = kStep,
                        .collisions = {.search = search, .epsilon = epsilon, .iteration_limit = 200}}));
}

BodyDesc elastic(const Shape& shape, DVec3 position, DVec3 velocity = {}) {
  BodyDesc desc = moving(shape, position);
  desc.velocity = real(velocity);
  desc.contact = {.friction = real(0), .restitution = real(1)};
  return desc;
}

/// Returns when the first impact was.
double first_hit(Rig& rig, Search search) {
  lab::Run run = run_of(rig, search, 1e-11);
  while (run.collisions().hits == 0 && run.time() < 5) must(run.advance());
  return run.collisions().last_hit;
}

double time_of_fall(const CheckSetting& setting, Search search) {
  Rig rig(setting);
  rig.add(level_ground(0));
  rig.add(elastic(Shape::sphere(real(0.25)), {0, 1.25, 0}));
  return first_hit(rig, search);
}

double time_of_balls(const CheckSetting& setting, Search search) {
  Rig rig(setting, weightless());
  rig.add(elastic(Shape::sphere(real(0.25)), {}, {3, 0, 0}));
  rig.add(elastic(Shape::sphere(real(0.25)), {2, 0.3125, 0}, {-1, 0, 0}));
  return first_hit(rig, search);
}

double time_of_rod(const CheckSetting& setting, Search search) {
  Rig rig(setting, weightless());
  BodyDesc rod = elastic(Shape::capsule(real(0.125), real(2)), {});
  rod.angular_velocity = real(DVec3{0, 0, -1});
  rig.add(rod);
  rig.add(elastic(Shape::sphere(real(0.125)), {1, 0, 0}));
  return first_hit(rig, search);
}

double time_of_edges(const CheckSetting& setting, Search search) {
  Rig rig(setting);
  const double half = kTau / 16;
  BodyDesc lower = {.shape = box_of({0.5, 0.5, 0.5}),
                    .rotation = {real(std::sin(half)), real(0), real(0), real(std::cos(half))}};
  rig.add(lower);
  BodyDesc upper = elastic(box_of({0.5, 0.5, 0.5}), {0, std::sqrt(2.0) + 1, 0});
  upper.rotation = {real(0), real(0), real(std::sin(half)), real(std::cos(half))};
  rig.add(upper);
  return first_hit(rig, search);
}

CheckRow time_row(std::string title, double expected, double achieved, double tolerance = 1e-9) {
  CheckRow row = absolute_row(std::move(title), "s", expected, achieved, tolerance);
  row.solver = "rk4, rollback";
  row.dt = kStep;
  row.substeps = 1;
  return row;
}

const char* name_of(Search search) {
  switch (search) {
    case Search::kHalving:
      return "halving";
    case Search::kBackward:
      return "backward";
    case Search::kEvent:
      return "event";
    case Search::kAdvancement:
      break;
  }
  return "advancement";
}

/// Counts balls of 1 cm radius that got through a wall of 2 mm within a tenth of a second.
int passed_wall(const CheckSetting& setting) {
  int passed = 0;
  for (double speed = 1; speed < 2e8; speed *= 10) {
    Rig rig(setting, weightless());
    rig.add({.shape = box_of({0.001, 1, 1}), .position = {1, 0, 0}});
    const BodyId ball = rig.add(elastic(Shape::sphere(real(0.01)), {0.9, 0, 0}, {speed, 0, 0}));
    lab::Run run = run_of(rig, Search::kEvent, 1e-6);
    for (int i = 0; i < 10; ++i) must(run.advance());
    const lab::BodyState now = must(run.body(ball));
    if (now.center.x > 0.99 || now.velocity.x > 0) ++passed;
  }
  return passed;
}

}  // namespace

/// The times are roots of known polynomials (validation.md, V58): h = g t^2 / 2; |d - v t| = r1 + r2. A rod
/// with 1 rad/s comes down on a ball where sin(angle left) = (r1 + r2) / distance; edges meet by h = g t^2 /
/// 2. Bounces with e = 1 come at (2 n - 1) sqrt(2 h / g).
Rows rollback(const CheckSetting& setting) {
  Rows rows;
  for (const Search search : {Search::kHalving, Search::kBackward, Search::kEvent, Search::kAdvancement}) {
    const std::string by = std::string(", ") + name_of(search);
    rows.push_back(time_row("a ball falls 1 m" + by, std::sqrt(2 / kHeld), time_of_fall(setting, search)));
    rows.push_back(time_row("balls meet aside" + by, (2 - std::sqrt(0.25 - 0.3125 * 0.3125)) / 4,
                            time_of_balls(setting, search)));
    rows.push_back(
        time_row("a rod turns onto a ball" + by, kTau / 4 - std::asin(0.25), time_of_rod(setting, search)));
    rows.push_back(time_row("edges meet after 1 m" + by, std::sqrt(2 / kHeld), time_of_edges(setting, search),
                            1e-7));  // The edges' rotations are float.
  }
  Rig rig(setting);
  rig.add(level_ground(0));
  const BodyId ball = rig.add(elastic(Shape::sphere(real(0.25)), {0, 1.25, 0}));
  lab::Run run = run_of(rig, Search::kEvent, 1e-9);
  while (run.collisions().hits < 1000 && run.time() < 2000) must(run.advance());
  const double weight = static_cast<double>(rig.world().mass(ball)) * kGravity;
  rows.push_back(
      time_row("top after 1000 bounces, 1 m, e = 1", 1, run.energy().total() / weight - 0.25, 1e-4));
  rows.back().unit = "m";
  rows.push_back(
      time_row("time of bounce 1000", 1999 * std::sqrt(2 / kHeld), run.collisions().last_hit, 1e-3));
  rows.push_back(time_row("balls that pass a wall of 2 mm, 1 to 1e8 m/s, of 9", 0, passed_wall(setting), 0));
  rows.back().unit = "";
  return rows;
}

/// These are V25 and V33 by rk4 with rollback, to 1e-4 (validation.md), except the time of rest, which is
/// seen only once a frame.
Rows bodies_by_rk4(const CheckSetting& setting) {
  Rows rows;
  const auto add = [&](const char* name, double dt, Rows (*run)(const CheckSetting&)) {
    CheckSetting own = setting;
    own.stepper = "rk4";
    own.dt = dt;
    for (CheckRow& row : run(own)) {
      if (row.title.find("at rest") == std::string::npos) row.tolerance = 1e-4;
      row.title = name + (", " + row.title);
      row.solver = "rk4, rollback";
      row.dt = dt;
      row.substeps = 1;
      rows.push_back(std::move(row));
    }
  };
  add("V25", kStep / 4, turning_over);
  add("V33", kStep, bouncing_ball);
  return rows;
}

}  // namespace hooke::check
