#include "hooke/command_line.h"
#include "hooke/drawing/drawing_style.h"
#include "hooke/drawing/scene_drawing.h"
#include "hooke/view_window.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace hooke::app {

namespace {

/// Assumed height of the picture [px]. In a larger window thin ropes are a little thinner than they could be.
constexpr int kUsualHeight = 720;

struct CommandOptions {
  std::string path;
  std::optional<double> fit;  ///< [m]
  bool paused = false;
  std::optional<double> seconds;
  std::string screenshot;
  StyleWords style;
  SceneOverrides overrides;
};

void describe(CLI::App& app, CommandOptions& options) {
  app.add_option("SCENE", options.path, "Scene file, or a model: .3ds .obj .stl .ply .gltf .glb")->required();
  add_number(app, "--fit", options.fit, 1e-6, 1e6, "Longest side of a model [m]; 1 by default");
  app.add_flag("--paused", options.paused, "Start paused");
  add_seconds(app, options.seconds, "Close after so much simulated time; never by default");
  app.add_option("--screenshot", options.screenshot, "Write the last picture to this .png")
      ->needs("--seconds");
  add_style(app, options.style);
  add_overrides(app, options.overrides);
  app.footer(
      "Left drag orbits, right drag pans, the wheel zooms. Space plays and pauses, S or right arrow steps, "
      "R\n"
      "resets, Escape closes.\n\n"
      "Examples:\n"
      "  hooke view scenes/showcase.json\n"
      "  hooke view scenes/paper/fig7.json --bounds sphere,oriented_box\n"
      "  hooke view scenes/models/lantern.3ds --fit 0.4");
}

bool is_model(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto known = {".3ds", ".obj", ".stl", ".ply", ".gltf", ".glb"};
  return std::any_of(known.begin(), known.end(), [&](const char* e) { return ending == e; });
}

/// Makes a scene with the model standing on a ground.
Result<Scene> scene_of_model(const CommandOptions& options) {
  const ImportOptions import = {.fit = options.fit.value_or(1)};
  const auto model = import_model(options.path, import);
  if (!model) return model.error();
  float lowest = 0;
  for (const ModelVertex& vertex : model.value().vertices) {
    lowest =
        &vertex == model.value().vertices.data() ? vertex.position[1] : std::min(lowest, vertex.position[1]);
  }
  Scene scene;
  const std::filesystem::path path = options.path;
  scene.title = path.filename().string();
  // Paths of meshes are relative to the scene, so that the scene gets a path beside the model.
  scene.path = (path.parent_path() / "model.json").string();
  scene.meshes.push_back({.name = "model", .file = path.filename().string(), .import = import});
  scene.materials.push_back({.name = "ground", .color = {0.13F, 0.16F, 0.14F}});
  scene.objects.bodies.push_back({.tag = {.name = "ground", .material = "ground"}});
  SceneBody body;
  body.tag.name = body.mesh = "model";
  body.desc.shape.kind = ShapeKind::kMesh;
  body.desc.position = {0, -static_cast<double>(lowest), 0};
  scene.objects.bodies.push_back(std::move(body));
  return scene;
}

std::optional<Scene> read(const CommandOptions& options, int& code) {
  code = kBadInput;
  if (!is_model(options.path)) return read_scene(options.path);
  auto scene = scene_of_model(options);
  if (scene) return std::move(scene).value();
  code = report(scene.error());
  return std::nullopt;
}

/// A Show is a simulation that can restart, and its pictures.
class Show {
 public:
  Show(Simulation simulation, DrawingStyle style)
      : simulation_(std::move(simulation)),
        scene_(simulation_.scene()),
        style_(std::move(style)),
        drawing_(style_) {
    drawing_.record(simulation_);
  }

  Result<void> advance() {
    const StepReport step = simulation_.step();
    if (!step.moved) return Error{ErrorCode::kOutOfRange, scene_.path, "the step did not move"};
    drawing_.record(simulation_);
    return {};
  }

  Result<void> reset() {
    Loaded<Simulation> built = Simulation::create(scene_, {}, load_options());
    if (!built) return built.errors.front();
    simulation_ = std::move(*built.value);
    drawing_ = SceneDrawing(style_);
    drawing_.record(simulation_);
    return {};
  }

  void fill(render::DrawList& list, double blend) {
    const double behind = (1 - blend) * static_cast<double>(scene_.dt);
    drawing_.fill(simulation_.world().time() - behind, kUsualHeight, list);
    for (const std::string& line : drawing_.take_warnings()) {
      std::fprintf(stderr, "warning: %s\n", line.c_str());
    }
  }

  [[nodiscard]] const World& world() const { return simulation_.world(); }
  [[nodiscard]] const Scene& scene() const { return scene_; }

 private:
  Simulation simulation_;
  Scene scene_;
  DrawingStyle style_;
  SceneDrawing drawing_;
};

ViewModel model_of(Show& show) {
  return {.advance = [&show] { return show.advance(); },
          .reset = [&show] { return show.reset(); },
          .fill = [&show](render::DrawList& list, double blend) { show.fill(list, blend); },
          .energies = [&show]() -> Energies {
            const Energy energy = show.world().measure().energy;
            return {energy.kinetic, energy.potential, energy.elastic};
          },
          .time = [&show] { return show.world().time(); },
          .step_seconds = static_cast<double>(show.scene().dt)};
}

}  // namespace

int command_view(Arguments arguments) {
  CLI::App app("Shows a scene, or a model on a ground, in a window.", "hooke view");
  CommandOptions options;
  describe(app, options);
  if (const auto code = parse(app, arguments)) return *code;

  auto style = style_of(options.style);
  if (!style) return report(style.error());
  int code = kGood;
  auto scene = read(options, code);
  if (!scene) return code;
  apply(options.overrides, scene->world);
  auto simulation = build_simulation(std::move(*scene));
  if (!simulation) return kBadInput;
  Show show(std::move(*simulation), std::move(style).value());
  ViewOptions view;
  view.title = show.scene().title.empty() ? "Hooke" : "Hooke: " + show.scene().title;
  view.start_paused = options.paused;
  view.stop_time = options.seconds;
  view.screenshot = options.screenshot;
  const auto shown = run_view(model_of(show), view);
  return shown ? kGood : report(shown.error());
}

}  // namespace hooke::app
