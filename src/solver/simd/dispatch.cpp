#include "solver/simd/dispatch.h"

#ifndef HOOKE_DOUBLE_PRECISION

#include <cctype>
#include <cstdint>
#include <hwy/highway.h>

namespace hooke::solver::wide {

namespace {

bool scalar_only = false;

std::string name_of(std::int64_t target) {
  std::string name = hwy::TargetName(target);
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name == "avx3" ? "avx512" : name;
}

}  // namespace

std::vector<std::string> targets() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    names.insert(names.begin(), name_of(target));
  // Highway's lanes of one, where it has them, are not what "scalar" stands for, which is the code without
  // Highway.
  std::erase(names, "scalar");
  names.insert(names.begin(), "scalar");
  return names;
}

bool is_scalar() {
  return scalar_only;
}

bool use_target(const std::string& name) {
  if (name == "scalar") {
    scalar_only = true;
    return true;
  }
  hwy::SetSupportedTargetsForTest(0);
  std::int64_t chosen = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name_of(target) == name) chosen = target;
  }
  if (chosen == 0 && !name.empty()) return false;
  scalar_only = false;
  hwy::SetSupportedTargetsForTest(chosen);
  hwy::GetChosenTarget().DeInit();
  return true;
}

}  // namespace hooke::solver::wide

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

std::vector<std::string> targets() {
  return {"scalar"};
}

bool is_scalar() {
  return true;
}

bool use_target(const std::string& name) {
  return name.empty() || name == "scalar";
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
