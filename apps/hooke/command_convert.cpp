#include "hooke/command_line.h"
#include "hooke/fracture.h"
#include "hooke/geometry.h"
#include "hooke/model_io.h"
#include "hooke/model_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <utility>

namespace hooke::app {

namespace {

/// This is an operation on the shapes of two models.
struct Combination {
  const char* option;
  const char* help;
  SolidOperation operation;
  std::string other = {};
};

/// Returns the model's surface combined with that of `other`; materials and textures are lost.
Result<Model> combine(const Model& model, const Combination& combination, const ImportOptions& options) {
  const auto other = import_model(combination.other, options);
  if (!other) return other.error();
  const auto mesh = combine_solids(model.mesh, other.value().mesh, combination.operation);
  if (!mesh) return mesh.error();
  if (mesh.value().triangles.empty()) {
    return Error{ErrorCode::kOutOfRange, combination.option, "nothing is left"};
  }
  return model_of(mesh.value());
}

/// Writes the cells of the model's solid, and says how many there are.
int write_cells(const Model& model, const FractureDesc& desc, const std::string& output) {
  const Result<SolidRepair> solid = repair_solid(model.mesh);
  if (!solid) return report(solid.error());
  const Result<Fracture> pieces = fracture(solid.value().mesh, desc);
  if (!pieces) return report(pieces.error());
  const auto written = export_cells(pieces.value(), output);
  if (!written) return report(written.error());
  std::printf("%s: %zu cells, %zu glued faces, %u seeds merged\n", output.c_str(),
              pieces.value().cells.size(), pieces.value().bonds.size(), pieces.value().merged);
  return kGood;
}

}  // namespace

int command_convert(Arguments arguments) {
  CLI::App app("Converts a model. Reads .3ds .obj .stl .ply .gltf .glb, writes .obj .glb .stl .3ds.",
               "hooke convert");
  std::string input;
  std::string output;
  ModelOptions model_options;
  Combination combinations[] = {
      {"--union", "Join with this solid", SolidOperation::kUnion},
      {"--intersect", "Keep what is in this solid, too", SolidOperation::kIntersection},
      {"--subtract", "Take this solid out", SolidOperation::kDifference},
  };
  const std::map<std::string, ModelOrigin> origins = {
      {"file", ModelOrigin::kFile}, {"center", ModelOrigin::kCenter}, {"bottom", ModelOrigin::kBottom}};
  app.add_option("IN", input, "Model to read")->required();
  app.add_option("OUT", output, "Model to write")->required();
  add_model_options(app, model_options);
  app.add_option("--origin", model_options.import.origin,
                 "Put the origin there: file, center or bottom; the file's by default")
      ->transform(CLI::Transformer(origins).description(""))
      ->option_text("PLACE");
  auto* const operations = app.add_option_group("Solids", "One of these; both models must be closed");
  for (Combination& c : combinations) operations->add_option(c.option, c.other, c.help)->option_text("MODEL");
  operations->require_option(0, 1);
  FractureDesc fracture_desc;
  auto* const cells =
      app.add_option("--fracture", fracture_desc.cells,
                     "Write this many Voronoi cells of the solid, each as an object of OUT, an .obj")
          ->option_text("N");
  app.add_option("--fracture-seed", fracture_desc.seed, "Seed of their random numbers; 1 by default")
      ->needs(cells)
      ->option_text("N");
  app.footer(
      "Examples:\n"
      "  hooke convert scenes/models/lantern.3ds lantern.glb --fit 0.4\n"
      "  hooke convert scenes/models/crate.3ds crate.obj --up z --scale 0.01\n"
      "  hooke convert scenes/models/crate.3ds --subtract scenes/models/lantern.3ds hollow.obj\n"
      "  hooke convert scenes/models/crate.3ds pieces.obj --fracture 30");
  if (const auto code = parse(app, arguments)) return *code;

  const ImportOptions options = model_options.options();
  auto model = import_model(input, options);
  for (const Combination& c : combinations) {
    if (model && !c.other.empty()) model = combine(model.value(), c, options);
  }
  if (!model) return report(model.error());
  for (const std::string& image : model.value().missing_images) {
    warn({ErrorCode::kFileNotReadable, input,
          "its image '" + image + "' is not beside it, and is left out: put it there"});
  }
  if (cells->count() > 0) return write_cells(model.value(), fracture_desc, output);
  const auto written = export_model(model.value(), output);
  if (!written) return report(written.error());
  std::printf("%s: %zu vertices, %zu triangles, %zu materials\n", output.c_str(),
              model.value().vertices.size(), model.value().indices.size() / 3,
              model.value().materials.size());
  return kGood;
}

}  // namespace hooke::app
