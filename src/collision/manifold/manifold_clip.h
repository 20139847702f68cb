#pragma once

#include "hooke/math.h"

#include "collision/manifold/manifold_points.h"

#include <array>
#include <cstdint>

/// \file
/// Clipping of convex polygons in the plane across a normal: Sutherland and Hodgman (1974), Reentrant polygon
/// clipping, with keys that name the vertices and edges that meet.

namespace hooke::collision {

/// A position in a plane. It is not initialized, because arrays of it are scratch.
struct Flat {
  Real u, v;
};

constexpr Flat operator-(Flat a, Flat b) {
  return {a.u - b.u, a.v - b.v};
}
constexpr Real dot(Flat a, Flat b) {
  return a.u * b.u + a.v * b.v;
}
constexpr Real cross(Flat a, Flat b) {
  return a.u * b.v - a.v * b.u;
}
constexpr Flat mix(Flat a, Flat b, Real t) {
  return {a.u + t * (b.u - a.u), a.v + t * (b.v - a.v)};
}

/// A corner of the polygon that is being clipped.
struct Cut {
  Flat at;
  Real height;  ///< Height over the plane, interpolated.
  std::uint32_t key;
  std::uint32_t edge;  ///< Edge that leaves the corner: an edge of the subject, or with kOfClipper one of the
                       ///< clipper.

  static constexpr std::uint32_t kOfClipper = 1u << 15;
};

struct CutPolygon {
  static constexpr int kMaxCuts = 32;

  int count = 0;
  std::array<Cut, kMaxCuts> cut;

  void add(const Cut& c) {
    if (count < kMaxCuts) cut[static_cast<std::size_t>(count++)] = c;
  }
};

/// Keeps what lies left of the line from p to q, which is `edge` of the clipper.
void clip_polygon(CutPolygon& polygon, Flat p, Flat q, std::uint32_t edge);

}  // namespace hooke::collision
