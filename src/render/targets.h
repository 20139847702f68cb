#pragma once

#include "render/gl/gl_objects.h"
#include "render/image.h"

#include <array>

/// \file
/// Makes the pictures that are drawn into.

namespace hooke::render {

/// A PictureTarget is a picture in a texture. With several samples per pixel it is drawn into other storage
/// and averaged. Both hold sRGB, which the shaders encode.
struct PictureTarget {
  int width = 0;
  int height = 0;
  bool is_sampled = false;  ///< Whether there are several samples per pixel.
  GlName framebuffer;
  GlName texture;
  GlName depth;                ///< Depth of what is drawn into.
  GlName sampled_framebuffer;  ///< Set with several samples, as the next.
  GlName sampled_color;
};

/// Makes a target. The Error is kOutOfRange for sizes outside 1 to 8192, kUnsupported if the driver cannot
/// make it.
Result<PictureTarget> make_picture_target(int width, int height, int samples);

/// Returns the framebuffer that is drawn into.
const GlName& drawn_framebuffer(const PictureTarget& target);

/// Averages the samples into the texture, if there are several per pixel.
void resolve(const PictureTarget& target);

/// Returns the averaged picture, RGB, top row first.
Image read_pixels(const PictureTarget& target);

/// A ShadowTarget is a square depth texture that compares depths when it is read.
struct ShadowTarget {
  int size = 0;
  GlName framebuffer;
  GlName texture;
};

Result<ShadowTarget> make_shadow_target(int size);

/// Makes a target of several square maps, `size` texels each: `columns` beside one another, in `rows`.
Result<ShadowTarget> make_shadow_tiles(int size, int columns, int rows);

/// An OcclusionTarget has a part of the picture's width and height: depths, and two pictures of how much of
/// the sky is seen and how far away what is seen is, which are blurred to and fro.
struct OcclusionTarget {
  int width = 0;
  int height = 0;
  GlName depth_framebuffer;
  GlName depth;
  std::array<GlName, 2> framebuffers;
  std::array<GlName, 2> textures;
};

/// Makes the target of a picture of `width` by `height` pixels; it has one pixel for `part` x `part` of them.
Result<OcclusionTarget> make_occlusion_target(int width, int height, int part);

}  // namespace hooke::render
