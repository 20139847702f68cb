#pragma once

/// The engine's own invariants. Active in the `dev` and `checked` builds, absent in `release`: bad input
/// never reaches an assertion, it comes back as an Error. The expression must have no side effects.
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

/// Called for a broken invariant; the default writes one line to stderr and traps. Returns the handler it
/// replaces.
AssertHandler set_assert_handler(AssertHandler handler);

void assert_failed(const char* condition, const char* file, int line);

}  // namespace hooke::base
