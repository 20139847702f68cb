/// Chapter 10 of the manual: what is refused, what a report tells, and how many substeps a stiff cloth needs.

#include "hooke/hooke.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace {

constexpr double kGravity = 9.81;

/// Prints a number next to the one that mechanics gives.
bool agrees(const char* what, double value, double expected, double tolerance) {
  std::printf("%s: %.4f, expected %.4f\n", what, value, expected);
  return std::abs(value - expected) <= tolerance * std::abs(expected);
}

/// What a step could not do as well as it should, and what helps. Returns how many such things there were.
std::uint32_t explain(const hooke::StepReport& report) {
  const struct {
    std::uint32_t count;
    const char* cure;
  } lines[] = {
      {report.rows_quarantined, "points or bodies were reset: look at your force laws and at extreme values"},
      {report.ropes_unconverged, "ropes are off their length: more particle_substeps, or a lighter load"},
      {report.pairs_left_out, "bodies are deep inside many others: do not create them at one place"},
      {report.rows_refused, "stacks may sink and nets may gape: fewer bodies, like masses, or more substeps"},
      {report.coupled_groups_cut_short, "groups of ropes took too much work: fewer points"},
  };
  std::uint32_t found = 0;
  for (const auto& line : lines) {
    if (line.count > 0) std::printf("%u: %s\n", line.count, line.cure);
    found += line.count;
  }
  return found;
}

/// A wrong argument is an Error that says where and why, and the world stays as it was.
bool refusals(hooke::World& world) {
  const std::uint64_t before = world.state_hash();
  const auto far_away = world.add_body({.position = {2 * hooke::limits::kPlace, 0, 0}});
  const auto dense = world.add_rope({.total_mass = -1});
  const auto pushed = world.apply_force(hooke::BodyId{}, {1, 0, 0});
  if (far_away || dense || pushed) return false;
  for (const hooke::Error& error : {far_away.error(), dense.error(), pushed.error()}) {
    std::printf("%s: %s\n", error.where.c_str(), error.message.c_str());
  }
  return world.state_hash() == before;
}

/// A step of no length moves nothing; a force law that divides by zero is caught, and the report counts it.
bool reports(hooke::World& world) {
  if (world.step(0).moved) return false;
  const auto particle = world.add_particles({.particles = {{.position = {0, 5, 0}}}});
  const auto law = world.add_force_law([](hooke::ForceView& object) {
    object.add_force(0, {std::numeric_limits<hooke::Real>::quiet_NaN(), 0, 0});
  });
  if (!particle || !law) return false;
  const hooke::StepReport sick = world.step(1.0f / 60);
  world.remove(law.value());
  const hooke::StepReport well = world.step(1.0f / 60);
  return explain(sick) == 1 && !sick.healthy() && explain(well) == 0 && well.healthy();
}

/// The largest stretch of a hanging cloth of springs of 500 N/m, each of which carries what is below it.
double stretch(int substeps) {
  hooke::World world = hooke::World::create({.substeps = substeps, .wind = {.air_density = 0}}).value();
  hooke::ClothDesc desc = {
      .columns = 21,
      .rows = 21,
      .areal_density = 0.2f,
      .stretch_stiffness = 500,
      .shear_stiffness = 0,
      .damping = 0.05f,
      .bend = hooke::ClothDesc::Bend::kNone,
      .air_friction = 0.2f,
  };
  for (std::uint32_t column = 0; column < 21; ++column) desc.pins.push_back({.point = column});
  if (!world.add_cloth(desc)) return -1;
  for (int frame = 0; frame < 240; ++frame) world.step(1.0f / 60);
  return world.measure().largest_stretch;
}

/// The uppermost springs carry all but half a row: weight / k over their length.
bool substeps() {
  const double weight = 0.2 * kGravity * 0.975 / 20;  // of one column, below its uppermost spring
  const double strain = weight / 500 / 0.05;
  return agrees("stretch with 8 substeps", stretch(8), strain, 0.05) &&
         agrees("stretch with 32 substeps", stretch(32), strain, 0.05);
}

}  // namespace

int main() {
  hooke::World world = hooke::World::create().value();
  return refusals(world) && reports(world) && substeps() ? 0 : 1;
}
