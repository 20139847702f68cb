#include "limits.h"
#include "refusal.h"
#include "scan.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace hooke::importer {

namespace {

using io::ImporterExit;
using nlohmann::json;

constexpr int kMaxJsonDepth = 64;

/// Returns the position of the closing quote of the string that starts before `i`, or the end of the text.
std::size_t end_of_string(std::string_view text, std::size_t i) {
  while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
  return i;
}

/// Counts open brackets outside strings, which bounds any parser's recursion.
void scan_depth(std::string_view text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') i = end_of_string(text, i + 1);
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kMaxJsonDepth) throw Refusal(ImporterExit::kLimitExceeded, "JSON nested more than 64 deep");
  }
}

/// Returns the nodes below a node, by number; the importer handles numbers that name no node.
std::vector<std::size_t> children_of(const json& node, std::size_t node_count) {
  std::vector<std::size_t> children;
  if (!node.is_object() || !node.contains("children")) return children;
  for (const json& child : node["children"]) {
    const bool is_node = child.is_number_unsigned() && child.get<std::uint64_t>() < node_count;
    if (is_node) children.push_back(child.get<std::size_t>());
  }
  return children;
}

/// Goes level by level from the nodes without a parent; a node that is never reached is part of a cycle.
void scan_nodes(const json& nodes) {
  if (nodes.size() > static_cast<std::size_t>(kMaxNodeCount)) {
    throw Refusal(ImporterExit::kLimitExceeded, "more than 16384 nodes");
  }
  std::vector<std::vector<std::size_t>> children;
  for (const json& node : nodes) children.push_back(children_of(node, nodes.size()));
  std::vector<int> parents(children.size(), 0);
  for (const auto& list : children) {
    for (const std::size_t child : list) ++parents[child];
  }
  if (std::any_of(parents.begin(), parents.end(), [](int count) { return count > 1; })) {
    throw Refusal(ImporterExit::kBadSyntax, "a node with two parents");
  }
  std::vector<std::size_t> level;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == 0) level.push_back(i);
  }
  std::size_t reached = 0;
  for (int depth = 1; !level.empty(); ++depth) {
    if (depth > kMaxNodeDepth) throw Refusal(ImporterExit::kLimitExceeded, "nodes stacked more than 64 deep");
    reached += level.size();
    std::vector<std::size_t> next;
    for (const std::size_t i : level) next.insert(next.end(), children[i].begin(), children[i].end());
    level = std::move(next);
  }
  if (reached != children.size()) throw Refusal(ImporterExit::kBadSyntax, "nodes that contain each other");
}

void scan_json(std::string_view text) {
  scan_depth(text);
  const json document = json::parse(text, nullptr, false);
  if (!document.is_object()) throw Refusal(ImporterExit::kBadSyntax, "not a glTF file: no JSON object");
  const auto nodes = document.find("nodes");
  if (nodes != document.end() && nodes->is_object()) {  // In glTF 2 they are an array.
    throw Refusal(ImporterExit::kUnsupported, "glTF 1 is not read: save it as glTF 2");
  }
  if (nodes != document.end() && nodes->is_array()) scan_nodes(*nodes);
}

}  // namespace

void scan_gltf(std::span<const std::byte> bytes) {
  scan_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void scan_glb(std::span<const std::byte> bytes) {
  struct Start {
    char magic[4];
    std::uint32_t version;
    std::uint32_t file_size;
    std::uint32_t json_size;
    char json_magic[4];
  } start = {};
  if (bytes.size() < sizeof(start)) throw Refusal(ImporterExit::kBadSyntax, "not a .glb file: too short");
  std::memcpy(&start, bytes.data(), sizeof(start));
  if (std::memcmp(start.magic, "glTF", 4) != 0 || std::memcmp(start.json_magic, "JSON", 4) != 0 ||
      start.json_size > bytes.size() - sizeof(start)) {
    throw Refusal(ImporterExit::kBadSyntax, "not a .glb file");
  }
  if (start.version != 2) throw Refusal(ImporterExit::kBadSyntax, "a .glb of another version than 2");
  const auto text = bytes.subspan(sizeof(start), start.json_size);
  scan_gltf(text);
}

}  // namespace hooke::importer
