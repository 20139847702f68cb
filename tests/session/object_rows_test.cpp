#include "hooke/view/object_rows.h"

#include <doctest/doctest.h>

namespace hooke::app {

namespace {

std::string lines(const std::vector<std::string>& names, const std::string& find = "",
                  const std::set<std::string>& open = {}, const std::string& selected = "") {
  std::vector<ListedObject> listed;
  for (const std::string& name : names) listed.push_back({.name = name});
  std::vector<const ListedObject*> objects;
  for (const ListedObject& object : listed) objects.push_back(&object);
  std::string text;
  for (const ObjectRow& row : object_rows(objects, find, open, selected)) {
    text += row.name;
    if (row.members > 0) text += (row.is_open ? " v" : " >") + std::to_string(row.members);
    text += ' ';
  }
  return text;
}

}  // namespace

TEST_SUITE("session/object_rows") {
  TEST_CASE("arrays are one line each until they are opened") {
    const std::vector<std::string> names = {"ground", "brick[0]", "brick[1]", "half[0]", "ball"};
    CHECK(lines(names) == "ground brick >2 half >1 ball ");
    CHECK(lines(names, "", {"half"}) == "ground brick >2 half v1 half[0] ball ");
    CHECK(lines(names, "", {}, "brick[1]") == "ground brick v2 brick[0] brick[1] half >1 ball ");
    CHECK(lines({}).empty());
  }

  TEST_CASE("a text that is looked for leaves the objects with it") {
    const std::vector<std::string> names = {"ground", "brick[0]", "brick[1]", "Half[0]", "ball"};
    CHECK(lines(names, "half") == "Half[0] ");
    CHECK(lines(names, "[1]") == "brick[1] ");
    CHECK(lines(names, "B") == "brick[0] brick[1] ball ");
    CHECK(lines(names, "rope").empty());
  }
}

}  // namespace hooke::app
