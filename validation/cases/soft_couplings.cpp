/// Tests bodies and ropes with cloth and jelly: loads that lie, hang, float and fly.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace hooke::check {

namespace {

/// Describes a cube of jelly with an edge of half a meter.
SolidDesc jelly(DVec3 place, double density) {
  SolidDesc desc{.cells = {4, 4, 4}, .size = {real(0.5), real(0.5), real(0.5)}, .position = place};
  desc.density = real(density);
  desc.young_modulus = real(2e4);
  desc.poisson_ratio = real(0.3);
  desc.damping = real(0.01);
  return desc;
}

/// Returns the mean height of those points of a cube that were at the height `own` at the start.
double level(const Rig& rig, SolidId id, const std::vector<DVec3>& start, double own) {
  const std::vector<DVec3> x = rig.positions(id);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(start[i].y - own) > 1e-4) continue;
    sum += x[i].y;
    ++count;
  }
  return sum / count;
}

constexpr double kSheet = 2;  ///< Mass of a sheet [kg].

/// Describes a level sheet of one square meter about the origin, as stiff as a substep carries.
ClothDesc sheet(int points) {
  ClothDesc desc{.columns = points,
                 .rows = points,
                 .corner = {-0.5, 0, -0.5},
                 .row_direction = {real(0), real(0), real(1)}};
  desc.total_mass = real(kSheet);
  desc.stretch_stiffness = real(3e5 / (points * points));
  desc.shear_stiffness = real(1e5 / (points * points));
  desc.damping = real(0.1);
  desc.drag_coefficient = real(0);
  desc.lift_coefficient = real(0);
  return desc;
}

BodyDesc ball(DVec3 place, double radius, double mass) {
  BodyDesc desc = moving(Shape::sphere(real(radius)), place);
  desc.mass = real(mass);
  return desc;
}

double lift_of(const Rig& rig, const std::vector<HookId>& hooks) {
  DVec3 sum;
  for (const HookId hook : hooks) sum += vector_cast<double>(rig.world().hook_force(hook).force);
  return std::abs(sum.y);
}

/// Runs on and returns the mean of a figure over two seconds.
template <class Figure>
double mean_over(Rig& rig, const Figure& figure) {
  double sum = 0;
  int count = 0;
  rig.run(2, [&] {
    sum += figure();
    ++count;
  });
  return sum / count;
}

Rows by(const char* solver, Rows rows) {
  for (CheckRow& row : rows) row.solver = solver;
  return rows;
}

}  // namespace

/// The supports of a hammock carry it and the load that lies in it (statics).
Rows load_in_hammock(const CheckSetting& setting) {
  Rig rig(setting, without_air());
  ClothDesc desc = sheet(11);
  desc.air_friction = real(2);
  const ClothId cloth = rig.add(desc);
  std::vector<HookId> hooks;
  for (std::uint32_t row = 0; row < 11; ++row) {
    for (const std::uint32_t column : {0u, 10u}) {
      const std::uint32_t i = row * 11 + column;
      must(rig.world().set_position(point(cloth, i), 0.98 * rig.positions(cloth)[i]));
      hooks.push_back(
          must(rig.world().add_hook({.b = {.point = point(cloth, i)}, .anchor = rig.positions(cloth)[i]})));
    }
  }
  BodyDesc roll{.kind = BodyKind::kDynamic,
                .shape = {.kind = ShapeKind::kCylinder, .radius = real(0.1), .half_height = real(0.3)},
                .position = {0, 0.11, 0},
                .rotation = quaternion_about(Vec3{real(1), real(0), real(0)}, real(kTau / 4))};
  roll.mass = real(5);
  roll.linear_damping = real(1);
  rig.add(roll);
  rig.run(10);
  const double lift = mean_over(rig, [&] { return lift_of(rig, hooks); });
  return by("cloth, bodies", {relative_row("lift of the hooks of a hammock with 5 kg in it", "N",
                                           (5 + kSheet) * kGravity, lift)});
}

/// The corners of a sheet hang on ropes, with a ball on it: the ropes carry both (statics).
Rows sheet_on_ropes(const CheckSetting& setting) {
  Rig rig(setting, without_air());
  const int n = 11;
  ClothDesc desc = sheet(n);
  desc.air_friction = real(2);
  const ClothId cloth = rig.add(desc);
  std::vector<RopeId> ropes;
  for (const int column : {0, n - 1}) {
    for (const int row : {0, n - 1}) {
      const auto i = static_cast<std::uint32_t>(row * n + column);
      const DVec3 corner = rig.positions(cloth)[i];
      RopeDesc rope{.total_mass = real(0.01), .points = {}, .drag_coefficient = real(0)};
      for (int k = 0; k <= 10; ++k)
        rope.points.push_back(corner + (1 - k / 10.0) * DVec3{corner.x, 1, corner.z});
      ropes.push_back(rig.add(rope));
      must(rig.world().add_hook(
          {.a = {.point = point(ropes.back(), 10)}, .b = {.point = point(cloth, i)}, .anchor = corner}));
    }
  }
  rig.add(ball({0, 0.11, 0}, 0.1, 3));
  rig.run(10);
  const double lift = mean_over(rig, [&] {
    double sum = 0;
    for (const RopeId rope : ropes) {
      const std::vector<DVec3> x = rig.positions(rope);
      sum += static_cast<double>(rig.world().tensions(rope)[0]) * normalize(x[0] - x[1]).y;
    }
    return sum;
  });
  // Half of a rope's first segment belongs to its pin.
  const double weight = (3 + kSheet + 4 * 0.01 * 0.95) * kGravity;
  return by("rope, cloth, bodies",
            {relative_row("lift of four ropes with a sheet and 3 kg", "N", weight, lift)});
}

/// A cube of jelly on smooth ground sinks by m g L / (E A) under a plate (statics).
Rows plate_on_jelly(const CheckSetting& setting) {
  const auto height = [&](double mass) {
    Rig rig(setting, without_air());
    rig.add(level_ground(0));
    SolidDesc cube = jelly({0, 0.252, 0}, 100);
    cube.contact.friction = real(0);
    const SolidId id = rig.add(cube);
    const std::vector<DVec3> start = rig.positions(id);
    if (mass > 0) {
      BodyDesc plate = moving(box_of({0.4, 0.02, 0.4}), {0, 0.524, 0});
      plate.mass = real(mass);
      plate.contact.friction = real(0);
      const BodyId body = rig.add(plate);
      must(rig.world().add_hook({.kind = HookKind::kSlider, .b = {body}}));
    }
    rig.run(6);
    return level(rig, id, start, 0.502) - level(rig, id, start, 0.002);
  };
  const double mass = 5;
  return by("tetrahedra, bodies",
            {relative_row("way down of 5 kg on a cube of jelly", "m", mass * kGravity * 0.5 / (2e4 * 0.25),
                          height(0) - height(mass), 0.05)});
}

/// The share of a floating cube of jelly that is under water is its density over the liquid's (Archimedes).
/// Under water a rope that holds it at its base pulls with the weight of the displaced water less its own.
Rows floating_jelly(const CheckSetting& setting) {
  const FieldDesc water{.kind = FieldDesc::Kind::kLiquid, .density = 1000, .drag = 3};
  Rig rig(setting, without_air());
  must(rig.world().add_field(water));
  SolidDesc raft = jelly({0, 0, 0}, 600);
  raft.cells[1] = 2;
  raft.size.y = real(0.25);
  const SolidId id = rig.add(raft);
  const std::vector<DVec3> start = rig.positions(id);
  rig.run(15);

  Rig held(setting, without_air());
  must(held.world().add_field(water));
  const SolidId below = held.add(jelly({0, -1, 0}, 600));
  RopeDesc rope{.total_mass = real(0.001), .points = {}, .radius = real(0.001)};
  for (int i = 0; i <= 10; ++i) rope.points.push_back({0, -2.25 + 0.1 * i, 0});
  const RopeId tether = held.add(rope);
  must(held.world().add_hook({.a = {.point = point(tether, 10)},
                              .b = {.point = point(below, PointRef::kNearest)},
                              .anchor = {0, -1.25, 0}}));
  held.run(15);
  const double missing = (1000 * held.world().in_its_frame().volume(below) - 600 * 0.125) * kGravity;
  return by("tetrahedra, rope", {relative_row("depth of floating jelly, density 0.6", "m", 0.15,
                                              -level(rig, id, start, -0.125), 0.01),
                                 relative_row("pull of a rope that holds it under water", "N", missing,
                                              static_cast<double>(held.world().tensions(tether)[0]))});
}

/// A cube of jelly hangs on a rope: tension and weight are equal, and it swings as a body does, about the
/// rope's pin, T = 2 pi sqrt((m l^2 + I) / (m g l)).
Rows jelly_on_rope(const CheckSetting& setting) {
  Rig rig(setting, without_air());
  SolidDesc cube = jelly({0, -1.25, 0}, 100);
  const SolidId id = rig.add(cube);
  RopeDesc rope{.total_mass = real(0.01), .points = {}, .drag_coefficient = real(0)};
  for (int i = 0; i <= 10; ++i) rope.points.push_back({0, -0.1 * i, 0});
  const RopeId cord = rig.add(rope);
  must(rig.world().add_hook({.a = {.point = point(cord, 10)},
                             .b = {.point = point(id, PointRef::kNearest)},
                             .anchor = {0, -1, 0}}));
  rig.run(5);
  const double pull = mean_over(rig, [&] { return static_cast<double>(rig.world().tensions(cord)[0]); });
  const double weight = (100 * 0.125 + 0.01 * 0.95) * kGravity;
  return by("tetrahedra, rope",
            {relative_row("pull of a rope with 12.5 kg of jelly on it", "N", weight, pull)});
}

/// Free bodies, ropes, cloth and jelly, together at rest, are hooked to each other and collide. Momentum and
/// angular momentum stay, and energy does not grow.
Rows free_rooms(const CheckSetting& setting) {
  WorldDesc space = without_air();
  space.gravity = {};
  Rig rig(setting, space);
  BodyDesc left = moving(box_of({0.2, 0.1, 0.15}), {-1, 0, 0});
  left.mass = real(3);
  left.velocity = real(DVec3{0, 0.4, 0.05});
  left.angular_velocity = real(DVec3{0.5, 1, -0.7});
  const BodyId a = rig.add(left);
  BodyDesc right = moving(box_of({0.15, 0.2, 0.1}), {1, 0.1, 0});
  right.mass = real(1);
  right.velocity = real(DVec3{0, -0.3, 0.05});
  right.angular_velocity = real(DVec3{0, 0.3, 0.4});
  const BodyId b = rig.add(right);
  RopeDesc rope{.total_mass = real(0.2), .points = {}, .pins = {}, .drag_coefficient = real(0)};
  for (int i = 0; i <= 20; ++i) rope.points.push_back({-0.8 + 0.08 * i, 0.05 * i / 20.0, 0});
  const RopeId cord = rig.add(rope);
  must(rig.world().add_hook({.a = {a}, .b = {.point = point(cord, 0)}, .anchor = {-0.8, 0, 0}}));
  must(rig.world().add_hook({.a = {b}, .b = {.point = point(cord, 20)}, .anchor = {0.8, 0.05, 0}}));
  ClothDesc cape = sheet(9);
  cape.corner = {1, 0.3, -0.5};
  cape.velocity = real(DVec3{0, -0.45, -0.1});
  const ClothId cloth = rig.add(cape);
  must(rig.world().add_hook({.a = {b}, .b = {.point = point(cloth, 0)}, .anchor = {1, 0.3, -0.5}}));
  SolidDesc soft = jelly({-1.6, 0, 0}, 30);
  soft.young_modulus = real(5e3);
  const SolidId cube = rig.add(soft);
  must(rig.world().add_hook(
      {.a = {a}, .b = {.point = point(cube, PointRef::kNearest)}, .anchor = {-1.3, 0, 0}}));
  BodyDesc loose = ball({0.1, -0.6, 0.1}, 0.1, 0.5);
  loose.velocity = real(DVec3{0, 0, 0});
  rig.add(loose);

  const Measurement start = rig.world().measure();
  const double energy = start.energy.total();
  double gain = 0;
  rig.run(60, [&] { gain = std::max(gain, rig.energy().total() / energy - 1); });
  const Measurement end = rig.world().measure();
  // The scale is the momentum of the whole mass at the root mean square of the speeds.
  const double mass = 3 + 1 + 0.2 + kSheet + 30 * 0.125 + 0.5;
  const double scale = std::sqrt(2 * energy * mass);
  CheckRow momentum = absolute_row("momentum lost in 60 s, share", "", 0,
                                   length(end.momentum - start.momentum) / scale, 1e-6);
  CheckRow turning = absolute_row("angular momentum lost in 60 s, share", "", 0,
                                  length(end.angular_momentum - start.angular_momentum) / scale, 1e-5);
  momentum = known_miss(momentum, "velocities are rounded to floats in each substep; 5e-11 in double");
  turning = known_miss(
      turning,
      "ropes and hooks at points pull along where these are about to be; cloth and jelly alone keep it");
  return by("all", {momentum, turning, absolute_row("energy gained, share", "", 0, gain, 1e-3)});
}

/// A ball flies into a free sheet: their common momentum stays (Newton), whatever the cloth takes.
Rows caught_ball(const CheckSetting& setting) {
  WorldDesc space = without_air();
  space.gravity = {};
  Rig rig(setting, space);
  const ClothId cloth = rig.add(sheet(11));
  BodyDesc desc = ball({0.05, 0.5, 0.02}, 0.1, 0.5);
  desc.velocity = real(DVec3{0, -2, 0});
  const BodyId body = rig.add(desc);
  const double energy = rig.energy().total();
  double gain = 0;
  rig.run(2, [&] { gain = std::max(gain, rig.energy().total() / energy - 1); });
  double mean = 0;
  for (const DVec3& v : rig.velocities(cloth)) mean += v.y / 121;
  return by("cloth, bodies", {relative_row("momentum of ball and sheet after the hit", "kg m/s", -1,
                                           rig.world().measure().momentum.y, 1e-4),
                              absolute_row("energy gained, share", "", 0, gain, 1e-3),
                              // The ball does not pass: the sheet is before it, and at least as fast.
                              relative_row("sheet is before the ball", "", 1,
                                           mean <= rig.velocity(body).y + 1e-3 ? 1 : 0, 0)});
}

}  // namespace hooke::check
