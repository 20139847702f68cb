#include "hooke/session/insight.h"

#include <algorithm>
#include <cmath>

namespace hooke::app {

namespace {

constexpr InsightChoice kChoices[] = {
    {"contacts", &DebugDrawDesc::contacts}, {"velocities", &DebugDrawDesc::velocities},
    {"boxes", &DebugDrawDesc::bounds},      {"loads", &DebugDrawDesc::loads},
    {"hooks", &DebugDrawDesc::hooks},       {"sleep", &DebugDrawDesc::sleep},
    {"routes", &DebugDrawDesc::routes},     {"numbers", &DebugDrawDesc::texts}};

/// The time in which a largest value fades to the half [s].
constexpr double kFading = 2;
constexpr double kAxisShare = 0.25;  ///< Length of axes and normals over that of the largest force's arrow.

/// Keeps the shapes of a picture.
class Collector : public DebugDraw {
 public:
  explicit Collector(Insight& insight) : insight_(insight) {}

  void line(DebugSubject subject, DVec3 from, DVec3 to, DebugColor color) override {
    insight_.lines.push_back({subject, from, to, color});
  }
  void point(DebugSubject /*subject*/, DVec3 place, DebugColor color) override {
    insight_.points.push_back({place, color});
  }
  void triangle(DebugSubject /*subject*/, const std::array<DVec3, 3>& corners, DebugColor color) override {
    insight_.triangles.push_back({corners, color});
  }
  void text(DebugSubject /*subject*/, DVec3 place, std::string_view text, DebugColor color) override {
    insight_.texts.push_back({place, std::string(text), color});
  }

 private:
  Insight& insight_;
};

auto choices_of(const DebugDrawDesc& desc) {
  return std::array{desc.contacts, desc.velocities, desc.bounds, desc.loads,
                    desc.hooks,    desc.sleep,      desc.routes, desc.texts};
}

}  // namespace

std::span<const InsightChoice> insight_choices() {
  return kChoices;
}

bool operator==(const InsightWish& a, const InsightWish& b) {
  return choices_of(a.desc) == choices_of(b.desc) && a.arrow == b.arrow;
}

bool InsightWish::any() const {
  const auto choices = choices_of(desc);
  return std::any_of(choices.begin(), choices.end() - 1, [](bool chosen) { return chosen; });
}

std::shared_ptr<const Insight> InsightMaker::make(const World& world, const InsightWish& wish,
                                                  double seconds) {
  if (!wish.any()) {
    *this = {};
    return nullptr;
  }
  const double fading = std::exp2(-std::max(seconds, 0.0) / kFading);
  force_ *= fading;
  tension_ *= fading;
  strain_ *= fading;
  DebugDrawDesc desc = wish.desc;
  desc.axis_length = kAxisShare * wish.arrow;
  for (;;) {
    desc.meters_per_newton = force_ > 0 ? std::min(wish.arrow / force_, 1e6) : 0;
    desc.full_tension = tension_;
    desc.full_strain = strain_;
    auto insight = std::make_shared<Insight>();
    Collector collector(*insight);
    const auto legend = world.debug_draw(collector, desc);
    if (!legend) return nullptr;  // The lengths are within their bounds.
    insight->legend = legend.value();
    insight->arrow_force = force_;
    const DebugDrawLegend& found = legend.value();
    if (!(found.force > force_ || found.tension > tension_ || found.strain > strain_)) return insight;
    force_ = std::max(force_, found.force);
    tension_ = std::max(tension_, found.tension);
    strain_ = std::max(strain_, found.strain);
  }
}

}  // namespace hooke::app
