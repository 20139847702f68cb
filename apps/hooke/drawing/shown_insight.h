#pragma once

#include "hooke/session/insight.h"

#include "render/draw_list.h"

#include <cstddef>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hooke::app {

/// Adds --show.
void add_show(CLI::App& app, std::vector<std::string>& words);

/// Returns what these words ask for. The Error names a word that asks for nothing.
Result<InsightWish> wish_of(const std::vector<std::string>& words);

/// Shows in pictures what a world knows besides where its objects are.
class ShownInsight {
 public:
  explicit ShownInsight(const InsightWish& wish) : wish_(wish) {}

  /// Adds the debug picture of the world as it is now, its numbers and its legend, to a list whose camera is
  /// set. `origin` is the list's [m], width and height are those of the picture [pixels].
  void add(const World& world, DVec3 origin, int width, int height, render::DrawList& list);

 private:
  void add_legend(const Insight& insight, std::size_t numbers_left_out, render::DrawList& list) const;

  InsightWish wish_;
  InsightMaker maker_;
  double time_ = 0;  ///< Of the picture before [s].
};

}  // namespace hooke::app
