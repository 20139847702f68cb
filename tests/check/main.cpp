/// hooke_check [CASE...] [--json F] [--markdown F] [--substeps N] [--stepper NAME]
///             [--turned SEED] [--ground-truth] [--list]

#include "validation/check.h"

#include <cstdio>
#include <cstdlib>
#include <string_view>

int main(int count, char** words) {
  hooke::check::CheckOptions options;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    const bool more = i + 1 < count;
    if (word == "--list") {
      options.list = true;
    } else if (word == "--json" && more) {
      options.json_file = words[++i];
    } else if (word == "--markdown" && more) {
      options.markdown_file = words[++i];
    } else if (word == "--substeps" && more) {
      options.substeps = std::atoi(words[++i]);
    } else if (word == "--stepper" && more) {
      options.stepper = words[++i];
    } else if (word == "--turned" && more) {
      options.turned = static_cast<std::uint32_t>(std::atoi(words[++i]));
    } else if (word == "--ground-truth") {
      options.ground_truth = true;
    } else if (word.starts_with("--")) {
      std::fprintf(stderr, "hooke_check: unknown option %s\n", words[i]);
      return 2;
    } else {
      options.cases.emplace_back(word);
    }
  }
  return hooke::check::check_command(options);
}
