#include "base/assert.h"

#include <atomic>
#include <cstdio>

namespace hooke::base {

namespace {

void trap(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: broken invariant: %s\n", file, line, condition);
  __builtin_trap();
}

std::atomic<AssertHandler> current{trap};

}  // namespace

AssertHandler set_assert_handler(AssertHandler handler) {
  return current.exchange(handler != nullptr ? handler : trap);
}

void assert_failed(const char* condition, const char* file, int line) {
  current.load()(condition, file, line);
}

}  // namespace hooke::base
