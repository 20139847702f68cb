/// Scene files: those of scenes/, changed where they mean something, read, written and read again. Small ones
/// are also run for a few steps.

#include "hooke/scene_io.h"

#include "fuzz/scene_checks.h"
#include "fuzz/target.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace hooke::fuzz {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kLargestFile = 30'000;

std::vector<Json> read_corpus() {
  std::vector<std::filesystem::path> files;
  for (const std::string& folder :
       {setting().scenes, setting().scenes + "/paper", setting().corpus + "/json"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const bool is_scene = entry.path().extension() == ".json" && entry.path().filename() != "schema.json";
      if (is_scene && entry.file_size() < kLargestFile) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<Json> corpus;
  for (const auto& file : files) {
    std::ifstream stream(file);
    Json scene = Json::parse(stream, nullptr, false, true);
    if (!scene.is_discarded()) corpus.push_back(std::move(scene));
  }
  return corpus;
}

const std::vector<Json>& corpus() {
  static const std::vector<Json> scenes = read_corpus();
  return scenes;
}

Json& child_of(Json& node, std::size_t i) {
  auto at = node.begin();
  std::advance(at, static_cast<std::ptrdiff_t>(i));
  return *at;
}

/// A node somewhere in the tree, deeper ones more often.
Json* pick_node(Random& random, Json& root) {
  Json* node = &root;
  while (node->is_structured() && !node->empty() && (node == &root || random.chance(0.8)))
    node = &child_of(*node, random.below(node->size()));
  return node;
}

/// A node with children.
Json* pick_parent(Random& random, Json& root) {
  Json* parent = &root;
  for (Json* node = &root; node->is_structured() && !node->empty();) {
    parent = node;
    if (!random.chance(0.75)) break;
    node = &child_of(*node, random.below(node->size()));
  }
  return parent;
}

Json make_value(Random& random) {
  switch (random.below(8)) {
    case 0:
      return nullptr;
    case 1:
      return random.chance(0.5);
    case 2:
      return random.pick<const char*>(
          {"", "last", "rigid", "ground", "a[0]", "x.y", "\xC3\xA9", "../x", "rope.end"});
    case 3:
      return Json::array();
    case 4:
      return Json::object();
    case 5:
      return Json::array({bad_number(random), 0, -0.0});
    case 6:
      return static_cast<std::int64_t>(
          random.pick<std::int64_t>({0, -1, 1, 2, 65, 4097, 1LL << 31, 1LL << 62}));
    default:
      return bad_number(random);
  }
}

void change_number(Random& random, Json& node) {
  const double value = node.get<double>();
  switch (random.below(6)) {
    case 0:
      node = bad_number(random);
      break;
    case 1:
      node = -value;
      break;
    case 2:
      node = value * random.pick<double>({0.1, 0.5, 2, 10, 1000});
      break;
    case 3:
      node = static_cast<std::int64_t>(random.below(8));
      break;
    case 4:
      node = -0.0;
      break;
    default:
      node = value + random.between(-1, 1);
  }
}

void change_parent(Random& random, Json& parent, const Json& other) {
  if (parent.empty()) return;
  const std::size_t i = random.below(parent.size());
  switch (random.below(4)) {
    case 0:
      if (parent.is_object()) {
        parent.erase(std::next(parent.begin(), static_cast<std::ptrdiff_t>(i)));
      } else {
        parent.erase(i);
      }
      break;
    case 1:  // the same once more
      if (parent.is_array()) {
        parent.push_back(Json(child_of(parent, i)));
      } else {
        parent[std::next(parent.begin(), static_cast<std::ptrdiff_t>(i)).key() + "2"] =
            Json(child_of(parent, i));
      }
      break;
    case 2: {  // what stands elsewhere
      const Json* source = pick_parent(random, const_cast<Json&>(other));
      if (source->empty()) break;
      const std::size_t k = random.below(source->size());
      const auto from = std::next(source->begin(), static_cast<std::ptrdiff_t>(k));
      if (parent.is_array()) {
        parent.push_back(*from);
      } else if (source->is_object()) {
        parent[from.key()] = *from;
      }
      break;
    }
    default:
      if (parent.is_array()) {
        std::swap(child_of(parent, i), child_of(parent, random.below(parent.size())));
      } else {
        child_of(parent, i) = make_value(random);
      }
  }
}

void change(Random& random, Json& scene) {
  if (random.chance(0.4)) {
    change_parent(random, *pick_parent(random, scene), random.chance(0.5) ? scene : random.one_of(corpus()));
    return;
  }
  Json& node = *pick_node(random, scene);
  if (node.is_number() && random.chance(0.85)) {
    change_number(random, node);
  } else {
    node = make_value(random);
  }
}

/// Changes of the text alone.
void tear(Random& random, std::string& text) {
  const std::size_t at = random.below(text.size());
  switch (random.below(5)) {
    case 0:
      text.resize(at);
      break;
    case 1:
      text[at] = static_cast<char>(random.bits());
      break;
    case 2:
      text.insert(at, random.pick<const char*>(
                          {"\"", "{", "]", "/*", "//", "\\u", "1e999", "-", "\xFF", ",", "NaN"}));
      break;
    case 3:
      text.insert(at, std::string(1 + random.below(200), random.pick<char>({'[', '{', ' ', '\n', '9'})));
      break;
    default:
      text.erase(at, random.below(20));
  }
}

void check_errors(const std::vector<Error>& errors) {
  for (const Error& error : errors) {
    expect(!error.message.empty(), "an error without a word");
    expect(to_line(error).find('\n') == std::string::npos, "an error of several lines");
  }
}

void expect_same(const std::string& written, const std::string& again) {
  const auto [a, b] = std::mismatch(written.begin(), written.end(), again.begin(), again.end());
  if (a == written.end() && b == again.end()) return;
  const auto at = static_cast<std::size_t>(a - written.begin());
  const std::size_t from = at - std::min<std::size_t>(at, 40);
  throw Failure("writes the same scene differently: " + written.substr(from, 80) + " | " +
                again.substr(from, 80));
}

}  // namespace

void check_json(std::string text) {
  Loaded<Scene> scene = parse_scene(std::move(text), "scene.json");
  check_errors(scene.errors);
  check_errors(scene.warnings);
  expect(scene.value.has_value() == scene.errors.empty(), "neither a scene nor an error");
  if (!scene) return;
  const std::string written = write_scene(*scene.value);
  const Loaded<Scene> second = parse_scene(written, "scene.json");
  expect(second.value.has_value(),
         "cannot read what it wrote: " + (second.errors.empty() ? "" : to_line(second.errors.front())));
  expect(*second.value == *scene.value, "does not come back from what it writes");
  expect_same(written, write_scene(*second.value));
  if (is_small(*scene.value)) run_both(std::move(*scene.value), *second.value);
}

void try_json(Random& random) {
  Json scene = random.one_of(corpus());
  note("from '" + scene.value("title", "") + "'");
  const int changes = random.integer(1, 6);
  for (int i = 0; i < changes; ++i) change(random, scene);
  std::string text = scene.dump(random.chance(0.2) ? 1 : -1, ' ', false, Json::error_handler_t::replace);
  if (random.chance(0.15)) tear(random, text);
  save_tried(std::as_bytes(std::span(text)));
  check_json(std::move(text));
}

}  // namespace hooke::fuzz
