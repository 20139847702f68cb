#pragma once

#include "hooke/result.h"

#include <cstddef>
#include <epoxy/gl.h>
#include <string>
#include <utility>

/// \file
/// Owns OpenGL objects. The owning context must be current in all of this.

namespace hooke::render {

/// A GlName owns one OpenGL object and deletes it on destruction.
class GlName {
 public:
  using Destroy = void (*)(GLuint name);

  GlName() = default;
  GlName(GLuint name, Destroy destroy) : name_(name), destroy_(destroy) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)), destroy_(other.destroy_) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    std::swap(destroy_, other.destroy_);
    return *this;
  }
  GlName(const GlName&) = delete;
  GlName& operator=(const GlName&) = delete;
  ~GlName() {
    if (name_ != 0) destroy_(name_);
  }

  [[nodiscard]] GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
  Destroy destroy_ = nullptr;
};

GlName make_buffer();
GlName make_vertex_array();
GlName make_texture();
GlName make_sampler();
GlName make_framebuffer();
GlName make_renderbuffer();

/// Links a program, or returns the driver's message if the shaders do not compile. `title` names it in the
/// error.
Result<GlName> make_program(const std::string& title, const std::string& vertex, const std::string& fragment);

/// Returns an offset into the bound buffer in the form that OpenGL wants, as a pointer.
const void* buffer_offset(std::size_t bytes);

/// Turns all pending OpenGL errors into one Error; without any it returns success.
Result<void> take_gl_error(const std::string& where);

}  // namespace hooke::render
