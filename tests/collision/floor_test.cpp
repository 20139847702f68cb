#include "collision/pairs.h"
#include "collision/scene.h"

#include <cmath>
#include <doctest/doctest.h>
#include <memory>
#include <string>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Quat;
using hooke::Real;
using hooke::Shape;
using hooke::ShapeKind;
using hooke::Vec3;
using hooke::state::Manifold;
using hooke::test::PairScene;

namespace {

/// A quad facing up, in two triangles with vertices of their own.
void add_quad(MeshDesc& mesh, double x0, double x1, double z0, double z1) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto place = [](double x, double z) { return Vec3{Real(x), Real(0), Real(z)}; };
  mesh.positions.insert(mesh.positions.end(), {place(x0, z0), place(x0, z1), place(x1, z1), place(x1, z0)});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A flat floor from x = -3 to 3 whose strips are cut differently: T-junctions at every seam, no vertex
/// shared.
MeshDesc make_cut_floor() {
  MeshDesc mesh;
  for (int strip = 0; strip < 6; ++strip) {
    const int pieces = 3 + 2 * (strip % 3);
    for (int i = 0; i < pieces; ++i) {
      const double z0 = -2 + 4.0 * i / pieces;
      add_quad(mesh, strip - 3, strip - 2, z0, z0 + 4.0 / pieces);
    }
  }
  return mesh;
}

struct Slider {
  const char* name;
  Shape shape;
  Quat turn;
  double rest;  ///< Height of its center when it touches the floor.
};

std::vector<Slider> make_sliders() {
  const Quat lying = hooke::quaternion_about(Vec3{Real(1), Real(0), Real(0)}, Real(1.57079633));
  const Quat turned = hooke::quaternion_about(Vec3{Real(0), Real(1), Real(0)}, Real(0.3));
  return {{"sphere", Shape::sphere(Real(0.3)), {}, 0.3},
          {"box", Shape::box({Real(0.3), Real(0.2), Real(0.4)}), turned, 0.2},
          {"box along", Shape::box({Real(0.3), Real(0.2), Real(0.4)}), {}, 0.2},
          {"capsule", Shape::capsule(Real(0.2), Real(0.3)), lying, 0.2},
          {"cylinder", Shape::cylinder(Real(0.3), Real(0.2)), {}, 0.2},
          {"lying cylinder", Shape::cylinder(Real(0.3), Real(0.2)), lying, 0.3},
          {"cone", Shape::cone(Real(0.3), Real(0.2)), {}, 0.2}};
}

/// Slides over the floor in steps of a few centimeters, with the speed that goes with them.
void slide(PairScene& scene, const Slider& slider, double depth) {
  CAPTURE(std::string(slider.name));
  CAPTURE(depth);
  const std::uint32_t body = scene.add_dynamic(slider.shape, {-2, slider.rest - depth, 0.137}, slider.turn);
  scene.bodies.motion[body].v = {Real(2.2), Real(0), Real(0.3)};
  const double h = 1.0 / 60;
  for (int step = 0; step < 100; ++step) {
    scene.update(Real(h));
    CAPTURE(step);
    CHECK(scene.pairs.manifold.size() >= 1);
    double deepest = 1;
    for (const Manifold& m : scene.pairs.manifold) {
      const Vec3 up = m.body_b == body ? m.normal : -m.normal;
      CHECK(std::fabs(up.x) + std::fabs(up.z) < 1e-4);
      CHECK(up.y > Real(0.999));
      for (int i = 0; i < m.point_count; ++i) {
        deepest = std::min(deepest, double(m.point[static_cast<std::size_t>(i)].separation));
      }
    }
    CHECK(std::fabs(deepest + depth) < 1e-5);
    scene.move(body, {2.2 * h, 0, 0.3 * h});
  }
}

}  // namespace

TEST_SUITE("collision/floor") {
  TEST_CASE("what slides over a flat mesh feels none of its edges, T-junctions included") {
    for (const Slider& slider : make_sliders()) {
      for (const double depth : {1e-4, -1e-4}) {
        PairScene scene;
        scene.add_mesh(make_cut_floor());
        slide(scene, slider, depth);
      }
    }
  }

  TEST_CASE("what slides over a floor of several boxes feels none of their edges") {
    for (const Slider& slider : make_sliders()) {
      for (const double depth : {1e-4, -1e-4}) {
        PairScene scene;
        for (int i = -3; i < 3; ++i) {
          scene.add_static(Shape::box({Real(0.5), Real(0.25), Real(1)}), {i + 0.5, -0.25, 1.1});
          scene.add_static(Shape::box({Real(0.5), Real(0.5), Real(1)}), {i + 0.5, -0.5, -0.9});
        }
        slide(scene, slider, depth);
      }
    }
  }

  TEST_CASE("what slides from one mesh to another feels nothing") {
    for (const Slider& slider : make_sliders()) {
      PairScene scene;
      scene.add_mesh(make_cut_floor(), {-3, 0, 0});
      scene.add_mesh(make_cut_floor(), {3, 0, 0});
      slide(scene, slider, 1e-4);
    }
  }

  TEST_CASE("a wall on the floor and a step of a centimeter are felt") {
    for (const double height : {0.01, 1.0}) {
      PairScene scene;
      scene.add_mesh(make_cut_floor());
      const Real half = Real(height / 2);
      scene.add_static(Shape::box({Real(0.1), half, Real(1)}), {1, height / 2, 0});
      const std::uint32_t box =
          scene.add_dynamic(Shape::box({Real(0.3), Real(0.2), Real(0.4)}), {0.595, 0.2, 0});
      scene.update();
      CHECK(scene.counts.ghosts == 0);
      bool is_felt = false;
      for (const Manifold& m : scene.pairs.manifold) {
        const Vec3 out = m.body_b == box ? m.normal : -m.normal;
        is_felt = is_felt || out.x < Real(-0.99);
      }
      CHECK(is_felt);
    }
  }

  TEST_CASE("a box on a mesh of many triangles rests on its own corners, on either side of the pair") {
    for (const bool mesh_first : {true, false}) {
      PairScene scene;
      if (mesh_first) scene.add_mesh(make_cut_floor());
      const std::uint32_t box =
          scene.add_dynamic(Shape::box({Real(0.7), Real(0.2), Real(0.9)}), {0.03, 0.1999, 0.05});
      if (!mesh_first) scene.add_mesh(make_cut_floor());
      scene.update();
      REQUIRE(scene.pairs.manifold.size() == 1);
      const Manifold& m = scene.pairs.manifold[0];
      CHECK(m.normal.y == (mesh_first ? Real(1) : Real(-1)));
      REQUIRE(m.point_count == 4);
      for (const auto& p : m.point) {
        const Vec3 anchor = m.body_b == box ? p.anchor_b : p.anchor_a;
        CHECK(std::fabs(anchor.x) == doctest::Approx(0.7));
        CHECK(std::fabs(anchor.z) == doctest::Approx(0.9));
        CHECK(double(p.separation) == doctest::Approx(-1e-4).epsilon(0.01).scale(0));
      }
    }
  }

  TEST_CASE("a sphere on a bent mesh is touched along its radius: its spin brings nothing nearer") {
    // A trough of narrow strips. A tenth of a millimeter beside the radius, a ball that rolls at 6 m/s came
    // nearer by 10 mm/s, and lost 1.5 % of its energy in a loop.
    constexpr int kStrips = 400;
    MeshDesc trough;
    for (std::uint32_t i = 0; i <= kStrips; ++i) {
      const double angle = 2.0 * i / kStrips - 1;
      for (const double z : {-0.3, 0.3})
        trough.positions.push_back({Real(std::sin(angle)), Real(1 - std::cos(angle)), Real(z)});
      if (i == kStrips) break;
      trough.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 2});
      trough.triangles.push_back({2 * i + 1, 2 * i + 3, 2 * i + 2});
    }
    for (int i = 0; i < 40; ++i) {
      PairScene scene;
      scene.add_mesh(trough);
      const double angle = 0.037 * i - 0.7;
      const double way = 1 - 0.05 + 2e-4;  // of the center about the trough's
      scene.add_dynamic(Shape::sphere(Real(0.05)),
                        {way * std::sin(angle), 1 - way * std::cos(angle), 0.011 * i - 0.2});
      scene.update();
      REQUIRE_FALSE(scene.pairs.manifold.empty());
      for (const Manifold& m : scene.pairs.manifold) {
        for (int k = 0; k < m.point_count; ++k)
          CHECK(length(cross(m.point[static_cast<std::size_t>(k)].anchor_b, m.normal)) < 1e-6);
      }
    }
  }

  TEST_CASE("in the edge between two walls that it overlaps, a box is pressed out along their fronts only") {
    // Over its rim, the way out of one wall is the shorter the nearer the other is.
    MeshDesc edge;
    const auto add = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
      const auto first = static_cast<std::uint32_t>(edge.positions.size());
      edge.positions.insert(edge.positions.end(), {a, b, c, d});
      edge.triangles.push_back({first, first + 1, first + 2});
      edge.triangles.push_back({first, first + 2, first + 3});
    };
    const Real o = Real(0);
    const Real l = Real(1);
    add({o, o, -l}, {o, o, l}, {l, o, l}, {l, o, -l});  // looks up
    add({o, o, -l}, {o, l, -l}, {o, l, l}, {o, o, l});  // looks along x
    for (int i = 0; i < 50; ++i) {
      CAPTURE(i);
      PairScene scene;
      scene.add_mesh(edge);
      const double deep = 1e-3 * (1 + i % 10);
      scene.add_dynamic(Shape::box({Real(0.02), Real(0.02), Real(0.1)}),
                        {0.02 - deep, 0.02 - deep, 0.013 * i - 0.3},
                        hooke::quaternion_about(Vec3{Real(0), Real(0), Real(1)}, Real(0.03 * i)));
      scene.update();
      CHECK_FALSE(scene.pairs.manifold.empty());
      for (const Manifold& m : scene.pairs.manifold) {
        CHECK(m.normal.x > Real(-1e-3));
        CHECK(m.normal.y > Real(-1e-3));
      }
    }
  }

  TEST_CASE("a sphere in a groove has a contact on both sides, over a ridge one, from below none") {
    const auto add_roof = [](PairScene& scene, double slope) {
      MeshDesc mesh;
      const auto place = [&](double x, double z) {
        return Vec3{Real(x), Real(-slope * std::fabs(x)), Real(z)};
      };
      mesh.positions = {place(-2, -2), place(-2, 2), place(0, 2), place(0, -2), place(2, 2), place(2, -2)};
      mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
      scene.add_mesh(mesh);
    };
    const Shape ball = Shape::sphere(Real(0.5));
    PairScene groove;
    add_roof(groove, -1);
    groove.add_dynamic(ball, {0, 0.5 * std::sqrt(2.0) - 0.001, 0.1});
    groove.update();
    REQUIRE(groove.pairs.manifold.size() == 2);
    for (const Manifold& m : groove.pairs.manifold) {
      CHECK(m.point_count == 1);
      CHECK(double(m.normal.y) == doctest::Approx(std::sqrt(0.5)));
    }
    PairScene ridge;
    add_roof(ridge, 1);
    const std::uint32_t over = ridge.add_dynamic(ball, {0.1, std::sqrt(0.24) - 0.001, 0.1});
    ridge.update();
    REQUIRE(ridge.pairs.manifold.size() == 1);
    CHECK(double(ridge.pairs.manifold[0].normal.x) == doctest::Approx(0.2).epsilon(0.01).scale(0));
    ridge.bodies.center[over] = {0, -0.6, 0.1};
    ridge.update();
    CHECK(ridge.pairs.manifold.empty());
  }
}
