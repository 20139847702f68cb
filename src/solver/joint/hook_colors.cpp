#include "solver/joint/hook_colors.h"

#include "base/assert.h"

#include <algorithm>
#include <bit>

namespace hooke::solver {

namespace {

constexpr int kMaskColors = 64;

/// The first color that no hook of either body has.
int choose_color(const state::Hook& hook, const state::Bodies& bodies, std::vector<std::uint64_t>& used,
                 int& next_own_color) {
  std::uint64_t mask = 0;
  for (const std::uint32_t body : {hook.a.body, hook.b.body})
    mask |= is_dynamic(bodies, body) ? used[body] : 0;
  HOOKE_ASSERT(is_dynamic(bodies, hook.a.body) || is_dynamic(bodies, hook.b.body));
  if (~mask == 0) return next_own_color++;
  const int color = std::countr_one(mask);
  for (const std::uint32_t body : {hook.a.body, hook.b.body}) {
    if (is_dynamic(bodies, body)) used[body] |= std::uint64_t{1} << color;
  }
  return color;
}

}  // namespace

bool is_awake(const state::Hook& hook, const state::Bodies& bodies) {
  return gives_way(bodies, hook.a.body) || gives_way(bodies, hook.b.body);
}

void color_hooks(std::span<const std::uint32_t> hook_rows, const std::vector<state::Hook>& hooks,
                 const state::Bodies& bodies, ColorScratch& scratch, HookColors colors) {
  auto& [used, colored] = scratch;
  used.assign(bodies.motion.size(), 0);
  colored.clear();
  int next_own_color = kMaskColors;
  for (const std::uint32_t row : hook_rows)
    colored.emplace_back(choose_color(hooks[row], bodies, used, next_own_color), row);
  std::sort(colored.begin(), colored.end());

  colors.hooks.clear();
  colors.begin.assign(1, 0);
  for (std::size_t i = 0; i < colored.size(); ++i) {
    if (i > 0 && colored[i].first != colored[i - 1].first) colors.begin.push_back(static_cast<int>(i));
    colors.hooks.push_back(colored[i].second);
  }
  if (!colored.empty()) colors.begin.push_back(static_cast<int>(colored.size()));
  HOOKE_ASSERT(colors.hooks.size() == hook_rows.size());
}

}  // namespace hooke::solver
