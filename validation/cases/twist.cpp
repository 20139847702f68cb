/// Tests ropes that resist twist: shafts, and a cable that is twisted until it forms a loop.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace hooke::check {

namespace {

constexpr double kPi = kTau / 2;
constexpr double kDegrees = 360 / kTau;

WorldDesc empty_space() {
  WorldDesc desc = without_air();
  desc.gravity = {};
  return desc;
}

/// Describes a straight rod from the origin to (1, 0, 0), with one more point beyond either end, by which it
/// is clamped.
RopeDesc straight_rod(int segments) {
  RopeDesc desc{.total_mass = real(0.01),
                .bend_stiffness = real(1),
                .bend_damping = real(0.05),
                .twist_stiffness = real(0.8),
                .pins = {}};
  for (int i = -1; i <= segments + 1; ++i) desc.points.push_back({i / static_cast<double>(segments), 0, 0});
  return desc;
}

BodyDesc hand(BodyKind kind, DVec3 place, double turns_per_second) {
  return {.kind = kind,
          .shape = box_of({0.05, 0.05, 0.05}),
          .position = place,
          .angular_velocity = {real(kTau * turns_per_second), real(0), real(0)},
          .collides = false};
}

/// Makes a body hold the point `first` and the next one.
void clamp(Rig& rig, BodyId body, RopeId rope, std::uint32_t first) {
  for (std::uint32_t i = first; i < first + 2; ++i) {
    must(rig.world().add_hook(
        {.a = {.body = body}, .b = {.point = point(rope, i)}, .anchor = rig.positions(rope)[i]}));
  }
}

double sum_of(const std::vector<Real>& values) {
  double sum = 0;
  for (const Real value : values) sum += static_cast<double>(value);
  return sum;
}

/// A wire runs from a fixed body to one that rotates it by a quarter turn in a second, then holds it.
struct Shaft {
  Rig rig;
  RopeId rope;

  Shaft(const CheckSetting& setting, const RopeDesc& desc)
      : rig(setting, empty_space()), rope(rig.add(desc)) {
    const auto last = static_cast<std::uint32_t>(desc.points.size()) - 2;
    const BodyId left = rig.add(hand(BodyKind::kStatic, {0, 0, 0}, 0));
    const BodyId right = rig.add(hand(BodyKind::kKinematic, {1, 0, 0}, 0.25));
    clamp(rig, left, rope, 0);
    clamp(rig, right, rope, last);
    rig.run(1);
    must(rig.world().set_angular_velocity(right, {}));
    rig.run(1);
  }
};

void add_even_twist(const CheckSetting& setting, Rows& rows) {
  const int segments = 32;
  Shaft shaft(setting, straight_rod(segments));
  const std::vector<Real> twists = shaft.rig.world().twists(shaft.rope);
  double squares = 0;
  double sum = 0;
  for (int i = 1; i <= segments; ++i) {
    sum += static_cast<double>(twists[static_cast<std::size_t>(i)]);
    squares += std::pow(sum - i * kPi / 2 / segments, 2);
  }
  double away = 0;
  const std::vector<DVec3> x = shaft.rig.positions(shaft.rope);
  for (std::size_t i = 0; i < x.size(); ++i)
    away = std::max(away, length(x[i] - DVec3{(static_cast<double>(i) - 1) / segments, 0, 0}));
  rows.push_back(absolute_row("twisted by 90 degrees: angle at its end", "deg", 90, sum * kDegrees, 0.005));
  rows.push_back(
      absolute_row("the same, rms from even", "deg", 0, std::sqrt(squares / segments) * kDegrees, 0.02));
  rows.push_back(absolute_row("the same, way from the straight line", "m", 0, away, 2e-5));
}

/// Tests a rope that is clamped along an arc of a quarter circle, pushed off it and left to return.
void add_even_bend(const CheckSetting& setting, Rows& rows) {
  const int segments = 32;
  const double radius = 2 / kPi;
  RopeDesc desc = straight_rod(segments);
  const auto at = [&](double angle) {
    return DVec3{radius * std::sin(angle), radius * (1 - std::cos(angle)), 0};
  };
  for (int i = 0; i <= segments; ++i)
    desc.points[static_cast<std::size_t>(i) + 1] = at(i * kPi / 2 / segments);
  const double pitch = length(desc.points[2] - desc.points[1]);
  desc.points.front() = {-pitch, 0, 0};
  desc.points.back() = desc.points[static_cast<std::size_t>(segments) + 1] + DVec3{0, pitch, 0};
  const auto last = static_cast<std::uint32_t>(desc.points.size()) - 1;
  desc.pins = {{.point = 0}, {.point = 1}, {.point = last - 1}, {.point = last}};
  desc.air_friction = real(0.5);
  Rig rig(setting, empty_space());
  const RopeId rope = rig.add(desc);
  must(rig.world().apply_impulse(point(rope, 12), {real(0.001), real(0.001), real(0.001)}));
  rig.run(6);
  const std::vector<DVec3> x = rig.positions(rope);
  double least = 10;
  double most = 0;
  double away = 0;
  for (std::size_t i = 2; i + 2 < x.size(); ++i) {
    const double curvature = length(x[i + 1] - 2 * x[i] + x[i - 1]) / (pitch * pitch);
    least = std::min(least, curvature);
    most = std::max(most, curvature);
    away = std::max(away, length(x[i] - desc.points[i]));
  }
  rows.push_back(absolute_row("bent to an arc: way from it, over L", "", 0, away, 2e-5));
  rows.push_back(relative_row("the same, least curvature", "1/m", 1 / radius, least));
  rows.push_back(relative_row("the same, largest curvature", "1/m", 1 / radius, most));
  rows.push_back(
      absolute_row("the same, twist that comes of it", "rad", 0, sum_of(rig.world().twists(rope)), 1e-5));
}

/// Returns the signed solid angle under which one segment sees the other, over 4 pi: Klenin and Langowski
/// 2000, "Computation of writhe in modeling of supercoiled DNA", method 1a.
double gauss_integral(DVec3 r1, DVec3 r2, DVec3 r3, DVec3 r4) {
  const DVec3 r13 = r3 - r1;
  const DVec3 r14 = r4 - r1;
  const DVec3 r23 = r3 - r2;
  const DVec3 r24 = r4 - r2;
  const std::array<DVec3, 4> n = {normalize(cross(r13, r14)), normalize(cross(r14, r24)),
                                  normalize(cross(r24, r23)), normalize(cross(r23, r13))};
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) area += std::asin(std::clamp(dot(n[i], n[(i + 1) % 4]), -1.0, 1.0));
  const double side = dot(cross(r4 - r3, r2 - r1), r13);
  return side == 0 ? 0 : std::copysign(area, side) / (2 * kTau);
}

/// Returns the writhe of a curve whose ends go on straight along x, which closes far away.
double writhe(std::vector<DVec3> x) {
  constexpr double kFar = 1e4;
  x.insert(x.begin(), x.front() - DVec3{kFar, 0, 0});
  x.push_back(x.back() + DVec3{kFar, 0, 0});
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t j = i + 2; j + 1 < x.size(); ++j) sum += gauss_integral(x[i], x[i + 1], x[j], x[j + 1]);
  }
  return 2 * sum;
}

}  // namespace

/// A rod of constant cross section bends to an arc under couples and twists evenly under torques (Kirchhoff
/// 1859), and bending in a plane does not twist it.
Rows bent_and_twisted(const CheckSetting& setting) {
  Rows rows;
  add_even_twist(setting, rows);
  add_even_bend(setting, rows);
  for (CheckRow& row : rows) row.solver = "rope";
  return rows;
}

/// A round wire of steel: M = GJ phi / L, G = E / 2 (1 + nu), J = pi r^4 / 2 (Saint-Venant 1855).
Rows torsion(const CheckSetting& setting) {
  const double e = 2e11;
  const double nu = 0.3;
  const double r = 1e-3;
  const double gj = e / 2 / (1 + nu) * kPi * std::pow(r, 4) / 2;
  RopeDesc wire = straight_rod(16);
  wire.young_modulus = real(e);
  wire.poisson_ratio = real(nu);
  wire.radius = real(r);
  Shaft shaft(setting, wire);
  Rows rows = {relative_row("torque of a wire turned by 90 degrees", "N m", gj * kPi / 2,
                            static_cast<double>(shaft.rig.world().torques(shaft.rope)[8]), 1e-4)};

  const double torque = 0.1;
  Rig rig(setting, empty_space());
  const RopeId rope = rig.add(wire);
  clamp(rig, rig.add(hand(BodyKind::kStatic, {0, 0, 0}, 0)), rope, 0);
  BodyDesc disk = hand(BodyKind::kDynamic, {1, 0, 0}, 0);
  disk.angular_damping = real(10);
  const BodyId end = rig.add(disk);
  clamp(rig, end, rope, 17);
  rig.run(8, [&] { must(rig.world().apply_torque(end, {real(torque), real(0), real(0)})); });
  const DVec3 y = rig.direction(end, {0, 1, 0});
  rows.push_back(absolute_row("angle of its end under a torque of 0.1 N m", "deg", torque / gj * kDegrees,
                              std::atan2(y.z, y.y) * kDegrees, 0.05));
  for (CheckRow& row : rows) row.solver = "rope";
  return rows;
}

/// The turns put into a slack cable are its twist plus its writhe, Lk = Tw + Wr (Calugareanu 1959), while no
/// strand passes another. Each passage takes two turns away (Fuller 1971).
Rows link_of_loop(const CheckSetting& setting) {
  const int segments = 64;
  RopeDesc desc = straight_rod(segments);
  desc.air_friction = real(0.5);
  const double span = 0.5;
  for (std::size_t i = 1; i < desc.points.size() - 1; ++i) {
    const double s = (static_cast<double>(i) - 1) / segments;
    desc.points[i] = {span * s, -0.2 * (1 - std::cos(kTau * s)), 0};
  }
  desc.points.front() = {-span / segments, 0, 0};
  desc.points.back() = {span + span / segments, 0, 0};
  Rig rig(setting, empty_space());
  const RopeId rope = rig.add(desc);
  clamp(rig, rig.add(hand(BodyKind::kStatic, {0, 0, 0}, 0)), rope, 0);
  const double rate = 0.5;
  clamp(rig, rig.add(hand(BodyKind::kKinematic, {span, 0, 0}, rate)), rope, segments + 1);
  double writhing = 0;
  const auto link = [&] {
    writhing = writhe(rig.positions(rope));
    return sum_of(rig.world().twists(rope)) / kTau + writhing - rate * rig.time();
  };
  double worst = 0;
  while (rig.time() < 5 && writhing < 0.9 && rig.healthy()) {
    rig.step();
    worst = std::max(worst, std::abs(link()));
  }
  Rows rows = {absolute_row("twist and writhe less the turns put in, largest", "", 0, worst, 0.05),
               absolute_row("writhe of the loop that it throws", "", 1, writhing, 0.15)};
  rig.run(6 - rig.time());
  rows.push_back(absolute_row("the same after the loop has passed through itself", "", -2, link(), 0.05));
  for (CheckRow& row : rows) row.solver = "rope";
  return rows;
}

namespace {

/// Tells whether a twisted rod bends out that is clamped at one end, and at the other to a body that slides
/// along it.
bool throws_itself(const CheckSetting& setting, double twist) {
  const int segments = 48;
  RopeDesc desc = straight_rod(segments);
  desc.twist = real(twist * (segments + 2) / segments);
  // More damping would hide how slowly the bend grows near the torque sought.
  desc.bend_damping = real(0.002);
  desc.pins = {{.point = 0}, {.point = 1}};
  Rig rig(setting, empty_space());
  const RopeId rope = rig.add(desc);
  const BodyId slide = rig.add(hand(BodyKind::kDynamic, {1, 0, 0}, 0));
  must(rig.world().add_hook(
      {.kind = HookKind::kSlider, .b = {slide}, .anchor = {1, 0, 0}, .axis = {real(1), real(0), real(0)}}));
  clamp(rig, slide, rope, segments + 1);
  must(rig.world().apply_impulse(point(rope, segments / 2), {real(0), real(1e-6), real(0)}));
  double away = 0;
  for (int i = 0; i < 10 && away < 0.02; ++i) {
    rig.run(1);
    for (const DVec3& x : rig.positions(rope)) away = std::max(away, std::hypot(x.y, x.z));
  }
  return away >= 0.02;
}

}  // namespace

/// A rod is clamped at both ends, which are free to approach each other. It bends to a helix when its torque
/// exceeds 8.9868 EI / L, from the first root of tan(M L / 2 EI) = M L / 2 EI (Greenhill 1883).
Rows twisted_rod(const CheckSetting& setting) {
  const double expected = 2 * 4.493409;
  const double stiffness = 0.8;  // GJ over EI.
  const double found = bisect(0.9 * expected, 1.1 * expected, 6,
                              [&](double torque) { return !throws_itself(setting, torque / stiffness); });
  CheckRow row = relative_row("torque that throws a twisted rod out, M L / EI", "", expected, found, 0.02);
  row.solver = "rope";
  return {row};
}

}  // namespace hooke::check
