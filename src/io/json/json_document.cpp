#include "io/json/json_document.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace hooke::io {

namespace {

/// In longer lines columns count bytes, so that a hostile file cannot make its errors slow.
constexpr std::size_t kLongestLine = std::size_t{1} << 20U;
/// Longest key shown in a message [bytes].
constexpr std::size_t kLongestKey = 64;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Builds the tree from the parser's events. The parser reports no positions, so a cursor follows it through
/// the source. Between two events stand only spaces, comments, commas and colons, which the parser has
/// already accepted.
class TreeBuilder {
 public:
  TreeBuilder(JsonDocument& document, std::vector<JsonError>& errors)
      : document_(document), errors_(errors), source_(document.source) {
    if (source_.starts_with(kByteOrderMark)) cursor_ = kByteOrderMark.size();
  }

  // nlohmann's SAX interface prescribes the names and signatures of these functions.
  bool null() { return add_scalar(JsonNode::Kind::kNull, 4); }
  bool boolean(bool value) {
    if (!add_scalar(JsonNode::Kind::kBoolean, value ? 4 : 5)) return false;
    last_->boolean = value;
    return true;
  }
  bool number_integer(std::int64_t value) { return add_number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) { return add_number(static_cast<double>(value)); }
  bool number_float(double value, const std::string& /*digits*/) { return add_number(value); }
  bool binary(std::vector<std::uint8_t>& /*bytes*/) { return false; }
  bool string(std::string& value) {
    const std::size_t start = next_token();
    cursor_ = string_end(start);
    if (!add_node(JsonNode::Kind::kString, start)) return false;
    last_->text = std::move(value);
    return true;
  }
  bool key(std::string& value) {
    const std::size_t start = next_token();
    cursor_ = string_end(start);
    key_ = std::move(value);
    key_offset_ = start;
    return true;
  }
  bool start_object(std::size_t /*size*/) { return open(JsonNode::Kind::kObject); }
  bool start_array(std::size_t /*size*/) { return open(JsonNode::Kind::kArray); }
  bool end_array() { return close(); }
  bool end_object() {
    report_repeated_keys(*open_.back());
    return close();
  }
  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& exception);

 private:
  bool fail(std::size_t offset, ErrorCode code, std::string message, std::string path = "") {
    errors_.push_back({static_cast<std::uint32_t>(offset), {code, std::move(path), std::move(message)}});
    return false;
  }
  [[nodiscard]] std::string open_path() const;
  std::size_t next_token();
  [[nodiscard]] std::size_t string_end(std::size_t start) const;
  bool add_node(JsonNode::Kind kind, std::size_t start);
  bool add_scalar(JsonNode::Kind kind, std::size_t length);
  bool add_number(double value);
  bool open(JsonNode::Kind kind);
  bool close();
  void report_repeated_keys(const JsonNode& object);

  JsonDocument& document_;
  std::vector<JsonError>& errors_;
  std::string_view source_;
  std::size_t cursor_ = 0;
  std::size_t values_ = 0;
  std::string key_;
  std::size_t key_offset_ = 0;
  JsonNode* last_ = nullptr;
  /// Pointers stay valid: a container grows only while nothing inside it is open.
  std::vector<JsonNode*> open_;
};

std::size_t TreeBuilder::next_token() {
  while (cursor_ < source_.size()) {
    const char c = source_[cursor_];
    if (c == '/') {
      const bool block = source_.substr(cursor_, 2) == "/*";
      const std::size_t end = source_.find(block ? "*/" : "\n", cursor_ + (block ? 2 : 0));
      if (end == std::string_view::npos) return cursor_ = source_.size();
      cursor_ = end + (block ? 2 : 1);
    } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == ':') {
      ++cursor_;
    } else {
      break;
    }
  }
  return cursor_;
}

std::size_t TreeBuilder::string_end(std::size_t start) const {
  std::size_t i = start + 1;
  while (i < source_.size() && source_[i] != '"') i += source_[i] == '\\' ? 2 : 1;
  return std::min(i + 1, source_.size());
}

bool TreeBuilder::add_node(JsonNode::Kind kind, std::size_t start) {
  if (++values_ > kMostJsonValues) {
    return fail(start, ErrorCode::kLimitExceeded,
                "more than " + std::to_string(kMostJsonValues) + " values in one file");
  }
  if (open_.empty()) {
    last_ = &document_.root;
  } else {
    last_ = &open_.back()->children.emplace_back();
    if (open_.back()->kind == JsonNode::Kind::kObject) {
      last_->key = std::move(key_);
      last_->key_offset = static_cast<std::uint32_t>(key_offset_);
    }
  }
  last_->kind = kind;
  last_->offset = static_cast<std::uint32_t>(start);
  return true;
}

bool TreeBuilder::add_scalar(JsonNode::Kind kind, std::size_t length) {
  const std::size_t start = next_token();
  cursor_ = start + length;
  return add_node(kind, start);
}

bool TreeBuilder::add_number(double value) {
  const std::size_t start = next_token();
  cursor_ = std::min(source_.find_first_not_of("+-.0123456789eE", start), source_.size());
  if (!add_node(JsonNode::Kind::kNumber, start)) return false;
  last_->number = value;
  return true;
}

bool TreeBuilder::open(JsonNode::Kind kind) {
  const std::size_t start = next_token();
  cursor_ = start + 1;
  if (open_.size() >= kDeepestJson) {
    return fail(start, ErrorCode::kLimitExceeded,
                "nested deeper than " + std::to_string(kDeepestJson) + " levels");
  }
  if (!add_node(kind, start)) return false;
  open_.push_back(last_);
  return true;
}

bool TreeBuilder::close() {
  cursor_ = next_token() + 1;
  open_.pop_back();
  return true;
}

std::string TreeBuilder::open_path() const {
  std::string path;
  for (std::size_t i = 1; i < open_.size(); ++i) {
    const JsonNode& parent = *open_[i - 1];
    if (parent.kind == JsonNode::Kind::kArray) {
      path += "[" + std::to_string(parent.children.size() - 1) + "]";
    } else {
      path += (path.empty() ? "" : ".") + open_[i]->key;
    }
  }
  return path;
}

void TreeBuilder::report_repeated_keys(const JsonNode& object) {
  std::vector<const JsonNode*> sorted;
  sorted.reserve(object.children.size());
  for (const JsonNode& child : object.children) sorted.push_back(&child);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const JsonNode* a, const JsonNode* b) { return a->key < b->key; });
  for (std::size_t i = 1; i < sorted.size() && errors_.size() < kMostErrors; ++i) {
    if (sorted[i]->key != sorted[i - 1]->key) continue;
    const std::string path = open_path();
    fail(sorted[i]->key_offset, ErrorCode::kUnknownKey, "this key is given twice",
         path + (path.empty() ? "" : ".") + sorted[i]->key.substr(0, kLongestKey));
  }
}

/// Returns the parser's sentence without its prefix, position and quotation of the source.
std::string plain_reason(std::string message) {
  for (const std::string_view mark : {"syntax error while parsing", "] ", ": "}) {
    const std::size_t found = message.find(mark);
    if (found == std::string::npos) continue;
    message.erase(0, found + (mark.front() == 's' ? 0 : mark.size()));
    if (mark.front() == 's') break;
  }
  const std::size_t dash = message.find(" - ");
  if (message.starts_with("syntax error") && dash != std::string::npos) message.erase(0, dash + 3);
  const std::size_t last_read = message.find("; last read:");
  if (last_read != std::string::npos) {
    const std::size_t expected = message.find("; expected", last_read);
    message = message.substr(0, last_read) + (expected == std::string::npos ? "" : message.substr(expected));
  }
  return message;
}

bool TreeBuilder::parse_error(std::size_t position, const std::string& token,
                              const nlohmann::detail::exception& exception) {
  constexpr int kNumberOverflow = 406;
  const std::size_t token_start = next_token();
  if (exception.id == kNumberOverflow) {
    return fail(token_start, ErrorCode::kOutOfRange, in_quotes(token) + " is too large for a number");
  }
  std::string reason = plain_reason(exception.what());
  const bool closes =
      token_start < source_.size() && (source_[token_start] == ']' || source_[token_start] == '}');
  const std::size_t before = source_.find_last_not_of(" \t\r\n", token_start > 0 ? token_start - 1 : 0);
  if (closes && before != std::string::npos && source_[before] == ',') reason += "; a comma stands before it";
  const bool whole_token = reason.find("unexpected") != std::string::npos;
  const std::size_t stopped = std::min(position > 0 ? position - 1 : 0, source_.size());
  return fail(whole_token ? token_start : stopped, ErrorCode::kBadSyntax, "not JSON: " + reason);
}

void find_lines(JsonDocument& document) {
  document.line_starts = {0};
  for (std::size_t i = 0; i < document.source.size(); ++i) {
    if (document.source[i] == '\n') document.line_starts.push_back(static_cast<std::uint32_t>(i + 1));
  }
}

}  // namespace

const JsonNode* step_down(const JsonNode& node, std::string_view& path) {
  if (path.starts_with('[')) {
    const std::size_t end = std::min(path.find(']'), path.size());
    std::size_t index = 0;
    for (const char c : path.substr(1, end - 1)) {
      if (c < '0' || c > '9' || index > kMostJsonValues) return nullptr;
      index = 10 * index + static_cast<std::size_t>(c - '0');
    }
    path.remove_prefix(std::min(end + 1, path.size()));
    const bool inside = node.kind == JsonNode::Kind::kArray && index < node.children.size();
    return inside ? &node.children[index] : nullptr;
  }
  if (path.starts_with('.')) path.remove_prefix(1);
  const std::string_view key = path.substr(0, path.find_first_of(".["));
  path.remove_prefix(key.size());
  return node.find(key);
}

std::string JsonDocument::place(std::uint32_t offset) const {
  const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
  const auto line = static_cast<std::size_t>(after - line_starts.begin());
  const std::size_t start = line > 0 ? line_starts[line - 1] : 0;
  const std::size_t end = std::min<std::size_t>(offset, source.size());
  std::size_t column = 1;
  std::size_t first = start;
  if (end - first > kLongestLine)
    return name + ":" + std::to_string(line) + ":" + std::to_string(end - first + 1);
  if (first == 0 && std::string_view(source).starts_with(kByteOrderMark)) first = kByteOrderMark.size();
  for (std::size_t i = first; i < end; ++i) {
    column += (static_cast<unsigned char>(source[i]) & 0xC0U) != 0x80U ? 1 : 0;
  }
  return name + ":" + std::to_string(std::max<std::size_t>(line, 1)) + ":" + std::to_string(column);
}

std::string JsonDocument::number_text(const JsonNode& node) const {
  const std::size_t start = std::min<std::size_t>(node.offset, source.size());
  const std::size_t end = std::min(source.find_first_not_of("+-.0123456789eE", start), source.size());
  return source.substr(start, std::min<std::size_t>(end - start, 40));
}

const JsonNode& JsonDocument::find_closest(std::string_view path) const {
  const JsonNode* node = &root;
  while (!path.empty()) {
    const JsonNode* child = step_down(*node, path);
    if (child == nullptr) break;
    node = child;
  }
  return *node;
}

std::vector<JsonError> parse_json(std::string source, std::string name, JsonDocument& document) {
  document = {};
  document.name = std::move(name);
  std::vector<JsonError> errors;
  if (source.size() > kLargestJson) {
    errors.push_back({0, {ErrorCode::kLimitExceeded, "", "the file is larger than 64 MiB"}});
    return errors;
  }
  document.source = std::move(source);
  const auto breaks = std::count_if(document.source.begin(), document.source.end(),
                                    [](char c) { return static_cast<unsigned char>(c) < ' '; });
  if (static_cast<std::size_t>(breaks) > kMostJsonBreaks) {
    errors.push_back({0,
                      {ErrorCode::kLimitExceeded, "",
                       "more than " + std::to_string(kMostJsonBreaks) + " line ends and tabs in one file"}});
    document.source.clear();
    return errors;
  }
  find_lines(document);
  TreeBuilder builder(document, errors);
  try {
    nlohmann::json::sax_parse(document.source, &builder, nlohmann::json::input_format_t::json, true, true);
  } catch (const std::exception& exception) {
    errors.push_back({0, {ErrorCode::kBadSyntax, "", std::string("not JSON: ") + exception.what()}});
  }
  return errors;
}

}  // namespace hooke::io
