#pragma once

#include "hooke/compare/plots.h"

#include <string>
#include <vector>

namespace hooke::app {

/// A drawn plot.
struct Picture {
  std::string name;
  std::string caption;
  std::string svg;  ///< The whole file.
};

/// One HTML page that needs nothing else: tables, pictures inside, a little style. `note` says why pictures
/// are missing; empty for none.
std::string make_page(const Comparison& comparison, const std::vector<Picture>& pictures,
                      const std::string& note);

}  // namespace hooke::app
