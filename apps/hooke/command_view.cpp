#include "hooke/command_line.h"
#include "hooke/drawing/drawing_style.h"
#include "hooke/model_options.h"
#include "hooke/session/model_scene.h"
#include "hooke/session/session.h"
#include "hooke/view/view_window.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace hooke::app {

namespace {

struct CommandOptions {
  std::string path;
  ModelOptions model;
  bool paused = false;
  std::optional<double> seconds;
  std::string screenshot;
  std::string log;
  std::optional<double> interface_scale;
  std::optional<double> picture_scale;
  std::optional<double> memory;  ///< [MiB]
  StyleWords style;
  SceneOverrides overrides;
};

void describe(CLI::App& app, CommandOptions& options) {
  app.add_option("SCENE", options.path, "Scene file, or a model: .3ds .obj .stl .ply .gltf .glb")->required();
  add_model_options(app, options.model);
  app.add_flag("--paused", options.paused, "Start paused");
  add_seconds(app, options.seconds, "Close after so much simulated time; never by default");
  app.add_option("--screenshot", options.screenshot, "Write the last picture to this .png")
      ->needs("--seconds");
  app.add_option("--log", options.log, "Write what is shown to this file, a line of JSON for each picture");
  add_number(
      app, "--picture-scale", options.picture_scale, 0.25, 1,
      "Part of the window's width and height that is drawn; what gives 20 pictures a second by default");
  add_number(app, "--ui-scale", options.interface_scale, 0.5, 8,
             "Size of the panels; what fits the window by default");
  add_number(app, "--memory", options.memory, 1, 1e6, "Memory for the timeline [MiB]; 512 by default");
  add_style(app, options.style);
  add_overrides(app, options.overrides);
  app.footer(
      "Drag an object with the left button to grab and throw it; drag on nothing, or with the right button, "
      "to\n"
      "turn the camera; the wheel zooms. Space plays and pauses, S steps, B shoots a ball, U undoes, R goes "
      "back\n"
      "to the start, the bar below rewinds. G, J and K make a model a rigid body, jelly or cloth. The key ? "
      "lists\n"
      "all keys. A model's longest side is 1 m unless --fit or --scale says otherwise.\n\n"
      "Examples:\n"
      "  hooke view scenes/showcase.json\n"
      "  hooke view scenes/paper/fig7.json --bounds sphere,oriented_box\n"
      "  hooke view scenes/models/lantern.3ds --fit 0.4\n"
      "  hooke view part.stl --up y --scale 0.001");
}

/// Reads a scene file, or makes the scene of a model.
Loaded<SceneDocument> read(const CommandOptions& options, const std::string& file) {
  if (!is_model_file(file)) return read_document(file);
  ImportOptions import = options.model.options();
  if (!options.model.scale && !import.fit) import.fit = 1;
  auto document = document_of_model(file, import);
  if (!document) return {.errors = {document.error()}};
  return {.value = std::move(document).value()};
}

/// Returns how the session gets scenes.
Loader loader_of(const CommandOptions& options) {
  Loader loader;
  loader.read = [options](const std::string& file) { return read(options, file); };
  loader.build = [options](const Scene& scene, const std::function<void(const std::string&)>& progress) {
    progress(std::filesystem::path(scene.path).filename().string());
    Scene made = scene;
    apply(options.overrides, made.world);
    LoadOptions load = load_options();
    load.progress = [&progress, line = load.progress](std::string_view what, double part) {
      if (line) line(what, part);
      progress(std::string(what) + " " + std::to_string(static_cast<int>(100 * part)) + " %");
    };
    Loaded<Simulation> built = Simulation::create(std::move(made), {}, load);
    for (const Error& warning : built.warnings) warn(warning);
    return built;
  };
  return loader;
}

}  // namespace

int command_view(Arguments arguments) {
  CLI::App app("Shows a scene, or a model on a ground, in a window.", "hooke view");
  CommandOptions options;
  describe(app, options);
  if (const auto code = parse(app, arguments)) return *code;

  auto style = style_of(options.style);
  if (!style) return report(style.error());
  std::optional<Scene> scene;
  if (!is_model_file(options.path)) {
    scene = read_scene(options.path);
    if (!scene) return kBadInput;
  }
  ViewOptions view;
  const std::string name = std::filesystem::path(options.path).filename().string();
  view.title = "Hooke: " + (scene && !scene->title.empty() ? scene->title : name);
  view.style = std::move(style).value();
  view.interface_scale = options.interface_scale;
  view.picture_scale = options.picture_scale;
  view.stop_time = options.seconds;
  view.screenshot = options.screenshot;
  view.log = options.log;
  SessionOptions playing = {.playing = !options.paused, .stop_time = options.seconds};
  if (options.memory) playing.timeline_budget = static_cast<std::size_t>(*options.memory * (1 << 20));
  Session session(options.path, loader_of(options), playing);
  const auto shown = run_view(session, view);
  if (!shown) return report(shown.error());
  const auto last = session.view();
  return last->stage == SessionView::Stage::kFailed ? report(last->errors, {}) : kGood;
}

}  // namespace hooke::app
