#include "render/shapes.h"

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

using hooke::Vec3;
using hooke::render::MeshGeometry;

namespace {

/// Volume inside the triangles by the divergence theorem: positive when they face outward.
double volume(const MeshGeometry& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3 a = mesh.vertices[mesh.indices[i]].position;
    const Vec3 b = mesh.vertices[mesh.indices[i + 1]].position;
    const Vec3 c = mesh.vertices[mesh.indices[i + 2]].position;
    sum += static_cast<double>(dot(a, cross(b, c))) / 6;
  }
  return sum;
}

/// Smallest cosine between a triangle's own normal and the normals at its corners.
float worst_agreement(const MeshGeometry& mesh) {
  float worst = 1;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto& a = mesh.vertices[mesh.indices[i]];
    const auto& b = mesh.vertices[mesh.indices[i + 1]];
    const auto& c = mesh.vertices[mesh.indices[i + 2]];
    const Vec3 normal = normalize(cross(b.position - a.position, c.position - a.position));
    // Triangles at a pole have no area.
    if (normal == Vec3{}) continue;
    for (const auto* corner : {&a, &b, &c}) worst = std::min(worst, dot(normal, corner->normal));
  }
  return worst;
}

constexpr double kPi = std::numbers::pi;

}  // namespace

TEST_SUITE("render/shapes") {
  TEST_CASE("shapes enclose their volume and face outward") {
    const MeshGeometry box = hooke::render::make_box({1, 2, 3});
    CHECK(volume(box) == doctest::Approx(48));
    CHECK(worst_agreement(box) == doctest::Approx(1));

    // Round shapes are inscribed, hence a little smaller.
    const MeshGeometry sphere = hooke::render::make_sphere(4);
    CHECK(volume(sphere) == doctest::Approx(4 * kPi / 3).epsilon(0.01));
    CHECK(volume(sphere) < 4 * kPi / 3);
    CHECK(worst_agreement(sphere) > 0.99F);

    const MeshGeometry capsule = hooke::render::make_capsule(0.5F, 1);
    CHECK(volume(capsule) == doctest::Approx(kPi * 0.25 * 2 + 4 * kPi / 3 * 0.125).epsilon(0.02));
    CHECK(worst_agreement(capsule) > 0.97F);
    const MeshGeometry coarse = hooke::render::make_capsule(0.5F, 1, 10);
    CHECK(coarse.indices.size() < capsule.indices.size() / 8);
    CHECK(volume(coarse) == doctest::Approx(volume(capsule)).epsilon(0.1));
    CHECK(worst_agreement(coarse) > 0.7F);

    const MeshGeometry cylinder = hooke::render::make_cylinder(0.5F, 1);
    CHECK(volume(cylinder) == doctest::Approx(kPi * 0.25 * 2).epsilon(0.01));
    CHECK(worst_agreement(cylinder) > 0.99F);

    const MeshGeometry cone = hooke::render::make_cone(0.5F, 1);
    CHECK(volume(cone) == doctest::Approx(kPi * 0.25 * 2 / 3).epsilon(0.01));
    CHECK(worst_agreement(cone) > 0.99F);
  }

  TEST_CASE("a tube encloses the volume of its rope, ends included") {
    MeshGeometry straight;
    const Vec3 line[] = {{0, 0, 0}, {0.7F, 0, 0}, {1.5F, 0, 0}, {2, 0, 0}};
    hooke::render::add_tube(line, 0.1F, straight);
    const double capsule = kPi * 0.01 * 2 + 4 * kPi / 3 * 0.001;
    CHECK(volume(straight) == doctest::Approx(capsule).epsilon(0.03));
    CHECK(worst_agreement(straight) > 0.9F);
  }

  TEST_CASE("a tube runs through its points, and a coarse ring of them becomes round") {
    std::vector<Vec3> ring;
    for (int i = 0; i <= 12; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / 12;
      ring.push_back({std::cos(angle), 0, std::sin(angle)});
    }
    MeshGeometry tube;
    hooke::render::add_tube(ring, 0.05F, tube);
    for (const auto& vertex : tube.vertices) {
      // Straight pieces would come as near to the center as cos(15 deg) = 0.966.
      const float distance = length(vertex.position - 0.05F * vertex.normal);
      CHECK(distance == doctest::Approx(1).epsilon(0.02));
    }
  }

  TEST_CASE("a tube survives hairpins, repeated points and points that are not numbers") {
    const Vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {std::nanf(""), 0, 0}, {0, 0, 0}, {0, 0, 1}};
    MeshGeometry tube;
    hooke::render::add_tube(points, 0.05F, tube);
    CHECK_FALSE(tube.indices.empty());
    for (const auto& vertex : tube.vertices) {
      CHECK(is_finite(vertex.position));
      CHECK(length(vertex.normal) == doctest::Approx(1).epsilon(1e-3));
    }
    MeshGeometry none;
    hooke::render::add_tube(std::span(points, 1), 0.05F, none);
    hooke::render::add_tube(points, 0, none);
    CHECK(none.indices.empty());
  }

  TEST_CASE("smooth normals of a sphere point away from its center") {
    MeshGeometry sphere = hooke::render::make_sphere(3);
    for (auto& vertex : sphere.vertices) vertex.normal = {};
    hooke::render::update_normals(sphere);
    CHECK(sphere.vertex_revision == 1);
    for (const auto& vertex : sphere.vertices) CHECK(dot(vertex.normal, vertex.position) > 0.999F);
  }
}
