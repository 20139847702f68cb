#pragma once

#include "hooke/compare/plots.h"

#include <string>
#include <string_view>
#include <vector>

namespace hooke::app {

/// Style and script of the page: compare/page/page.css and page.js, as they were when the program was built.
extern const std::string_view kPageStyle;
extern const std::string_view kPageScript;

/// A Picture is a drawn plot.
struct Picture {
  std::string name;
  std::string caption;
  std::string svg;  ///< Content of the whole file.
};

/// Makes one HTML page that needs no other file: what happened and why, panels that move, plots, tables.
/// `note` says why pictures are missing; it is empty if none are.
std::string make_page(const Comparison& comparison, const std::vector<Picture>& pictures,
                      const std::string& note);

}  // namespace hooke::app
