#include "hooke/scene_io.h"

#include "io/json/json_document.h"

#include <algorithm>
#include <vector>

namespace hooke {

namespace {

/// Returns the offset after the string that begins at `start`.
std::size_t end_of_string(std::string_view text, std::size_t start) {
  std::size_t i = start + 1;
  for (; i < text.size() && text[i] != '"'; ++i) {
    if (text[i] == '\\') ++i;
  }
  return std::min(i + 1, text.size());
}

/// Returns the offset after the comment that begins at `start`, or `start` if none does.
std::size_t end_of_comment(std::string_view text, std::size_t start) {
  const std::string_view mark = text.substr(start, 2);
  const auto after = [&](std::string_view end) {
    const std::size_t found = text.find(end, start + 2);
    return found == std::string_view::npos ? text.size() : found + end.size();
  };
  if (mark == "//") return after("\n");
  if (mark == "/*") return after("*/");
  return start;
}

/// Returns the offset after the value that begins at `start`. The text was parsed before, so that it is well
/// formed.
std::size_t end_of_value(std::string_view text, std::size_t start) {
  if (text[start] == '"') return end_of_string(text, start);
  if (text[start] != '{' && text[start] != '[')
    return std::min(text.find_first_of(",]}/ \t\r\n", start), text.size());
  int depth = 0;
  for (std::size_t i = start; i < text.size();) {
    if (const std::size_t comment = end_of_comment(text, i); comment > i) {
      i = comment;
      continue;
    }
    if (text[i] == '"') {
      i = end_of_string(text, i);
      continue;
    }
    depth += text[i] == '{' || text[i] == '[' ? 1 : text[i] == '}' || text[i] == ']' ? -1 : 0;
    ++i;
    if (depth == 0) return i;
  }
  return text.size();
}

/// Writes a key as a new last member of an object: on a line of its own if the member before it has one.
void append_member(std::string& text, const io::JsonNode& object, const std::string& member) {
  if (object.children.empty()) {
    text.insert(object.offset + 1, member);
    return;
  }
  const io::JsonNode& last = object.children.back();
  const std::size_t line = text.rfind('\n', last.key_offset) + 1;
  const std::string indent = text.substr(line, last.key_offset - line);
  const bool has_line = line > 0 && indent.find_first_not_of(" \t") == std::string::npos;
  text.insert(end_of_value(text, last.offset), (has_line ? ",\n" + indent : ", ") + member);
}

}  // namespace

Result<std::string> edit_scene_text(std::string text, std::string_view path, std::string_view value) {
  const std::string where(path);
  io::JsonDocument document;
  if (!io::parse_json(std::string(value), where, document).empty())
    return Error{ErrorCode::kWrongType, where, "what it shall be is no JSON: " + std::string(value)};
  const auto errors = io::parse_json(text, where, document);
  if (!errors.empty()) return errors.front().error;
  const io::JsonNode* node = &document.root;
  while (!path.empty()) {
    std::string_view below = path;
    const io::JsonNode* child = io::step_down(*node, below);
    if (child == nullptr) break;
    node = child;
    path = below;
  }
  if (path.empty()) {
    const std::size_t start = node->offset;
    text.replace(start, end_of_value(text, start) - start, value);
    return text;
  }
  // What is missing on the way is made of objects.
  std::vector<std::string_view> keys;
  while (!path.empty()) {
    if (path.starts_with('[')) return Error{ErrorCode::kUnknownKey, where, "the list has no such element"};
    if (path.starts_with('.')) path.remove_prefix(1);
    keys.push_back(path.substr(0, path.find_first_of(".[")));
    path.remove_prefix(keys.back().size());
  }
  std::string member(value);
  for (std::size_t i = keys.size(); i-- > 0;) {
    member = io::to_flat_text(io::make_string(std::string(keys[i]))) + ": " + member;
    if (i > 0) member = "{" + member + "}";
  }
  if (node->kind != io::JsonNode::Kind::kObject)
    return Error{ErrorCode::kWrongType, where, "lies in a value that has no keys"};
  append_member(text, *node, member);
  return text;
}

}  // namespace hooke
