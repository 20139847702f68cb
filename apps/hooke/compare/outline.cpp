#include "hooke/compare/outline.h"

#include <algorithm>
#include <charconv>

namespace hooke::app {

namespace {

using Line = std::pair<std::uint32_t, std::uint32_t>;

constexpr std::size_t kMostDrawn = 400;
constexpr std::size_t kMostFramePoints =
    60000;  // Points of all frames of all runs; ten bytes each on the page.
constexpr std::uint64_t kLeastFrames = 40;
constexpr std::uint64_t kMostFrames = 600;

/// Returns the number of the object in its list of the scene, from a path such as "ropes[2]".
std::size_t number_of(const SceneObject& object) {
  const std::size_t bracket = object.path.find('[');
  std::size_t number = 0;
  if (bracket != std::string::npos) {
    std::from_chars(object.path.data() + bracket + 1, object.path.data() + object.path.size(), number);
  }
  return number;
}

std::vector<Line> lines_of_cloth(const SceneCloth& cloth) {
  std::vector<Line> lines;
  if (!cloth.mesh.empty()) return lines;
  const auto columns = static_cast<std::uint32_t>(cloth.desc.columns);
  const auto rows = static_cast<std::uint32_t>(cloth.desc.rows);
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t i = row * columns + column;
      if (column + 1 < columns) lines.emplace_back(i, i + 1);
      if (row + 1 < rows) lines.emplace_back(i, i + columns);
    }
  }
  return lines;
}

std::vector<Line> lines_of(const Stage& stage) {
  const SceneObjects& objects = stage.scene().objects;
  const std::size_t number = number_of(stage.object);
  std::vector<Line> lines;
  switch (stage.object.kind) {
    case SceneObject::Kind::kRope:
      for (std::uint32_t i = 0; i + 1 < stage.points.size(); ++i) lines.emplace_back(i, i + 1);
      break;
    case SceneObject::Kind::kCloth:
      if (number < objects.cloths.size()) lines = lines_of_cloth(objects.cloths[number]);
      break;
    case SceneObject::Kind::kParticles:
      if (number >= objects.particles.size()) break;
      for (const SpringDesc& spring : objects.particles[number].desc.springs)
        lines.emplace_back(spring.a, spring.b);
      break;
    default:
      break;
  }
  const std::size_t count = stage.points.size();
  std::erase_if(lines, [&](const Line& line) { return line.first >= count || line.second >= count; });
  return lines;
}

}  // namespace

Outline make_outline(const Stage& stage) {
  Outline outline;
  const std::size_t count = stage.points.size();
  const std::size_t stride = (count + kMostDrawn - 1) / kMostDrawn;
  for (std::size_t i = 0; i < count; ++i) {
    if (i == stage.point) outline.watched = static_cast<std::uint32_t>(outline.points.size());
    if (i % stride == 0 || i == stage.point) outline.points.push_back(static_cast<std::uint32_t>(i));
  }
  outline.left_out = count - outline.points.size();
  if (outline.left_out == 0) outline.lines = lines_of(stage);
  return outline;
}

std::uint64_t most_frames(const Outline& outline, std::size_t runs) {
  const std::size_t places = std::max<std::size_t>(1, outline.points.size() * runs);
  return std::clamp<std::uint64_t>(kMostFramePoints / places, kLeastFrames, kMostFrames);
}

}  // namespace hooke::app
