#include "hooke/command_line.h"

#include "validation/check.h"

#include <CLI/CLI.hpp>

namespace hooke::app {

int command_check(Arguments arguments) {
  CLI::App app("Runs scenes whose answer is known and says how near the engine comes to it.", "hooke check");
  check::CheckOptions options;
  app.add_option("CASE", options.cases, "Ids of cases; all by default");
  app.add_option("--json", options.json_file, "Also write the rows as JSON; - prints them");
  app.add_option("--markdown", options.markdown_file, "Also write a table; - prints it");
  app.add_option("--substeps", options.substeps, "Substeps of every world")->check(CLI::Range(1, 64));
  app.add_option("--stepper", options.stepper,
                 "Also by this method of the laboratory; all: which method reaches which goal");
  app.add_option("--turned", options.turned,
                 "Turn every world by a random rotation of this seed, and move it: the answers stay the same")
      ->check(one_or_more());
  app.add_flag("--ground-truth", options.ground_truth,
               "Instead: how far the solver is from SUNDIALS in scenes without a closed form");
  app.add_flag("--list", options.list, "Only print ids and titles");
  app.footer(
      "Exit code 1 if a case failed.\n\n"
      "Examples:\n"
      "  hooke check\n"
      "  hooke check V7 V17 --json check.json\n"
      "  hooke check --stepper rk4\n"
      "  hooke check V14 --turned 3\n"
      "  hooke check V1 V4 --stepper all --markdown goals.md\n"
      "  hooke check --list");
  if (const auto code = parse(app, arguments)) return *code;
  return check::check_command(options);
}

}  // namespace hooke::app
