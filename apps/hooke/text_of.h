#pragma once

#include <string>

namespace hooke::app {

/// Formats as std::printf does, into a string of at most 1000 characters.
[[gnu::format(printf, 1, 2)]] std::string text_of(const char* format, ...);

}  // namespace hooke::app
