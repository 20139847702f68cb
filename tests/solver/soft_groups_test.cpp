#include "solver/soft/soft_groups.h"

#include "build/build.h"
#include "solver/soft/soft_tuning.h"
#include "state/tables.h"
#include "world/object_edits.h"

#include <doctest/doctest.h>

namespace hooke::solver {

namespace {

/// A world's tables without a World, and the copies of their rows.
struct Rig {
  state::Tables t;
  SoftGroups soft;

  void add_cloth(int side) {
    REQUIRE(build::add_cloth({.columns = side, .rows = side, .bend = ClothDesc::Bend::kIsometric}, t));
  }
  void add_pair() {
    REQUIRE(build::add_particles({.particles = {{}, {.position = {1, 0, 0}}}, .springs = {{0, 1}}}, t));
  }
  void remove(std::uint32_t object) {
    // Without slots, which belong to the World.
    t.particles_slots = {};
    for (std::uint32_t i = 0; i < t.objects.size(); ++i) t.objects[i].kind = PointRef::Kind::kNone;
    world::remove_object(t, object);
  }

  /// How many objects were copied to bring the groups up to date.
  std::uint64_t refresh() {
    const std::uint64_t before = soft.built_objects;
    refresh_soft_groups(t, 1, soft);
    return soft.built_objects - before;
  }
};

constexpr int kLargeSide = 90;  // More rows than groups of several objects have.

/// The rows of a spring's particles, by the copy of its object.
std::uint32_t first_end_of_copy(const Rig& rig, std::uint32_t object) {
  const SoftGroup& group = rig.soft.groups[rig.soft.group_of[object]];
  REQUIRE(group.springs.blocks.size() == 1);
  return group.springs.first_particle + group.springs.blocks[0].record_a[0] / 4;
}

}  // namespace

TEST_SUITE("solver/soft_groups") {
  TEST_CASE("what is added beside a large object is copied alone") {
    Rig rig;
    rig.add_cloth(kLargeSide);
    CHECK(rig.refresh() == 1);
    CHECK(rig.soft.groups[0].size > kMostRowsOfSharedGroup);
    rig.add_pair();
    CHECK(rig.refresh() == 1);
    CHECK(rig.refresh() == 0);
    CHECK(rig.soft.groups.size() == 2);
  }

  TEST_CASE("small neighbors share a group, and one more makes the copies of their group alone anew") {
    Rig rig;
    rig.add_pair();
    rig.add_cloth(kLargeSide);
    for (int i = 0; i < 3; ++i) rig.add_pair();
    CHECK(rig.refresh() == 5);
    CHECK(rig.soft.groups.size() == 3);
    rig.add_pair();
    CHECK(rig.refresh() == 4);
    CHECK(rig.soft.groups.size() == 3);
    rig.add_pair();
    CHECK(rig.refresh() == 5);
    rig.add_pair();
    CHECK(rig.refresh() == 1);  // Its neighbors are more than four by now.
    CHECK(rig.soft.groups.size() == 4);
    for (const SoftGroup& group : rig.soft.groups)
      CHECK((group.revisions.size() == 1 || group.size <= kMostRowsOfSharedGroup));
  }

  TEST_CASE("loose particles have nothing to copy") {
    Rig rig;
    rig.add_cloth(3);
    rig.refresh();
    REQUIRE(build::add_particles({.particles = {{}}}, rig.t));
    CHECK(rig.refresh() == 0);
    CHECK(rig.soft.group_of[1] == SoftGroups::kNone);
  }

  TEST_CASE("copies move with the rows when an earlier object goes") {
    Rig rig;
    rig.add_pair();
    rig.add_cloth(kLargeSide);
    rig.add_pair();
    rig.refresh();
    CHECK(first_end_of_copy(rig, 2) == rig.t.springs.particle_a.back());
    rig.remove(0);
    CHECK(rig.refresh() == 0);
    CHECK(rig.soft.groups.size() == 2);
    CHECK(rig.soft.groups[0].springs.first_particle == 0);
    CHECK(first_end_of_copy(rig, 1) == rig.t.springs.particle_a.back());
    CHECK(first_end_of_copy(rig, 1) == kLargeSide * kLargeSide);
  }

  TEST_CASE("an object that changes is copied anew, with its group") {
    Rig rig;
    rig.add_cloth(kLargeSide);
    rig.add_pair();
    rig.add_pair();
    rig.refresh();
    state::note_change(rig.t, rig.t.objects[0]);
    CHECK(rig.refresh() == 1);
    state::note_change(rig.t, rig.t.objects[1]);
    CHECK(rig.refresh() == 2);
    state::note_change_of_all(rig.t);
    CHECK(rig.refresh() == 3);
  }

  TEST_CASE("objects that come one by one are copied a few times each, and leave few groups") {
    Rig rig;
    constexpr std::size_t kObjects = 120;
    for (std::size_t i = 0; i < kObjects; ++i) {
      rig.add_cloth(16);
      rig.refresh();
    }
    std::size_t rows = 0;
    for (const SoftGroup& group : rig.soft.groups) rows += group.size;
    CHECK(rows > 4 * kMostRowsOfSharedGroup);
    CHECK(rig.soft.groups.size() <= 2 * rows / kMostRowsOfSharedGroup + 4);
    CHECK(rig.soft.built_objects < 8 * kObjects);
  }

  TEST_CASE("a group that is most of the work is divided, and equal ones are not") {
    Rig rig;
    rig.add_cloth(kLargeSide);
    for (int i = 0; i < 3; ++i) rig.add_pair();
    refresh_soft_groups(rig.t, 4, rig.soft);
    CHECK(rig.soft.divided == std::vector<std::uint32_t>{0});
    CHECK(rig.soft.whole == std::vector<std::uint32_t>{1});
    for (int i = 0; i < 15; ++i) rig.add_cloth(kLargeSide);
    refresh_soft_groups(rig.t, 4, rig.soft);
    CHECK(rig.soft.divided.empty());
  }
}

}  // namespace hooke::solver
