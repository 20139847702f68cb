#include "validation/report.h"

#include "hooke/version.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace hooke::check {

namespace {

std::string number(double value, int digits = 7) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string with_unit(double value, const CheckRow& row) {
  return number(value) + (row.unit.empty() ? "" : " " + row.unit);
}

std::string percent_or_unit(double value, const CheckRow& row) {
  if (row.measure == CheckRow::Measure::kRelative) return number(100 * value, 3) + " %";
  return number(value, 3) + (row.unit.empty() ? "" : " " + row.unit);
}

std::string stepping(const CheckRow& row) {
  return number(1 / row.dt, 4) + " Hz x " + std::to_string(row.substeps);
}

const char* verdict(const CheckRow& row) {
  if (row.pass()) return "ok";
  return row.missed_as_known() ? "MISS" : "FAIL";
}

std::string verdict_markdown(const CheckRow& row) {
  if (row.pass()) return "pass";
  return row.missed_as_known() ? "known miss: " + row.known_miss : "**fail**";
}

/// Returns by what factor the error is too large; a row that is not a number is worst.
double excess(const CheckRow& row) {
  if (row.pass()) return 0;
  const double times = row.error() / row.tolerance;
  return times >= 0 ? times : std::numeric_limits<double>::infinity();
}

std::string cell(const std::vector<Ran>& rows) {
  if (rows.empty()) return "";
  const auto worst = std::max_element(
      rows.begin(), rows.end(), [](const Ran& a, const Ran& b) { return excess(a.row) < excess(b.row); });
  const CheckRow& row = worst->row;
  if (row.pass()) return "reached";
  if (row.failure) return *row.failure == ErrorCode::kUnsupported ? "cannot" : "diverges";
  if (!(row.error() < 1e3)) return "diverges";
  return percent_or_unit(row.error(), row) + " of " + percent_or_unit(row.tolerance, row);
}

std::vector<Ran> rows_of(const std::vector<Ran>& ran, const CheckCase* check) {
  std::vector<Ran> rows;
  std::copy_if(ran.begin(), ran.end(), std::back_inserter(rows),
               [&](const Ran& r) { return r.check == check; });
  return rows;
}

/// Returns the cases in the order of their first run.
std::vector<const CheckCase*> cases_of(const std::vector<Column>& columns) {
  std::vector<const CheckCase*> cases;
  for (const Column& column : columns) {
    for (const Ran& r : column.ran) {
      if (std::find(cases.begin(), cases.end(), r.check) == cases.end()) cases.push_back(r.check);
    }
  }
  return cases;
}

std::string step_text(const CheckCase& check) {
  std::string text = number(1000 * check.laboratory_dt, 3) + " ms";
  if (check.implicit_dt > 0) text += ", " + number(1000 * check.implicit_dt, 3) + " ms without a limit";
  return text;
}

}  // namespace

void print_row(const Ran& ran) {
  const CheckRow& row = ran.row;
  std::printf("%-4s %-4s %-58s %18s %18s  error %-12s of %-10s %s\n", verdict(row), ran.check->id.c_str(),
              row.title.c_str(), with_unit(row.expected, row).c_str(), with_unit(row.achieved, row).c_str(),
              percent_or_unit(row.error(), row).c_str(), percent_or_unit(row.tolerance, row).c_str(),
              row.solver.c_str());
  std::fflush(stdout);
}

std::string to_json(const std::vector<Ran>& ran) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [check, row] : ran) {
    list.push_back({{"id", check->id},
                    {"case", check->title},
                    {"title", row.title},
                    {"unit", row.unit},
                    {"expected", row.expected},
                    {"achieved", row.achieved},  // Null if it is not a number.
                    {"tolerance", row.tolerance},
                    {"relative", row.measure == CheckRow::Measure::kRelative},
                    {"error", row.error()},
                    {"pass", row.pass()},
                    {"known_miss", row.known_miss},
                    {"dt", row.dt},
                    {"substeps", row.substeps},
                    {"solver", row.solver},
                    {"precision", precision_name()}});
  }
  return nlohmann::ordered_json{{"version", kVersion}, {"cases", list}}.dump(2) + "\n";
}

std::string to_markdown(const std::vector<Ran>& ran) {
  std::ostringstream out;
  out << "# Validation\n\n"
         "Scenes whose answer is known, and how near the engine comes to it. Written by\n"
         "`hooke check --markdown docs/validation.md`; `hooke check` prints the same rows and says which "
         "fail.\n"
         "The formula and its source stand above each case in `validation`. An error or tolerance in\n"
         "percent is relative to the expected value. A known miss is what the engine does not reach yet, and "
         "why. What the\n"
         "textbooks' methods make of the same scenes is in [goals.md](goals.md).\n\n"
         "Precision: "
      << precision_name()
      << ". Step: frames per second x substeps.\n\n"
         "| case | measured | expected | achieved | error | tolerance | step | solver | |\n"
         "|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [check, row] : ran) {
    out << "| " << check->id << " " << check->title << " | " << row.title << " | "
        << with_unit(row.expected, row) << " | " << with_unit(row.achieved, row) << " | "
        << percent_or_unit(row.error(), row) << " | " << percent_or_unit(row.tolerance, row) << " | "
        << stepping(row) << " | " << row.solver << " | " << verdict_markdown(row) << " |\n";
  }
  return out.str();
}

std::string goals_to_markdown(const std::vector<Column>& columns) {
  const std::vector<const CheckCase*> cases = cases_of(columns);
  std::ostringstream out;
  out << "# Which method reaches which goal\n\n"
         "The scenes of [validation.md](validation.md) by the methods of the [laboratory](laboratory.md), "
         "all "
         "with the same\n"
         "step. Written by `hooke check --stepper all --markdown docs/goals.md`. A cell says \"reached\", or "
         "by "
         "how much the\n"
         "worst figure of the case misses what goal. \"diverges\": it does, or would and was refused. "
         "\"cannot\": the method\n"
         "needs what the scene does not have (derivatives of gusts). The row `solver` is the real-time "
         "solver "
         "with its own\n"
         "step and tolerances; what it does not stretch has a stiffness of 1e6 N/m or 5e4 N in the "
         "laboratory.\n\n| |";
  for (const CheckCase* check : cases) out << " " << check->id << " |";
  out << "\n|---|";
  for (std::size_t i = 0; i < cases.size(); ++i) out << "---|";
  out << "\n";
  for (const Column& column : columns) {
    out << "| `" << column.stepper << "` |";
    for (const CheckCase* check : cases) out << " " << cell(rows_of(column.ran, check)) << " |";
    out << "\n";
  }
  out << "\n| case | | step of the laboratory |\n|---|---|---|\n";
  for (const CheckCase* check : cases) {
    out << "| " << check->id << " | " << check->title << " | " << step_text(*check) << " |\n";
  }
  return out.str();
}

bool write_text(const std::string& file, const std::string& text) {
  if (file == "-") return std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) std::fprintf(stderr, "hooke check: cannot write %s\n", file.c_str());
  return static_cast<bool>(out);
}

}  // namespace hooke::check
