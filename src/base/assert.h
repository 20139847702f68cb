#pragma once

/// Checks an invariant of the engine itself in the `dev` and `checked` builds, and is absent in `release`.
/// Bad input never reaches an assertion; it comes back as an Error. The expression must have no side effects.
#ifdef HOOKE_CHECKS
#define HOOKE_ASSERT(condition)                                                     \
  do {                                                                              \
    if (!(condition)) ::hooke::base::assert_failed(#condition, __FILE__, __LINE__); \
  } while (false)
#else
#define HOOKE_ASSERT(condition) static_cast<void>(sizeof(condition))
#endif

namespace hooke::base {

using AssertHandler = void (*)(const char* condition, const char* file, int line);

/// Sets the function that is called for a broken invariant and returns the one it replaces. The default (and
/// null) writes one line to stderr and traps.
AssertHandler set_assert_handler(AssertHandler handler);

void assert_failed(const char* condition, const char* file, int line);

}  // namespace hooke::base
