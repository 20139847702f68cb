#include "hooke/scene_io.h"

#include <doctest/doctest.h>

TEST_SUITE("io/scene_load") {
  TEST_CASE("a rope scene arrives in the descriptor") {
    const auto loaded = hooke::parse_scene(R"({
      // a comment
      "version": 1,
      "ropes": [{"name": "rope", "masses": 32, "total_mass": 0.4, "stiffness": 1e4, "pins": [0, "last"]}]
    })",
                                           "demo.json");
    for (const auto& error : loaded.errors) MESSAGE(hooke::to_line(error));
    REQUIRE(loaded);
    REQUIRE(loaded.value->objects.ropes.size() == 1);
    const hooke::SceneRope& rope = loaded.value->objects.ropes[0];
    CHECK(rope.tag.name == "rope");
    CHECK(rope.desc.masses == 32);
    CHECK(rope.desc.total_mass == hooke::Real(0.4));
    CHECK(rope.desc.stiffness == hooke::Real(1e4));
    REQUIRE(rope.pins.size() == 2);
    CHECK(rope.pins[1].point.last);
    MESSAGE(hooke::write_scene(*loaded.value));
  }

  TEST_CASE("an error says where it stands, what is wrong and what is right") {
    const auto loaded = hooke::parse_scene(
        "{\n  \"version\": 1,\n  \"ropes\": [{\"masses\": 1, \"mases\": 2}]\n}", "demo.json");
    REQUIRE(loaded.errors.size() == 2);
    CHECK(hooke::to_line(loaded.errors[0]) ==
          "demo.json:3:24: ropes[0].masses: 1 is out of range, must be 2 to 65536");
    CHECK(hooke::to_line(loaded.errors[1]) ==
          "demo.json:3:27: ropes[0].mases: unknown key, did you mean 'masses'?");
  }
}
