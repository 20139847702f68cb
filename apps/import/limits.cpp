#include "limits.h"

#include "io/model/model_flat.h"

#include <algorithm>
#include <csignal>
#include <sys/prctl.h>
#include <sys/resource.h>

namespace hooke::importer {

namespace {

/// Lowers both limits and never raises one.
template <class Kind>
bool lower_limit(Kind kind, rlim_t value) {
  rlimit limit = {};
  if (::getrlimit(kind, &limit) != 0) return false;
  limit.rlim_max = std::min(limit.rlim_max, value);
  limit.rlim_cur = std::min(limit.rlim_cur, limit.rlim_max);
  return ::setrlimit(kind, &limit) == 0;
}

}  // namespace

bool enter_limits() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // The process must not outlive its parent.
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  bool entered = lower_limit(RLIMIT_CORE, 0) && lower_limit(RLIMIT_CPU, kMaxCpuSeconds) &&
                 lower_limit(RLIMIT_STACK, kMaxStack) && lower_limit(RLIMIT_FSIZE, io::kMaxFlatModelSize);
  if (!kIsSanitized) entered = entered && lower_limit(RLIMIT_AS, kMaxMemory) && lower_limit(RLIMIT_NPROC, 0);
  return entered;
}

}  // namespace hooke::importer
