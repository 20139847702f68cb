#pragma once

#include "hooke/compare/tables.h"

#include <string>

namespace hooke::app {

/// Name of the reference among the runs of a page.
inline constexpr const char* kReferenceName = "reference";

/// Returns what the script of the page draws, as JSON: curves thinned so that a page stays below two
/// megabytes, frames in whole units of the picture, growth and regions of stability.
std::string page_data(const Comparison& comparison);

/// Returns a number with so many digits.
std::string text_of_number(double value, int digits = 6);

}  // namespace hooke::app
