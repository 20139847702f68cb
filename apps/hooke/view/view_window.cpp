#include "hooke/view/view_window.h"

#include "hooke/drawing/scene_drawing.h"
#include "hooke/view/eye.h"
#include "hooke/view/view_input.h"
#include "hooke/view/view_log.h"
#include "hooke/view/view_panel.h"

#define GLFW_INCLUDE_NONE  // NOLINT(readability-identifier-naming): GLFW's own name
#include "render/orbit_camera.h"
#include "render/renderer.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <chrono>
#include <cstdio>
#include <exception>
#include <imgui.h>
#include <optional>
#include <utility>
#include <vector>

namespace hooke::app {

namespace {

using WallClock = std::chrono::steady_clock;
using Key = ViewInput::Key;

double milliseconds_since(WallClock::time_point start) {
  return std::chrono::duration<double, std::milli>(WallClock::now() - start).count();
}

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

/// The state of one window between two pictures.
struct Window {
  explicit Window(Session& its_session, const ViewOptions& options)
      : session(its_session), drawing(options.style), input(its_session, camera) {}

  Session& session;
  std::shared_ptr<const SessionView> view;
  SceneDrawing drawing;
  render::OrbitCamera camera;
  bool has_camera = false;
  ViewInput input;
  ViewPanel panel;
  ViewLog log;
  PictureFacts facts;
  render::DrawList list;
  double picture_ms = 0;
  std::size_t warned = 0;  ///< Number of warnings that were printed.
  std::vector<Key> keys;   ///< Keys pressed since the last picture.
};

std::optional<Key> key_of(int key, int modifiers) {
  switch (key) {
    case GLFW_KEY_SPACE:
      return Key::kPlay;
    case GLFW_KEY_S:
    case GLFW_KEY_RIGHT:
      return Key::kStep;
    case GLFW_KEY_LEFT:
      return Key::kStepBack;
    case GLFW_KEY_R:
      return Key::kRestart;
    case GLFW_KEY_B:
      return Key::kShoot;
    case GLFW_KEY_D:
      return Key::kDrop;
    case GLFW_KEY_P:
      return Key::kPin;
    case GLFW_KEY_H:
      return Key::kTie;
    case GLFW_KEY_DELETE:
      return Key::kRemove;
    case GLFW_KEY_U:
      return Key::kUndo;
    case GLFW_KEY_Z:
      return (modifiers & GLFW_MOD_CONTROL) != 0 ? std::optional(Key::kUndo) : std::nullopt;
    case GLFW_KEY_F1:
      return Key::kHelp;
    case GLFW_KEY_ESCAPE:
      return Key::kClose;
    default:
      return {};
  }
}

/// Stores every key press for the next picture. The interface's own key states lose a key that is pressed and
/// released between two pictures, which at three pictures a second is most of them.
void keep_key(GLFWwindow* window, int code, int /*scancode*/, int action, int modifiers) {
  const std::optional<Key> key = key_of(code, modifiers);
  const bool repeats = key == Key::kStep || key == Key::kStepBack;
  if (!key || !(action == GLFW_PRESS || (action == GLFW_REPEAT && repeats))) return;
  static_cast<Window*>(glfwGetWindowUserPointer(window))->keys.push_back(*key);
}

/// The same for signs, which lie on other keys on other keyboards.
void keep_sign(GLFWwindow* window, unsigned int sign) {
  std::vector<Key>& keys = static_cast<Window*>(glfwGetWindowUserPointer(window))->keys;
  if (sign == '?') keys.push_back(Key::kHelp);
  if (sign == '-') keys.push_back(Key::kSlower);
  if (sign == '+' || sign == '=') keys.push_back(Key::kFaster);
}

void begin_interface() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  // Two pictures within the clock's resolution would break an invariant of the library.
  ImGui::GetIO().DeltaTime = std::max(ImGui::GetIO().DeltaTime, 1e-5F);
  ImGui::NewFrame();
}

void take_view(Window& window) {
  const auto before = std::exchange(window.view, window.session.view());
  if (before == window.view) return;
  const SessionView& view = *window.view;
  window.panel.note(view);
  if (view.picture && !(before && before->picture == view.picture))
    window.drawing.record(*view.picture, view.step_seconds);
  for (; window.warned < view.warnings.size(); ++window.warned)
    std::fprintf(stderr, "warning: %s\n", view.warnings[window.warned].c_str());
}

/// Position of the picture between the last two states, 1 being the last.
double blend_of(const SessionView& view) {
  if (!view.playing || !(view.step_seconds > 0)) return 1;
  return std::min(1.0, milliseconds_since(view.made) / 1000 * view.speed / view.step_seconds);
}

void fill_list(Window& window, int height_px) {
  const SessionView& view = *window.view;
  window.list = {};
  if (!view.picture) return;
  const double behind = (1 - blend_of(view)) * view.step_seconds;
  window.drawing.fill(view.time - behind, height_px, window.list);
  if (!window.has_camera) window.camera = render::make_orbit_camera(window.list.camera);
  window.has_camera = true;
  window.list.camera = render::camera_of(window.camera);
  for (const std::string& line : window.drawing.take_warnings())
    std::fprintf(stderr, "warning: %s\n", line.c_str());
}

void handle_input(Window& window, GLFWwindow* handle) {
  const ImGuiIO& io = ImGui::GetIO();
  const Eye eye = eye_of(window.camera, window.drawing.origin(), static_cast<double>(io.DisplaySize.x),
                         static_cast<double>(io.DisplaySize.y));
  window.input.look(eye, *window.view,
                    {static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y)});
  constexpr ViewInput::Button kButtons[] = {ViewInput::Button::kLeft, ViewInput::Button::kRight,
                                            ViewInput::Button::kMiddle};
  for (int i = 0; i < 3; ++i) {
    if (ImGui::IsMouseClicked(i) && !io.WantCaptureMouse) window.input.press(kButtons[i]);
    if (ImGui::IsMouseReleased(i)) window.input.release(kButtons[i]);
  }
  if (!io.WantCaptureMouse) window.input.wheel(io.MouseWheel);
  for (const Key key : std::exchange(window.keys, {})) {
    if (!io.WantTextInput) window.input.key(key);
  }
  if (window.input.wants_to_close()) glfwSetWindowShouldClose(handle, GLFW_TRUE);
}

void write_log(Window& window, const render::Context& context) {
  const ImGuiIO& io = ImGui::GetIO();
  const Eye eye = eye_of(window.camera, window.drawing.origin(), static_cast<double>(io.DisplaySize.x),
                         static_cast<double>(io.DisplaySize.y));
  ++window.facts.picture;
  window.facts.posted = window.input.posted();
  window.facts.timeline = window.panel.timeline_box();
  window.facts.help = window.input.shows_help();
  window.facts.gl_error = context.take_error();
  window.log.write(*window.view, eye, window.facts);
}

Result<void> draw_picture(Window& window, render::Renderer& renderer, const render::Context& context) {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(context.window(), &width, &height);
  begin_interface();
  take_view(window);
  handle_input(window, context.window());
  window.panel.build(*window.view, window.input, window.picture_ms);
  ImGui::Render();
  // A minimized window has no pixels.
  if (width <= 0 || height <= 0) return {};
  fill_list(window, height);
  auto sized = renderer.resize(width, height);
  if (!sized) return sized;
  auto drawn = renderer.draw(window.list);
  if (!drawn) return drawn;
  auto shown = renderer.present(width, height);
  if (!shown) return shown;
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(context.window());
  write_log(window, context);
  return {};
}

Result<void> save_screenshot(const ViewOptions& options, const render::Renderer& renderer) {
  if (options.screenshot.empty()) return {};
  const auto image = renderer.read_image();
  if (!image) return image.error();
  return render::write_png(image.value(), options.screenshot);
}

bool is_over(const Window& window, const ViewOptions& options) {
  if (!window.view) return false;
  if (window.view->stage == SessionView::Stage::kFailed) return true;
  return window.view->picture && options.stop_time && window.view->time >= *options.stop_time;
}

Result<void> run_window(Session& session, const ViewOptions& options) {
  Window window(session, options);
  if (auto opened = window.log.open(options.log); !opened) return opened;
  const auto context = render::Context::create_window(options.title, options.width, options.height);
  if (!context) return context.error();
  const bool fast = context.value().driver().find("llvmpipe") != std::string::npos;
  const int samples = options.samples > 0 ? options.samples : fast ? 1 : 4;
  auto renderer = render::Renderer::create(context.value(), {.width = options.width,
                                                             .height = options.height,
                                                             .samples = samples,
                                                             .shadow_map_size = fast ? 1024 : 2048,
                                                             .fast = fast,
                                                             .occlusion = true});
  if (!renderer) return renderer.error();
  GLFWwindow* handle = context.value().window();
  // This comes before the interface starts, which passes events on to the callbacks that it finds.
  glfwSetWindowUserPointer(handle, &window);
  glfwSetKeyCallback(handle, keep_key);
  glfwSetCharCallback(handle, keep_sign);
  const UserInterface interface(handle);
  if (!interface.ready())
    return Error{ErrorCode::kUnsupported, "window", "the user interface does not start"};

  auto last = WallClock::now();
  while (glfwWindowShouldClose(handle) == GLFW_FALSE && !is_over(window, options)) {
    glfwPollEvents();
    const double elapsed_ms = milliseconds_since(last);
    last = WallClock::now();
    window.picture_ms = window.picture_ms > 0 ? 0.92 * window.picture_ms + 0.08 * elapsed_ms : elapsed_ms;
    auto drawn = draw_picture(window, renderer.value(), context.value());
    if (!drawn) return drawn;
  }
  return save_screenshot(options, renderer.value());
}

}  // namespace

Result<void> run_view(Session& session, const ViewOptions& options) {
  try {
    return run_window(session, options);
  } catch (const std::exception& exception) {
    return Error{ErrorCode::kUnsupported, "view", exception.what()};
  }
}

}  // namespace hooke::app
