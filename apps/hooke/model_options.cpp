#include "hooke/model_options.h"

#include "hooke/command_line.h"

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace hooke::app {

void add_model_options(CLI::App& app, ModelOptions& model) {
  const std::map<std::string, UpAxis> axes = {{"x", UpAxis::kX}, {"y", UpAxis::kY}, {"z", UpAxis::kZ}};
  app.add_option("--up", model.import.up,
                 "Axis that points up in the file: x, y or z; the format's by default")
      ->transform(CLI::Transformer(axes).description(""))
      ->option_text("AXIS");
  add_number(app, "--scale", model.scale, 1e-9, 1e9, "Meters per unit of the file");
  add_number(app, "--fit", model.import.fit, 1e-6, 1e6, "Make the longest side so long [m]");
  app.get_option("--fit")->excludes("--scale");
}

}  // namespace hooke::app
