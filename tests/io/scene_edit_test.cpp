#include "hooke/scene_io.h"

#include <doctest/doctest.h>
#include <string>

namespace {

const std::string kText = R"({
  "version": 1, // the newest
  "title": "not \" ]} the end",
  "world": {"gravity": [0, -9.81, 0], "wind": {}},
  "materials": {"rubber": {"friction": 1}},
  "ropes": [
    {
      "name": "a", /* "total_mass": 7, */
      "stiffness": "rigid" // }
    },
    {"name": "b", "total_mass": 2.5}
  ]
}
)";

std::string edited(const std::string& text, const char* path, const char* value) {
  const hooke::Result<std::string> result = hooke::edit_scene_text(text, path, value);
  return result ? result.value() : "error: " + hooke::to_line(result.error());
}

/// The text with a part of it replaced.
std::string with(const std::string& part, const std::string& by) {
  std::string text = kText;
  REQUIRE(text.find(part) != std::string::npos);
  return text.replace(text.find(part), part.size(), by);
}

}  // namespace

TEST_SUITE("io/scene_edit") {
  TEST_CASE("a value is replaced, and all else stays to the byte") {
    CHECK(edited(kText, "ropes[1].total_mass", "3") == with("2.5", "3"));
    CHECK(edited(kText, "world.gravity", "[0, -1.62, 0]") == with("[0, -9.81, 0]", "[0, -1.62, 0]"));
    CHECK(edited(kText, "world.gravity[1]", "-1.62") == with("-9.81", "-1.62"));
    CHECK(edited(kText, "ropes[0].stiffness", "500") == with("\"rigid\"", "500"));
    CHECK(edited(kText, "materials.rubber.friction", "0.5") == with("\"friction\": 1", "\"friction\": 0.5"));
    CHECK(edited(kText, "title", "\"c\"") == with("\"not \\\" ]} the end\"", "\"c\""));
  }

  TEST_CASE("a key that is not there is added in the style of its object") {
    CHECK(edited(kText, "ropes[0].total_mass", "3") ==
          with("\"rigid\" //", "\"rigid\",\n      \"total_mass\": 3 //"));
    CHECK(edited(kText, "ropes[1].masses", "8") == with("2.5}", "2.5, \"masses\": 8}"));
    CHECK(edited(kText, "world.wind.gust", "0.5") == with("\"wind\": {}", "\"wind\": {\"gust\": 0.5}"));
    CHECK(edited(kText, "camera.view.eye", "[1, 2, 3]") ==
          with("\n  ]\n}", "\n  ],\n  \"camera\": {\"view\": {\"eye\": [1, 2, 3]}}\n}"));
  }

  TEST_CASE("what cannot be edited is refused with a reason") {
    CHECK(edited(kText, "ropes[2].masses", "8").find("no such element") != std::string::npos);
    CHECK(edited(kText, "version.of", "8").find("has no keys") != std::string::npos);
    CHECK(edited(kText, "ropes[1].masses", "8,").find("no JSON") != std::string::npos);
    CHECK(edited("{\"a\": ", "a", "8").starts_with("error: "));
  }

  TEST_CASE("an edited scene is read with the new value") {
    const hooke::Loaded<hooke::Scene> scene =
        hooke::parse_scene(edited(kText, "ropes[0].total_mass", "3"), "scene.json");
    REQUIRE(scene);
    CHECK(scene.value->objects.ropes[0].desc.total_mass == 3);
    const hooke::Loaded<hooke::Scene> bad =
        hooke::parse_scene(edited(kText, "ropes[1].total_mass", "-3"), "scene.json");
    REQUIRE(bad.errors.size() == 1);
    CHECK(hooke::to_line(bad.errors[0]).find("greater than 0") != std::string::npos);
  }
}
