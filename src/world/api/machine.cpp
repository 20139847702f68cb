#include "world/api/machine.h"

#include "hooke/machine.h"

#include "build/checks.h"
#include "solver/soft/particle_kernels.h"

#include <atomic>
#include <cstdlib>
#include <mutex>

namespace hooke {

namespace {

constexpr const char* kVariable = "HOOKE_INSTRUCTION_SET";

std::atomic<bool> is_chosen = false;

Result<void> use(const std::string& name, const char* where) {
  if (solver::wide::use_target(name)) return {};
  return build::no_such_name("instruction set", name, solver::wide::targets(), where);
}

}  // namespace

std::vector<std::string> instruction_sets() {
  return solver::wide::targets();
}

Result<void> use_instruction_set(const std::string& name) {
  Result<void> used = use(name, "instruction_set");
  if (used) is_chosen = true;
  return used;
}

Result<void> world::heed_environment() {
  if (is_chosen) return {};
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const char* name = std::getenv(kVariable);
  if (is_chosen || name == nullptr || *name == '\0') return {};
  Result<void> used = use(name, kVariable);
  if (used) is_chosen = true;
  return used;
}

}  // namespace hooke
