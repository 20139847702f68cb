#pragma once

#include "hooke/compare/plots.h"

#include <string>
#include <vector>

namespace hooke::app {

/// A Picture is a drawn plot.
struct Picture {
  std::string name;
  std::string caption;
  std::string svg;  ///< Content of the whole file.
};

/// Makes one HTML page that needs no other file: tables, pictures inside, a little style. `note` says why
/// pictures are missing; it is empty if none are.
std::string make_page(const Comparison& comparison, const std::vector<Picture>& pictures,
                      const std::string& note);

}  // namespace hooke::app
