#pragma once

#include <string>

namespace hooke::app {

/// As std::printf, to a string of at most 1000 characters.
[[gnu::format(printf, 1, 2)]] std::string text_of(const char* format, ...);

}  // namespace hooke::app
