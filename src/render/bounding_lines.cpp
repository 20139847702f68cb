#include "render/bounding_lines.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace hooke::render {

namespace {

using geometry::BoundingSphere;
using geometry::DBox;
using geometry::MeshView;
using geometry::OrientedBox;
using geometry::VolumeTree;

constexpr Color kColor = {0.85F, 0.15F, 0.1F};
constexpr float kWidthPx = 1.6F;
constexpr int kCircleParts = 48;
constexpr int kTreeLevel = 3;

class Pen {
 public:
  Pen(const Mat4& body, std::vector<DrawLine>& lines) : body_(body), lines_(lines) {}

  void draw(const OrientedBox& box) const {
    const auto corner = [&](unsigned i) {
      const DVec3 h = box.half_extents;
      return box.center + box.axes * DVec3{(i & 1u) != 0 ? h.x : -h.x, (i & 2u) != 0 ? h.y : -h.y,
                                           (i & 4u) != 0 ? h.z : -h.z};
    };
    for (unsigned from = 0; from < 8; ++from) {
      for (const unsigned along : {1u, 2u, 4u}) {
        if ((from & along) == 0) line(corner(from), corner(from | along));
      }
    }
  }
  void draw(const DBox& box) const {
    draw(OrientedBox{0.5 * (box.lower + box.upper), {}, 0.5 * (box.upper - box.lower)});
  }
  /// Draws three great circles.
  void draw(const BoundingSphere& sphere) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](int part) {
        const double angle = 2 * std::numbers::pi * part / kCircleParts;
        const double c = sphere.radius * std::cos(angle);
        const double s = sphere.radius * std::sin(angle);
        return sphere.center + (axis == 0 ? DVec3{0, c, s} : axis == 1 ? DVec3{s, 0, c} : DVec3{c, s, 0});
      };
      for (int part = 0; part < kCircleParts; ++part) line(at(part), at(part + 1));
    }
  }
  template <class Volume>
  void draw(const VolumeTree<Volume>& tree, std::uint32_t node = 0, int level = 0) const {
    if (tree.nodes.empty()) return;
    if (level == kTreeLevel || tree.is_leaf(node)) return draw(tree.nodes[node].volume);
    draw(tree, node + 1, level + 1);
    draw(tree, tree.nodes[node + 1].next, level + 1);
  }

 private:
  void line(DVec3 from, DVec3 to) const {
    lines_.push_back({.from = transform_point(body_, vector_cast<Real>(from)),
                      .to = transform_point(body_, vector_cast<Real>(to)),
                      .color = kColor,
                      .width_px = kWidthPx});
  }

  const Mat4& body_;
  std::vector<DrawLine>& lines_;
};

}  // namespace

std::optional<Preselection> bounding_volume_named(std::string_view name) {
  for (const Preselection kind : kPreselections) {
    if (kind != Preselection::kAllPairs && name == name_of(kind)) return kind;
  }
  return {};
}

void add_bounding_lines(const MeshGeometry& mesh, const Mat4& in_body, const Mat4& body, Preselection kind,
                        std::vector<DrawLine>& lines) {
  const bool is_world_box = kind == Preselection::kBox;
  const Mat4 to_frame = is_world_box ? body * in_body : in_body;
  std::vector<DVec3> points;
  for (const Vertex& vertex : mesh.vertices) {
    points.push_back(vector_cast<double>(transform_point(to_frame, vertex.position)));
  }
  if (points.empty()) return;
  std::vector<geometry::Triangle> triangles;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    triangles.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  }
  const MeshView view = {points, triangles};
  const Mat4 to_list = is_world_box ? Mat4{} : body;
  const Pen pen(to_list, lines);
  switch (kind) {
    case Preselection::kAllPairs:
      return;
    case Preselection::kVertexSphere:
      return pen.draw(geometry::vertex_sphere(points));
    case Preselection::kSphere:
      return pen.draw(geometry::minimum_sphere(points));
    case Preselection::kBox:
      return pen.draw(geometry::bounds_of(points));
    case Preselection::kOrientedBox:
      return pen.draw(geometry::tight_box(points));
    case Preselection::kSphereTree:
      return pen.draw(geometry::build_volume_tree<BoundingSphere>(view));
    case Preselection::kBoxTree:
      return pen.draw(geometry::build_volume_tree<DBox>(view));
    case Preselection::kOrientedBoxTree:
      return pen.draw(geometry::build_volume_tree<OrientedBox>(view));
  }
}

}  // namespace hooke::render
