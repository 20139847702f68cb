#include "io/motion/motion_names.h"

#include <algorithm>
#include <cctype>

namespace hooke::io {

namespace {

constexpr std::size_t kLongestFileName = 64;  ///< [bytes]

bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

bool is_allowed(char c, NameStyle style) {
  switch (style) {
    case NameStyle::kText:
      return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F;
    case NameStyle::kIdentifier:
      return is_letter_or_digit(c) || c == '_';
    case NameStyle::kFile:
      break;
  }
  return is_letter_or_digit(c) || std::string_view("-._[]").find(c) != std::string_view::npos;
}

std::string in_lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string NameBook::fitting(std::string_view wanted) const {
  std::string name;
  for (const char c : wanted) name += is_allowed(c, style_) ? c : '_';
  if (style_ == NameStyle::kIdentifier && name[0] >= '0' && name[0] <= '9') name.insert(0, "_");
  // The end of a name tells more than its beginning: it has the number of a copy, or the kind of a file.
  if (style_ == NameStyle::kFile && name.size() > kLongestFileName)
    name.erase(0, name.size() - kLongestFileName);
  if (style_ == NameStyle::kFile && name[0] == '.') name[0] = '_';
  return name;
}

std::string NameBook::take(std::string_view wanted, std::string_view usual) {
  const std::string name = fitting(wanted.empty() ? usual : wanted);
  const auto key = [&](const std::string& text) {
    return style_ == NameStyle::kFile ? in_lower_case(text) : text;
  };
  std::string candidate = name;
  for (std::size_t number = 2; !taken_.insert(key(candidate)).second; ++number) {
    candidate = name;
    // A file keeps its ending, by which programs know its kind.
    const std::size_t dot = style_ == NameStyle::kFile ? name.rfind('.') : std::string::npos;
    candidate.insert(std::min(dot, name.size()),
                     (style_ == NameStyle::kIdentifier ? "_" : ".") + std::to_string(number));
  }
  return candidate;
}

}  // namespace hooke::io
