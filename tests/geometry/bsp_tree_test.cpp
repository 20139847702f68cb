#include "geometry/bsp/bsp_tree.h"

#include "geometry/building.h"
#include "geometry/closest.h"
#include "geometry/solids.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

using hooke::BspCrossing;
using hooke::BspTree;
using hooke::cast_ray;
using hooke::DVec3;
using hooke::is_solid_at;
using hooke::load_bsp;
using hooke::move_point;
using hooke::move_sphere;
using hooke::save_bsp;
using hooke::geometry::build_bsp;
using hooke::geometry::SolidMesh;
using hooke::test::make_box;

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

BspTree tree_of(const SolidMesh& mesh) {
  const auto tree = build_bsp(mesh);
  if (!tree) FAIL(tree.error().where << " " << tree.error().message);
  return tree.value();
}

std::string error_of(const SolidMesh& mesh) {
  const auto tree = build_bsp(mesh);
  return tree ? "none" : tree.error().where + ": " + tree.error().message;
}

struct Solid {
  std::string name;
  SolidMesh mesh;
};

/// On a grid of 2^-20 m: what is moved to the lattice stays where it is.
SolidMesh rounded(SolidMesh mesh) {
  const auto round = [](double x) { return std::ldexp(std::round(std::ldexp(x, 20)), -20); };
  for (DVec3& p : mesh.positions) p = {round(p.x), round(p.y), round(p.z)};
  return mesh;
}

/// Convex and concave, with a hole, with a cavity, in several shells, with many faces in one plane.
std::vector<Solid> make_solids() {
  std::mt19937 random(7);
  using hooke::test::inside_out;
  using hooke::test::joined;
  const SolidMesh ball = hooke::geometry::solid_mesh_of(hooke::test::make_sphere(2));
  std::vector<Solid> solids = {
      {"ball", ball},
      {"star", hooke::test::make_star(2, 0.3, random)},
      {"ring", hooke::test::make_ring(24, 0.6, 1.2, 0.3)},
      {"shell", joined(make_box({-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}), inside_out(ball))},
      {"nested", joined(joined(make_box({-2, -2, -2}, {2, 2, 2}),
                               inside_out(make_box({-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}))),
                        ball)},
      {"rooms", hooke::test::moved(hooke::test::make_building(2, 1, 1), {}, 0.3, {-1, -0.5, -0.7})}};
  for (Solid& solid : solids) solid.mesh = rounded(solid.mesh);
  return solids;
}

DVec3 random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> at(-size, size);
  const double x = at(random);
  const double y = at(random);
  return {x, y, at(random)};
}

/// Where the line passes the triangle, by its three signed volumes; no number if it does not.
double pass(const SolidMesh& mesh, std::size_t triangle, DVec3 origin, DVec3 direction) {
  const auto& t = mesh.triangles[triangle];
  const DVec3 a = mesh.positions[t[0]] - origin;
  const DVec3 b = mesh.positions[t[1]] - origin;
  const DVec3 c = mesh.positions[t[2]] - origin;
  const double u = dot(direction, cross(b, c));
  const double v = dot(direction, cross(c, a));
  const double w = dot(direction, cross(a, b));
  if ((u < 0 || v < 0 || w < 0) == (u > 0 || v > 0 || w > 0)) return std::nan("");
  const DVec3 normal = cross(b - a, c - a);
  return dot(normal, a) / dot(normal, direction);
}

/// All fractions where the ray passes the surface.
std::vector<double> brute_force(const SolidMesh& mesh, DVec3 origin, DVec3 direction) {
  std::vector<double> fractions;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double fraction = pass(mesh, t, origin, direction);
    if (fraction >= 0) fractions.push_back(fraction);
  }
  std::sort(fractions.begin(), fractions.end());
  return fractions;
}

void check_rays(int count) {
  std::mt19937 random(11);
  for (const Solid& solid : make_solids()) {
    CAPTURE(solid.name);
    const BspTree tree = tree_of(solid.mesh);
    std::vector<BspCrossing> crossings;
    int wrong = 0;
    for (int ray = 0; ray < count; ++ray) {
      const DVec3 origin = random_point(random, 2.5);
      const DVec3 direction = random_point(random, 1.0);
      const std::vector<double> expected = brute_force(solid.mesh, origin, direction);
      find_crossings(tree, origin, direction, kNever, crossings);
      const auto first = cast_ray(tree, origin, direction);
      bool is_right = crossings.size() == expected.size() && first.has_value() == !expected.empty();
      is_right = is_right && is_solid_at(tree, origin) == (expected.size() % 2 == 1);
      for (std::size_t k = 0; is_right && k < expected.size(); ++k) {
        const double slope = std::fabs(dot(tree.nodes[crossings[k].node].normal, direction));
        is_right = std::fabs(crossings[k].fraction - expected[k]) * slope < 1e-13 &&
                   crossings[k].enters == ((expected.size() - k) % 2 == 0);
      }
      if (is_right && first) {
        const DVec3 p = origin + first->fraction * direction;
        const auto triangle = triangle_at(tree, first->node, p);
        is_right = first->fraction == crossings[0].fraction &&
                   pass(solid.mesh, triangle, origin, direction) == expected[0];
      }
      wrong += is_right ? 0 : 1;
    }
    CHECK(wrong == 0);
  }
}

}  // namespace

TEST_SUITE("geometry/bsp_tree") {
  TEST_CASE("a box is six planes, solid behind all of them") {
    const BspTree tree = tree_of(make_box({1, 2, 3}, {2, 4, 6}));
    const auto size = size_of(tree);
    CHECK(size.nodes == 6);
    CHECK(size.depth == 6);
    CHECK(size.faces == 12);
    CHECK(size.solid_leaves == 1);
    CHECK(size.empty_leaves == 6);
    CHECK(is_solid_at(tree, {1.5, 3, 4}));
    CHECK(is_solid_at(tree, {1.0000001, 2.0000001, 3.0000001}));
    CHECK_FALSE(is_solid_at(tree, {0.9999999, 3, 4}));
    CHECK_FALSE(is_solid_at(tree, {1.5, 3, 6.0000001}));
  }

  TEST_CASE("a ray against a box, by hand") {
    const BspTree tree = tree_of(make_box({1, 2, 3}, {2, 4, 6}));
    const auto hit = cast_ray(tree, {0, 3, 4}, {0.5, 0, 0});
    REQUIRE(hit);
    CHECK(hit->fraction == doctest::Approx(2).epsilon(1e-15));
    CHECK(hit->enters);
    CHECK(std::fabs(tree.nodes[hit->node].normal.x) == 1);
    CHECK_FALSE(cast_ray(tree, {0, 3, 4}, {0.5, 0, 0}, 1.9));
    CHECK_FALSE(cast_ray(tree, {0, 3, 4}, {-0.5, 0, 0}));
    CHECK_FALSE(cast_ray(tree, {0, 3, 4}, {0, 0, 0}));
    CHECK_FALSE(cast_ray(tree, {0, 3, 4}, {0.5, 0, 0}, -1));
    const auto out = cast_ray(tree, {1.5, 3, 4}, {0, 1, 0});
    REQUIRE(out);
    CHECK(out->fraction == doctest::Approx(1).epsilon(1e-15));
    CHECK_FALSE(out->enters);
    std::vector<BspCrossing> crossings;
    find_crossings(tree, {0, 3, 4}, {1, 0, 0}, kNever, crossings);
    REQUIRE(crossings.size() == 2);
    CHECK(crossings[1].fraction == doctest::Approx(2).epsilon(1e-15));
  }

  TEST_CASE("what is not finite is nowhere, and a tree of nothing is empty") {
    const BspTree tree = tree_of(make_box({1, 2, 3}, {2, 4, 6}));
    const DVec3 in = {1.5, 3, 4};
    std::vector<std::uint32_t> faces;
    for (const double bad : {std::nan(""), kNever, -kNever}) {
      for (const DVec3 p : {DVec3{bad, 3, 4}, DVec3{1.5, bad, 4}, DVec3{1.5, 3, bad}}) {
        CHECK_FALSE(is_solid_at(tree, p));
        CHECK_FALSE(cast_ray(tree, p, {1, 0, 0}));
        CHECK_FALSE(cast_ray(tree, in, p));
        CHECK_FALSE(move_point(tree, p, {1, 0, 0}));
        CHECK_FALSE(move_point(tree, in, p));
        CHECK_FALSE(move_sphere(tree, p, {1, 0, 0}, 0.1));
        CHECK_FALSE(move_sphere(tree, in, p, 0.1));
        order_back_to_front(tree, p, faces);
        CHECK(faces.size() == tree.faces.size());
      }
      CHECK_FALSE(move_sphere(tree, in, {1, 0, 0}, bad));
      CHECK(cast_ray(tree, in, {1, 0, 0}, bad).has_value() == (bad > 0));
    }
    CHECK_FALSE(move_sphere(tree, in, {1, 0, 0}, -0.1));
    const BspTree nothing;
    CHECK_FALSE(is_solid_at(nothing, in));
    CHECK_FALSE(cast_ray(nothing, in, {1, 0, 0}));
    CHECK_FALSE(move_sphere(nothing, in, {1, 0, 0}, 1));
    order_back_to_front(nothing, in, faces);
    CHECK(faces.empty());
  }

  TEST_CASE("120 000 random rays pass the surface where all triangles say") {
    check_rays(20'000);
  }
  TEST_CASE("1 200 000 random rays pass the surface where all triangles say" * doctest::skip()) {
    check_rays(200'000);
  }

  TEST_CASE("rays aimed at corners and edges, and along faces, do not slip through") {
    std::mt19937 random(13);
    for (const Solid& solid : make_solids()) {
      CAPTURE(solid.name);
      const BspTree tree = tree_of(solid.mesh);
      int slipped = 0;
      for (int i = 0; i < 3000; ++i) {
        const auto& t = solid.mesh.triangles[random() % solid.mesh.triangles.size()];
        const double along = static_cast<double>(random() % 3) / 2;
        const DVec3 a = solid.mesh.positions[t[0]];
        const DVec3 b = solid.mesh.positions[t[1]];
        const DVec3 target = a + along * (b - a);
        // From one side of the edge to well inside the solid, through the edge itself.
        const DVec3 origin = random_point(random, 3.0);
        const DVec3 beyond = target + 1e-6 * (target - origin);
        if (is_solid_at(tree, origin) || !is_solid_at(tree, beyond)) continue;
        const auto hit = cast_ray(tree, origin, beyond - origin, 1.0);
        slipped += hit && hit->enters ? 0 : 1;
      }
      CHECK(slipped == 0);
    }
  }

  TEST_CASE("a point stops at the first wall, and starts in one at once") {
    const BspTree tree = tree_of(make_box({1, -1, -1}, {2, 1, 1}));
    const auto hit = move_point(tree, {0, 0, 0}, {4, 0, 0});
    REQUIRE(hit);
    CHECK(hit->fraction == doctest::Approx(0.25).epsilon(1e-15));
    CHECK(hit->normal == DVec3{-1, 0, 0});
    CHECK_FALSE(move_point(tree, {0, 0, 0}, {0.9, 0, 0}));
    CHECK_FALSE(move_point(tree, {0, 0, 0}, {0, 0, 0}));
    const auto inside = move_point(tree, {1.5, 0, 0}, {4, 0, 0});
    REQUIRE(inside);
    CHECK(inside->fraction == 0);
    CHECK(inside->normal == DVec3{});
  }

  TEST_CASE("a sphere touches a face, an edge and a corner of a box where geometry says") {
    const BspTree tree = tree_of(make_box({0, 0, 0}, {1, 1, 1}));
    const auto face = move_sphere(tree, {0.5, 3, 0.5}, {0, -4, 0}, 0.5);
    REQUIRE(face);
    CHECK(face->fraction == doctest::Approx(1.5 / 4).epsilon(1e-14));
    CHECK(face->normal.y == doctest::Approx(1).epsilon(1e-14));
    // Above the edge x = 1: at 0.3 beside it, the center is at 0.4 over the top for a radius of 0.5.
    const auto edge = move_sphere(tree, {1.3, 3, 0.5}, {0, -4, 0}, 0.5);
    REQUIRE(edge);
    CHECK(edge->fraction == doctest::Approx(1.6 / 4).epsilon(1e-14));
    CHECK(edge->normal.x == doctest::Approx(0.6).epsilon(1e-14));
    CHECK(edge->normal.y == doctest::Approx(0.8).epsilon(1e-14));
    // Beside the corner by (0.2, 0.4): sqrt(0.6^2 - 0.2^2 - 0.4^2) = 0.4 over it.
    const auto corner = move_sphere(tree, {1.2, 3, 1.4}, {0, -4, 0}, 0.6);
    REQUIRE(corner);
    CHECK(corner->fraction == doctest::Approx(1.6 / 4).epsilon(1e-14));
    CHECK_FALSE(move_sphere(tree, {1.51, 3, 0.5}, {0, -4, 0}, 0.5));
    CHECK_FALSE(move_sphere(tree, {1.4, 3, 1.4}, {0, -4, 0}, 0.5));
    // Touching: against the box at once, away from it and along it not at all.
    CHECK(move_sphere(tree, {0.5, 1.4, 0.5}, {0, -1, 0}, 0.5)->fraction == 0);
    CHECK_FALSE(move_sphere(tree, {0.5, 1.4, 0.5}, {0, 1, 0}, 0.5));
    CHECK_FALSE(move_sphere(tree, {0.3, 1.5, 0.4}, {0.5, 0, 0.3}, 0.5));
    CHECK(move_sphere(tree, {0.5, 0.5, 0.5}, {0, 1, 0}, 0.1)->fraction == 0);
    // A sphere of no size is a point.
    CHECK(move_sphere(tree, {0.5, 3, 0.5}, {0, -4, 0}, 0)->fraction == doctest::Approx(0.5).epsilon(1e-14));
  }

  TEST_CASE("random spheres stop at the radius from the nearest triangle, and nowhere before") {
    std::mt19937 random(17);
    for (const Solid& solid : make_solids()) {
      CAPTURE(solid.name);
      const BspTree tree = tree_of(solid.mesh);
      const auto gap_at = [&](DVec3 p) {
        double nearest = kNever;
        for (const auto& t : solid.mesh.triangles) {
          const auto& at = solid.mesh.positions;
          nearest = std::min(
              nearest,
              hooke::geometry::closest_on_triangle(p, at[t[0]], at[t[1]], at[t[2]]).distance_squared);
        }
        return std::sqrt(nearest);
      };
      int hits = 0;
      for (int i = 0; i < 600; ++i) {
        const DVec3 origin = random_point(random, 2.5);
        const DVec3 motion = random_point(random, 3.0);
        const double radius = 0.02 + 0.3 * static_cast<double>(random() % 1000) / 1000;
        if (is_solid_at(tree, origin) || gap_at(origin) <= radius) continue;
        const auto hit = move_sphere(tree, origin, motion, radius);
        if (hit) CHECK(gap_at(origin + hit->fraction * motion) == doctest::Approx(radius).epsilon(1e-9));
        hits += hit ? 1 : 0;
        const double end = hit ? hit->fraction : 1.0;
        for (int k = 0; k < 12; ++k) CHECK(gap_at(origin + end * k / 12.0 * motion) > radius);
      }
      CHECK(hits > 20);
    }
  }
}

namespace {

/// Whether part of the first convex face is between the eye and the second: it is inside the pyramid of the
/// eye over the second, on the eye's side of it.
bool hides(std::span<const DVec3> first, std::span<const DVec3> second, DVec3 eye) {
  struct Half {
    DVec3 normal, point;
  };
  const DVec3 normal = cross(second[1] - second[0], second[2] - second[0]);
  const double side = dot(normal, eye - second[0]) > 0 ? 1 : -1;
  std::vector<Half> halves = {{side * normal, second[0]}};
  for (std::size_t k = 0; k < second.size(); ++k) {
    const DVec3 next = second[(k + 1) % second.size()];
    halves.push_back({side * cross(eye - second[k], next - second[k]), eye});
  }
  std::vector<DVec3> rest(first.begin(), first.end());
  for (const Half& half : halves) {
    std::vector<DVec3> kept;
    const auto height = [&](DVec3 p) { return dot(normalize(half.normal), p - half.point) - 1e-9; };
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const DVec3 a = rest[k];
      const DVec3 b = rest[(k + 1) % rest.size()];
      const double at_a = height(a);
      const double at_b = height(b);
      if (at_a > 0) kept.push_back(a);
      if (at_a * at_b < 0) kept.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    rest = kept;
  }
  DVec3 area = {};
  for (std::size_t k = 2; k < rest.size(); ++k) area += cross(rest[k - 1] - rest[0], rest[k] - rest[0]);
  return length(area) > 1e-12;
}

/// A tree, its bytes, and a place in them.
struct Saved {
  BspTree tree;
  std::vector<std::byte> bytes;

  [[nodiscard]] std::size_t node(std::size_t index) const { return 24 + 48 * index; }
  [[nodiscard]] std::size_t face(std::size_t index) const { return node(tree.nodes.size()) + 12 * index; }
  [[nodiscard]] std::string error_with(std::size_t place, std::vector<unsigned char> values) const {
    std::vector<std::byte> changed = bytes;
    for (std::size_t k = 0; k < values.size(); ++k) changed[place + k] = static_cast<std::byte>(values[k]);
    const auto loaded = load_bsp(changed);
    return loaded ? "none" : loaded.error().where + ": " + loaded.error().message;
  }
};

Saved save_star() {
  std::mt19937 random(5);
  Saved saved = {tree_of(hooke::test::make_star(1, 0.5, random)), {}};
  saved.bytes = save_bsp(saved.tree);
  return saved;
}

}  // namespace

TEST_SUITE("geometry/bsp_tree") {
  TEST_CASE("painter's order: from 200 eyes no face hides one that comes after it") {
    std::mt19937 random(19);
    const SolidMesh star = hooke::test::make_star(1, 0.3, random);
    const SolidMesh solids[] = {star, hooke::test::make_ring(10, 0.6, 1.2, 0.3),
                                hooke::test::joined(star, make_box({1.2, -1, -1}, {1.4, 1, 1}))};
    std::size_t hiding = 0;
    for (const SolidMesh& solid : solids) {
      const BspTree tree = tree_of(solid);
      const auto corners = [&](std::uint32_t face) {
        const auto& f = tree.faces[face];
        return std::span(tree.corners).subspan(f.first_corner, f.corner_count);
      };
      std::vector<std::uint32_t> order;
      for (int i = 0; i < 200; ++i) {
        const DVec3 eye = random_point(random, i % 2 == 0 ? 3.0 : 1.0);
        order_back_to_front(tree, eye, order);
        REQUIRE(std::set<std::uint32_t>(order.begin(), order.end()).size() == tree.faces.size());
        REQUIRE(order.size() == tree.faces.size());
        std::size_t wrong = 0;
        for (std::size_t a = 0; a < order.size(); ++a) {
          for (std::size_t b = a + 1; b < order.size(); ++b) {
            wrong += hides(corners(order[a]), corners(order[b]), eye) ? 1 : 0;
            // The check itself sees what hides: from the back of the order to the front.
            if (i == 0) hiding += hides(corners(order[b]), corners(order[a]), eye) ? 1 : 0;
          }
        }
        CHECK(wrong == 0);
      }
    }
    CHECK(hiding > 100);
  }

  TEST_CASE("a saved tree comes back to the bit") {
    const Saved saved = save_star();
    const auto loaded = load_bsp(saved.bytes);
    REQUIRE(loaded);
    CHECK(save_bsp(loaded.value()) == saved.bytes);
    CHECK(loaded.value().nodes.size() == saved.tree.nodes.size());
    std::mt19937 random(23);
    for (int i = 0; i < 1000; ++i) {
      const DVec3 origin = random_point(random, 2.0);
      const DVec3 direction = random_point(random, 1.0);
      const auto a = cast_ray(saved.tree, origin, direction);
      const auto b = cast_ray(loaded.value(), origin, direction);
      REQUIRE(a.has_value() == b.has_value());
      if (a) CHECK(a->fraction == b->fraction);
    }
  }

  TEST_CASE("a file that was tampered with gives one line") {
    const Saved saved = save_star();
    CHECK(saved.error_with(0, {'X'}) == "bsp: not a BSP tree: it does not begin with HOOKEBSP");
    CHECK(saved.error_with(8, {9}) == "bsp: version 9; this program reads version 1");
    CHECK(saved.error_with(12, {0, 0, 0, 0}) == "bsp: no nodes, or more than 2^30 of something");
    CHECK(saved.error_with(12, {0xFF, 0xFF, 0xFF, 0xFF}) == "bsp: no nodes, or more than 2^30 of something");
    CHECK(saved.error_with(12, {1, 0, 0, 0}).find("its counts ask for") != std::string::npos);
    // A node that is its own child, one beyond the end, one without a parent.
    CHECK(saved.error_with(saved.node(1) + 32, {1, 0, 0, 0}).find("bsp.nodes[1]: a child") == 0);
    CHECK(saved.error_with(saved.node(1) + 32, {0, 0, 0, 0x7F}).find("bsp.nodes[1]: a child") == 0);
    CHECK(saved.error_with(saved.node(0) + 32, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}) ==
          "bsp.nodes[1]: no node's child");
    // The root in place of a leaf: a way without end.
    const auto is_leaf_above = [](const auto& node) { return node.above >= hooke::kBspEmpty; };
    const auto& nodes = saved.tree.nodes;
    const auto leaf = std::find_if(nodes.begin(), nodes.end(), is_leaf_above) - nodes.begin();
    CHECK(saved.error_with(saved.node(static_cast<std::size_t>(leaf)) + 32, {0, 0, 0, 0}).find(": a child") !=
          std::string::npos);
    CHECK(saved.error_with(saved.node(0) + 40, {0, 0, 0, 0x7F}) == "bsp.nodes[0]: faces that are not there");
    // A node takes a face of the next one as well; or none, and its own are nobody's.
    const auto has_faces = [](const auto& node) { return node.face_count > 0; };
    const auto owner =
        static_cast<std::size_t>(std::find_if(nodes.begin(), nodes.end(), has_faces) - nodes.begin());
    const auto own = static_cast<unsigned char>(nodes[owner].face_count + 1);
    CHECK(saved.error_with(saved.node(owner) + 44, {own, 0, 0, 0}).find(": faces that are another's") !=
          std::string::npos);
    CHECK(saved.error_with(saved.node(owner) + 44, {0, 0, 0, 0}) == "bsp.faces[0]: in no node's plane");
    // Infinite, and not of length one.
    CHECK(saved.error_with(saved.node(2) + 6, {0xF0, 0x7F}) == "bsp.nodes[2]: a plane that is none");
    CHECK(saved.error_with(saved.node(2) + 30, {0xF8, 0x7F}) == "bsp.nodes[2]: a plane that is none");
    CHECK(saved.error_with(saved.node(2), {0, 0, 0, 0, 0, 0, 0, 0x40}) ==
          "bsp.nodes[2]: a plane that is none");
    CHECK(saved.error_with(saved.face(0) + 8, {2, 0, 0, 0}).find("bsp.faces[0]: fewer than three") == 0);
    CHECK(saved.error_with(saved.face(0) + 4, {0, 0, 0, 0x7F}).find("bsp.faces[0]: fewer than three") == 0);
    CHECK(saved.error_with(saved.bytes.size() - 2, {0xF0, 0x7F}).find("is not finite") != std::string::npos);
    for (const std::size_t length :
         {std::size_t{0}, std::size_t{7}, std::size_t{20}, saved.bytes.size() - 1}) {
      CHECK_FALSE(load_bsp(std::span(saved.bytes).first(length)));
    }
  }

  TEST_CASE("any byte changed: an error, or a tree whose queries end") {
    const Saved saved = save_star();
    std::mt19937 random(29);
    int loaded_count = 0;
    for (int i = 0; i < 2000; ++i) {
      std::vector<std::byte> bytes = saved.bytes;
      bytes[random() % bytes.size()] = static_cast<std::byte>(random() & 0xFF);
      const auto loaded = load_bsp(bytes);
      if (!loaded) continue;
      ++loaded_count;
      std::vector<std::uint32_t> order;
      std::vector<BspCrossing> crossings;
      const BspTree& tree = loaded.value();
      find_crossings(tree, {2, 0.3, 0.4}, {-1, 0, 0}, kNever, crossings);
      order_back_to_front(tree, {2, 0.3, 0.4}, order);
      (void)move_sphere(tree, {2, 0.3, 0.4}, {-4, 0, 0}, 0.1);
      for (const BspCrossing& crossing : crossings) (void)triangle_at(tree, crossing.node, {0, 0, 0});
      CHECK(crossings.size() <= tree.nodes.size());
    }
    CHECK(loaded_count > 100);
  }

  TEST_CASE("the inside of a building: a walker crosses it through its doors and never through a wall") {
    const SolidMesh building = hooke::test::make_building(4, 1, 4);
    const BspTree tree = tree_of(building);
    // Rooms from 0.2 to 4.2 and so on; doors from 1.7 to 2.7, up to 2.2.
    CHECK(is_solid_at(tree, {0.1, 1, 2}));
    CHECK_FALSE(is_solid_at(tree, {0.3, 1, 2}));
    CHECK_FALSE(is_solid_at(tree, {4.3, 1, 2.2}));
    CHECK(is_solid_at(tree, {4.3, 1, 3}));
    CHECK(is_solid_at(tree, {4.3, 2.3, 2.2}));
    // Straight on through three doors to the far wall at 16.8.
    const auto through = move_point(tree, {1, 1, 2.2}, {100, 0, 0});
    REQUIRE(through);
    CHECK(1 + 100 * through->fraction == doctest::Approx(16.8).epsilon(1e-9));
    // A sphere of 0.4 goes through doors of 1 m, one of 0.51 does not.
    const auto small = move_sphere(tree, {1, 1, 2.2}, {100, 0, 0}, 0.4);
    REQUIRE(small);
    CHECK(1 + 100 * small->fraction == doctest::Approx(16.4).epsilon(1e-9));
    // It stops at the door's two jambs: sqrt(0.51^2 - 0.5^2) = 0.1005 before them.
    const auto large = move_sphere(tree, {1, 1, 2.2}, {100, 0, 0}, 0.51);
    REQUIRE(large);
    CHECK(1 + 100 * large->fraction == doctest::Approx(4.2 - std::sqrt(0.51 * 0.51 - 0.25)).epsilon(1e-9));

    std::mt19937 random(31);
    DVec3 point = {1, 1, 2.2};
    DVec3 ball = point;
    std::set<std::pair<int, int>> rooms;
    int blocked = 0;
    for (int step = 0; step < 20'000; ++step) {
      const DVec3 motion = random_point(random, 6.0);
      const auto hit = move_point(tree, point, motion);
      blocked += hit ? 1 : 0;
      // Stops 1 mm before what it hits.
      const double room = hit ? std::max(0.0, hit->fraction - 0.001 / length(motion)) : 1.0;
      point += room * motion;
      const auto touch = move_sphere(tree, ball, motion, 0.3);
      ball += (touch ? std::max(0.0, touch->fraction - 0.001 / length(motion)) : 1.0) * motion;
      rooms.insert({static_cast<int>(point.x / 4.2), static_cast<int>(point.z / 4.2)});
      for (const DVec3& p : {point, ball}) {
        REQUIRE_FALSE(is_solid_at(tree, p));
        REQUIRE(std::min({p.x, p.y, p.z}) > 0.2);
        REQUIRE(std::max({p.x, p.z}) < 16.8);
        REQUIRE(p.y < 2.7);
      }
    }
    CHECK(blocked > 10'000);
    CHECK(rooms.size() == 16);
  }

  TEST_CASE(
      "what changes no solid makes no other tree: inside out, double, flat, cut in the middle of an edge") {
    const SolidMesh box = make_box({0, 0, 0}, {1, 1, 1});
    const auto check_box = [](const SolidMesh& mesh) {
      const BspTree tree = tree_of(mesh);
      CHECK(size_of(tree).nodes == 6);
      CHECK(size_of(tree).solid_leaves == 1);
      CHECK(is_solid_at(tree, {0.5, 0.5, 0.5}));
      CHECK_FALSE(is_solid_at(tree, {1.5, 0.5, 0.5}));
      return size_of(tree).faces;
    };
    CHECK(check_box(box) == 12);
    CHECK(check_box(hooke::test::inside_out(box)) == 12);
    CHECK(check_box(hooke::test::joined(box, box)) == 12);

    // A triangle that lies on itself, both ways round.
    SolidMesh fin = box;
    fin.positions.push_back({2, 2, 2});
    fin.triangles.insert(fin.triangles.end(), {{0, 1, 8}, {1, 0, 8}});
    CHECK(check_box(fin) == 12);

    // Two boxes whose triangles lie on each other where they touch are one.
    const BspTree two = tree_of(hooke::test::joined(box, make_box({1, 0, 0}, {2, 1, 1})));
    CHECK(size_of(two).faces == 20);
    CHECK_FALSE(cast_ray(two, {0.5, 0.5, 0.5}, {1, 0, 0}, 1.4));

    // An edge goes by its middle on one side: a flat triangle, or a T-junction without it.
    SolidMesh flat = box;
    flat.positions.push_back({0.5, 0, 0});  // on the edge from 0 to 1
    for (auto& t : flat.triangles) {
      if (t != hooke::geometry::Triangle{0, 1, 5}) continue;
      t = {0, 8, 5};
      flat.triangles.push_back({8, 1, 5});
      break;
    }
    REQUIRE(flat.triangles.size() == 13);
    CHECK(check_box(flat) == 13);
    flat.triangles.push_back({0, 1, 8});
    CHECK(check_box(flat) == 13);
  }

  TEST_CASE("errors that name the triangles") {
    const SolidMesh box = make_box({0, 0, 0}, {1, 1, 1});
    CHECK(error_of({}) == "mesh: less than 1e-9 m wide");
    CHECK(error_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}}) == "mesh.triangles: a solid needs triangles");
    CHECK(error_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}})
              .find("mesh.triangles[0]: names a vertex") == 0);
    CHECK(error_of({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}).find("mesh.triangles: no triangle") ==
          0);

    SolidMesh bad = box;
    bad.positions[3].y = std::nan("");
    CHECK(error_of(bad).find("mesh.positions[3]: a coordinate is not finite") == 0);
    bad.positions[3].y = kNever;
    CHECK(error_of(bad).find("mesh.positions[3]: ") == 0);

    SolidMesh open = box;
    open.triangles.pop_back();
    CHECK(error_of(open).find("has an edge without a neighbor, one of 3 such edges") != std::string::npos);

    SolidMesh flipped = box;
    std::swap(flipped.triangles[4][0], flipped.triangles[4][1]);
    CHECK(error_of(flipped).find("mesh.triangles[4]: and triangles[") == 0);

    SolidMesh fin = box;
    fin.positions.push_back({2, 2, 2});
    fin.triangles.push_back({0, 1, 8});
    CHECK(error_of(fin).find("mesh.triangles[") == 0);

    // Through each other, and one that lies on another.
    const SolidMesh crossing = hooke::test::joined(box, make_box({0.5, 0.5, 0.5}, {2, 2, 2}));
    CHECK(error_of(crossing).find("goes through the solid") != std::string::npos);
    const SolidMesh touching = hooke::test::joined(box, make_box({1, 0.25, 0.25}, {2, 0.75, 0.75}));
    CHECK(error_of(touching).find("mesh.triangles[12]: and its shell") == 0);
    // A corner pulled through the opposite side.
    SolidMesh folded = make_box({0, 0, 0}, {1, 1, 1});
    folded.positions[7] = {0.5, 0.5, -0.5};
    CHECK(error_of(folded).find("goes through the solid") != std::string::npos);
    const SolidMesh twofold = hooke::test::joined(box, make_box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}));
    CHECK(error_of(twofold).find("wound 2 times around") != std::string::npos);
    // Far from each other, so that no leaf of the tree touches both.
    const SolidMesh ball = hooke::geometry::solid_mesh_of(hooke::test::make_sphere(3));
    const SolidMesh in_ball = hooke::test::joined(ball, hooke::test::moved(ball, {}, 0.01, {0.1, 0.2, 0.3}));
    CHECK(error_of(in_ball).find("mesh.triangles[512]: and its shell") == 0);
    const SolidMesh hollow =
        hooke::test::joined(ball, hooke::test::moved(hooke::test::inside_out(ball), {}, 0.5, {}));
    CHECK(error_of(hollow) == "none");
    // Shells that touch in a corner or along an edge are a solid.
    CHECK(error_of(hooke::test::joined(box, make_box({1, 1, 1}, {2, 2, 2}))) == "none");
    CHECK(error_of(hooke::test::joined(box, make_box({1, 1, 0}, {2, 2, 1}))) == "none");
  }

  TEST_CASE("needles, plates and far places: sizes from 1e-6 to 1e6 of each other, 1e6 m from the origin") {
    const struct {
      DVec3 lower, size;
    } cases[] = {{{0, 0, 0}, {1e-6, 1, 1}},
                 {{0, 0, 0}, {1e-6, 1e-6, 1}},
                 {{1e6, 1e6, -1e6}, {1, 1, 1}},
                 {{0, 0, 0}, {1e6, 1e6, 0.1}},
                 {{-1e-7, 0, 0}, {1e-7, 1e-7, 1e-7}}};
    for (const auto& c : cases) {
      const BspTree tree = tree_of(make_box(c.lower, c.lower + c.size));
      CHECK(is_solid_at(tree, c.lower + 0.5 * c.size));
      CHECK_FALSE(is_solid_at(tree, c.lower + DVec3{0.5 * c.size.x, 0.5 * c.size.y, 1.01 * c.size.z}));
      const double way = length(c.size);
      const DVec3 origin = c.lower + DVec3{0.5 * c.size.x, 0.5 * c.size.y, c.size.z + way};
      const auto hit = cast_ray(tree, origin, {0, 0, -1});
      REQUIRE(hit);
      CHECK(hit->fraction == doctest::Approx(way).epsilon(1e-8));
    }
  }

  TEST_CASE("a fan of slivers, whose planes all meet in one edge") {
    // A double cone of 64 sides over a polygon that is 1e-5 as wide as it is high.
    SolidMesh cone;
    cone.positions = {{0, 1, 0}, {0, -1, 0}};
    for (std::uint32_t i = 0; i < 64; ++i) {
      const double angle = 6.283185307179586 * i / 64;
      cone.positions.push_back({1e-5 * std::cos(angle), 0, 1e-5 * std::sin(angle)});
      const std::uint32_t a = 2 + i;
      const std::uint32_t b = 2 + (i + 1) % 64;
      cone.triangles.insert(cone.triangles.end(), {{0, b, a}, {1, a, b}});
    }
    const BspTree tree = tree_of(cone);
    CHECK(is_solid_at(tree, {0, 0.5, 0}));
    CHECK_FALSE(is_solid_at(tree, {1e-5, 0.5, 0}));
    CHECK(move_point(tree, {-1, 0.5, 0}, {2, 0, 0})->fraction ==
          doctest::Approx(0.5 - 0.25e-5).epsilon(1e-7));
  }
}
