#include "hooke/drawing/drawing_style.h"

#include "render/bounding_lines.h"

#include <CLI/CLI.hpp>

namespace hooke::app {

void add_style(CLI::App& app, StyleWords& words) {
  app.add_option("--bounds", words.bounds,
                 "Bounding volumes around bodies, one after the other: sphere, vertex_sphere, box, "
                 "oriented_box, sphere_tree, box_tree, oriented_box_tree")
      ->delimiter(',');
  app.add_flag("--painter", words.painter,
               "Opaque surfaces from far to near by a BSP tree, without a depth test");
}

Result<DrawingStyle> style_of(const StyleWords& words) {
  DrawingStyle style = {.painter = words.painter};
  for (const std::string& name : words.bounds) {
    const auto kind = render::bounding_volume_named(name);
    if (!kind)
      return Error{ErrorCode::kOutOfRange, "--bounds", "no bounding volume is called '" + name + "'"};
    style.bounds.push_back(*kind);
  }
  return style;
}

}  // namespace hooke::app
