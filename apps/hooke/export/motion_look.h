#pragma once

#include "hooke/drawing/figure.h"
#include "hooke/motion_io.h"

#include "render/image.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace hooke::app {

/// MotionLooks gives the materials of a recording: equal ones once, with the files of their images.
class MotionLooks {
 public:
  /// Returns the image of the bytes, or at the path if there are none, as the renderer sees it, or null with
  /// a warning. Equal paths and bytes are one image.
  std::shared_ptr<const render::Image> load(const std::string& path, const ImageBytes& bytes);

  /// Returns the number in `motion` of a material that looks like the finish. `name` is that of the scene;
  /// empty for none.
  std::uint32_t find(MotionRecording& motion, const Finish& finish, const std::string& name, bool two_sided);

  /// Returns the images that could not be read, one line each.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  using Key = std::tuple<std::string, float, float, float, float, float, const render::Image*, bool>;

  std::map<std::pair<std::string, ImageBytes>, std::shared_ptr<const render::Image>> images_;
  std::map<const render::Image*, std::shared_ptr<const MotionImage>> files_;
  std::map<Key, std::uint32_t> numbers_;
  std::vector<std::string> warnings_;
};

}  // namespace hooke::app
