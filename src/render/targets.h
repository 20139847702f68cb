#pragma once

#include "render/gl/gl_objects.h"
#include "render/image.h"

/// \file
/// Makes the pictures that are drawn into.

namespace hooke::render {

/// A PictureTarget is a picture with several samples per pixel, and its average in a texture. Both store
/// sRGB.
struct PictureTarget {
  int width = 0;
  int height = 0;
  GlName sampled_framebuffer;
  GlName sampled_color;
  GlName sampled_depth;
  GlName framebuffer;
  GlName texture;
};

/// Makes a target. The Error is kOutOfRange for sizes outside 1 to 8192, kUnsupported if the driver cannot
/// make it.
Result<PictureTarget> make_picture_target(int width, int height, int samples);

/// Averages the samples into the texture.
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

}  // namespace hooke::render
