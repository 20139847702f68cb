/// The flat format in which the importer hands models over: written, changed, read.

#include "hooke/model_io.h"

#include "fuzz/bytes.h"
#include "fuzz/mesh_maker.h"
#include "fuzz/target.h"
#include "io/model/model_flat.h"
#include "io/model/model_geometry.h"

namespace hooke::fuzz {

namespace {

Model make_model(Random& random) {
  MeshDesc mesh = random.chance(0.5) ? make_solid(random, 1) : make_hostile_mesh(random, 1);
  Model model = model_of(mesh);
  if (random.chance(0.5) && model.indices.size() > 6) {
    model.materials = {{.name = "paper", .texture = "a.png"}, {.name = "wood \xC3\xA9", .opacity = 0.5f}};
    const auto cut = static_cast<std::uint32_t>(3 * (1 + random.below(model.indices.size() / 3 - 1)));
    model.parts = {{0, cut, 1}, {cut, static_cast<std::uint32_t>(model.indices.size()) - cut, 0}};
  }
  return model;
}

}  // namespace

void check_flat(std::span<const std::byte> bytes) {
  Result<Model> model = io::read_flat_model(bytes);
  if (!model) {
    expect(!model.error().message.empty(), "refused without a word");
    return;
  }
  expect(io::check_model(*model).has_value(), "accepted what check_model refuses");
  const std::vector<std::byte> again = io::write_flat_model(*model);
  const Result<Model> second = io::read_flat_model(again);
  expect(second.has_value() && io::write_flat_model(*second) == again,
         "does not come back from what it writes");
  io::weld_model(*model);
  expect(model->welded_of.size() == model->vertices.size(), "a vertex without a welded one");
  for (const std::uint32_t v : model->welded_of)
    expect(v < model->mesh.positions.size(), "welded to nothing");
  for (const auto& triangle : model->mesh.triangles) {
    for (const std::uint32_t v : triangle) expect(v < model->mesh.positions.size(), "a triangle of nothing");
  }
  for (const Vec3 p : model->mesh.positions) expect(is_finite(p), "a welded place that is not finite");
}

void try_flat(Random& random) {
  std::vector<std::byte> bytes = io::write_flat_model(make_model(random));
  const int changes = random.integer(0, 5);
  for (int i = 0; i < changes; ++i) change_bytes(random, bytes);
  save_tried(bytes);
  check_flat(bytes);
}

}  // namespace hooke::fuzz
