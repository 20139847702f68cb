#include "hooke/lab.h"

#include "validation/check.h"
#include "validation/ground_truth.h"
#include "validation/report.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <exception>

namespace hooke::check {

namespace {

constexpr int kPassed = 0;
constexpr int kFailed = 1;
constexpr int kBadInput = 2;

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

/// Returns the cases that were asked for, or none if one of them does not exist.
std::vector<const CheckCase*> chosen_cases(const CheckOptions& options) {
  std::vector<const CheckCase*> chosen;
  for (const std::string& id : options.cases) {
    chosen.push_back(find_case(id));
    if (chosen.back() != nullptr) continue;
    std::fprintf(stderr, "hooke check: no case '%s'; --list names all\n", id.c_str());
    return {};
  }
  if (!chosen.empty()) return chosen;
  for (const CheckCase& check : check_cases()) {
    if (options.stepper.empty() || check.laboratory_dt > 0) chosen.push_back(&check);
  }
  return chosen;
}

void run_and_print(const CheckCase& check, const CheckSetting& setting, std::vector<Ran>& ran) {
  for (const CheckRow& row : run_case(check, setting)) {
    ran.push_back({&check, row});
    print_row(ran.back());
  }
}

/// Runs the solver's rows, and those of the stepper if one was named.
int check_one(const CheckOptions& options, const std::vector<const CheckCase*>& chosen) {
  std::vector<Ran> ran;
  for (const CheckCase* check : chosen) {
    if (options.turned != 0 && check->not_turned != nullptr) {
      std::printf("not  %-4s %s: %s\n", check->id.c_str(), check->title.c_str(), check->not_turned);
      continue;
    }
    run_and_print(*check, {.substeps = options.substeps, .turned = options.turned}, ran);
    if (options.stepper.empty() || !(check->laboratory_dt > 0)) continue;
    run_and_print(*check, {.substeps = options.substeps, .stepper = options.stepper}, ran);
  }
  const auto known =
      std::count_if(ran.begin(), ran.end(), [](const Ran& r) { return r.row.missed_as_known(); });
  const auto failed =
      std::count_if(ran.begin(), ran.end(), [](const Ran& r) { return !r.row.pass(); }) - known;
  std::printf("%zu rows, %td failed, %td known misses (%s)\n", ran.size(), failed, known, precision_name());
  if (!options.json_file.empty() && !write_text(options.json_file, to_json(ran))) return kBadInput;
  if (!options.markdown_file.empty() && !write_text(options.markdown_file, to_markdown(ran)))
    return kBadInput;
  return failed > 0 ? kFailed : kPassed;
}

/// Runs every case by every method.
int check_all(const CheckOptions& options, const std::vector<const CheckCase*>& chosen) {
  std::vector<Column> columns = {{.stepper = "solver"}};
  for (const lab::StepperInfo& info : lab::steppers()) {
    if (info.available) columns.push_back({.stepper = std::string(info.name)});
  }
  std::vector<Ran> every;
  for (Column& column : columns) {
    const bool solver = column.stepper == "solver";
    for (const CheckCase* check : chosen) {
      if (!(check->laboratory_dt > 0)) continue;
      run_and_print(*check, {.substeps = options.substeps, .stepper = solver ? "" : column.stepper},
                    column.ran);
    }
    every.insert(every.end(), column.ran.begin(), column.ran.end());
  }
  const std::string table = goals_to_markdown(columns);
  const std::string& file = options.markdown_file;
  if (!options.json_file.empty() && !write_text(options.json_file, to_json(every))) return kBadInput;
  return write_text(file.empty() ? "-" : file, table) ? kPassed : kBadInput;
}

int write_ground_truth(const std::string& file) {
  try {
    return write_text(file, ground_truth_markdown()) ? kPassed : kBadInput;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "hooke check: %s\n", failure.what());
    return kBadInput;
  }
}

}  // namespace

int check_command(const CheckOptions& options) {
  if (options.ground_truth) {
    return write_ground_truth(options.markdown_file.empty() ? "-" : options.markdown_file);
  }
  const bool every_stepper = options.stepper == kAllSteppers;
  if (!options.stepper.empty() && !every_stepper && options.stepper != "auto") {
    if (const auto found = lab::find_stepper(options.stepper); !found) {
      std::fprintf(stderr, "hooke check: %s\n", found.error().message.c_str());
      return kBadInput;
    }
  }
  const std::vector<const CheckCase*> chosen = chosen_cases(options);
  if (chosen.empty()) return kBadInput;
  if (options.list) {
    for (const CheckCase* check : chosen) std::printf("%-4s %s\n", check->id.c_str(), check->title.c_str());
    return kPassed;
  }
  return every_stepper ? check_all(options, chosen) : check_one(options, chosen);
}

}  // namespace hooke::check
