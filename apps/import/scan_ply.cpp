#include "refusal.h"
#include "scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace hooke::importer {

namespace {

using io::ImporterExit;

constexpr std::size_t kMaxHeader = std::size_t{64} << 10;
constexpr std::uint64_t kMaxElements = std::uint64_t{1} << 28;

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
  line.remove_prefix(word.size());
  return word;
}

/// Returns the bytes of a number in the binary form; 0 for a word that names no type.
std::uint64_t size_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::uint64_t>, 16> kSizes = {{{"char", 1},
                                                                                  {"uchar", 1},
                                                                                  {"int8", 1},
                                                                                  {"uint8", 1},
                                                                                  {"short", 2},
                                                                                  {"ushort", 2},
                                                                                  {"int16", 2},
                                                                                  {"uint16", 2},
                                                                                  {"int", 4},
                                                                                  {"uint", 4},
                                                                                  {"int32", 4},
                                                                                  {"uint32", 4},
                                                                                  {"float", 4},
                                                                                  {"float32", 4},
                                                                                  {"double", 8},
                                                                                  {"float64", 8}}};
  const auto* entry =
      std::find_if(kSizes.begin(), kSizes.end(), [&](const auto& known) { return known.first == type; });
  return entry == kSizes.end() ? 0 : entry->second;
}

/// A Header is what a file's header promises.
class Header {
 public:
  /// Returns false at the end of the header.
  bool add(std::string_view line) {
    const std::string_view word = take_word(line);
    if (word == "format") is_text_ = take_word(line) == "ascii";
    if (word == "element") add_element(line);
    if (word == "property") add_property(line);
    return word != "end_header";
  }

  [[nodiscard]] bool has_faces() const { return has_faces_; }

  /// Returns the fewest bytes that can hold all elements: in the text form, a digit and a line's end each.
  [[nodiscard]] std::uint64_t least_size() const {
    return is_text_ ? 2 * all_elements_ - std::min<std::uint64_t>(all_elements_, 1) : bytes_;
  }

 private:
  void add_element(std::string_view line) {
    const std::string_view name = take_word(line);
    // The importer would keep one triangle of all strips, and say nothing.
    if (name == "tristrips") {
      throw Refusal(ImporterExit::kUnsupported, "strips of triangles are not read: save it with faces");
    }
    has_faces_ = has_faces_ || name == "face";
    const std::string_view number = take_word(line);
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), count_);
    if (error != std::errc() || end != number.data() + number.size()) {
      throw Refusal(ImporterExit::kBadSyntax, "an element without a number");
    }
    all_elements_ += count_;
    if (count_ > kMaxElements || all_elements_ > kMaxElements) {
      throw Refusal(ImporterExit::kLimitExceeded, "more than 2^28 elements");
    }
  }

  void add_property(std::string_view line) {
    std::string_view type = take_word(line);
    if (type == "list") type = take_word(line);  // A list has at least its length.
    const std::uint64_t size = size_of(type);
    if (size == 0) throw Refusal(ImporterExit::kBadSyntax, "a property of an unknown type");
    bytes_ += count_ * size;
  }

  bool is_text_ = false;
  bool has_faces_ = false;
  std::uint64_t count_ = 0;  ///< Count of the element that the next properties belong to.
  std::uint64_t all_elements_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace

void scan_ply(std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.substr(0, 3) != "ply") throw Refusal(ImporterExit::kBadSyntax, "not a .ply file");
  const std::string_view head = text.substr(0, kMaxHeader);
  Header header;
  std::size_t at = 0;
  for (bool is_open = true; is_open;) {
    const std::size_t end = head.find_first_of("\r\n", at);
    if (end == std::string_view::npos) throw Refusal(ImporterExit::kBadSyntax, "a header without an end");
    is_open = header.add(head.substr(at, end - at));
    at = end + 1;
  }
  if (header.least_size() > text.size() - at) {
    throw Refusal(ImporterExit::kBadSyntax, "shorter than its header says");
  }
  if (!header.has_faces()) throw Refusal(ImporterExit::kOutOfRange, "points alone, without faces");
}

}  // namespace hooke::importer
