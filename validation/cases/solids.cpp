#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace hooke::check {

namespace {

constexpr double kDensity = 1000;

/// A Bar lies along an axis and has square ends. It has `cells` cells across, and cells of the same length
/// along it.
struct Bar {
  int axis = 0;
  int cells = 2;
  int length_over_width = 4;
  double young_modulus = 1e5;
  double poisson_ratio = 0.3;
};

/// Describes a bar one meter long. `calm` is the rate at which air friction slows it [1/s].
SolidDesc desc_of(const Bar& bar, double calm) {
  const double width = 1.0 / bar.length_over_width;
  SolidDesc desc;
  desc.cells = {bar.cells, bar.cells, bar.cells};
  desc.cells[bar.axis] = bar.cells * bar.length_over_width;
  desc.size = {real(width), real(width), real(width)};
  (bar.axis == 0 ? desc.size.x : bar.axis == 1 ? desc.size.y : desc.size.z) = Real(1);
  desc.density = real(kDensity);
  desc.young_modulus = real(bar.young_modulus);
  desc.poisson_ratio = real(bar.poisson_ratio);
  desc.damping = Real(0);
  desc.air_friction = real(calm * kDensity * width * width);
  return desc;
}

WorldDesc fine_world(DVec3 gravity) {
  WorldDesc desc;
  desc.gravity = real(gravity);
  desc.particle_substeps = 4;
  return desc;
}

std::vector<std::uint32_t> points_at(const Rig& rig, SolidId id, int axis, double place) {
  std::vector<std::uint32_t> found;
  const std::vector<DVec3> points = rig.positions(id);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (std::abs(component(points[i], axis) - place) < 1e-4) found.push_back(i);
  }
  return found;
}

double mean_of(const Rig& rig, SolidId id, const std::vector<std::uint32_t>& points, int axis) {
  const std::vector<DVec3> x = rig.positions(id);
  double sum = 0;
  for (const std::uint32_t i : points) sum += component(x[i], axis);
  return sum / static_cast<double>(points.size());
}

/// Holds the bar at the end of its axis, with `gravity` downward, until it rests. Returns how far the free
/// end went down [m].
double sag_of(const CheckSetting& setting, const Bar& bar, double gravity, double calm, double seconds) {
  Rig rig(setting, fine_world({0, -gravity, 0}));
  SolidDesc desc = desc_of(bar, calm);
  const SolidId id = rig.add(desc);
  for (const std::uint32_t i : points_at(rig, id, bar.axis, 0.5)) must(rig.world().pin(point(id, i)));
  const std::vector<std::uint32_t> end = points_at(rig, id, bar.axis, -0.5);
  const double before = mean_of(rig, id, end, 1);
  rig.run(seconds);
  return before - mean_of(rig, id, end, 1);
}

using Corner = std::array<std::uint32_t, 3>;

/// Visits all corners whose coordinates are below `side`, first along x, last along z.
template <class Visitor>
void for_each_corner(std::uint32_t side, const Visitor& visit) {
  for (std::uint32_t z = 0; z < side; ++z) {
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t x = 0; x < side; ++x) visit(Corner{x, y, z});
    }
  }
}

/// This is a cube of 1 m made of n x n x n cubes, six tetrahedra to each. Their inner corners are moved at
/// random by up to a fifth of a small cube's side.
struct IrregularCube {
  SolidDesc desc;
  std::vector<std::uint32_t> rim;

  explicit IrregularCube(std::uint32_t n) : n_(n) {
    for_each_corner(n + 1, [&](const Corner& corner) { add_point(corner); });
    for_each_corner(n, [&](const Corner& corner) { add_tetrahedra(corner); });
    desc.poisson_ratio = Real(0.3);
    desc.damping = Real(0);
    desc.air_friction = Real(3e4);
  }

 private:
  /// Returns a number from -0.5 to 0.5.
  double random() {
    random_ = random_ * 1664525u + 1013904223u;
    return (random_ >> 8) / 16777216.0 - 0.5;
  }
  [[nodiscard]] std::uint32_t index_of(const Corner& corner) const {
    return corner[0] + (n_ + 1) * (corner[1] + (n_ + 1) * corner[2]);
  }
  void add_point(const Corner& corner) {
    const auto& [x, y, z] = corner;
    const bool inner = x % n_ != 0 && y % n_ != 0 && z % n_ != 0;
    const DVec3 off = inner ? DVec3{0.4 * random(), 0.4 * random(), 0.4 * random()} : DVec3{};
    if (!inner) rim.push_back(index_of(corner));
    desc.points.push_back(real((1.0 / n_) * (DVec3{x + off.x, y + off.y, z + off.z})));
  }
  /// Each of the six goes from the lowest corner of the small cube to the highest, along its edges in another
  /// order of the axes.
  void add_tetrahedra(const Corner& lowest) {
    constexpr std::array<std::array<std::uint32_t, 3>, 6> kOrders = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (const auto& order : kOrders) {
      Corner corner = lowest;
      std::array<std::uint32_t, 4> four = {index_of(corner)};
      for (std::size_t i = 0; i < 3; ++i) {
        ++corner[order[i]];
        four[i + 1] = index_of(corner);
      }
      desc.tetrahedra.push_back(four);
    }
  }

  std::uint32_t n_;
  std::uint32_t random_ = 12345;
};

/// Returns the areas of the two ends of a bar along x, divided among their points; those of the lower end are
/// negative.
std::map<std::uint32_t, double> areas_of_ends(const Rig& rig, SolidId id, const std::vector<DVec3>& points) {
  std::map<std::uint32_t, double> area;
  const std::vector<DVec3> surface = rig.world().surface(id);
  const auto point_at = [&](DVec3 place) {
    const auto same = [&](DVec3 p) { return length(p - place) < 1e-5; };
    return static_cast<std::uint32_t>(std::find_if(points.begin(), points.end(), same) - points.begin());
  };
  for (const auto& t : rig.world().triangles(id)) {
    const DVec3 normal = cross(surface[t[1]] - surface[t[0]], surface[t[2]] - surface[t[0]]);
    if (std::abs(normal.x) < 0.9 * length(normal)) continue;
    for (const std::uint32_t corner : t) area[point_at(surface[corner])] += normal.x / 6;
  }
  return area;
}

/// Returns how far two faces of a bar across an axis are apart now, over how far they were at rest. The faces
/// are at `half` to both sides of the center in `rest`, the positions at rest.
double stretch_of(const Rig& rig, SolidId id, const std::vector<DVec3>& rest, int axis, double half) {
  std::vector<std::uint32_t> ends[2];
  for (std::uint32_t i = 0; i < rest.size(); ++i) {
    if (std::abs(std::abs(component(rest[i], axis)) - half) < 1e-4)
      ends[component(rest[i], axis) > 0].push_back(i);
  }
  return (mean_of(rig, id, ends[1], axis) - mean_of(rig, id, ends[0], axis)) / (2 * half);
}

}  // namespace

/// This is a patch test: if the rim of an irregular mesh is moved by an affine map of 1 %, the inside follows
/// it exactly (FEM practice). Rotated and moved as a whole, the mesh has no energy. Figures are in units of
/// its side and of E V.
Rows patch_test(const CheckSetting& setting) {
  const bool exact = sizeof(Real) == sizeof(double);
  const double goal = exact ? 1e-10 : 1e-6;
  const auto map = [](DVec3 x) {
    return x + 0.01 * DVec3{x.x + 0.5 * x.y, 0.3 * x.z - 0.7 * x.y, 0.4 * x.x + 0.2 * x.z};
  };
  IrregularCube cube(3);
  for (const std::uint32_t i : cube.rim) {
    const auto x = vector_cast<double>(cube.desc.points[i]);
    cube.desc.pins.push_back(
        {i, {.kind = MotionDesc::Kind::kKeyframes, .keyframes = {{0, {}}, {0.5, real(map(x) - x)}}}});
  }
  Rig rig(setting, fine_world({}));
  const SolidId id = rig.add(cube.desc);
  rig.run(exact ? 6 : 3);
  const std::vector<DVec3> now = rig.positions(id);
  double farthest = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    farthest = std::max(farthest, length(now[i] - map(vector_cast<double>(cube.desc.points[i]))));

  cube.desc.pins.clear();
  Rig free(setting, fine_world({}));
  const SolidId whole = free.add(cube.desc);
  const Quat turn = quaternion_about(normalize(Vec3{Real(1), Real(2), Real(-3)}), Real(1));
  for (std::uint32_t i = 0; i < cube.desc.points.size(); ++i) {
    const DVec3 x = vector_cast<double>(rotate(turn, cube.desc.points[i])) + DVec3{1, 2, 3};
    must(free.world().set_position(point(whole, i), x));
  }
  const CheckRow affine =
      absolute_row("farthest of an inner point from the affine map", "m", 0, farthest, goal);
  Rows rows = {known_miss(affine, "one pass over tetrahedra leaves (c h / l)^2 of the stress unbalanced"),
               absolute_row("energy of a turn by 1 rad, over E V", "", 0, free.energy().elastic / 1e5, goal)};
  for (CheckRow& row : rows) row.solver = "tetrahedra";
  return rows;
}

/// A force of 10 kN acts for 3 s on 216 kg. The displacement is F t^2 / 2 m, plus half a substep of motion by
/// a semi-implicit step.
Rows pushed_cubes(const CheckSetting& setting) {
  Rig rig(setting, weightless());
  SolidDesc soft;
  soft.cells = {5, 5, 5};
  soft.total_mass = Real(216);
  soft.young_modulus = Real(1e6);
  const SolidId jelly = rig.add(soft);
  BodyDesc rigid = moving(box_of({0.5, 0.5, 0.5}), {0, 5, 0});
  rigid.mass = Real(216);
  const BodyId box = rig.add(rigid);
  const std::vector<DVec3> start = rig.positions(jelly);
  const auto count = static_cast<std::uint32_t>(start.size());
  for (int i = 0; i < 180; ++i) {
    for (std::uint32_t k = 0; k < count; ++k)
      must(rig.world().apply_force(point(jelly, k), {real(1e4 / count), 0, 0}));
    must(rig.world().apply_force(box, {real(1e4), 0, 0}));
    rig.step();
  }
  double way = 0;
  for (std::uint32_t k = 0; k < count; ++k) way += (rig.positions(jelly)[k].x - start[k].x) / count;
  const double expected = 0.5 * 1e4 / 216 * 9;
  const double momentum = rig.world().measure().momentum.x - 216 * rig.velocity(box).x;
  Rows rows = {relative_row("way of a jelly cube under 10 kN in 3 s", "m", expected, way, 0.01),
               relative_row("its speed", "m/s", 1e4 * 3 / 216, momentum / 216, 0.001),
               relative_row("way of a rigid cube", "m", expected, rig.center(box).x, 0.01)};
  for (CheckRow& row : rows) row.solver = "tetrahedra, bodies";
  return rows;
}

/// A free bar is pulled at both ends by P per area at rest. Stable neo-Hookean matter stretches by s and
/// narrows by t with t^2 = ((lambda + mu) s - mu) / (lambda s^2) and P = mu (s - t^2 / s) (V71 in three
/// dimensions). The stress is even, so the mesh does not matter.
Rows pulled_bar(const CheckSetting& setting) {
  Rows rows;
  for (const double nu : {0.3, 0.45}) {
    const double shear = 1e5 / (2 * (1 + nu));
    const double volume = shear / (1 - 2 * nu);
    const double stretch = 1.05;
    const double narrowing = std::sqrt(((volume + shear) * stretch - shear) / (volume * stretch * stretch));
    const double pull = shear * (stretch - narrowing * narrowing / stretch);

    Rig rig(setting, fine_world({}));
    const SolidId id = rig.add(desc_of({.poisson_ratio = nu}, 60));
    const std::vector<DVec3> rest = rig.positions(id);
    const std::map<std::uint32_t, double> area = areas_of_ends(rig, id, rest);
    for (int i = 0; i < 60; ++i) {
      for (const auto& [index, share] : area)
        must(rig.world().apply_force(point(id, index), {real(pull * share), 0, 0}));
      rig.step();
    }
    const std::string title = "bar of nu = " + std::string(nu < 0.4 ? "0.3" : "0.45") + " pulled by 5 %: ";
    rows.push_back(
        relative_row(title + "strain", "", stretch - 1, stretch_of(rig, id, rest, 0, 0.5) - 1, 0.01));
    rows.push_back(relative_row(title + "lateral strain", "", narrowing - 1,
                                stretch_of(rig, id, rest, 1, 0.125) - 1, 0.01));
  }
  for (CheckRow& row : rows) row.solver = "tetrahedra";
  return rows;
}

/// A bar that hangs by one end lengthens by rho g L^2 / 2 E.
Rows hanging_bar(const CheckSetting& setting) {
  const double expected = kDensity * 1.0 / (2 * 1e5);
  Rows rows;
  for (const int cells : {1, 2}) {
    const double sag = sag_of(setting, {.axis = 1, .cells = cells}, 1, 30, 1);
    rows.push_back(relative_row("bar under its own weight, " + std::to_string(4 * cells) + " cells long", "m",
                                expected, sag, cells == 1 ? 0.06 : 0.03));
  }
  const double shorter =
      -sag_of(setting, {.axis = 1, .cells = 2, .young_modulus = 1e6, .poisson_ratio = 0}, -kGravity, 60, 1);
  rows.push_back(
      relative_row("column that stands, E = 1e6, nu = 0: shortening", "m", 4.905e-3, shorter, 0.02));
  for (CheckRow& row : rows) row.solver = "tetrahedra";
  return rows;
}

/// A cantilever under its own weight sags by q L^4 / 8 E I (Euler and Bernoulli) and, with Timoshenko's
/// shear, by q L^2 / 2 k G A more, k = 10 (1 + nu) / (12 + 11 nu). Tetrahedra of even strain are too stiff in
/// bending; the error goes with the square of the cell size, so two meshes allow an extrapolation.
Rows cantilever_of_jelly(const CheckSetting& setting) {
  const double width = 0.2, e = 2e5, nu = 0.3, g = 0.125;
  const double shear_factor = 10 * (1 + nu) / (12 + 11 * nu);
  const double load = kDensity * g * width * width;
  const double expected = load / (8 * e * std::pow(width, 4) / 12) +
                          load / (2 * shear_factor * e / (2 * (1 + nu)) * width * width);
  std::array<double, 2> sag = {};
  for (const int k : {0, 1}) {
    sag[k] =
        sag_of(setting, {.cells = 2 + k, .length_over_width = 5, .young_modulus = e, .poisson_ratio = nu}, g,
               6, 2.4);
  }
  const CheckRow coarse = relative_row("cantilever of 2 cells across", "m", expected, sag[0], 0.01);
  const CheckRow fine = relative_row("cantilever of 3 cells across", "m", expected, sag[1], 0.01);
  const std::string why = "tetrahedra of even strain lock in bending";
  Rows rows = {known_miss(coarse, why), known_miss(fine, why),
               relative_row("both, extrapolated to cells of no size", "m", expected,
                            (9 * sag[1] - 4 * sag[0]) / 5, 0.06)};
  for (CheckRow& row : rows) row.solver = "tetrahedra";
  return rows;
}

/// A free bar oscillates along its length with the period 2 L / sqrt(E / rho); lateral motion lowers the
/// speed by (nu pi r / L)^2 / 2 with r^2 = b^2 / 6 (Rayleigh, Love). A cube keeps its volume under its own
/// weight.
Rows jelly_wave(const CheckSetting& setting) {
  CheckSetting fast = setting;
  fast.dt = setting.dt / 10;
  Rig rig(fast, weightless());
  const SolidId id = rig.add(desc_of({}, 0));
  const std::vector<DVec3> rest = rig.positions(id);
  for (std::uint32_t i = 0; i < rest.size(); ++i)
    must(rig.world().set_velocity(point(id, i), {real(0.02 * std::sin(kTau / 2 * rest[i].x)), 0, 0}));
  std::vector<double> crossings;
  double last = 0;
  rig.run(0.65, [&] {
    const std::vector<DVec3> now = rig.positions(id);
    double mode = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
      mode += (now[i].x - rest[i].x) * std::sin(kTau / 2 * rest[i].x);
    if (mode * last < 0) crossings.push_back(rig.time() - fast.dt * mode / (mode - last));
    last = mode;
  });
  const double speed = std::sqrt(1e5 / kDensity) * (1 - std::pow(0.3 * kTau / 2, 2) * (0.0625 / 6) / 2);
  const double period = crossings.size() < 3 ? 0
                                             : 2 * (crossings.back() - crossings.front()) /
                                                   static_cast<double>(crossings.size() - 1);
  CheckRow row = relative_row("period of a bar that swings along its length", "s", 2 / speed, period, 0.02);
  row.solver = "tetrahedra";
  row.dt = fast.dt;
  return {row};
}

}  // namespace hooke::check
