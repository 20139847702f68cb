#include "hooke/result.h"

#include <cstdio>
#include <cstdlib>

namespace hooke {

void abort_with(const Error& error) {
  const char* separator = error.where.empty() ? "" : ": ";
  std::fprintf(stderr, "hooke: %s%s%s\n", error.where.c_str(), separator, error.message.c_str());
  std::fflush(stderr);
  std::abort();
}

}  // namespace hooke
