#include "hooke/drawing/shown_insight.h"

#include "hooke/drawing/insight_drawing.h"
#include "hooke/text_of.h"
#include "hooke/view/eye.h"

#include "render/orbit_camera.h"

#include <CLI/CLI.hpp>
#include <utility>

namespace hooke::app {

namespace {

constexpr float kNumberSize = 12;  ///< Height of a number [pixels].

/// The names of all that can be shown.
std::string list_choices() {
  std::string list;
  for (const InsightChoice& choice : insight_choices())
    list += (list.empty() ? "" : ", ") + std::string(choice.name);
  return list;
}

template <std::size_t N>
std::string names_of(const std::array<DebugRoute, N>& routes) {
  std::string names;
  for (const DebugRoute& route : routes) {
    const auto byte = [](float share) { return static_cast<int>(255 * share + 0.5F); };
    names += text_of("%s%s #%02x%02x%02x", names.empty() ? "" : ", ", std::string(route.name).c_str(),
                     byte(route.color.r), byte(route.color.g), byte(route.color.b));
  }
  return names;
}

/// Writes the numbers of a debug picture beside what they are of, with a shadow that makes them legible.
/// Returns how many have no room.
std::size_t add_numbers(const Insight& insight, const Eye& eye, render::DrawList& list) {
  std::size_t left_out = 0;
  for (const SeenNumber& number : numbers_with_room(insight, eye, kNumberSize, left_out)) {
    const Insight::Text& text = *number.text;
    render::DrawText drawn = {.x_px = static_cast<float>(number.pixel[0]) + 6,
                              .y_px = static_cast<float>(number.pixel[1]) - 6,
                              .size_px = kNumberSize,
                              .color = {0, 0, 0},
                              .text = text.text};
    list.texts.push_back(drawn);
    drawn.x_px -= 1;
    drawn.y_px -= 1;
    drawn.color = {text.color.r, text.color.g, text.color.b};
    list.texts.push_back(std::move(drawn));
  }
  return left_out;
}

}  // namespace

void add_show(CLI::App& app, std::vector<std::string>& words) {
  app.add_option("--show", words, "Show what the engine knows, with a legend: " + list_choices())
      ->delimiter(',');
}

Result<InsightWish> wish_of(const std::vector<std::string>& words) {
  InsightWish wish;
  for (const std::string& word : words) {
    const InsightChoice* found = nullptr;
    for (const InsightChoice& choice : insight_choices()) {
      if (word == choice.name) found = &choice;
    }
    if (found == nullptr)
      return Error{ErrorCode::kOutOfRange, "--show", "'" + word + "' is none of " + list_choices()};
    wish.desc.*found->shown = true;
  }
  if (!words.empty() && !wish.any())
    return Error{ErrorCode::kOutOfRange, "--show", "numbers stand beside what else is shown: add that, too"};
  return wish;
}

void ShownInsight::add(const World& world, DVec3 origin, int width, int height, render::DrawList& list) {
  if (!wish_.any()) return;
  const render::OrbitCamera camera = render::make_orbit_camera(list.camera);
  wish_.arrow = kArrowShare * static_cast<double>(camera.distance);
  const auto insight = maker_.make(world, wish_, world.time() - std::exchange(time_, world.time()));
  if (!insight) return;
  const Eye eye = eye_of(camera, origin, width, height);
  add_insight(*insight, origin, static_cast<float>(2 * eye.half_height / height), list);
  add_legend(*insight, add_numbers(*insight, eye, list), list);
}

void ShownInsight::add_legend(const Insight& insight, std::size_t numbers_left_out,
                              render::DrawList& list) const {
  const DebugDrawLegend& legend = insight.legend;
  std::string text;
  if (wish_.desc.contacts) {
    text += text_of("%u contacts, the longest arrow is %.4g N: normal green, force red, friction yellow\n",
                    legend.contacts, insight.arrow_force);
  }
  if (wish_.desc.velocities) text += text_of("arrows: the way in 0.1 s; up to %.4g m/s\n", legend.speed);
  if (wish_.desc.loads) {
    if (legend.full_tension > 0)
      text += text_of("tension: blue -%.4g, red %.4g N\n", legend.full_tension, legend.full_tension);
    if (legend.full_strain > 0) {
      text +=
          text_of("strain: blue -%.3g, red %.3g %%\n", 100 * legend.full_strain, 100 * legend.full_strain);
    }
  }
  if (wish_.desc.sleep) text += text_of("%u bodies sleep\n", legend.asleep);
  if (wish_.desc.routes) {
    text += "contacts: " + names_of(debug_routes_of_contacts()) +
            "\nhooks: " + names_of(debug_routes_of_hooks()) + "\n";
  }
  if (numbers_left_out > 0) text += text_of("%zu numbers have no room beside others\n", numbers_left_out);
  if (!text.empty()) list.texts.push_back({.text = std::move(text)});
}

}  // namespace hooke::app
