#include "render/gl/gl_objects.h"

#include <array>

namespace hooke::render {

namespace {

Result<GlName> compile_shader(const std::string& title, GLenum kind, const std::string& source) {
  GlName shader(glCreateShader(kind), [](GLuint name) { glDeleteShader(name); });
  const char* text = source.c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  return Error{ErrorCode::kUnsupported, "shader " + title, log.data()};
}

}  // namespace

GlName make_buffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return {name, [](GLuint old) { glDeleteBuffers(1, &old); }};
}

GlName make_vertex_array() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return {name, [](GLuint old) { glDeleteVertexArrays(1, &old); }};
}

GlName make_texture() {
  GLuint name = 0;
  glGenTextures(1, &name);
  return {name, [](GLuint old) { glDeleteTextures(1, &old); }};
}

GlName make_sampler() {
  GLuint name = 0;
  glGenSamplers(1, &name);
  return {name, [](GLuint old) { glDeleteSamplers(1, &old); }};
}

GlName make_framebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return {name, [](GLuint old) { glDeleteFramebuffers(1, &old); }};
}

GlName make_renderbuffer() {
  GLuint name = 0;
  glGenRenderbuffers(1, &name);
  return {name, [](GLuint old) { glDeleteRenderbuffers(1, &old); }};
}

Result<GlName> make_program(const std::string& title, const std::string& vertex,
                            const std::string& fragment) {
  const auto vertex_shader = compile_shader(title + " (vertex)", GL_VERTEX_SHADER, vertex);
  if (!vertex_shader) return vertex_shader.error();
  const auto fragment_shader = compile_shader(title + " (fragment)", GL_FRAGMENT_SHADER, fragment);
  if (!fragment_shader) return fragment_shader.error();
  GlName program(glCreateProgram(), [](GLuint name) { glDeleteProgram(name); });
  glAttachShader(program.name(), vertex_shader.value().name());
  glAttachShader(program.name(), fragment_shader.value().name());
  glLinkProgram(program.name());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  std::array<char, 1024> log{};
  glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  return Error{ErrorCode::kUnsupported, "shader " + title, log.data()};
}

const void* buffer_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

Result<void> take_gl_error(const std::string& where) {
  const GLenum first = glGetError();
  if (first == GL_NO_ERROR) return {};
  // A lost context reports errors without end.
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
  }
  return Error{ErrorCode::kUnsupported, where, "OpenGL error " + std::to_string(first)};
}

}  // namespace hooke::render
