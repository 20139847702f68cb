#pragma once

#include <span>
#include <string>

/// \file
/// Declares the subcommands of `hooke`, which have one file each. All take the words after their name and
/// return the program's exit code; see ExitCode.

namespace hooke::app {

using Arguments = std::span<const std::string>;

int command_run(Arguments arguments);
int command_view(Arguments arguments);
int command_render(Arguments arguments);
int command_export(Arguments arguments);
int command_convert(Arguments arguments);
int command_settle(Arguments arguments);
int command_load(Arguments arguments);
int command_validate(Arguments arguments);
int command_new(Arguments arguments);
int command_check(Arguments arguments);
int command_compare(Arguments arguments);
int command_bench(Arguments arguments);

}  // namespace hooke::app
