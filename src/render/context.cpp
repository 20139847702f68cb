#include "render/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE  // NOLINT(readability-identifier-naming): GLFW's own name
#include <GLFW/glfw3.h>
#include <array>
#include <string_view>

namespace hooke::render {

/// This is either an EGL context or a window, never both.
struct ContextData {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext egl = EGL_NO_CONTEXT;
  GLFWwindow* window = nullptr;

  ContextData() = default;
  ContextData(const ContextData&) = delete;
  ContextData& operator=(const ContextData&) = delete;
  ~ContextData() {
    // The display itself stays open, because every context of the process shares it, and EGL does not count
    // its users.
    if (egl != EGL_NO_CONTEXT) {
      if (eglGetCurrentContext() == egl) {
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      }
      eglDestroyContext(display, egl);
    }
    if (window != nullptr) {
      glfwDestroyWindow(window);
      glfwTerminate();
    }
  }
};

namespace {

Error no_headless(const std::string& reason) {
  return {ErrorCode::kUnsupported, "headless OpenGL",
          reason + " (Debian: packages libegl1 libegl-mesa0 libgl1-mesa-dri)"};
}

bool has_word(const char* list, std::string_view word) {
  return list != nullptr && std::string_view(list).find(word) != std::string_view::npos;
}

Result<EGLContext> create_egl_context(EGLDisplay display) {
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (!has_word(extensions, "EGL_KHR_surfaceless_context") ||
      !has_word(extensions, "EGL_KHR_create_context")) {
    return no_headless("the EGL driver cannot draw without a surface");
  }
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return no_headless("the EGL driver has no desktop OpenGL");
  const std::array<EGLint, 5> wanted = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count < 1) {
    return no_headless("the EGL driver has no OpenGL configuration");
  }
  const std::array<EGLint, 7> attributes = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                                            3,
                                            EGL_CONTEXT_MINOR_VERSION_KHR,
                                            3,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                            EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return no_headless("the driver has no OpenGL 3.3 core profile");
  return context;
}

}  // namespace

Result<Context> Context::create_headless() {
  // The loader ends the program if a library or a function is missing, so each is tested before its first
  // use.
  if (!epoxy_has_egl()) return no_headless("there is no EGL library");
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_word(extensions, "EGL_MESA_platform_surfaceless") ||
      !has_word(extensions, "EGL_EXT_platform_base")) {
    return no_headless("EGL has no surfaceless platform");
  }
  auto data = std::make_shared<ContextData>();
  data->display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (data->display == EGL_NO_DISPLAY || eglInitialize(data->display, nullptr, nullptr) != EGL_TRUE) {
    return no_headless("EGL has no software driver");
  }
  const auto context = create_egl_context(data->display);
  if (!context) return context.error();
  data->egl = context.value();
  Context result(std::move(data));
  const auto current = result.make_current();
  if (!current) return current.error();
  return result;
}

Result<Context> Context::create_window(const std::string& title, int width, int height) {
  const std::string where = "window";
  if (width <= 0 || height <= 0) return Error{ErrorCode::kOutOfRange, where, "the size must be positive"};
  constexpr const char* kNoDisplay =
      "there is no display that answers to open it on: set DISPLAY, or use what needs none, such as hooke "
      "render";
  if (glfwInit() != GLFW_TRUE) return Error{ErrorCode::kUnsupported, where, kNoDisplay};
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  auto data = std::make_shared<ContextData>();
  data->window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (data->window == nullptr) {
    glfwTerminate();
    return Error{ErrorCode::kUnsupported, where, "the display has no OpenGL 3.3 core profile"};
  }
  Context result(std::move(data));
  const auto current = result.make_current();
  if (!current) return current.error();
  glfwSwapInterval(1);
  return result;
}

Result<void> Context::make_current() const {
  if (data_->window != nullptr) {
    glfwMakeContextCurrent(data_->window);
    if (glfwGetCurrentContext() == data_->window) return {};
  } else if (eglMakeCurrent(data_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, data_->egl) == EGL_TRUE) {
    return {};
  }
  return Error{ErrorCode::kUnsupported, "OpenGL", "the driver refuses to make the context current"};
}

GLFWwindow* Context::window() const {
  return data_->window;
}

std::uint32_t Context::take_error() const {
  return make_current() ? glGetError() : GL_NO_ERROR;
}

std::string Context::driver() const {
  if (!make_current()) return {};
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name != nullptr ? name : "";
}

}  // namespace hooke::render
