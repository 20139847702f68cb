#include "check.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace hooke::check {

namespace {

struct Ran {
  const CheckCase* check = nullptr;
  CheckRow row;
};

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

const CheckCase* find_case(const std::string& id) {
  const auto& all = check_cases();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const CheckCase& c) { return upper(c.id) == upper(id); });
  return found == all.end() ? nullptr : &*found;
}

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

void print_row(const CheckCase& check, const CheckRow& row) {
  std::printf("%-4s %-4s %-58s %18s %18s  error %-12s of %-10s\n", row.pass() ? "ok" : "FAIL",
              check.id.c_str(), row.title.c_str(), with_unit(row.expected, row).c_str(),
              with_unit(row.achieved, row).c_str(), percent_or_unit(row.error(), row).c_str(),
              percent_or_unit(row.tolerance, row).c_str());
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
                    {"achieved", row.achieved},  // null if not a number
                    {"tolerance", row.tolerance},
                    {"relative", row.measure == CheckRow::Measure::kRelative},
                    {"error", row.error()},
                    {"pass", row.pass()},
                    {"dt", row.dt},
                    {"substeps", row.substeps},
                    {"solver", row.solver},
                    {"precision", precision_name()}});
  }
  return nlohmann::ordered_json{{"cases", list}}.dump(2) + "\n";
}

std::string to_markdown(const std::vector<Ran>& ran) {
  std::ostringstream out;
  out << "# Validation\n\n"
         "Scenes whose answer is known, and how near the engine comes to it. Written by\n"
         "`hooke check --markdown docs/validation.md`; `hooke check` prints the same rows and says which "
         "fail.\n"
         "The formula and its source stand above each case in `apps/hooke/check`. An error or tolerance in\n"
         "percent is relative to the expected value.\n\n"
         "Precision: "
      << precision_name()
      << ". Step: frames per second x substeps.\n\n"
         "| case | measured | expected | achieved | error | tolerance | step | solver | |\n"
         "|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [check, row] : ran) {
    out << "| " << check->id << " " << check->title << " | " << row.title << " | "
        << with_unit(row.expected, row) << " | " << with_unit(row.achieved, row) << " | "
        << percent_or_unit(row.error(), row) << " | " << percent_or_unit(row.tolerance, row) << " | "
        << stepping(row) << " | " << row.solver << " | " << (row.pass() ? "pass" : "**fail**") << " |\n";
  }
  return out.str();
}

bool write(const std::string& file, const std::string& text) {
  if (file.empty()) return true;
  if (file == "-") return std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) std::fprintf(stderr, "hooke check: cannot write %s\n", file.c_str());
  return static_cast<bool>(out);
}

}  // namespace

int check_command(const CheckOptions& options) {
  std::vector<const CheckCase*> chosen;
  for (const std::string& id : options.cases) {
    chosen.push_back(find_case(id));
    if (chosen.back() != nullptr) continue;
    std::fprintf(stderr, "hooke check: no case '%s'; --list names all\n", id.c_str());
    return 2;
  }
  if (options.cases.empty()) {
    for (const CheckCase& check : check_cases()) chosen.push_back(&check);
  }
  if (options.list) {
    for (const CheckCase* check : chosen) std::printf("%-4s %s\n", check->id.c_str(), check->title.c_str());
    return 0;
  }

  std::vector<Ran> ran;
  for (const CheckCase* check : chosen) {
    for (const CheckRow& row : run_case(*check, {.substeps = options.substeps})) {
      print_row(*check, row);
      ran.push_back({check, row});
    }
  }
  const auto failed = std::count_if(ran.begin(), ran.end(), [](const Ran& r) { return !r.row.pass(); });
  std::printf("%zu rows, %td failed (%s)\n", ran.size(), failed, precision_name());
  const bool json = write(options.json_file, options.json_file.empty() ? "" : to_json(ran));
  const bool markdown = write(options.markdown_file, options.markdown_file.empty() ? "" : to_markdown(ran));
  if (!json || !markdown) return 2;
  return failed > 0 ? 1 : 0;
}

}  // namespace hooke::check
