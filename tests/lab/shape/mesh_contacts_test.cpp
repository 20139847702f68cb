#include "lab/shape/mesh_contacts.h"

#include "geometry/meshes.h"
#include "math/random.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Real;
using hooke::collision::find_mesh_contacts;
using hooke::collision::find_sphere_contacts;
using hooke::collision::largest_depth;
using hooke::collision::MeshContact;
using hooke::collision::MeshContactKind;
using hooke::geometry::ContactMesh;
using hooke::geometry::make_contact_mesh;
using hooke::geometry::RigidPose;
using hooke::geometry::Search;
using hooke::test::random_vector;

namespace {

constexpr double kMargin = 1e-3;

using Contacts = std::vector<MeshContact>;

ContactMesh solid(const MeshDesc& mesh) {
  auto result = make_contact_mesh(mesh);
  REQUIRE(result.has_value());
  return std::move(result).value();
}

bool is_same(const MeshContact& x, const MeshContact& y) {
  return x.kind == y.kind && x.feature_a == y.feature_a && x.feature_b == y.feature_b && x.point == y.point &&
         x.normal == y.normal && x.depth == y.depth;
}

/// By the tree, after comparing with all pairs.
Contacts contacts_of(const ContactMesh& a, const RigidPose& pose_a, const ContactMesh& b,
                     const RigidPose& pose_b, double margin = kMargin) {
  Contacts by_tree;
  Contacts by_all;
  find_mesh_contacts(a, pose_a, b, pose_b, {margin, Search::kTree}, by_tree);
  find_mesh_contacts(a, pose_a, b, pose_b, {margin, Search::kAll}, by_all);
  REQUIRE(by_tree.size() == by_all.size());
  REQUIRE(std::equal(by_tree.begin(), by_tree.end(), by_all.begin(), is_same));
  return by_tree;
}

double near(DVec3 a, DVec3 b) {
  return length(a - b);
}

int count_at(const Contacts& contacts, DVec3 point, double within) {
  return static_cast<int>(std::count_if(contacts.begin(), contacts.end(),
                                        [&](const MeshContact& c) { return near(c.point, point) < within; }));
}

RigidPose random_pose(std::mt19937_64& random, double reach) {
  const DVec3 q = random_vector(random);
  const double w = hooke::test::signed_unit(random);
  return {reach * random_vector(random), normalize(hooke::Quaternion<double>{q.x, q.y, q.z, w})};
}

/// Whether two solids have a point in common, by all pairs of triangles and by a vertex inside.
bool overlap_by_all(const ContactMesh& a, const RigidPose& a_in_b, const ContactMesh& b) {
  std::vector<DVec3> moved;
  for (const DVec3& p : a.positions) moved.push_back(to_world(a_in_b, p));
  const hooke::geometry::MeshView view = {moved, a.triangles};
  for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
    for (std::uint32_t k = 0; k < b.triangles.size(); ++k) {
      if (hooke::geometry::triangles_overlap(view.corners(i), b.view().corners(k))) return true;
    }
  }
  const DVec3 b_in_a = to_local(a_in_b, b.positions[0]);
  return closest_on_solid(b, moved[0], Search::kAll).signed_distance < 0 ||
         closest_on_solid(a, b_in_a, Search::kAll).signed_distance < 0;
}

const hooke::Quaternion<double> kYaw45 = hooke::quaternion_about(DVec3{0, 1, 0}, std::acos(-1.0) / 4);
const hooke::Quaternion<double> kRoll45 = hooke::quaternion_about(DVec3{0, 0, 1}, std::acos(-1.0) / 4);

}  // namespace

TEST_SUITE("collision/mesh_contacts") {
  TEST_CASE("a box on a box: four corners, pushed up, as deep as it sank, touching, or over it") {
    const ContactMesh top = solid(hooke::test::make_cube(1));
    const ContactMesh bottom = solid(hooke::test::make_box({10, 1, 10}));
    for (const double depth : {0.1, 1e-4, 1e-9, 0.0, -1e-4}) {
      CAPTURE(depth);
      // A turn about y changes no depth; it leaves the boxes' edges unaligned.
      for (const auto& turn : {hooke::Quaternion<double>{}, kYaw45}) {
        const Contacts found = contacts_of(bottom, {}, top, {{0.5, 2 - depth, -0.25}, turn});
        REQUIRE(found.size() == 4);
        for (const MeshContact& contact : found) {
          CHECK(contact.kind == MeshContactKind::kFaceVertex);
          CHECK(near(contact.normal, {0, 1, 0}) < 1e-12);
          CHECK(contact.depth == doctest::Approx(depth).epsilon(1e-9).scale(1e-3));
          CHECK(contact.point.y == doctest::Approx(1 - depth / 2));
        }
        const DVec3 corner = DVec3{0.5, 1 - depth / 2, -0.25} + rotate(turn, DVec3{1, 0, -1});
        CHECK(count_at(found, corner, 1e-9) == 1);
      }
    }
    CHECK(contacts_of(bottom, {}, top, {{0, 2.002, 0}, {}}).empty());
  }

  TEST_CASE("boxes of one size, one on the other: pushed up, not aside") {
    const ContactMesh cube = solid(hooke::test::make_cube(1));
    for (const double depth : {1e-4, 0.0, -1e-4}) {
      for (const double aside : {0.0, 1e-5, -1e-5}) {
        CAPTURE(depth);
        CAPTURE(aside);
        const Contacts found = contacts_of(cube, {}, cube, {{aside, 2 - depth, aside}, {}});
        REQUIRE(found.size() >= 4);
        for (const MeshContact& contact : found) {
          CHECK(near(contact.normal, {0, 1, 0}) < 1e-9);
          // A corner beside the other box touches it only.
          CHECK(contact.depth <= std::max(depth, 0.0) + 1e-9);
          CHECK(contact.depth >= std::min(depth, 0.0) - 1e-9);
        }
        CHECK(largest_depth(found) == doctest::Approx(depth).epsilon(1e-6).scale(1e-3));
        for (const double x : {-1.0, 1.0}) {
          for (const double z : {-1.0, 1.0}) CHECK(count_at(found, {x, 1, z}, 1e-3) >= 1);
        }
      }
    }
  }

  TEST_CASE("a plank across a plank: the four corners of the patch") {
    const ContactMesh plank = solid(hooke::test::make_box({3, Real(0.5), 1}));
    const auto across = hooke::quaternion_about(DVec3{0, 1, 0}, std::acos(-1.0) / 2);
    for (const double depth : {1e-3, 1e-6, 0.0, -1e-4}) {
      CAPTURE(depth);
      const Contacts found = contacts_of(plank, {}, plank, {{0, 1 - depth, 0}, across});
      for (const MeshContact& contact : found) {
        CHECK(near(contact.normal, {0, 1, 0}) < 1e-9);
        CHECK(contact.depth == doctest::Approx(depth).epsilon(1e-6).scale(1e-3));
      }
      for (const double x : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) CHECK(count_at(found, {x, 0.5, z}, 2e-3) >= 1);
      }
    }
  }

  TEST_CASE("crossed edges: one contact along the line between the centers") {
    // Boxes of half 0.5, one turned 45 degrees about y, the other about z: edges meet at sqrt(2) apart.
    for (const double scale : {100.0, 1.0, 0.2}) {
      const auto half = static_cast<Real>(0.5 * scale);
      const ContactMesh box = solid(hooke::test::make_cube(half));
      const double touching = std::sqrt(2.0) * 2 * double(half);
      for (const double gap : {-0.05, -0.002, 0.0005}) {
        CAPTURE(scale);
        CAPTURE(gap);
        const Contacts found = contacts_of(box, {{0, 0, 0}, kYaw45}, box,
                                           {{touching + gap * scale, 0, 0}, kRoll45}, kMargin * scale);
        REQUIRE(found.size() == 1);
        CHECK(found[0].kind == MeshContactKind::kEdgeEdge);
        CHECK(near(found[0].normal, {1, 0, 0}) < 1e-9);
        CHECK(found[0].depth == doctest::Approx(-gap * scale).epsilon(1e-6));
        CHECK(near(found[0].point, {0.5 * (touching + gap * scale), 0, 0}) < 1e-9 * scale);
      }
    }
  }

  TEST_CASE("boxes side by side at several places of a list of known answers") {
    const auto depth_of = [](hooke::Vec3 half_a, const RigidPose& a, hooke::Vec3 half_b, const RigidPose& b) {
      const Contacts found =
          contacts_of(solid(hooke::test::make_box(half_a)), a, solid(hooke::test::make_box(half_b)), b);
      return largest_depth(found);
    };
    // Vertices inside: as deep as the nearest face says.
    CHECK(depth_of({Real(2.5), Real(2.5), Real(2.5)}, {{-1, 0, 0}, {}}, {1, 1, 1}, {{1.5, 0, 0}, {}}) ==
          doctest::Approx(1));
    const double pi = std::acos(-1.0);
    const auto yaw = [&](double degrees) {
      return hooke::quaternion_about(DVec3{0, 0, 1}, degrees * pi / 180);
    };
    CHECK(depth_of({Real(0.25), Real(0.25), Real(0.05)}, {{0, 0, -4.5622964424}, yaw(15)},
                   {Real(0.25), Real(0.25), Real(0.05)},
                   {{0, 0, -4.6592303609}, yaw(30)}) == doctest::Approx(0.0030660815).epsilon(1e-4));
    // Sides that touch, by rounding perhaps not quite.
    for (const double z : {1.8599132000000014, -0.3}) {
      const double depth = depth_of({1, 1, 1}, {{0, 0, z}, {}}, {1, 1, 1}, {{0, 2, z}, {}});
      CHECK(std::fabs(depth) < 1e-9);
    }
    // Apart: nothing.
    CHECK(depth_of({1, 1, 1}, {{-1.5, 0.5, 0}, {}}, {1, 1, 1}, {{1.5, 0, 0}, {}}) < -1e9);
  }

  TEST_CASE("a rod through a plate, with no vertex inside and no edges near") {
    const ContactMesh plate = solid(hooke::test::make_box({5, Real(0.125), 5}));
    const ContactMesh rod = solid(hooke::test::make_box({Real(0.25), 4, Real(0.25)}));
    const Contacts found = contacts_of(plate, {}, rod, {{0.3, 0, 0.2}, {}});
    REQUIRE(found.size() == 4);
    for (const MeshContact& contact : found) {
      CHECK(contact.kind == MeshContactKind::kFaceEdge);
      CHECK(contact.depth == doctest::Approx(0.125));
      CHECK(std::fabs(contact.normal.y) == doctest::Approx(1));
    }
  }

  TEST_CASE("a solid inside another is found, though no triangles cross") {
    const ContactMesh big = solid(hooke::test::make_cube(2));
    const ContactMesh small = solid(hooke::test::make_cube(Real(0.5)));
    const Contacts found = contacts_of(big, {}, small, {{1, 0, 0}, {}});
    CHECK(found.size() == 8);
    CHECK(largest_depth(found) == doctest::Approx(1.5));  // of the far corners, to the nearest side
  }

  TEST_CASE("a cube in the inner corner of an ell touches both arms") {
    const ContactMesh ell = solid(hooke::test::make_ell(1));
    const ContactMesh cube = solid(hooke::test::make_cube(Real(0.25)));
    const Contacts found = contacts_of(ell, {}, cube, {{1.25 - 1e-4, 1.25 - 2e-4, 0}, {}});
    const auto deepest_along = [&](DVec3 normal) {
      double deepest = -1;
      for (const MeshContact& c : found) {
        if (near(c.normal, normal) < 1e-9) deepest = std::max(deepest, c.depth);
      }
      return deepest;
    };
    CHECK(deepest_along({1, 0, 0}) == doctest::Approx(1e-4).epsilon(0.01));
    CHECK(deepest_along({0, 1, 0}) == doctest::Approx(2e-4).epsilon(0.01));
    // Through the notch, free of both arms: nothing.
    CHECK(contacts_of(ell, {}, cube, {{1.3, 1.3, 0}, {}}).empty());
  }

  TEST_CASE("rings linked through each other are free; pulled apart they hold each other") {
    const ContactMesh ring = solid(hooke::test::make_torus(1, Real(0.2), 24, 12));
    const auto upright = hooke::quaternion_about(DVec3{1, 0, 0}, std::acos(-1.0) / 2);
    CHECK(contacts_of(ring, {}, ring, {{1, 0, 0}, upright}).empty());
    const Contacts found = contacts_of(ring, {}, ring, {{1.61, 0, 0}, upright});
    REQUIRE_FALSE(found.empty());
    // The wire of b presses against the inner side of a's: b is pulled back.
    for (const MeshContact& contact : found) CHECK(contact.normal.x < -0.5);
    CHECK(largest_depth(found) == doctest::Approx(0.01).epsilon(0.5));
  }

  TEST_CASE("contacts if and only if the solids overlap, by both searches, for any solids in any pose") {
    std::mt19937_64 random(3);
    const ContactMesh solids[] = {solid(hooke::test::make_cube(1)), solid(hooke::test::make_ell(Real(0.5))),
                                  solid(hooke::test::make_torus(1, Real(0.3), 8, 5)),
                                  solid(hooke::test::make_sphere(1)),
                                  solid(hooke::test::make_box({2, Real(0.05), Real(0.05)}))};
    int overlapping = 0;
    int apart = 0;
    for (int i = 0; i < 300; ++i) {
      const ContactMesh& a = solids[random() % 5];
      const ContactMesh& b = solids[random() % 5];
      const RigidPose pose_a = random_pose(random, 1);
      const RigidPose pose_b = random_pose(random, 1);
      const bool expected = overlap_by_all(a, relative_pose(pose_a, pose_b), b);
      const Contacts found = contacts_of(a, pose_a, b, pose_b, 0);
      REQUIRE((largest_depth(found) >= 0) == expected);
      ++(expected ? overlapping : apart);
    }
    CHECK(overlapping > 50);
    CHECK(apart > 50);
  }

  TEST_CASE("moved out along the deepest contact a little at a time, convex solids come free") {
    std::mt19937_64 random(4);
    const ContactMesh ball = solid(hooke::test::make_sphere(2));
    const ContactMesh cube = solid(hooke::test::make_cube(1));
    for (int i = 0; i < 20; ++i) {
      RigidPose pose = random_pose(random, 1);
      pose.position = 1.6 * normalize(pose.position);
      double depth = 0;
      for (int step = 0; step < 30; ++step) {
        const Contacts found = contacts_of(cube, {}, ball, pose, 0);
        depth = largest_depth(found);
        if (!(depth > 1e-9)) break;
        for (const MeshContact& c : found) {
          if (c.depth == depth) {
            pose.position += depth * c.normal;
            break;
          }
        }
      }
      CHECK(depth <= 1e-6);
    }
  }

  TEST_CASE("contacts move with the pair, wherever it is") {
    std::mt19937_64 random(5);
    const ContactMesh ell = solid(hooke::test::make_ell(Real(0.5)));
    const RigidPose pose_a = random_pose(random, 1);
    const RigidPose pose_b = {pose_a.position + DVec3{0.3, 0.2, 0.1}, random_pose(random, 1).rotation};
    const Contacts here = contacts_of(ell, pose_a, ell, pose_b, 0);
    REQUIRE_FALSE(here.empty());
    const DVec3 shift = {4096, -8192, 1024};
    const Contacts there = contacts_of(ell, {pose_a.position + shift, pose_a.rotation}, ell,
                                       {pose_b.position + shift, pose_b.rotation}, 0);
    REQUIRE(there.size() == here.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      CHECK(near(there[i].point, here[i].point + shift) < 1e-9);
      CHECK(near(there[i].normal, here[i].normal) < 1e-9);
      CHECK(there[i].depth == doctest::Approx(here[i].depth));
    }
  }

  TEST_CASE("a sphere at a face, an edge, a vertex, in a notch, and with its center inside") {
    const ContactMesh cube = solid(hooke::test::make_cube(1));
    const auto sphere = [](DVec3 center, double radius, const ContactMesh& mesh) {
      Contacts by_tree;
      Contacts by_all;
      find_sphere_contacts(center, radius, mesh, {}, {kMargin, Search::kTree}, by_tree);
      find_sphere_contacts(center, radius, mesh, {}, {kMargin, Search::kAll}, by_all);
      REQUIRE(std::equal(by_tree.begin(), by_tree.end(), by_all.begin(), by_all.end(), is_same));
      return by_tree;
    };
    const auto one = [&](DVec3 center, double radius, MeshContactKind kind, DVec3 out, double depth) {
      const Contacts found = sphere(center, radius, cube);
      REQUIRE(found.size() == 1);
      CHECK(found[0].kind == kind);
      CHECK(near(found[0].normal, -normalize(out)) < 1e-12);
      CHECK(found[0].depth == doctest::Approx(depth));
    };
    one({0.2, 1.4, 0.3}, 0.5, MeshContactKind::kVertexFace, {0, 1, 0}, 0.1);
    one({0.2, 1.5005, 0.3}, 0.5, MeshContactKind::kVertexFace, {0, 1, 0}, -0.0005);
    // The paper's figure 6: a ball beside the face, over the edge.
    one({1.3, 1.3, 0.2}, 0.5, MeshContactKind::kEdgeEdge, {1, 1, 0}, 0.5 - 0.3 * std::sqrt(2.0));
    one({1.2, 1.2, -1.2}, 0.5, MeshContactKind::kFaceVertex, {1, 1, -1}, 0.5 - 0.2 * std::sqrt(3.0));
    one({0.1, 0.8, 0.2}, 0.5, MeshContactKind::kVertexFace, {0, 1, 0}, 0.7);
    one({0.1, 1, 0.2}, 0.5, MeshContactKind::kVertexFace, {0, 1, 0}, 0.5);
    CHECK(sphere({1.4, 1.4, 0.2}, 0.5, cube).empty());
    CHECK(sphere({std::nan(""), 0, 0}, 0.5, cube).empty());
    const Contacts notch = sphere({1.4, 1.45, 0}, 0.5, solid(hooke::test::make_ell(1)));
    REQUIRE(notch.size() == 2);
    CHECK(std::max(notch[0].depth, notch[1].depth) == doctest::Approx(0.1));
    CHECK(std::min(notch[0].depth, notch[1].depth) == doctest::Approx(0.05));
  }

  TEST_CASE("poses that are not finite have no contacts") {
    const ContactMesh cube = solid(hooke::test::make_cube(1));
    for (const double bad : {std::nan(""), double(INFINITY)}) {
      CHECK(contacts_of(cube, {{bad, 0, 0}, {}}, cube, {}).empty());
      CHECK(contacts_of(cube, {}, cube, {{0, 0, 0}, {0, bad, 0, 1}}).empty());
    }
  }
}
