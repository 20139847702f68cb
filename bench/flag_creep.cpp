#include "flag_creep.h"

#include <cmath>
#include <cstdio>

namespace hooke::bench {

Result<Flag> make_flag(const FlagSetting& setting) {
  WorldDesc desc;
  desc.wind.velocity = {Real(8), Real(0), Real(1)};
  desc.wind.gust = setting.gusts ? Real(0.5) : Real(0);
  desc.wind.side_gust = setting.gusts ? Real(0.3) : Real(0);
  auto world = World::create(desc);
  if (!world) return world.error();
  ClothDesc cloth;
  cloth.columns = kFlagColumns;
  cloth.rows = kFlagRows;
  cloth.corner = {0, 3, 0};
  cloth.width = Real(kFlagWidth);
  cloth.areal_density = Real(0.2);
  cloth.stretch_stiffness = Real(60);
  cloth.shear_stiffness = Real(20);
  cloth.bend = ClothDesc::Bend::kNone;
  cloth.damping = Real(0.02);
  if (setting.limited) cloth.extension_max = Real(0.05);
  for (int row = 0; row < kFlagRows; ++row) {
    cloth.pins.push_back({.point = static_cast<std::uint32_t>(row * kFlagColumns)});
  }
  auto id = world.value().add_cloth(cloth);
  if (!id) return id.error();
  return Flag{std::move(world).value(), id.value()};
}

double extension_of(const std::vector<DVec3>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (i % kFlagColumns != 0) sum += length(points[i] - points[i - 1]);
  }
  return sum / (kFlagRows * kFlagWidth) - 1;
}

void CreepMeter::add(double time, double extension) {
  if (time >= kFlagWindow && time < 2 * kFlagWindow) {
    first_ += extension;
    ++first_count_;
  }
  if (time >= kFlagSeconds - kFlagWindow) {
    last_ += extension;
    ++last_count_;
  }
}

void print_row(const char* stepper, double dt, const FlagSetting& setting, const CreepMeter& meter,
               const std::string& end) {
  std::printf("| %s | %.4g | %s | %s | ", stepper, 1000 * dt, setting.gusts ? "gusting" : "steady",
              setting.limited ? "5 %" : "none");
  if (!end.empty()) {
    std::printf("%s | | |\n", end.c_str());
  } else {
    std::printf("%.3f | %.3f | %+.3f |\n", 100 * meter.first(), 100 * meter.last(),
                100 * (meter.last() - meter.first()));
  }
  std::fflush(stdout);
}

int print_solver_rows(const char* name) {
  for (const bool gusts : {false, true}) {
    for (const bool limited : {false, true}) {
      auto flag = make_flag({gusts, limited});
      if (!flag) return 1;
      World& world = flag.value().world;
      CreepMeter meter;
      std::string end;
      while (world.time() < kFlagSeconds && end.empty()) {
        if (!world.step(Real(1) / Real(60)).healthy()) end = "not finite";
        std::vector<DVec3> points;
        const PointView view = world.positions(flag.value().cloth);
        for (std::size_t i = 0; i < view.size(); ++i) points.push_back(view[i]);
        meter.add(world.time(), extension_of(points));
      }
      print_row(name, 1.0 / 60, {gusts, limited}, meter, end);
    }
  }
  return 0;
}

}  // namespace hooke::bench
