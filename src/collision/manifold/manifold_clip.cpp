#include "collision/manifold/manifold_clip.h"

#include "base/assert.h"

namespace hooke::collision {

namespace {

/// Key of the point where `edge` of the polygon crosses `clip` of the clipper.
std::uint32_t crossing_key(std::uint32_t edge, std::uint32_t clip) {
  // Two edges of the clipper meet in its vertex.
  const std::uint32_t kind = (edge & Cut::kOfClipper) != 0 ? kVertexOfA : kCrossing;
  return kind | (edge & (Cut::kOfClipper - 1)) << 15 | clip;
}

}  // namespace

void clip_polygon(CutPolygon& polygon, Flat p, Flat q, std::uint32_t edge) {
  const Flat along = q - p;
  const int count = polygon.count;
  HOOKE_ASSERT(count >= 0 && count <= CutPolygon::kMaxCuts);
  std::array<Real, CutPolygon::kMaxCuts + 1> inside;
  bool all_inside = true;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    inside[k] = cross(along, polygon.cut[k].at - p);
    all_inside = all_inside && inside[k] >= Real(0);
  }
  if (all_inside) return;
  CutPolygon rest;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto next = static_cast<std::size_t>(i + 1 < count ? i + 1 : 0);
    const Cut& from = polygon.cut[k];
    const Cut& to = polygon.cut[next];
    const bool is_inside = inside[k] >= Real(0);
    if (is_inside) rest.add(from);
    if (is_inside == (inside[next] >= Real(0))) continue;
    const Real t = inside[k] / (inside[k] - inside[next]);
    rest.add({mix(from.at, to.at, t), from.height + t * (to.height - from.height),
              crossing_key(from.edge, edge), is_inside ? edge | Cut::kOfClipper : from.edge});
  }
  polygon.count = rest.count;
  for (int i = 0; i < rest.count; ++i)
    polygon.cut[static_cast<std::size_t>(i)] = rest.cut[static_cast<std::size_t>(i)];
}

}  // namespace hooke::collision
