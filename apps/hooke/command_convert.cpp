#include "hooke/command_line.h"
#include "hooke/model_io.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

namespace hooke::app {

int command_convert(Arguments arguments) {
  CLI::App app("Converts a model. Reads .3ds .obj .stl .ply .gltf .glb, writes .obj .glb .stl .3ds.",
               "hooke convert");
  std::string input;
  std::string output;
  ImportOptions options;
  std::optional<double> scale;
  const std::map<std::string, UpAxis> axes = {{"x", UpAxis::kX}, {"y", UpAxis::kY}, {"z", UpAxis::kZ}};
  app.add_option("IN", input, "Model to read")->required();
  app.add_option("OUT", output, "Model to write")->required();
  app.add_option("--up", options.up, "Axis that points up in the file: x, y or z; the format's by default")
      ->transform(CLI::Transformer(axes).description(""))
      ->option_text("AXIS");
  add_number(app, "--scale", scale, 1e-9, 1e9, "Meters per unit of the file");
  add_number(app, "--fit", options.fit, 1e-6, 1e6, "Make the longest side so long [m]");
  app.get_option("--fit")->excludes("--scale");
  app.footer(
      "Examples:\n"
      "  hooke convert scenes/models/lantern.3ds lantern.glb --fit 0.4\n"
      "  hooke convert scenes/models/crate.3ds crate.obj --up z --scale 0.01");
  if (const auto code = parse(app, arguments)) return *code;

  options.scale = scale.value_or(options.scale);
  const auto model = import_model(input, options);
  if (!model) return report(model.error());
  const auto written = export_model(model.value(), output);
  if (!written) return report(written.error());
  std::printf("%s: %zu vertices, %zu triangles, %zu materials\n", output.c_str(),
              model.value().vertices.size(), model.value().indices.size() / 3,
              model.value().materials.size());
  return kGood;
}

}  // namespace hooke::app
