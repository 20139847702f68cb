#include "hooke/session/scene_keys.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

namespace hooke::app {

namespace {

using Json = nlohmann::ordered_json;

/// Groups within groups are shown to this depth, as "world", "wind".
constexpr int kDeepestGroup = 3;
/// Lists of more numbers than these are data, and no vectors.
constexpr std::size_t kLongestVector = 4;

const Json& schema() {
  static const Json parsed = Json::parse(scene_schema());
  return parsed;
}

/// Follows references to the description of an object.
const Json& resolve(const Json& described) {
  const Json* now = &described;
  for (;;) {
    if (now->contains("allOf")) {
      now = &now->at("allOf").front();
    } else if (now->contains("$ref")) {
      const std::string reference = now->at("$ref");
      now = &schema().at("definitions").at(reference.substr(reference.rfind('/') + 1));
    } else {
      return *now;
    }
  }
}

struct Place {
  const Json* described = nullptr;  ///< What the format says of it; null for a path that it does not know.
  const Json* value = nullptr;      ///< What the document says; null for nothing.
};

/// Goes on to a key or to an element.
Place step(Place place, const std::string& word, bool is_index) {
  const Json& described = resolve(*place.described);
  Place next;
  if (is_index) {
    if (described.contains("items")) next.described = &described.at("items");
    const std::size_t index = std::strtoul(word.c_str(), nullptr, 10);
    const bool is_there = place.value != nullptr && place.value->is_array() && index < place.value->size();
    if (is_there) next.value = &place.value->at(index);
    return next;
  }
  if (described.contains("properties") && described.at("properties").contains(word)) {
    next.described = &described.at("properties").at(word);
  } else if (described.contains("additionalProperties") && described.at("additionalProperties").is_object()) {
    next.described = &described.at("additionalProperties");
  }
  const bool is_there = place.value != nullptr && place.value->is_object() && place.value->contains(word);
  if (is_there) next.value = &place.value->at(word);
  return next;
}

Place find(Place place, std::string_view path) {
  while (!path.empty() && place.described != nullptr) {
    const bool is_index = path.front() == '[';
    if (is_index || path.front() == '.') path.remove_prefix(1);
    const std::size_t end = std::min(path.find_first_of(is_index ? "]" : ".["), path.size());
    place = step(place, std::string(path.substr(0, end)), is_index);
    path.remove_prefix(std::min(is_index ? end + 1 : end, path.size()));
  }
  return place;
}

bool is_number(const Json& described) {
  const std::string type = described.value("type", "");
  return type == "number" || type == "integer";
}

bool is_vector(const Json& described) {
  if (!described.contains("items") || !described.contains("maxItems")) return false;
  const std::size_t most = described.at("maxItems");
  const bool has_size = described.value("minItems", std::size_t{0}) == most;
  return has_size && most <= kLongestVector && is_number(described.at("items"));
}

/// Returns nothing for a list, and for what has several forms.
std::optional<SceneKey::Type> type_of(const Json& described) {
  const std::string type = described.value("type", "");
  if (is_number(described)) return SceneKey::Type::kNumber;
  if (type == "boolean") return SceneKey::Type::kBoolean;
  if (type == "string") return SceneKey::Type::kText;
  if (described.contains("enum")) return SceneKey::Type::kWord;
  if (is_vector(described)) return SceneKey::Type::kVector;
  if (described.contains("anyOf")) {
    const Json& first = described.at("anyOf").front();
    if (is_number(first)) return SceneKey::Type::kNumber;
    if (is_vector(first)) return SceneKey::Type::kVector;
    return {};
  }
  if (resolve(described).contains("properties")) return SceneKey::Type::kGroup;
  return {};
}

/// Help ends with the unit in brackets, if there is one.
void take_help(const Json& described, SceneKey& key) {
  key.help = described.value("description", "");
  const std::size_t bracket = key.help.rfind(" [");
  if (bracket == std::string::npos || !key.help.ends_with(']')) return;
  key.unit = key.help.substr(bracket + 2, key.help.size() - bracket - 3);
  key.help.erase(bracket);
}

std::vector<SceneKey> keys_at(const Place& place, const std::string& path, int depth) {
  std::vector<SceneKey> keys;
  const Json& described = resolve(*place.described);
  if (!described.contains("properties") || depth > kDeepestGroup) return keys;
  for (const auto& [word, rule] : described.at("properties").items()) {
    const std::optional<SceneKey::Type> type = type_of(rule);
    if (!type) continue;
    SceneKey key;
    key.type = *type;
    key.key = word;
    key.path = path.empty() ? word : path + "." + word;
    take_help(rule, key);
    const Place inside = step(place, word, false);
    key.said = inside.value != nullptr;
    if (key.said) {
      key.value = inside.value->dump();
    } else if (rule.contains("default")) {
      key.value = rule.at("default").dump();
    }
    if (rule.contains("enum")) key.words = rule.at("enum").get<std::vector<std::string>>();
    if (key.type == SceneKey::Type::kGroup) key.keys = keys_at(inside, key.path, depth + 1);
    keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace

std::vector<SceneKey> keys_of(const SceneDocument& document, const std::string& path) {
  // The scene was read from this text, so that it is JSON.
  const Json text = Json::parse(document.text, nullptr, false, true);
  if (text.is_discarded()) return {};
  const Place place = find({&schema(), &text}, path);
  return place.described != nullptr ? keys_at(place, path, 0) : std::vector<SceneKey>();
}

}  // namespace hooke::app
