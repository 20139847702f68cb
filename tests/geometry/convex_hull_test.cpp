#include "geometry/convex/convex_hull.h"

#include "geometry/convex/mass_properties.h"
#include "geometry/meshes.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>

using hooke::Real;
using hooke::Vec3;
using hooke::geometry::ConvexHull;
using hooke::geometry::make_convex_hull;

namespace {

using Points = std::vector<Vec3>;

ConvexHull hull_of(const Points& points) {
  auto hull = make_convex_hull(points);
  REQUIRE(hull.has_value());
  return std::move(hull).value();
}

std::string error_of(const Points& points) {
  const auto hull = make_convex_hull(points);
  REQUIRE_FALSE(hull.has_value());
  return hull.error().where + ": " + hull.error().message;
}

double volume_of(const ConvexHull& hull) {
  return hooke::geometry::mass_of(hull).volume;
}

double extent_of(const Points& points) {
  double extent = 0;
  for (const Vec3 p : points) {
    const Vec3 d = p - points[0];
    extent = std::max({extent, std::abs(double(d.x)), std::abs(double(d.y)), std::abs(double(d.z))});
  }
  return extent;
}

/// Three faces at each vertex, three vertices on each face, two faces at each edge, one surface.
void check_structure(const ConvexHull& hull) {
  CHECK(hull.vertices.size() <= std::size_t{ConvexHull::kMaxVertices});
  CHECK(hull.vertices.size() + hull.faces.size() - hull.edges.size() == 2);
  std::map<std::pair<int, int>, int> face_of_side;
  std::vector<int> faces_at(hull.vertices.size(), 0);
  std::size_t first = 0;
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const auto& face = hull.faces[f];
    CHECK(face.first == first);
    CHECK(face.count >= 3);
    first += face.count;
    for (std::size_t k = 0; k < face.count; ++k) {
      const int a = hull.loop[face.first + k];
      const int b = hull.loop[face.first + (k + 1) % face.count];
      CHECK(face_of_side.try_emplace({a, b}, int(f)).second);
      ++faces_at[std::size_t(a)];
    }
  }
  CHECK(hull.loop.size() == first);
  CHECK(2 * hull.edges.size() == first);
  for (const auto& edge : hull.edges) {
    CHECK(edge.vertex_a < edge.vertex_b);
    CHECK(face_of_side.at({edge.vertex_a, edge.vertex_b}) == edge.face_a);
    CHECK(face_of_side.at({edge.vertex_b, edge.vertex_a}) == edge.face_b);
  }
  for (const int count : faces_at) CHECK(count >= 3);
}

/// How far the corner of the face that reaches in most lies inside the line between its neighbors.
double dent_of(const ConvexHull& hull, const ConvexHull::Face& face) {
  const auto corner = [&](std::size_t k) {
    return hooke::vector_cast<double>(hull.vertices[hull.loop[face.first + k % face.count]]);
  };
  double dent = 0;
  for (std::size_t k = 0; k < face.count; ++k) {
    const hooke::DVec3 along = corner(k + 2) - corner(k);
    const hooke::DVec3 inward = cross(hooke::vector_cast<double>(face.normal), along);
    dent = std::max(dent, dot(normalize(inward), corner(k + 1) - corner(k)));
  }
  return dent;
}

/// Planes have unit normals, hold their own vertices and have all others below them; faces are convex.
void check_planes(const ConvexHull& hull, double extent, double magnitude) {
  const double slack =
      3 * ConvexHull::kTolerance * extent + 4 * std::numeric_limits<Real>::epsilon() * magnitude;
  double above = 0;
  double below = 0;
  double dent = 0;
  for (const auto& face : hull.faces) {
    CHECK(std::abs(double(length(face.normal)) - 1) < 1e-6);
    const auto height = [&](Vec3 p) {
      return dot(hooke::vector_cast<double>(face.normal), hooke::vector_cast<double>(p)) -
             double(face.offset);
    };
    for (const Vec3 v : hull.vertices) above = std::max(above, height(v));
    for (std::size_t k = 0; k < face.count; ++k) {
      below = std::min(below, height(hull.vertices[hull.loop[face.first + k]]));
    }
    dent = std::max(dent, dent_of(hull, face));
  }
  CHECK(above <= slack);
  CHECK(below >= -slack);
  CHECK(dent <= slack);
}

/// How far the farthest point is outside the hull.
double outside(const ConvexHull& hull, const Points& points) {
  double farthest = 0;
  for (const Vec3 p : points) {
    for (const auto& face : hull.faces)
      farthest = std::max(farthest, double(dot(face.normal, p) - face.offset));
  }
  return farthest;
}

ConvexHull checked_hull(const Points& points) {
  const ConvexHull hull = hull_of(points);
  double magnitude = 0;
  for (const Vec3 p : points) magnitude = std::max(magnitude, double(length(p)));
  check_structure(hull);
  check_planes(hull, extent_of(points), magnitude);
  return hull;
}

Points random_points(int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto next = [&] { return Real(double(random()) / 2147483648.0 - 1.0); };
  Points points;
  for (int i = 0; i < count; ++i) points.push_back({next(), next(), next()});
  return points;
}

Points on_sphere(int count, unsigned seed) {
  Points points = random_points(count, seed);
  for (Vec3& p : points) p = normalize(p);
  return points;
}

/// Points of a grid on the surface of and in a cube of side 2.
Points cube_grid(int per_side) {
  Points points;
  const auto place = [&](int i) { return Real(2) * Real(i) / Real(per_side - 1) - Real(1); };
  for (int x = 0; x < per_side; ++x) {
    for (int y = 0; y < per_side; ++y) {
      for (int z = 0; z < per_side; ++z) points.push_back({place(x), place(y), place(z)});
    }
  }
  return points;
}

Points turned(Points points, Vec3 axis, Real angle) {
  const hooke::Quat q = hooke::quaternion_about(axis, angle);
  for (Vec3& p : points) p = rotate(q, p);
  return points;
}

Points prism(int sides, Real radius, Real half_height) {
  Points points;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / sides;
    const Vec3 rim = {radius * Real(std::cos(angle)), half_height, radius * Real(std::sin(angle))};
    points.push_back(rim);
    points.push_back({rim.x, -half_height, rim.z});
  }
  return points;
}

void check_is_cube(const ConvexHull& hull) {
  CHECK(hull.vertices.size() == 8);
  CHECK(hull.faces.size() == 6);
  CHECK(hull.edges.size() == 12);
}

}  // namespace

TEST_SUITE("geometry/convex_hull") {
  TEST_CASE("a tetrahedron is its own hull") {
    const Points points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const ConvexHull hull = checked_hull(points);
    CHECK(hull.vertices.size() == 4);
    CHECK(hull.faces.size() == 4);
    CHECK(volume_of(hull) == doctest::Approx(1.0 / 6).epsilon(1e-14));
    CHECK(double(hull.center.x) == doctest::Approx(0.25).epsilon(1e-6));
    // From the center to the slanted face: (1 - 3/4) / sqrt 3; to the farthest corner: sqrt(11) / 4.
    CHECK(double(hull.inner_radius) == doctest::Approx(0.25 / std::sqrt(3.0)).epsilon(1e-6));
    CHECK(double(hull.outer_radius) == doctest::Approx(std::sqrt(11.0) / 4).epsilon(1e-6));
  }

  TEST_CASE("points inside, on faces and on edges of a cube are no vertices") {
    for (const int per_side : {2, 3, 4, 7, 20}) {
      CAPTURE(per_side);
      const Points points = cube_grid(per_side);
      const ConvexHull hull = checked_hull(points);
      check_is_cube(hull);
      CHECK(volume_of(hull) == 8.0);
      CHECK(hull.inner_radius == Real(1));
      for (const auto& face : hull.faces) CHECK(face.offset == Real(1));
    }
  }

  TEST_CASE("a turned cube, whose faces rounding has bent, is still a cube") {
    for (int i = 0; i < 20; ++i) {
      CAPTURE(i);
      const Points points = turned(cube_grid(3 + i % 4), {Real(1), Real(i), Real(-2)}, Real(0.3 * i + 0.1));
      const ConvexHull hull = checked_hull(points);
      check_is_cube(hull);
      CHECK(volume_of(hull) == doctest::Approx(8.0).epsilon(1e-6));
    }
  }

  TEST_CASE("a cube a million meters away is still a cube") {
    Points points = cube_grid(3);
    for (Vec3& p : points) p += {Real(1e6), Real(-1e6), Real(1e6)};
    const ConvexHull hull = checked_hull(points);
    check_is_cube(hull);
    CHECK(volume_of(hull) == 8.0);
    CHECK(hull.center == Vec3{Real(1e6), Real(-1e6), Real(1e6)});
  }

  TEST_CASE("caps of prisms and cylinders are one face") {
    for (const int sides : {3, 5, 6, 8, 32, 100, 128}) {
      CAPTURE(sides);
      const ConvexHull hull = checked_hull(turned(prism(sides, 1, 1), {1, 2, 3}, Real(0.7)));
      CHECK(hull.vertices.size() == std::size_t(2 * sides));
      CHECK(hull.faces.size() == std::size_t(sides + 2));
      const double area = 0.5 * sides * std::sin(2 * 3.14159265358979323846 / sides);
      CHECK(volume_of(hull) == doctest::Approx(2 * area).epsilon(1e-6));
    }
  }

  TEST_CASE("copies of a point count once") {
    Points points = cube_grid(2);
    points.insert(points.end(), 100000, points[3]);
    check_is_cube(checked_hull(points));
  }

  TEST_CASE("the hull does not depend on the order of the points") {
    Points points = random_points(500, 3);
    const ConvexHull hull = hull_of(points);
    std::mt19937 random(4);
    for (int i = 0; i < 5; ++i) {
      std::shuffle(points.begin(), points.end(), random);
      const ConvexHull again = hull_of(points);
      CHECK(again.vertices == hull.vertices);
      CHECK(again.loop == hull.loop);
      CHECK(again.edges.size() == hull.edges.size());
    }
  }

  TEST_CASE("the hull of random points contains them") {
    for (unsigned seed = 0; seed < 60; ++seed) {
      CAPTURE(seed);
      const Points points = random_points(4 + int(seed), seed);
      const ConvexHull hull = checked_hull(points);
      CHECK(outside(hull, points) < 2 * ConvexHull::kTolerance * extent_of(points));
      const std::set<Real> given = [&] {
        std::set<Real> xs;
        for (const Vec3 p : points) xs.insert(p.x);
        return xs;
      }();
      for (const Vec3 v : hull.vertices) CHECK(given.count(v.x) == 1);
    }
  }

  TEST_CASE("a hundred thousand random points have a hull") {
    const Points points = random_points(100000, 1);
    const ConvexHull hull = checked_hull(points);
    CHECK(volume_of(hull) > 7.9);
    CHECK(volume_of(hull) < 8.0);
    CHECK(outside(hull, points) < 0.01);
  }

  TEST_CASE("a sphere of ten thousand points is reduced and keeps its volume to 2.5 %") {
    const Points points = on_sphere(10000, 2);
    const ConvexHull hull = checked_hull(points);
    CHECK(hull.vertices.size() == std::size_t{ConvexHull::kMaxVertices});
    const double sphere = 4.0 / 3 * 3.14159265358979323846;
    CHECK(volume_of(hull) > 0.975 * sphere);
    CHECK(volume_of(hull) < sphere);
    CHECK(outside(hull, points) < 0.03);
  }

  TEST_CASE("thin plates and needles have a hull down to the limit") {
    const double thin = 2 * ConvexHull::kThicknessMin;
    for (const double angle : {0.0, 0.4, 1.0}) {
      CAPTURE(angle);
      Points plate = cube_grid(2);
      for (Vec3& p : plate) p.y *= Real(thin);
      const ConvexHull hull = checked_hull(turned(plate, {1, 1, 0}, Real(angle)));
      check_is_cube(hull);
      CHECK(volume_of(hull) == doctest::Approx(8 * thin).epsilon(2e-3));
      Points needle = cube_grid(2);
      for (Vec3& p : needle) p = {Real(thin) * p.x, Real(thin) * p.y, p.z};
      check_is_cube(checked_hull(turned(needle, {1, 1, 0}, Real(angle))));
    }
  }

  TEST_CASE("what has no volume is an error") {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    CHECK(error_of({}) == "points: 0 points; a hull needs at least four");
    CHECK(error_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}) == "points: 3 points; a hull needs at least four");
    CHECK(error_of({{0, 0, 0}, {1, 0, 0}, {0, nan, 0}, {0, 0, 1}}) ==
          "points[2]: a coordinate is not finite");
    const std::string flat = "points: the points lie in a plane; a hull is at least 1e-4 of its extent thick";
    CHECK(error_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}) == flat);
    CHECK(error_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {5, 5, 5}}) == flat);
    CHECK(error_of(Points(100000, {3, 4, 5})).starts_with("points: the points are 0"));
    for (const double angle : {0.0, 0.4, 1.0, 2.5}) {
      Points plate = cube_grid(4);
      for (Vec3& p : plate) p.y *= Real(1e-5);
      CHECK(error_of(turned(plate, {1, 1, 0}, Real(angle))) == flat);
      for (Vec3& p : plate) p.z *= Real(1e-5);
      CHECK(error_of(turned(plate, {1, 1, 0}, Real(angle))) == flat);
    }
    CHECK_FALSE(
        make_convex_hull(Points{{0, 0, 0}, {Real(1e30), 0, 0}, {0, Real(1e30), 0}, {0, 0, 1}}).has_value());
  }

  TEST_CASE("point sets that are known to be hard have a proper hull or none") {
    // Five points almost in a plane, a prism with rounded coordinates, and a rod whose sides are warped.
    const Points five = {{Real(1), Real(-1.42292389), Real(1.30826111)},
                         {Real(.995354385), Real(-.713011093), Real(1.30826111)},
                         {Real(.995930862), Real(-.801112213), Real(-1)},
                         {Real(1), Real(-1.42292389), Real(-1)},
                         {Real(.995930862), Real(-.801112213), Real(1.30826111)}};
    const Points thirteen = {{Real(.100183107), Real(-498.925385), Real(-1275.39966)},
                             {Real(.100183107), Real(-498.925415), Real(.125)},
                             {Real(.100183107), Real(486.34375), Real(.125)},
                             {Real(.100183107), Real(486.343719), Real(-1275.39966)},
                             {Real(-395.117462), Real(486.343781), Real(-1462.4375)},
                             {Real(-395.117462), Real(486.34375), Real(-96.7426758)},
                             {Real(-395.117462), Real(-498.925415), Real(-96.7424469)},
                             {Real(-395.117462), Real(-498.925446), Real(-1462.52612)},
                             {Real(-186.979691), Real(486.294891), Real(-1462.47949)},
                             {Real(-298.25), Real(486.294891), Real(.125)},
                             {Real(-395.121216), Real(486.294891), Real(-1462.52612)},
                             {Real(-186.98436), Real(-498.913361), Real(-1462.48413)},
                             {Real(-298.25), Real(-498.913361), Real(.125)}};
    const Points sliver = {{Real(-11.3861933), Real(-24.2451687), Real(-12.0037909)},
                           {Real(-11.3889809), Real(-24.2466526), Real(-11.9013014)},
                           {Real(-11.3804407), Real(-24.3151531), Real(-12.0046492)},
                           {Real(-11.3832273), Real(-24.3166409), Real(-11.9021587)},
                           {Real(-14.43962), Real(-24.3636723), Real(-12.1324549)},
                           {Real(-14.443265), Real(-24.3655701), Real(-12.0299988)},
                           {Real(-14.4356947), Real(-24.4337788), Real(-12.1336164)},
                           {Real(-14.4393377), Real(-24.4356804), Real(-12.0311594)}};
    CHECK(error_of(five).starts_with("points: the points lie in a plane"));
    CHECK(outside(checked_hull(thirteen), thirteen) < 0.1);
    CHECK(checked_hull(sliver).vertices.size() == 8);
  }

  TEST_CASE("faces that are almost in one plane make a proper hull") {
    // A cube with points pushed out of one face by about the tolerance, and a shallow dome over it.
    std::mt19937 random(5);
    for (int round = 0; round < 300; ++round) {
      CAPTURE(round);
      Points points = cube_grid(2);
      const double height = ConvexHull::kTolerance * 2 * std::pow(10.0, double(random() % 400) / 100.0 - 2);
      for (int i = 0; i < 30; ++i) {
        const double x = double(random()) / 2147483648.0 - 1.0;
        const double z = double(random()) / 2147483648.0 - 1.0;
        const double noise = double(random()) / 4294967296.0;
        const double up = round % 2 == 0 ? noise : (1 - x * x) * (1 - z * z);
        points.push_back({Real(x), Real(1 + height * up), Real(z)});
      }
      points = turned(points, {Real(random() % 7), 1, Real(0.5)}, Real(random() % 100));
      const ConvexHull hull = checked_hull(points);
      CHECK(outside(hull, points) < 4 * ConvexHull::kTolerance * extent_of(points));
      CHECK(volume_of(hull) > 8 - 1e-3);
    }
  }

  TEST_CASE("a box hull is the hull of its corners") {
    const ConvexHull box = hooke::geometry::make_box_hull({1, 2, 3});
    check_structure(box);
    check_planes(box, 6, 6);
    CHECK(volume_of(box) == 48.0);
    CHECK(box.center == Vec3{});
    CHECK(box.inner_radius == Real(1));
    CHECK(double(box.outer_radius) == doctest::Approx(std::sqrt(14.0)).epsilon(1e-6));
    // However thin.
    check_structure(hooke::geometry::make_box_hull({1, Real(1e-7), 1}));
  }

  TEST_CASE("the support is the vertex farthest along a direction") {
    const ConvexHull box = hooke::geometry::make_box_hull({1, 2, 3});
    for (const Vec3 corner : box.vertices) {
      CHECK(box.vertices[support(box, corner)] == corner);
      CHECK(box.vertices[support(box, Real(1e-3) * corner)] == corner);
    }
    // All four corners of a face are equally far, and all eight along nothing.
    CHECK(support(box, {1, 0, 0}) == 1);
    CHECK(support(box, {}) == 0);
    const Points points = on_sphere(100, 6);
    const ConvexHull hull = hull_of(points);
    for (const Vec3 direction : random_points(100, 7)) {
      const Vec3 found = hull.vertices[support(hull, direction)];
      for (const Vec3 p : points) CHECK(dot(direction, p) <= dot(direction, found));
    }
  }
}
