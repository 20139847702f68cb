#pragma once

namespace hooke::importer {

enum class Seal {
  kDone,
  kUnavailable,  ///< The kernel has no filters of system calls, or the processor is none of those known here.
};

/// Gives up every system call but those that take and return memory, write to standard output and standard
/// error, and end the process: from here on it opens no file and no connection, starts nothing, signals
/// nobody but itself, reads nothing it did not read before and makes no memory executable. What is refused
/// fails with EPERM. Not to be undone. Needs one thread, and PR_SET_NO_NEW_PRIVS of `enter_limits`.
[[nodiscard]] Seal seal_process();

}  // namespace hooke::importer
