#pragma once

#include "validation/check.h"

#include <string>
#include <vector>

/// \file
/// What `hooke check` writes: lines for people, JSON, and tables in Markdown.

namespace hooke::check {

/// A row and the case that it belongs to.
struct Ran {
  const CheckCase* check = nullptr;
  CheckRow row;
};

void print_row(const Ran& ran);
std::string to_json(const std::vector<Ran>& ran);
std::string to_markdown(const std::vector<Ran>& ran);

/// The rows of one stepper, or of the solver, for all cases.
struct Column {
  std::string stepper = {};
  std::vector<Ran> ran = {};
};

/// Steppers down, cases across: "reached", or the error that exceeds its goal most, and the goal.
std::string goals_to_markdown(const std::vector<Column>& columns);

/// Writes to a file, or to standard output for "-". False, and a line to standard error, if that failed.
bool write_text(const std::string& file, const std::string& text);

}  // namespace hooke::check
