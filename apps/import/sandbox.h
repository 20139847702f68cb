#pragma once

namespace hooke::importer {

enum class Seal {
  kDone,
  /// The kernel has no filters of system calls, or the processor is of an unknown kind.
  kUnavailable,
};

/// Gives up every system call except those that take and return memory, write to standard output and standard
/// error, and end the process. From here on the process opens no file and no connection, starts nothing,
/// signals only itself, reads nothing new and makes no memory executable. A call that is refused fails with
/// EPERM. It cannot be undone. It needs one thread, and PR_SET_NO_NEW_PRIVS of `enter_limits`.
[[nodiscard]] Seal seal_process();

}  // namespace hooke::importer
