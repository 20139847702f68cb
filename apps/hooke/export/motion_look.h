#pragma once

#include "hooke/drawing/figure.h"
#include "hooke/motion_io.h"

#include "render/image.h"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace hooke::app {

/// MotionLooks gives the materials of a recording: equal ones once, with the files of their images.
class MotionLooks {
 public:
  /// Returns the image of the bytes, or at the path if there are none, as the renderer sees it, or null with
  /// a warning. An image of heights becomes one of normals. Equal paths, bytes and uses are one image.
  std::shared_ptr<const render::Image> load(const std::string& path, const ImageBytes& bytes, ImageUse use);

  /// Returns the number in `motion` of a material that looks like the finish. `name` is that of the scene;
  /// empty for none.
  std::uint32_t find(MotionRecording& motion, const Finish& finish, const std::string& name, bool two_sided);

  /// Returns the images that could not be read, one line each.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  using Key = std::tuple<std::string, std::array<float, 9>, std::array<const render::Image*, 3>, bool>;

  [[nodiscard]] std::shared_ptr<const MotionImage> file_of(const render::Image* image) const;

  std::map<std::tuple<std::string, ImageBytes, ImageUse>, std::shared_ptr<const render::Image>> images_;
  std::map<const render::Image*, std::shared_ptr<const MotionImage>> files_;
  std::map<Key, std::uint32_t> numbers_;
  std::vector<std::string> warnings_;
};

}  // namespace hooke::app
