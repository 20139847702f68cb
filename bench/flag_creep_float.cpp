/// Prints the rows of the laboratory, which is double throughout and has no limits, and of the solver in
/// float.
#include "hooke/lab.h"

#include "flag_creep.h"

#include <cmath>
#include <cstdio>

namespace {

using hooke::bench::CreepMeter;

struct Method {
  const char* name;
  double dt;  ///< [s]
};

int print_laboratory_row(const Method& method, bool gusts) {
  auto flag = hooke::bench::make_flag({gusts, false});
  if (!flag) return 1;
  auto run =
      hooke::lab::Run::create(flag.value().world, {.stepper = method.name, .dt = method.dt, .force = true});
  if (!run) {
    std::fprintf(stderr, "%s: %s\n", method.name, run.error().message.c_str());
    return 1;
  }
  CreepMeter meter;
  std::string end;
  const int steps = static_cast<int>(std::lround(hooke::bench::kFlagSeconds / method.dt));
  const int stride = static_cast<int>(std::lround(1 / (60 * method.dt)));
  for (int i = 1; i <= steps && end.empty(); ++i) {
    const auto moved = run.value().advance();
    if (!moved) end = moved.error().message;
    if (i % stride != 0) continue;
    const double extension = hooke::bench::extension_of(run.value().positions());
    if (!(extension < 100)) end = "gone by " + std::to_string(run.value().time()).substr(0, 4) + " s";
    meter.add(run.value().time(), extension);
  }
  print_row(method.name, method.dt, {gusts, false}, meter, end);
  return 0;
}

}  // namespace

int main() {
  std::printf(
      "| stepper | dt [ms] | wind | limit | mean extension at 20 to 40 s [%%] | at 100 to 120 s [%%] | creep "
      "[%%] |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  constexpr Method kMethods[] = {
      {"euler", 1e-3},    {"euler", 0.5e-3},       {"euler", 1.0 / 2400},       {"euler", 1.0 / 2700},
      {"euler", 0.25e-3}, {"taylor2_paper", 1e-3}, {"taylor2_paper", 0.5e-3},   {"paper", 1e-3},
      {"verlet", 1e-3},   {"rk4", 1e-3},           {"implicit_euler", 1.0 / 60}};
  int failures = 0;
  for (const Method& method : kMethods) {
    for (const bool gusts : {false, true}) failures += print_laboratory_row(method, gusts);
  }
  return failures + hooke::bench::print_solver_rows("solver, float");
}
