#include "hooke/command_line.h"
#include "hooke/compare/stage.h"
#include "hooke/drawing/drawing_style.h"
#include "hooke/drawing/scene_drawing.h"
#include "hooke/drawing/shown_insight.h"
#include "hooke/progress.h"

#include "render/renderer.h"
#include "render/video.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace hooke::app {

namespace {

struct RenderOptions {
  std::string scene;
  std::string output;
  std::string size = "1280x720";
  int width = 1280;
  int height = 720;
  int frames_per_second = 30;
  std::optional<double> seconds;
  std::optional<double> at;
  std::optional<double> trail;  ///< [s]
  StyleWords style;
  std::vector<std::string> show;
  std::string stepper;  ///< Method of the laboratory; empty for the solver.
  bool force = false;
  SceneOverrides overrides;
};

void describe(CLI::App& app, RenderOptions& options) {
  app.add_option("SCENE", options.scene, "Scene file")->required();
  app.add_option("-o,--output", options.output, "X.mp4, X.gif, X_%04d.png, or X.png for one picture")
      ->required();
  app.add_option("--size", options.size, "Width x height in pixels")
      ->capture_default_str()
      ->option_text("WxH");
  app.add_option("--fps", options.frames_per_second, "Pictures per simulated second")
      ->check(CLI::Range(1, 240))
      ->capture_default_str();
  add_seconds(app, options.seconds, "Length of the film; the scene's by default");
  add_number(app, "--at", options.at, 0, 1e6, "Time of a single picture; the scene's end by default");
  add_number(app, "--trail", options.trail, 1e-6, 1e6,
             "Leave ropes and particles in the picture as they were every so many seconds");
  add_style(app, options.style);
  add_show(app, options.show);
  CLI::Option* stepper =
      app.add_option("--stepper", options.stepper, "Draw the laboratory's run; see hooke compare --help");
  app.add_flag("--force", options.force, "Run an explicit stepper where it is known to diverge, too")
      ->needs(stepper);
  add_overrides(app, options.overrides);
  app.footer(
      "Each picture shows the state at its own time, between the two steps around it.\n\n"
      "Examples:\n"
      "  hooke render scenes/flag.json -o flag.mp4 --seconds 2 --size 640x360\n"
      "  hooke render scenes/rope.json -o rope.png --at 1.5\n"
      "  hooke render scenes/rope.json -o rope_%04d.png --seconds 0.2 --size 320x180\n"
      "  hooke render scenes/paper/fig2.json -o fig2.png --stepper euler --force --trail 0.016 --at 0.3\n"
      "  hooke render scenes/paper/fig7.json -o fig7.png --bounds sphere,box,oriented_box,oriented_box_tree\n"
      "  hooke render scenes/paper/bsp_walk.json -o walk.png --at 1 --painter\n"
      "  hooke render scenes/rope_bridge.json -o loads.png --show loads,contacts");
}

bool read_size(RenderOptions& options) {
  int end = 0;
  const int fields = std::sscanf(options.size.c_str(), "%5dx%5d%n", &options.width, &options.height, &end);
  return fields == 2 && options.size.c_str()[end] == '\0' && options.width > 0 && options.height > 0;
}

bool ends_in(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// Advances the simulation, or the laboratory's run of it, to the two steps around a time and draws between
/// them.
class Film {
 public:
  Film(Simulation simulation, std::optional<lab::Run> run, render::Renderer renderer,
       std::optional<double> trail, SceneDrawing drawing, const InsightWish& wish)
      : simulation_(std::move(simulation)),
        run_(std::move(run)),
        renderer_(std::move(renderer)),
        drawing_(std::move(drawing)),
        insight_(wish) {
    if (trail) drawing_.keep_trail(*trail);
    has_trail_ = trail.has_value();
    drawing_.record(simulation_);
  }

  /// Draws the picture at `time` [s]; times must not decrease.
  Result<render::Image> picture_at(double time, Progress* progress) {
    const double steps = time / static_cast<double>(simulation_.scene().dt);
    // A time that is a whole number of steps, except for rounding, needs no step beyond.
    const auto last = static_cast<std::uint64_t>(std::ceil(std::max(steps - 1e-4, 0.0)));
    while (steps_ < last) {
      const std::uint64_t left = last - steps_;
      const auto stepped = step();
      if (!stepped) return stepped.error();
      if (left <= 2 || has_trail_) drawing_.record(simulation_, this->time());
      if (progress != nullptr) progress->show(steps_);
    }
    render::DrawList list;
    drawing_.fill(time, renderer_.height(), list);
    insight_.add(simulation_.world(), drawing_.origin(), renderer_.width(), renderer_.height(), list);
    for (const std::string& line : drawing_.take_warnings()) {
      std::fprintf(stderr, "warning: %s\n", line.c_str());
    }
    const auto drawn = renderer_.draw(list);
    if (!drawn) return drawn.error();
    return renderer_.read_image();
  }

  [[nodiscard]] const Simulation& simulation() const { return simulation_; }

 private:
  [[nodiscard]] double time() const {
    return run_ ? static_cast<double>(steps_) * static_cast<double>(simulation_.scene().dt)
                : simulation_.world().time();
  }

  Result<void> step() {
    ++steps_;
    if (!run_) {
      if (simulation_.step().moved) return {};
      return Error{ErrorCode::kOutOfRange, simulation_.scene().path, "the step did not move"};
    }
    // What has diverged stays out of the picture.
    gone_ = gone_ || !run_->advance() || !show_run(*run_, simulation_);
    return {};
  }

  Simulation simulation_;
  std::optional<lab::Run> run_;
  render::Renderer renderer_;
  SceneDrawing drawing_;
  ShownInsight insight_;
  std::uint64_t steps_ = 0;
  bool has_trail_ = false;
  bool gone_ = false;
};

Result<void> render_picture(Film& film, const RenderOptions& options) {
  const Scene& scene = film.simulation().scene();
  const double time = options.at.value_or(options.seconds.value_or(scene.seconds));
  Progress progress("simulating", steps_in(scene, time));
  const auto image = film.picture_at(time, &progress);
  if (!image) return image.error();
  return render::write_png(image.value(), options.output);
}

Result<void> render_film(Film& film, const RenderOptions& options) {
  const double seconds = options.seconds.value_or(film.simulation().scene().seconds);
  const auto frames = static_cast<std::uint64_t>(
      std::max(1LL, std::llround(seconds * static_cast<double>(options.frames_per_second))));
  auto video =
      render::VideoWriter::create({options.output, options.width, options.height, options.frames_per_second});
  if (!video) return video.error();
  Progress progress("rendering", frames);
  for (std::uint64_t i = 0; i < frames; ++i) {
    const auto image =
        film.picture_at(static_cast<double>(i) / static_cast<double>(options.frames_per_second), nullptr);
    if (!image) return image.error();
    auto added = video.value().add(image.value());
    if (!added) return added;
    progress.show(i + 1);
  }
  return video.value().finish();
}

Result<render::Renderer> make_renderer(const RenderOptions& options) {
  const auto context = render::Context::create_headless();
  if (!context) return context.error();
  // Thin ropes cast shadows, too, which a smaller map shows as dots.
  return render::Renderer::create(
      context.value(), {.width = options.width, .height = options.height, .shadow_map_size = 4096});
}

}  // namespace

int command_render(Arguments arguments) {
  CLI::App app("Draws a scene to a film or to pictures. Needs no display.", "hooke render");
  RenderOptions options;
  describe(app, options);
  if (const auto code = parse(app, arguments)) return *code;
  if (!read_size(options)) {
    return report({ErrorCode::kOutOfRange, "--size", "'" + options.size + "' is not like 1280x720"});
  }
  const bool single = ends_in(options.output, ".png") && options.output.find('%') == std::string::npos;
  if (options.at && !single) {
    return report({ErrorCode::kOutOfRange, "--at", "is for a single picture, X.png"});
  }

  auto style = style_of(options.style);
  if (!style) return report(style.error());
  const auto wish = wish_of(options.show);
  if (!wish) return report(wish.error());
  auto scene = read_scene(options.scene);
  if (!scene) return kBadInput;
  apply(options.overrides, scene->world);
  auto simulation = build_simulation(std::move(*scene));
  if (!simulation) return kBadInput;
  auto renderer = make_renderer(options);
  if (!renderer) return report(renderer.error());
  std::optional<lab::Run> run;
  if (!options.stepper.empty() && options.stepper != kSolverName) {
    auto created = make_run(*simulation, options.stepper,
                            options.seconds.value_or(simulation->scene().seconds), options.force);
    if (!created) return report(created.error());
    run.emplace(std::move(created).value());
  }
  Film film(std::move(*simulation), std::move(run), std::move(renderer).value(), options.trail,
            SceneDrawing(std::move(style).value()), wish.value());
  const auto done = single ? render_picture(film, options) : render_film(film, options);
  if (!done) return report(done.error());
  std::printf("%s\n", options.output.c_str());
  return kGood;
}

}  // namespace hooke::app
