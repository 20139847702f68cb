#include "hooke/view/view_window.h"

#include "hooke/drawing/insight_drawing.h"
#include "hooke/drawing/scene_drawing.h"
#include "hooke/view/eye.h"
#include "hooke/view/picture_pace.h"
#include "hooke/view/unsaved_edits.h"
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
#include <cmath>
#include <cstdio>
#include <deque>
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

constexpr double kWaitSeconds = 0.02;  ///< Between two looks at a session in which nothing changes.

constexpr float kPanelMargin = 12;  ///< Beside panels [screen units].
constexpr float kPanelRim =
    2.7F;  ///< Around the contents of a panel, with its scroll bar, in heights of the font.
constexpr float kLeastInterfaceScale = 0.5F;
constexpr float kLetterHeight = 13;  ///< Of the library's own letters [screen units].

ImGuiStyle interface_style() {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 6;
  style.FrameRounding = 4;
  return style;
}

/// Starts the library of the user interface and ends it on destruction.
class UserInterface {
 public:
  explicit UserInterface(GLFWwindow* window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    // The library must leave no file behind.
    ImGui::GetIO().IniFilename = nullptr;
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

/// A key that was pressed, as the system names it.
struct KeyPress {
  int code = 0;
  int modifiers = 0;
};

/// The state of one window between two pictures.
struct Window {
  explicit Window(Session& its_session, const ViewOptions& options)
      : session(its_session),
        style(options.style),
        drawing(options.style),
        interface_scale(options.interface_scale),
        pace(options.picture_scale),
        input(its_session, camera) {}

  Session& session;
  std::shared_ptr<const SessionView> view;
  DrawingStyle style;
  SceneDrawing drawing;
  std::optional<double> interface_scale;  ///< Size of the panels; what fits the window by default.
  PicturePace pace;
  render::OrbitCamera camera;
  bool has_camera = false;
  ViewInput input;
  ViewPanel panel;
  ViewLog log;
  PictureFacts facts;
  render::DrawList list;
  PictureCost cost;
  float drawn_scale = 0;           ///< Size of the panels for which letters were drawn.
  std::size_t warned = 0;          ///< Number of warnings that were printed.
  std::vector<Key> keys;           ///< Keys pressed since the last picture.
  std::deque<KeyPress> presses;    ///< The same for the interface, in the order of time.
  std::vector<int> shown_presses;  ///< Keys that the interface has seen as down in the last picture.
};

Window& window_of(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

std::optional<Key> control_key(int key) {
  switch (key) {
    case GLFW_KEY_Z:
      return Key::kUndo;
    case GLFW_KEY_Y:
      return Key::kRedo;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
      return Key::kLarger;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      return Key::kSmaller;
    default:
      return {};
  }
}

std::optional<Key> key_of(int key, int modifiers) {
  if ((modifiers & GLFW_MOD_CONTROL) != 0) return control_key(key);
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
    case GLFW_KEY_C:
      return Key::kCut;
    case GLFW_KEY_G:
      return Key::kRigid;
    case GLFW_KEY_J:
      return Key::kJelly;
    case GLFW_KEY_K:
      return Key::kCloth;
    case GLFW_KEY_DELETE:
      return Key::kRemove;
    case GLFW_KEY_U:
      return Key::kUndo;
    case GLFW_KEY_I:
      return Key::kInspector;
    case GLFW_KEY_1:
    case GLFW_KEY_2:
    case GLFW_KEY_3:
    case GLFW_KEY_4:
    case GLFW_KEY_5:
    case GLFW_KEY_6:
    case GLFW_KEY_7:
    case GLFW_KEY_8:
      return static_cast<Key>(static_cast<int>(Key::kContacts) + key - GLFW_KEY_1);
    case GLFW_KEY_F5:
      return Key::kReload;
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
  Window& its = window_of(window);
  its.pace.wake(WallClock::now());
  if (action == GLFW_PRESS && code >= 0) its.presses.push_back({code, modifiers});
  const std::optional<Key> key = key_of(code, modifiers);
  const bool repeats = key == Key::kStep || key == Key::kStepBack;
  if (!key || !(action == GLFW_PRESS || (action == GLFW_REPEAT && repeats))) return;
  its.keys.push_back(*key);
}

/// The same for signs, which lie on other keys on other keyboards.
void keep_sign(GLFWwindow* window, unsigned int sign) {
  Window& its = window_of(window);
  its.pace.wake(WallClock::now());
  std::vector<Key>& keys = its.keys;
  if (sign == '?') keys.push_back(Key::kHelp);
  if (sign == '-') keys.push_back(Key::kSlower);
  if (sign == '+' || sign == '=') keys.push_back(Key::kFaster);
}

/// Has the window drawn anew after everything that one does to it.
void wake_by_events(GLFWwindow* window) {
  glfwSetCursorPosCallback(
      window, [](GLFWwindow* its, double, double) { window_of(its).pace.wake(WallClock::now()); });
  glfwSetMouseButtonCallback(
      window, [](GLFWwindow* its, int, int, int) { window_of(its).pace.wake(WallClock::now()); });
  glfwSetScrollCallback(window,
                        [](GLFWwindow* its, double, double) { window_of(its).pace.wake(WallClock::now()); });
  glfwSetWindowFocusCallback(window,
                             [](GLFWwindow* its, int) { window_of(its).pace.wake(WallClock::now()); });
  glfwSetWindowCloseCallback(window, [](GLFWwindow* its) { window_of(its).pace.wake(WallClock::now()); });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* its) { window_of(its).pace.wake(WallClock::now()); });
  glfwSetFramebufferSizeCallback(
      window, [](GLFWwindow* its, int, int) { window_of(its).pace.wake(WallClock::now()); });
}

/// Size of the panels: what was asked for, else what keeps them readable on a large or dense display; at most
/// what leaves room for both beside one another.
float interface_scale(const Window& window, int width_px, int height_px) {
  constexpr float kUsualHeight = 1080;
  const float fitting = std::round(4 * static_cast<float>(height_px) / kUsualHeight) / 4;
  const float wanted = static_cast<float>(window.interface_scale.value_or(std::clamp(fitting, 1.0F, 4.0F))) *
                       window.input.zoom();
  const float room = 0.5F * static_cast<float>(width_px) - 2 * kPanelMargin;
  return std::min(wanted, std::max(room / ((kPanelWidth + kPanelRim) * kLetterHeight), kLeastInterfaceScale));
}

/// Draws the letters anew if their size has changed: letters that are only stretched are blurred.
void scale_interface(Window& window, int width_px, int height_px) {
  const float scale = interface_scale(window, width_px, height_px);
  if (scale == window.drawn_scale) return;
  window.drawn_scale = scale;
  ImGui::GetStyle() = interface_style();
  ImGui::GetStyle().ScaleAllSizes(scale);
  ImFontConfig letters;
  letters.SizePixels = std::max(1.0F, std::round(kLetterHeight * scale));
  ImGui::GetIO().Fonts->Clear();
  ImGui::GetIO().Fonts->AddFontDefault(&letters);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

/// Shows the interface keys that were pressed since the last picture, also those that were released again,
/// such as Enter in a field. A key that is pressed twice is up for a picture in between.
void show_presses(Window& window, GLFWwindow* handle) {
  ImGuiIO& io = ImGui::GetIO();
  const std::vector<int> before = std::exchange(window.shown_presses, {});
  const auto is_down = [&](int code) { return glfwGetKey(handle, code) == GLFW_PRESS; };
  for (const int code : before) io.KeysDown[code] = is_down(code);
  io.KeyCtrl = is_down(GLFW_KEY_LEFT_CONTROL) || is_down(GLFW_KEY_RIGHT_CONTROL);
  io.KeyShift = is_down(GLFW_KEY_LEFT_SHIFT) || is_down(GLFW_KEY_RIGHT_SHIFT);
  const auto is_in = [](const std::vector<int>& codes, int code) {
    return std::find(codes.begin(), codes.end(), code) != codes.end();
  };
  while (!window.presses.empty()) {
    const KeyPress press = window.presses.front();
    if (is_in(before, press.code) || is_in(window.shown_presses, press.code)) break;
    window.presses.pop_front();
    window.shown_presses.push_back(press.code);
    io.KeysDown[press.code] = true;
    io.KeyCtrl = (press.modifiers & GLFW_MOD_CONTROL) != 0;
    io.KeyShift = (press.modifiers & GLFW_MOD_SHIFT) != 0;
  }
}

void begin_interface(Window& window, GLFWwindow* handle, int width_px, int height_px) {
  scale_interface(window, width_px, height_px);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  show_presses(window, handle);
  // Two pictures within the clock's resolution would break an invariant of the library.
  ImGui::GetIO().DeltaTime = std::max(ImGui::GetIO().DeltaTime, 1e-5F);
  ImGui::NewFrame();
}

void take_view(Window& window) {
  const auto before = std::exchange(window.view, window.session.view());
  if (before == window.view) return;
  const SessionView& view = *window.view;
  if (!before || before->built != view.built) {
    window.drawing = SceneDrawing(window.style);
    window.warned = 0;
  }
  if (!before || before->opened != view.opened) window.has_camera = false;
  if (view.picture && !(before && before->picture == view.picture))
    window.drawing.record(*view.picture, view.step_seconds);
  for (; window.warned < view.texture_warnings.size(); ++window.warned)
    std::fprintf(stderr, "warning: %s\n", view.texture_warnings[window.warned].c_str());
}

/// Position of the picture between the last two states, 1 being the last.
double blend_of(const SessionView& view) {
  if (!view.playing || !(view.step_seconds > 0)) return 1;
  return std::min(1.0, milliseconds_since(view.made) / 1000 * view.speed / view.step_seconds);
}

Eye present_eye(const Window& window) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  return eye_of(window.camera, window.drawing.origin(), static_cast<double>(size.x),
                static_cast<double>(size.y));
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
  const auto half_height = static_cast<float>(present_eye(window).half_height);
  if (view.insight) {
    add_insight(*view.insight, window.drawing.origin(), 2 * half_height / static_cast<float>(height_px),
                window.list);
  }
  for (const std::string& line : window.drawing.take_warnings())
    std::fprintf(stderr, "warning: %s\n", line.c_str());
}

void handle_input(Window& window, GLFWwindow* handle) {
  const ImGuiIO& io = ImGui::GetIO();
  window.input.look(present_eye(window), *window.view,
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
  if (glfwWindowShouldClose(handle) == GLFW_TRUE) window.input.key(Key::kQuit);
  glfwSetWindowShouldClose(handle, GLFW_FALSE);
}

/// Marks the selected object, so that one finds in the picture what the list names.
void mark_selected(const Window& window) {
  const SessionView& view = *window.view;
  const auto found = std::find_if(view.places.begin(), view.places.end(),
                                  [&](const auto& place) { return place.first == view.selected; });
  if (found == view.places.end() || !window.has_camera) return;
  const auto pixel = pixel_of(present_eye(window), found->second);
  if (!pixel) return;
  const ImVec2 center = {static_cast<float>((*pixel)[0]), static_cast<float>((*pixel)[1])};
  constexpr ImU32 kColor = IM_COL32(255, 210, 90, 255);
  const float radius = 0.8F * ImGui::GetFontSize();
  ImDrawList* canvas = ImGui::GetBackgroundDrawList();
  canvas->AddCircle(center, radius, kColor, 24, 2);
  canvas->AddText({center.x + 1.3F * radius, center.y - 1.6F * radius}, kColor, view.selected.c_str());
}

/// Draws the line of a cut while the mouse draws it.
void draw_cut(const Window& window) {
  const auto line = window.input.cut_line();
  if (!line) return;
  const auto at = [](std::array<double, 2> pixel) {
    return ImVec2{static_cast<float>(pixel[0]), static_cast<float>(pixel[1])};
  };
  ImGui::GetBackgroundDrawList()->AddLine(at((*line)[0]), at((*line)[1]), IM_COL32(255, 80, 60, 255), 2);
}

/// Writes the numbers of a debug picture beside what they are of.
void write_insight(const Window& window) {
  if (!window.view->insight || !window.has_camera) return;
  ImDrawList* canvas = ImGui::GetBackgroundDrawList();
  const auto write = [&](ImVec2 at, const std::string& text, ImVec4 color) {
    canvas->AddText({at.x + 1, at.y + 1}, IM_COL32(0, 0, 0, 200), text.c_str());
    canvas->AddText(at, ImGui::ColorConvertFloat4ToU32(color), text.c_str());
  };
  const float line = ImGui::GetFontSize();
  std::size_t left_out = 0;
  for (const SeenNumber& number :
       numbers_with_room(*window.view->insight, present_eye(window), line, left_out)) {
    const DebugColor& color = number.text->color;
    write({static_cast<float>(number.pixel[0]) + 5, static_cast<float>(number.pixel[1]) - 5},
          number.text->text, {color.r, color.g, color.b, 1});
  }
  if (left_out == 0) return;
  const float above_timeline = ImGui::GetIO().DisplaySize.y - 7.5F * line;
  write({kPanelMargin, above_timeline}, std::to_string(left_out) + " numbers have no room beside others",
        {1, 1, 1, 1});
}

void write_log(Window& window, const render::Context& context) {
  ++window.facts.picture;
  window.facts.posted = window.input.posted();
  window.facts.scale = window.cost.scale;
  window.facts.boxes = window.panel.boxes();
  window.facts.plot = window.panel.plotted();
  window.facts.font_px = ImGui::GetFontSize();
  window.facts.hint = window.input.hint();
  window.facts.help = window.input.shows_help();
  window.facts.gl_error = context.take_error();
  window.log.write(*window.view, present_eye(window), window.facts);
}

int scaled(int pixels, double scale) {
  return std::max(1, static_cast<int>(std::lround(pixels * scale)));
}

/// Draws what the window shows but for its panels into a picture of that size.
Result<void> draw_scene(Window& window, render::Renderer& renderer, int width, int height) {
  fill_list(window, height);
  auto sized = renderer.resize(width, height);
  return sized ? renderer.draw(window.list) : sized;
}

Result<void> draw_picture(Window& window, render::Renderer& renderer, const render::Context& context) {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(context.window(), &width, &height);
  begin_interface(window, context.window(), width, height);
  take_view(window);
  handle_input(window, context.window());
  mark_selected(window);
  write_insight(window);
  draw_cut(window);
  window.panel.build(*window.view, window.input, window.cost);
  ImGui::Render();
  if (width <= 0 || height <= 0) {  // A window without pixels.
    glfwWaitEventsTimeout(kWaitSeconds);
    return {};
  }
  auto drawn =
      draw_scene(window, renderer, scaled(width, window.cost.scale), scaled(height, window.cost.scale));
  if (!drawn) return drawn;
  auto shown = renderer.present(width, height);
  if (!shown) return shown;
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(context.window());
  write_log(window, context);
  return {};
}

/// Draws a picture if it would differ from the last one, and otherwise waits a little for an event.
Result<void> draw_when_due(Window& window, render::Renderer& renderer, const render::Context& context) {
  const WallClock::time_point now = WallClock::now();
  const std::shared_ptr<const SessionView> view = window.session.view();
  const bool is_hidden = glfwGetWindowAttrib(context.window(), GLFW_ICONIFIED) == GLFW_TRUE &&
                         glfwWindowShouldClose(context.window()) == GLFW_FALSE;
  if (view != window.view || view->playing) window.pace.wake(now);
  if (is_hidden || !window.pace.is_due(now)) {
    take_view(window);
    glfwWaitEventsTimeout(kWaitSeconds);
    return {};
  }
  int width = 0;
  glfwGetFramebufferSize(context.window(), &width, nullptr);
  window.cost.scale = window.pace.scale(now, width);
  auto drawn = draw_picture(window, renderer, context);
  const double picture_ms = milliseconds_since(now);
  double& mean_ms = window.cost.milliseconds;
  mean_ms = mean_ms > 0 ? 0.92 * mean_ms + 0.08 * picture_ms : picture_ms;
  window.pace.drew(now, picture_ms);
  return drawn;
}

/// Writes the last picture, with all pixels of the window.
Result<void> save_screenshot(const ViewOptions& options, Window& window, render::Renderer& renderer,
                             const render::Context& context) {
  if (options.screenshot.empty()) return {};
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(context.window(), &width, &height);
  if (width > renderer.width() || height > renderer.height()) {
    auto drawn = draw_scene(window, renderer, width, height);
    if (!drawn) return drawn;
  }
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
  const auto context = render::Context::create_window(options.title, options.width, options.height);
  if (!context) return context.error();
  // It goes before the context, which holds the pictures of its panels.
  Window window(session, options);
  if (auto opened = window.log.open(options.log); !opened) return opened;
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
  wake_by_events(handle);
  const UserInterface interface(handle);
  if (!interface.ready())
    return Error{ErrorCode::kUnsupported, "window", "the user interface does not start"};

  while (!window.input.wants_to_close() && !is_over(window, options)) {
    glfwPollEvents();
    auto drawn = draw_when_due(window, renderer.value(), context.value());
    if (!drawn) return drawn;
  }
  return save_screenshot(options, window, renderer.value(), context.value());
}

}  // namespace

Result<void> run_view(Session& session, const ViewOptions& options) {
  UnsavedEdits edits(session);
  try {
    auto closed = run_window(session, options);
    if (closed) edits.forget();
    return closed;
  } catch (const std::exception& exception) {
    return Error{ErrorCode::kUnsupported, "view", exception.what()};
  }
}

}  // namespace hooke::app
