#include "hooke/command_line.h"
#include "hooke/output_file.h"

#include <CLI/CLI.hpp>
#include <filesystem>

namespace hooke::app {

int command_new(Arguments arguments) {
  CLI::App app("Writes a commented scene to start from.", "hooke new");
  std::string kind;
  std::string path = "-";
  bool force = false;
  app.add_option("KIND", kind, "rope, flag or empty")
      ->required()
      ->check(CLI::IsMember({"rope", "flag", "empty"}));
  app.add_option("-o,--output", path, "File to write; the standard output by default");
  app.add_flag("--force", force, "Replace a file that exists");
  app.footer("Examples:\n  hooke new rope -o rope.json\n  hooke new flag -o flag.json --force");
  if (const auto code = parse(app, arguments)) return *code;

  const auto text = starter_scene(kind);
  if (!text)
    return report({ErrorCode::kOutOfRange, "hooke new", "there is no scene of the kind '" + kind + "'"});
  std::error_code code;
  if (!force && std::filesystem::is_regular_file(path, code)) {
    return report({ErrorCode::kOutOfRange, path, "exists; --force replaces it"});
  }
  const auto written = write_file(path, *text);
  return written ? kGood : report(written.error());
}

}  // namespace hooke::app
