#include "hooke/load/load_picture.h"

#include "hooke/drawing/scene_drawing.h"
#include "hooke/text_of.h"

#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace hooke::app {

namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr float kRodRadius = 0.005F;  ///< Of a rod, which has no shape, over the extent of the rods.

/// Color of a utilization: blue, green, yellow, red in linear steps.
render::Color color_of(double used) {
  static constexpr std::array<render::Color, 4> kColors = {
      {{0.05F, 0.2F, 0.75F}, {0.05F, 0.55F, 0.15F}, {0.85F, 0.65F, 0.02F}, {0.8F, 0.04F, 0.02F}}};
  if (used > 1 + 1e-9) return {0.5F, 0.02F, 0.6F};
  const double place = std::clamp(used, 0.0, 1.0) * (kColors.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), kColors.size() - 2);
  const auto part = static_cast<float>(place - static_cast<double>(low));
  const render::Color& a = kColors[low];
  const render::Color& b = kColors[low + 1];
  return {a.r + part * (b.r - a.r), a.g + part * (b.g - a.g), a.b + part * (b.b - a.b)};
}

render::Color color_of(const Member& member, const MemberForce& force) {
  return has_limit(member) ? color_of(force.utilization) : render::Color{0.35F, 0.35F, 0.35F};
}

/// Adds rods as round bars, because nothing else of them is drawn.
void add_rods(const World& world, const Raised& raised, const Equilibrium& shown, DVec3 origin,
              render::DrawList& list) {
  double longest = 0;
  for (const Member& member : raised.members) {
    if (member.kind != MemberKind::kRod) continue;
    const auto [a, b] = world.hook_anchors(member.hook);
    longest = std::max(longest, length(b - a));
  }
  for (std::size_t i = 0; i < raised.members.size(); ++i) {
    const Member& member = raised.members[i];
    if (member.kind != MemberKind::kRod || shown.forces[i].broken) continue;
    const auto [a, b] = world.hook_anchors(member.hook);
    list.ropes.push_back({.points = {vector_cast<Real>(a - origin), vector_cast<Real>(b - origin)},
                          .radius = 2 * kRodRadius * static_cast<float>(longest),
                          .color = color_of(member, shown.forces[i])});
    list.ropes.back().surface.shading = render::Shading::kSolid;
  }
}

}  // namespace

Result<void> draw_load(Simulation& simulation, const Raised& raised, const std::string& path) {
  if (auto restored = simulation.restore(raised.whole); !restored) return restored;
  const Equilibrium& shown = last_whole(raised);
  std::map<std::string, render::Color> colors;
  double most = 0;
  for (std::size_t i = 0; i < raised.members.size(); ++i) {
    const Member& member = raised.members[i];
    most = std::max(most, shown.forces[i].utilization);
    if (member.kind == MemberKind::kBar || member.kind == MemberKind::kRope) {
      colors[member.name] = color_of(member, shown.forces[i]);
    }
  }
  const auto context = render::Context::create_headless();
  if (!context) return context.error();
  auto renderer = render::Renderer::create(context.value(), {kWidth, kHeight});
  if (!renderer) return renderer.error();
  SceneDrawing drawing;
  drawing.paint(std::move(colors));
  drawing.record(simulation);
  render::DrawList list;
  drawing.fill(simulation.world().time(), kHeight, list);
  add_rods(simulation.world(), raised, shown, drawing.origin(), list);
  list.texts.push_back(
      {.text = text_of("%.6g N\nused up to %.1f %%: blue 0, green 33, yellow 67, red 100 %%, violet beyond",
                       shown.load, 100 * most)});
  if (const auto drawn = renderer.value().draw(list); !drawn) return drawn.error();
  const auto image = renderer.value().read_image();
  if (!image) return image.error();
  return render::write_png(image.value(), path);
}

}  // namespace hooke::app
