#include "io/model/model_write.h"

#include <array>
#include <cstdint>

namespace hooke::io {

namespace {

constexpr std::size_t kTitleSize = 80;

DVec3 wide(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

Bytes write_stl(const Model& model) {
  Bytes bytes;
  bytes.reserve(kTitleSize + 4 + model.indices.size() / 3 * 50);
  // The header must not begin with "solid", which begins the text form.
  put_text(bytes, "binary, meters, z up");
  bytes.resize(kTitleSize);
  put(bytes, static_cast<std::uint32_t>(model.indices.size() / 3));
  for (std::size_t i = 0; i < model.indices.size(); i += 3) {
    std::array<std::array<float, 3>, 3> corners = {};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = stand_on_z(model.vertices[model.indices[i + k]].position);
    }
    const DVec3 a = wide(corners[0]);
    const auto normal = vector_cast<float>(normalize(cross(wide(corners[1]) - a, wide(corners[2]) - a)));
    put(bytes, normal);
    put(bytes, corners);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace hooke::io
