#include "solver/surface/surface_mesh.h"

#include "build/build.h"
#include "build/cloth_tears.h"
#include "state/tables.h"
#include "world/object_edits.h"

#include <doctest/doctest.h>

namespace hooke::solver {

namespace {

/// A world's tables without a World, and the surfaces of its objects as steps keep them.
struct Rig {
  state::Tables t;
  SurfaceMeshes surfaces;

  Rig() {
    REQUIRE(build::add_cloth({.columns = 4, .rows = 4}, t));
    REQUIRE(build::add_rope({.masses = 7, .touches_surfaces = true}, t));
    REQUIRE(build::add_cloth({.columns = 5, .rows = 6, .tear_strain = Real(0.1)}, t));
    REQUIRE(build::add_cloth({.columns = 9, .rows = 3}, t));
    for (std::uint32_t i = 0; i < t.objects.size(); ++i) {
      state::Deformable& object = t.objects[i];
      object.slot =
          object.kind == PointRef::Kind::kRope ? t.rope_slots.add(i).slot : t.cloth_slots.add(i).slot;
    }
    (void)refresh_surfaces(t, surfaces);
  }

  std::size_t tear(std::uint32_t object) {
    const state::Rows rows = t.objects[object].particles;
    for (std::uint32_t i = rows.first; i < rows.end(); ++i) t.particles.position[i].x.x *= Real(1.5);
    std::vector<ClothTearEvent> events;
    build::tear_cloth(object, 0, t, events);
    return events.size();
  }
};

bool equals(const SurfaceEdge& a, const SurfaceEdge& b) {
  return a.vertex == b.vertex && a.opposite == b.opposite && a.owns_vertex == b.owns_vertex;
}

bool equals(const SurfaceTriangle& a, const SurfaceTriangle& b) {
  return a.vertex == b.vertex && a.edge == b.edge && a.owns_edge == b.owns_edge &&
         a.owns_vertex == b.owns_vertex;
}

bool equals(const SurfacePart& a, const SurfacePart& b) {
  return a.vertex == b.vertex && a.edge == b.edge && a.triangle == b.triangle &&
         a.joined_vertex == b.joined_vertex && a.joined_edge == b.joined_edge &&
         a.joined_triangle == b.joined_triangle && a.first_vertex == b.first_vertex;
}

template <class Row>
bool all_equal(const std::vector<Row>& a, const std::vector<Row>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Row& x, const Row& y) { return equals(x, y); });
}

/// Checks that surfaces that were kept are those that would be made anew.
void check_kept(Rig& rig) {
  CHECK(refresh_surfaces(rig.t, rig.surfaces));
  SurfaceMeshes anew;
  (void)refresh_surfaces(rig.t, anew);
  CHECK(rig.surfaces.particle == anew.particle);
  CHECK(rig.surfaces.mesh_of == anew.mesh_of);
  CHECK(rig.surfaces.joined == anew.joined);
  REQUIRE(rig.surfaces.meshes.size() == anew.meshes.size());
  for (std::size_t i = 0; i < anew.meshes.size(); ++i) {
    const SurfaceMesh& a = rig.surfaces.meshes[i];
    const SurfaceMesh& b = anew.meshes[i];
    CAPTURE(i);
    CHECK(a.object == b.object);
    CHECK(a.revision == b.revision);
    CHECK(a.first_particle == b.first_particle);
    CHECK(a.first_vertex == b.first_vertex);
    CHECK(a.vertices == b.vertices);
    CHECK(a.neighbors == b.neighbors);
    CHECK(all_equal(a.edges, b.edges));
    CHECK(all_equal(a.triangles, b.triangles));
    CHECK(all_equal(a.parts, b.parts));
  }
}

}  // namespace

TEST_SUITE("solver/surface_mesh") {
  TEST_CASE("surfaces are kept while others tear, come and go, and are those that would be made anew") {
    Rig rig;
    REQUIRE(rig.surfaces.meshes.size() == 4);
    CHECK(!refresh_surfaces(rig.t, rig.surfaces));
    REQUIRE(rig.tear(2) > 0);
    check_kept(rig);
    REQUIRE(build::add_cloth({.columns = 3, .rows = 3}, rig.t));
    check_kept(rig);
    CHECK(rig.surfaces.meshes.size() == 5);
  }

  TEST_CASE("surfaces move up when an object before them goes") {
    Rig rig;
    const SurfaceTriangle* const kept = rig.surfaces.meshes[2].triangles.data();
    world::remove_object(rig.t, 0);
    check_kept(rig);
    REQUIRE(rig.surfaces.meshes.size() == 3);
    CHECK(rig.surfaces.meshes[1].triangles.data() == kept);
  }
}

}  // namespace hooke::solver
