#include "hooke/view_window.h"

#include "hooke/clock.h"

#define GLFW_INCLUDE_NONE  // NOLINT(readability-identifier-naming): GLFW's own name
#include "render/orbit_camera.h"
#include "render/renderer.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <imgui.h>
#include <utility>
#include <vector>

namespace hooke::app {

namespace {

using WallClock = std::chrono::steady_clock;

constexpr std::size_t kHistory = 600;
// A slow machine shows the simulation slowly, because otherwise it would never catch up.
constexpr int kCatchUpSteps = 4;
constexpr float kRadiansPerPixel = 0.006F;
constexpr float kPanelWidth = 300;

double milliseconds_since(WallClock::time_point start) {
  return std::chrono::duration<double, std::milli>(WallClock::now() - start).count();
}

/// Makes a value follow its input slowly enough to be read.
void smooth(double& value, double input) {
  value = value > 0 ? 0.92 * value + 0.08 * input : input;
}

/// This is one curve of the plot.
struct Curve {
  const char* name = "";
  ImU32 color = 0;
  double (*value)(const Energies&) = nullptr;
};

const std::array<Curve, 4> kCurves = {{
    {"kinetic", IM_COL32(90, 170, 255, 255), [](const Energies& e) { return e.kinetic; }},
    {"potential", IM_COL32(120, 210, 120, 255), [](const Energies& e) { return e.potential; }},
    {"elastic", IM_COL32(240, 150, 80, 255), [](const Energies& e) { return e.elastic; }},
    {"total", IM_COL32(240, 240, 240, 255),
     [](const Energies& e) { return e.kinetic + e.potential + e.elastic; }},
}};

/// A Session is the state of one window between two pictures.
struct Session {
  const ViewModel& model;
  bool playing = true;
  Clock clock;
  double blend = 1;  ///< Position of the picture between the last two states.
  double step_ms = 0;
  double picture_ms = 0;
  std::string problem;
  std::deque<Energies> history;
  render::OrbitCamera camera;
  bool has_camera = false;
  render::DrawList list;
  std::vector<int> keys;  ///< Keys pressed since the last picture.
};

/// Starts the library of the user interface and ends it on destruction.
class UserInterface {
 public:
  explicit UserInterface(GLFWwindow* window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    // The library must leave no file behind.
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 6;
    ImGui::GetStyle().FrameRounding = 4;
    ready_ = ImGui_ImplGlfw_InitForOpenGL(window, true) && ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  UserInterface(const UserInterface&) = delete;
  UserInterface& operator=(const UserInterface&) = delete;
  ~UserInterface() {
    if (ready_) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui_ImplGlfw_Shutdown();
    }
    ImGui::DestroyContext();
  }

  [[nodiscard]] bool ready() const { return ready_; }

 private:
  bool ready_ = false;
};

void record(Session& session) {
  if (!session.model.energies) return;
  session.history.push_back(session.model.energies());
  if (session.history.size() > kHistory) session.history.pop_front();
}

void stop_with(Session& session, const Error& error) {
  session.playing = false;
  session.problem = error.where + ": " + error.message;
}

void step_once(Session& session) {
  const auto start = WallClock::now();
  const auto done = session.model.advance();
  smooth(session.step_ms, milliseconds_since(start));
  if (!done) stop_with(session, done.error());
  record(session);
}

void reset(Session& session) {
  const auto done = session.model.reset();
  session.history.clear();
  session.clock.reset();
  session.blend = 1;
  session.problem.clear();
  if (!done) stop_with(session, done.error());
  record(session);
}

void single_step(Session& session) {
  session.playing = false;
  session.blend = 1;
  step_once(session);
}

void play(Session& session, double elapsed_seconds) {
  if (!session.playing) return;
  const Clock::Due due = session.clock.advance(elapsed_seconds);
  for (int i = 0; i < due.steps && session.playing; ++i) step_once(session);
  session.blend = session.playing ? due.blend : 1;
}

/// Stores every key press for the next picture. The interface's own key states lose a key that is pressed and
/// released between two pictures, which at three pictures a second is most of them.
void keep_key(GLFWwindow* window, int key, int /*scancode*/, int action, int /*modifiers*/) {
  auto* session = static_cast<Session*>(glfwGetWindowUserPointer(window));
  const bool repeats = key == GLFW_KEY_S || key == GLFW_KEY_RIGHT;
  if (action == GLFW_PRESS || (action == GLFW_REPEAT && repeats)) session->keys.push_back(key);
}

void handle_keys(Session& session, GLFWwindow* window) {
  const std::vector<int> keys = std::exchange(session.keys, {});
  if (ImGui::GetIO().WantTextInput) return;
  for (const int key : keys) {
    if (key == GLFW_KEY_SPACE) session.playing = !session.playing;
    if (key == GLFW_KEY_S || key == GLFW_KEY_RIGHT) single_step(session);
    if (key == GLFW_KEY_R) reset(session);
    if (key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(window, GLFW_TRUE);
  }
}

void handle_mouse(Session& session) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) return;
  const float height = std::max(io.DisplaySize.y, 1.0F);
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    render::turn(session.camera, -kRadiansPerPixel * io.MouseDelta.x, kRadiansPerPixel * io.MouseDelta.y);
  }
  if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
    render::pan(session.camera, io.MouseDelta.x / height, -io.MouseDelta.y / height);
  }
  if (io.MouseWheel < 0 || io.MouseWheel > 0) render::zoom(session.camera, std::pow(0.9F, io.MouseWheel));
}

void draw_curve(const Session& session, const Curve& curve, ImVec2 corner, ImVec2 size,
                const std::array<double, 2>& range) {
  std::vector<ImVec2> points;
  points.reserve(session.history.size());
  for (const Energies& energies : session.history) {
    const double part = (curve.value(energies) - range[0]) / (range[1] - range[0]);
    const float along = static_cast<float>(points.size()) / static_cast<float>(kHistory - 1);
    points.emplace_back(corner.x + along * size.x, corner.y + (1 - static_cast<float>(part)) * size.y);
  }
  ImGui::GetWindowDrawList()->AddPolyline(points.data(), static_cast<int>(points.size()), curve.color, 0,
                                          1.5F);
}

/// All curves share one scale, so that one sees energy move from one form to another.
void draw_plot(const Session& session) {
  std::array<double, 2> range = {0, 0};
  for (const Energies& energies : session.history) {
    for (const Curve& curve : kCurves) {
      const double value = curve.value(energies);
      if (std::isfinite(value)) range = {std::min(range[0], value), std::max(range[1], value)};
    }
  }
  if (!(range[1] > range[0])) range[1] = range[0] + 1;
  const ImVec2 size = {ImGui::GetContentRegionAvail().x, 130};
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImDrawList* canvas = ImGui::GetWindowDrawList();
  canvas->AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, IM_COL32(0, 0, 0, 110), 4);
  const float zero = corner.y + size.y * static_cast<float>(range[1] / (range[1] - range[0]));
  canvas->AddLine({corner.x, zero}, {corner.x + size.x, zero}, IM_COL32(255, 255, 255, 60));
  canvas->PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
  for (const Curve& curve : kCurves) draw_curve(session, curve, corner, size, range);
  canvas->PopClipRect();
  ImGui::Dummy(size);
  for (const Curve& curve : kCurves) {
    const ImVec4 color = ImGui::ColorConvertU32ToFloat4(curve.color);
    ImGui::TextColored(color, "%-10s %12.5g J", curve.name, curve.value(session.history.back()));
  }
}

void draw_panel(Session& session) {
  ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({kPanelWidth, 0}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.82F);
  ImGui::Begin("Simulation", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav);
  const ImVec2 button = {84, 0};
  if (ImGui::Button(session.playing ? "Pause" : "Play", button)) session.playing = !session.playing;
  ImGui::SameLine();
  if (ImGui::Button("Step", button)) single_step(session);
  ImGui::SameLine();
  if (ImGui::Button("Reset", button)) reset(session);
  if (session.model.time) ImGui::Text("time     %10.3f s", session.model.time());
  ImGui::Text("step     %10.3f ms", session.step_ms);
  ImGui::Text("pictures %10.1f /s", session.picture_ms > 0 ? 1000 / session.picture_ms : 0.0);
  ImGui::Text("dropped  %10.3f s", session.clock.dropped_seconds());
  if (!session.history.empty()) draw_plot(session);
  if (!session.problem.empty()) {
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + kPanelWidth);
    ImGui::TextColored({1, 0.45F, 0.35F, 1}, "%s", session.problem.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

void begin_interface() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  // Two pictures within the clock's resolution would break an invariant of the library.
  ImGui::GetIO().DeltaTime = std::max(ImGui::GetIO().DeltaTime, 1e-5F);
  ImGui::NewFrame();
}

void fill_list(Session& session) {
  session.list = {};
  session.model.fill(session.list, session.blend);
  if (!session.has_camera) session.camera = render::make_orbit_camera(session.list.camera);
  session.has_camera = true;
  session.list.camera = render::camera_of(session.camera);
}

Result<void> draw_picture(Session& session, render::Renderer& renderer, GLFWwindow* window) {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  // A minimized window has no pixels.
  const bool visible = width > 0 && height > 0;
  begin_interface();
  handle_keys(session, window);
  handle_mouse(session);
  draw_panel(session);
  ImGui::Render();
  if (!visible) return {};
  fill_list(session);
  auto sized = renderer.resize(width, height);
  if (!sized) return sized;
  auto drawn = renderer.draw(session.list);
  if (!drawn) return drawn;
  auto shown = renderer.present(width, height);
  if (!shown) return shown;
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(window);
  return {};
}

Result<void> save_screenshot(const ViewOptions& options, const render::Renderer& renderer) {
  if (options.screenshot.empty()) return {};
  const auto image = renderer.read_image();
  if (!image) return image.error();
  return render::write_png(image.value(), options.screenshot);
}

Result<void> run_window(const ViewModel& model, const ViewOptions& options) {
  const auto clock = Clock::create({.step_seconds = model.step_seconds, .catch_up_steps = kCatchUpSteps});
  if (!clock) return clock.error();
  const auto context = render::Context::create_window(options.title, options.width, options.height);
  if (!context) return context.error();
  const int automatic = context.value().driver().find("llvmpipe") == std::string::npos ? 4 : 1;
  const int samples = options.samples > 0 ? options.samples : automatic;
  auto renderer = render::Renderer::create(context.value(), {options.width, options.height, samples, 2048});
  if (!renderer) return renderer.error();
  GLFWwindow* window = context.value().window();
  Session session{model, !options.start_paused, clock.value(), 1, 0, 0, {}, {}, {}, false, {}, {}};
  // This comes before the interface starts, which passes events on to the callbacks that it finds.
  glfwSetWindowUserPointer(window, &session);
  glfwSetKeyCallback(window, keep_key);
  const UserInterface interface(window);
  if (!interface.ready())
    return Error{ErrorCode::kUnsupported, "window", "the user interface does not start"};

  record(session);
  fill_list(session);
  auto last = WallClock::now();
  for (int frame = 0; glfwWindowShouldClose(window) == GLFW_FALSE; ++frame) {
    if (options.max_frames > 0 && frame >= options.max_frames) break;
    if (options.stop_time && frame > 0 && model.time && model.time() >= *options.stop_time) break;
    glfwPollEvents();
    const double elapsed_ms = milliseconds_since(last);
    last = WallClock::now();
    smooth(session.picture_ms, elapsed_ms);
    play(session, elapsed_ms / 1000);
    auto drawn = draw_picture(session, renderer.value(), window);
    if (!drawn) return drawn;
  }
  return save_screenshot(options, renderer.value());
}

}  // namespace

Result<void> run_view(const ViewModel& model, const ViewOptions& options) {
  if (!model.advance || !model.reset || !model.fill || !(model.step_seconds > 0)) {
    return Error{ErrorCode::kOutOfRange, "view",
                 "advance, reset, fill and a positive step_seconds are needed"};
  }
  try {
    return run_window(model, options);
  } catch (const std::exception& exception) {
    return Error{ErrorCode::kUnsupported, "view", exception.what()};
  }
}

}  // namespace hooke::app
