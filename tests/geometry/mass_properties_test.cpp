#include "geometry/convex/mass_properties.h"

#include "constants.h"
#include "geometry/meshes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using doctest::Approx;
using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Real;
using hooke::Shape;
using hooke::Vec3;
using hooke::geometry::joined;
using hooke::geometry::mass_of;
using hooke::geometry::MassProperties;
using hooke::geometry::moved;
using Inertia = hooke::math::Symmetric3<double>;

using hooke::test::kPi;

namespace {

MassProperties mass_of_mesh(const MeshDesc& mesh) {
  return mass_of(mesh.positions, mesh.triangles);
}

void check_same(const MassProperties& a, const MassProperties& b, double tolerance) {
  CHECK(a.volume == Approx(b.volume).epsilon(tolerance));
  CHECK(length(a.center - b.center) < tolerance * (1 + length(b.center)));
  const double scale = std::abs(b.inertia.xx) + std::abs(b.inertia.yy) + std::abs(b.inertia.zz);
  const auto near = [&](double p, double q) { CHECK(std::abs(p - q) < tolerance * scale); };
  near(a.inertia.xx, b.inertia.xx);
  near(a.inertia.xy, b.inertia.xy);
  near(a.inertia.xz, b.inertia.xz);
  near(a.inertia.yy, b.inertia.yy);
  near(a.inertia.yz, b.inertia.yz);
  near(a.inertia.zz, b.inertia.zz);
}

/// A solid of revolution about y: the profile's radii at ascending heights, from the axis to the axis.
MeshDesc make_turned(const std::vector<std::array<double, 2>>& profile, std::uint32_t slices) {
  MeshDesc mesh;
  mesh.positions.push_back({Real(0), Real(profile.front()[1]), Real(0)});
  for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
    for (std::uint32_t s = 0; s < slices; ++s) {
      const double angle = 2 * kPi * s / slices;
      mesh.positions.push_back({Real(profile[i][0] * std::cos(angle)), Real(profile[i][1]),
                                Real(profile[i][0] * std::sin(angle))});
    }
  }
  mesh.positions.push_back({Real(0), Real(profile.back()[1]), Real(0)});
  const auto rings = static_cast<std::uint32_t>(profile.size() - 2);
  const auto top = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (std::uint32_t s = 0; s < slices; ++s) {
    const std::uint32_t t = (s + 1) % slices;
    mesh.triangles.push_back({0, 1 + s, 1 + t});
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const std::uint32_t low = 1 + ring * slices;
      const std::uint32_t high = low + slices;
      mesh.triangles.push_back({low + s, high + s, low + t});
      mesh.triangles.push_back({low + t, high + s, high + t});
    }
    const std::uint32_t last = 1 + (rings - 1) * slices;
    mesh.triangles.push_back({top, last + t, last + s});
  }
  return mesh;
}

std::vector<std::array<double, 2>> capsule_profile(double radius, double half_height, int arcs) {
  std::vector<std::array<double, 2>> profile;
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i <= arcs; ++i) {
      const double angle = kPi / 2 * (double(i) / arcs - (side == 0 ? 1 : 0));
      profile.push_back(
          {radius * std::cos(angle), radius * std::sin(angle) + (side == 0 ? -half_height : half_height)});
    }
  }
  return profile;
}

void check_identity(const hooke::Quaternion<double>& q) {
  CHECK(q == hooke::Quaternion<double>{});
}

}  // namespace

TEST_SUITE("geometry/mass_properties") {
  TEST_CASE("primitives have the textbook's volumes and inertias") {
    const MassProperties sphere = mass_of(Shape::sphere(1));
    CHECK(sphere.volume == Approx(4 * kPi / 3).epsilon(1e-14));
    CHECK(sphere.inertia.xx == Approx(0.4 * sphere.volume).epsilon(1e-14));
    CHECK(sphere.inertia.yy == sphere.inertia.xx);
    const MassProperties box = mass_of(Shape::box({1, 2, 3}));
    CHECK(box.volume == 48.0);
    CHECK(1234 * box.inertia.xx == Approx(256672).epsilon(1e-14));
    CHECK(1234 * box.inertia.yy == Approx(197440).epsilon(1e-14));
    CHECK(1234 * box.inertia.zz == Approx(98720).epsilon(1e-14));
    // m (3 r^2 + (2 h)^2) / 12 and m r^2 / 2.
    const MassProperties cylinder = mass_of(Shape::cylinder(2, 3));
    CHECK(cylinder.volume == Approx(24 * kPi).epsilon(1e-14));
    CHECK(cylinder.inertia.xx == Approx(cylinder.volume * (3 * 4 + 36) / 12).epsilon(1e-14));
    CHECK(cylinder.inertia.yy == Approx(cylinder.volume * 2).epsilon(1e-14));
    // Of height 4: the center 1 above the base; 3/20 m r^2 + 3/80 m (2 h)^2 and 3/10 m r^2.
    const MassProperties cone = mass_of(Shape::cone(3, 2));
    CHECK(cone.volume == Approx(12 * kPi).epsilon(1e-14));
    CHECK(cone.center == DVec3{0, -1, 0});
    CHECK(cone.inertia.xx == Approx(cone.volume * (3.0 / 20 * 9 + 3.0 / 80 * 16)).epsilon(1e-14));
    CHECK(cone.inertia.yy == Approx(cone.volume * 2.7).epsilon(1e-14));
    const MassProperties capsule = mass_of(Shape::capsule(3, 5));
    CHECK(7 * capsule.volume == Approx(2770.8847).epsilon(1e-7));
    CHECK(7 * capsule.inertia.xx == Approx(52495.071).epsilon(1e-7));
    CHECK(7 * capsule.inertia.yy == Approx(11756.468).epsilon(1e-7));
    CHECK(7 * capsule.inertia.zz == Approx(52495.071).epsilon(1e-7));
  }

  TEST_CASE("a half-space, and a shape that is only named, has no mass") {
    CHECK(mass_of(Shape::half_space()).volume == 0);
    CHECK(mass_of(Shape::hull_of({})).volume == 0);
    CHECK(mass_of(std::span<const Vec3>{}, {}).volume == 0);
    CHECK(mass_of(hooke::geometry::ConvexHull{}).volume == 0);
    const MeshDesc sheet = hooke::test::make_grid(3, 3, 1);
    CHECK(mass_of_mesh(sheet).volume == 0);
    CHECK(mass_of_mesh(sheet).center == DVec3{});
  }

  TEST_CASE("meshes of primitives converge to their closed forms") {
    const double r = 0.5;
    const double h = 0.7;
    check_same(mass_of_mesh(make_turned(capsule_profile(r, h, 64), 256)),
               mass_of(Shape::capsule(Real(r), Real(h))), 1e-3);
    check_same(mass_of_mesh(make_turned({{0, -h}, {r, -h}, {0, h}}, 512)),
               mass_of(Shape::cone(Real(r), Real(h))), 1e-3);
    check_same(mass_of_mesh(make_turned({{0, -h}, {r, -h}, {r, h}, {0, h}}, 512)),
               mass_of(Shape::cylinder(Real(r), Real(h))), 1e-3);
  }

  TEST_CASE("the corner tetrahedron has the textbook's moments") {
    const MeshDesc mesh = {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                           .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const MassProperties solid = mass_of_mesh(mesh);
    CHECK(solid.volume == Approx(1.0 / 6).epsilon(1e-14));
    CHECK(length(solid.center - DVec3{0.25, 0.25, 0.25}) < 1e-15);
    CHECK(solid.inertia.xx == Approx(1.0 / 80).epsilon(1e-13));
    // The integral of x y about the center is -1/480: the element of the inertia matrix is its negative.
    CHECK(solid.inertia.xy == Approx(1.0 / 480).epsilon(1e-13));
    check_same(mass_of(hooke::geometry::make_convex_hull(mesh.positions).value()), solid, 1e-13);
  }

  TEST_CASE("a cube of triangles has the cube's mass to 1e-12, near and far") {
    const MassProperties cube = mass_of(Shape::box({Real(0.5), Real(0.5), Real(0.5)}));
    MeshDesc mesh = hooke::test::make_cube(Real(0.5));
    check_same(mass_of_mesh(mesh), cube, 1e-12);
    for (Vec3& p : mesh.positions) p += {1000, -2000, 500};
    check_same(mass_of_mesh(mesh), moved(cube, {}, {1000, -2000, 500}), 1e-12);
  }

  TEST_CASE("a hull has the mass of its mesh, an inside-out mesh the negative one") {
    MeshDesc mesh = hooke::test::make_sphere(2);
    for (Vec3& p : mesh.positions) p = {p.x + 3, 2 * p.y, p.z};
    const auto hull = hooke::geometry::make_convex_hull(mesh.positions);
    REQUIRE(hull.has_value());
    const MassProperties solid = mass_of_mesh(mesh);
    check_same(mass_of(hull.value()), solid, 1e-4);
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    const MassProperties inside_out = mass_of_mesh(mesh);
    CHECK(inside_out.volume == Approx(-solid.volume));
    CHECK(inside_out.inertia.yy == Approx(-solid.inertia.yy));
    CHECK(length(inside_out.center - solid.center) < 1e-12);
  }

  TEST_CASE("a small sphere far off keeps its digits") {
    const MassProperties sphere = moved(mass_of(Shape::sphere(Real(0.5))), {}, {100, -50, 75});
    CHECK(sphere.center == DVec3{100, -50, 75});
    CHECK(sphere.inertia.xx == Approx(0.1 * sphere.volume).epsilon(1e-14));
  }

  TEST_CASE("a box cut in two and joined again is the box") {
    const MassProperties whole = mass_of(Shape::box({2, 1, Real(0.5)}));
    const MassProperties half = mass_of(Shape::box({1, 1, Real(0.5)}));
    const MassProperties both = joined(moved(half, {}, {-1, 0, 0}), 1, moved(half, {}, {1, 0, 0}), 1);
    check_same(both, whole, 1e-14);
  }

  TEST_CASE("eight spheres on the corners of a cube have 8 (2/5 m r^2) + 16 m h^2") {
    const double h = 3;
    const MassProperties sphere = mass_of(Shape::sphere(1));
    MassProperties sum;
    for (int i = 0; i < 8; ++i) {
      const DVec3 corner = {(i & 1) != 0 ? h : -h, (i & 2) != 0 ? h : -h, (i & 4) != 0 ? h : -h};
      sum = joined(sum, 1, moved(sphere, {}, corner), 1);
    }
    CHECK(length(sum.center) < 1e-14);
    CHECK(sum.inertia.xx == Approx(sphere.volume * (8 * 0.4 + 16 * h * h)).epsilon(1e-13));
    CHECK(std::abs(sum.inertia.xy) < 1e-12);
  }

  TEST_CASE("joining weighs with the densities") {
    const MassProperties ball = mass_of(Shape::sphere(1));
    const MassProperties pair = joined(moved(ball, {}, {-1, 0, 0}), 1, moved(ball, {}, {1, 0, 0}), 3);
    CHECK(pair.volume == Approx(4 * ball.volume));
    CHECK(pair.center.x == Approx(0.5));
    // Reduced mass 3/4 over a distance of 2.
    CHECK(pair.inertia.yy == Approx(ball.volume * (4 * 0.4 + 0.75 * 4)));
    CHECK(pair.inertia.xx == Approx(ball.volume * 4 * 0.4));
    CHECK(joined({}, 1, {}, 1).volume == 0);
  }

  TEST_CASE("turning a solid turns its axes") {
    const MassProperties box = mass_of(Shape::box({1, 2, 3}));
    // A quarter turn about z: x becomes y.
    const MassProperties turned = moved(box, hooke::quaternion_about(Vec3{0, 0, 1}, Real(kPi / 2)), {});
    CHECK(turned.inertia.xx == Approx(box.inertia.yy).epsilon(1e-6));
    CHECK(turned.inertia.yy == Approx(box.inertia.xx).epsilon(1e-6));
    const MassProperties cone =
        moved(mass_of(Shape::cone(1, 2)), hooke::quaternion_about(Vec3{0, 0, 1}, Real(kPi / 2)), {0, 5, 0});
    CHECK(length(cone.center - DVec3{1, 5, 0}) < 1e-6);
  }

  TEST_CASE("principal axes of a turned solid are its own axes") {
    const MassProperties box = mass_of(Shape::box({1, 2, 3}));
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
      CAPTURE(i);
      const auto next = [&] { return Real(double(random()) / 2147483648.0 - 1.0); };
      const hooke::Quat q = normalize(hooke::Quat{next(), next(), next(), next()});
      const Inertia matrix = moved(box, q, {}).inertia;
      const auto [rotation, moments] = hooke::geometry::principal_axes(matrix);
      const auto axes = hooke::matrix_of(rotation);
      CHECK(determinant(axes) == Approx(1.0).epsilon(1e-12));
      CHECK(rotation.w >= 0);
      CHECK(length(matrix * axes.x - moments.x * axes.x) < 1e-10);
      CHECK(length(matrix * axes.y - moments.y * axes.y) < 1e-10);
      CHECK(length(matrix * axes.z - moments.z * axes.z) < 1e-10);
      std::array<double, 3> sorted = {moments.x, moments.y, moments.z};
      std::sort(sorted.begin(), sorted.end());
      CHECK(sorted[0] == Approx(box.inertia.zz).epsilon(1e-12));
      CHECK(sorted[1] == Approx(box.inertia.yy).epsilon(1e-12));
      CHECK(sorted[2] == Approx(box.inertia.xx).epsilon(1e-12));
    }
  }

  TEST_CASE("principal axes of upright and isotropic solids are exactly the given axes") {
    const auto upright = hooke::geometry::principal_axes(mass_of(Shape::box({3, 1, 2})).inertia);
    check_identity(upright.rotation);
    CHECK(upright.moments.x == mass_of(Shape::box({3, 1, 2})).inertia.xx);
    check_identity(
        hooke::geometry::principal_axes(mass_of_mesh(hooke::test::make_cube(Real(0.3))).inertia).rotation);
    check_identity(hooke::geometry::principal_axes({}).rotation);
    check_identity(hooke::geometry::principal_axes({2, 1e-14, -1e-14, 2, 1e-14, 2}).rotation);
  }

  TEST_CASE("almost equal and very unequal moments have principal axes") {
    for (const Inertia& matrix : {Inertia{1, 1e-9, 1e-9, 1, 1e-9, 1}, Inertia{1, 0.5, 0, 1, 0, 1e-8},
                                  Inertia{1e12, 1, 1, 1, 0.1, 1e-3}, Inertia{0, 1, 0, 0, 0, 0}}) {
      const auto [rotation, moments] = hooke::geometry::principal_axes(matrix);
      const auto axes = hooke::matrix_of(rotation);
      const double scale = std::abs(matrix.xx) + std::abs(matrix.xy) + std::abs(matrix.zz);
      CHECK(length(matrix * axes.x - moments.x * axes.x) < 1e-12 * scale);
      CHECK(length(matrix * axes.y - moments.y * axes.y) < 1e-12 * scale);
      CHECK(length(matrix * axes.z - moments.z * axes.z) < 1e-12 * scale);
    }
  }

  TEST_CASE("matter has moments that a surface which crosses itself may not have") {
    using hooke::geometry::is_physical;
    CHECK(is_physical(mass_of(Shape::cylinder(1, Real(1e-5)))));
    CHECK(is_physical(mass_of(Shape::cylinder(Real(1e-5), 1))));
    MeshDesc ring = hooke::test::make_torus(1, Real(0.2), 12, 6);
    CHECK(is_physical(mass_of_mesh(ring)));
    MeshDesc inside_out = ring;
    for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
    CHECK_FALSE(is_physical(mass_of_mesh(inside_out)));
    ring.positions[2].z = 64;
    const auto crossing = mass_of_mesh(ring);
    CHECK(crossing.volume > 0);
    CHECK_FALSE(is_physical(crossing));
    CHECK_FALSE(is_physical({}));
  }

  TEST_CASE("the paper's center, the mean of the vertices, is where the vertices are") {
    // A cube of side 1 at 0, a ball of radius 0.5 at x = 3 and a thin rod between them: the center of volume
    // is at 1.036, the mean of the vertices at 2.976, because the ball has almost all of them.
    const MassProperties cube = mass_of(Shape::box({Real(0.5), Real(0.5), Real(0.5)}));
    const MassProperties ball = moved(mass_of(Shape::sphere(Real(0.5))), {}, {3, 0, 0});
    const MassProperties rod = moved(mass_of(Shape::cylinder(Real(0.05), 1)),
                                     hooke::quaternion_about(Vec3{0, 0, 1}, Real(kPi / 2)), {1.5, 0, 0});
    const MassProperties solid = joined(joined(cube, 1, ball, 1), 1, rod, 1);
    CHECK(std::abs(solid.center.x - 1.036) < 5e-4);

    std::vector<Vec3> vertices = hooke::test::make_cube(Real(0.5)).positions;
    const auto add = [&](const MeshDesc& mesh, Vec3 shift) {
      for (const Vec3 p : mesh.positions) vertices.push_back({p.y + shift.x, p.x + shift.y, p.z + shift.z});
    };
    std::vector<std::array<double, 2>> circle;  // 32 stacks from pole to pole
    for (int i = 0; i <= 32; ++i)
      circle.push_back({0.5 * std::sin(kPi * i / 32), -0.5 * std::cos(kPi * i / 32)});
    add(make_turned(circle, 64), {3, 0, 0});
    for (int i = 0; i < 16; ++i)
      vertices.push_back({i < 8 ? Real(0.5) : Real(2.5), 0, 0});  // the rod's two octagons
    CHECK(std::abs(hooke::geometry::vertex_average(vertices).x - 2.976) < 5e-4);
    CHECK(hooke::geometry::vertex_average({}) == DVec3{});
  }
}
