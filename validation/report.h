#pragma once

#include "validation/check.h"

#include <string>
#include <vector>

/// \file
/// Writes what `hooke check` found: lines for people, JSON, and tables in Markdown.

namespace hooke::check {

/// This is a row and the case that it belongs to.
struct Ran {
  const CheckCase* check = nullptr;
  CheckRow row;
};

void print_row(const Ran& ran);
std::string to_json(const std::vector<Ran>& ran);
std::string to_markdown(const std::vector<Ran>& ran);

/// A Column holds the rows of one stepper, or of the solver, for all cases.
struct Column {
  std::string stepper = {};
  std::vector<Ran> ran = {};
};

/// Returns a table with a row per stepper and a column per case: "reached", or the error that exceeds its
/// goal most, and the goal.
std::string goals_to_markdown(const std::vector<Column>& columns);

/// Writes to a file, or to standard output for "-". If that fails, it writes a line to standard error and
/// returns false.
bool write_text(const std::string& file, const std::string& text);

}  // namespace hooke::check
