#include "io/json/json_node.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace hooke::io {

namespace {

constexpr std::size_t kLineWidth = 100;

using FloatJson =
    nlohmann::basic_json<std::map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>;

JsonNode number_node(double value, std::string digits) {
  JsonNode node;
  node.kind = JsonNode::Kind::kNumber;
  node.number = value;
  // "-0" would be read as the whole number 0.
  if (digits.ends_with(".0") && digits != "-0.0") digits.resize(digits.size() - 2);
  node.text = std::move(digits);
  return node;
}

std::string string_literal(const std::string& text) {
  const bool plain = std::all_of(text.begin(), text.end(),
                                 [](char c) { return c >= ' ' && c < 127 && c != '"' && c != '\\'; });
  if (plain) return '"' + text + '"';
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string scalar_text(const JsonNode& node) {
  switch (node.kind) {
    case JsonNode::Kind::kBoolean:
      return node.boolean ? "true" : "false";
    case JsonNode::Kind::kNumber:
      return node.text.empty() ? make_number(node.number).text : node.text;
    case JsonNode::Kind::kString:
      return string_literal(node.text);
    default:
      return "null";
  }
}

/// Appends the node on one line; returns false as soon as the line is wider than `width`.
bool append_flat(std::string& line, const JsonNode& node, std::size_t width) {
  const bool object = node.kind == JsonNode::Kind::kObject;
  if (!object && node.kind != JsonNode::Kind::kArray) {
    line += scalar_text(node);
    return line.size() <= width;
  }
  line += object ? "{" : "[";
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    if (i > 0) line += ", ";
    if (object) line += string_literal(node.children[i].key) + ": ";
    if (!append_flat(line, node.children[i], width)) return false;
  }
  line += object ? "}" : "]";
  return line.size() <= width;
}

void append(std::string& text, const JsonNode& node, std::size_t depth, std::size_t used) {
  std::string flat;
  const bool splittable = !node.children.empty();
  const std::size_t width = used < kLineWidth ? kLineWidth - used : 0;
  if (!splittable || (depth > 0 && append_flat(flat, node, width))) {
    if (!splittable) append_flat(flat, node, std::string::npos);
    text += flat;
    return;
  }
  const bool object = node.kind == JsonNode::Kind::kObject;
  const std::string indent(2 * (depth + 1), ' ');
  text += object ? "{" : "[";
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    text += (i > 0 ? ",\n" : "\n") + indent;
    const std::string label = object ? string_literal(node.children[i].key) + ": " : "";
    text += label;
    append(text, node.children[i], depth + 1, indent.size() + label.size() + 1);
  }
  text += "\n" + std::string(2 * depth, ' ') + (object ? "}" : "]");
}

}  // namespace

const JsonNode* JsonNode::find(std::string_view wanted) const {
  if (kind != Kind::kObject) return nullptr;
  const auto found =
      std::find_if(children.begin(), children.end(), [&](const JsonNode& c) { return c.key == wanted; });
  return found == children.end() ? nullptr : &*found;
}

JsonNode* JsonNode::find(std::string_view wanted) {
  return const_cast<JsonNode*>(std::as_const(*this).find(wanted));
}

JsonNode& JsonNode::add(std::string_view new_key, JsonNode value) {
  value.key = std::string(new_key);
  children.push_back(std::move(value));
  return children.back();
}

JsonNode& JsonNode::add(JsonNode value) {
  children.push_back(std::move(value));
  return children.back();
}

JsonNode make_object() {
  JsonNode node;
  node.kind = JsonNode::Kind::kObject;
  return node;
}

JsonNode make_array() {
  JsonNode node;
  node.kind = JsonNode::Kind::kArray;
  return node;
}

JsonNode make_string(std::string_view text) {
  JsonNode node;
  node.kind = JsonNode::Kind::kString;
  node.text = std::string(text);
  return node;
}

JsonNode make_boolean(bool value) {
  JsonNode node;
  node.kind = JsonNode::Kind::kBoolean;
  node.boolean = value;
  return node;
}

JsonNode make_integer(std::int64_t value) {
  return number_node(static_cast<double>(value), std::to_string(value));
}

JsonNode make_number(double value) {
  if (!std::isfinite(value)) return make_integer(0);
  return number_node(value, nlohmann::json(value).dump());
}

JsonNode make_number(float value) {
  if (!std::isfinite(value)) return make_integer(0);
  return number_node(static_cast<double>(value), FloatJson(value).dump());
}

const char* name_of(JsonNode::Kind kind) {
  switch (kind) {
    case JsonNode::Kind::kNull:
      return "null";
    case JsonNode::Kind::kBoolean:
      return "true or false";
    case JsonNode::Kind::kNumber:
      return "a number";
    case JsonNode::Kind::kString:
      return "a string";
    case JsonNode::Kind::kArray:
      return "a list";
    case JsonNode::Kind::kObject:
      return "an object";
  }
  return "nothing";
}

std::string to_text(const JsonNode& root) {
  std::string text;
  append(text, root, 0, 0);
  text += '\n';
  return text;
}

std::string to_flat_text(const JsonNode& root) {
  std::string text;
  append_flat(text, root, std::string::npos);
  return text;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  std::string_view shown = text.substr(0, kLongest);
  if (text.size() > kLongest) {
    // A character of several bytes must not be cut in two.
    while (!shown.empty() && (static_cast<unsigned char>(text[shown.size()]) & 0xC0U) == 0x80U) {
      shown.remove_suffix(1);
    }
  }
  for (const char c : shown) result += static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c;
  return result + (text.size() > kLongest ? "...'" : "'");
}

int edit_distance_up_to_2(std::string_view a, std::string_view b) {
  constexpr std::size_t kLongest = 48;
  constexpr int kFar = 3;
  const std::size_t difference = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
  if (difference > 2 || a.size() > kLongest || b.size() > kLongest) return kFar;
  std::array<int, kLongest + 1> row = {};
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return std::min(row[b.size()], kFar);
}

}  // namespace hooke::io
