#pragma once

/// Checks an invariant of the engine itself in the `dev` and `checked` builds, and is absent in `release`.
/// Bad input never reaches an assertion; it comes back as an Error. The expression must have no side effects.
///
/// HOOKE_VALIDATE does the same for a whole table: its call returns what is wrong in a few words, or null.
#ifdef HOOKE_CHECKS
#define HOOKE_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::hooke::base::assert_failed(#condition, __FILE__, __LINE__))
#define HOOKE_VALIDATE(call) ::hooke::base::validate(call, __FILE__, __LINE__)
#else
#define HOOKE_ASSERT(condition) static_cast<void>(sizeof(condition))
#define HOOKE_VALIDATE(call) static_cast<void>(sizeof(call))
#endif

namespace hooke::base {

using AssertHandler = void (*)(const char* condition, const char* file, int line);

/// Sets the function that is called for a broken invariant and returns the one it replaces. The default (and
/// null) writes one line to stderr and traps.
AssertHandler set_assert_handler(AssertHandler handler);

void assert_failed(const char* condition, const char* file, int line);

/// Reports `what` as a broken invariant if it is not null.
inline void validate(const char* what, const char* file, int line) {
  if (what != nullptr) assert_failed(what, file, line);
}

}  // namespace hooke::base
