#pragma once

#include "hooke/drawing/figure.h"
#include "hooke/motion_io.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::app {

/// A MotionSkin is the triangles of a rope, cloth, solid or group of particles. Their number stays the same
/// in all frames, as formats of motion ask for, while the renderer's tubes grow and shrink with the ropes.
class MotionSkin {
 public:
  /// Makes the triangles of a figure whose points are at `points` in the first frame. `materials` has one
  /// number for each range of the figure; `iron` is that of loads.
  MotionSkin(const Figure& figure, std::span<const DVec3> points, std::span<const std::uint32_t> materials,
             std::uint32_t iron);

  /// Returns the mesh, with the vertices of the first frame.
  [[nodiscard]] const MotionMesh& mesh() const { return mesh_; }

  /// Returns the vertices for points of now, in the world [m]. Frames must come in their order: the rings of
  /// a tube turn as little as possible from one to the next.
  [[nodiscard]] std::vector<Vec3> vertices(std::span<const DVec3> points);

 private:
  /// A Tube leads along points with cross sections of `sides` vertices.
  struct Tube {
    std::vector<std::uint32_t> points;
    float radius = 0;
    std::uint32_t sides = 8;
    std::uint32_t pieces = 1;  ///< Number of straight pieces between two points.
    DVec3 across = {};         ///< Direction of the first vertex of the first ring in the frame before.
  };
  /// A Ball sits at a point.
  struct Ball {
    std::uint32_t point = 0;
    float radius = 0;
    std::uint32_t shape = 0;  ///< Index into `shapes_`.
  };

  void add_surface(const Figure& figure, std::span<const std::uint32_t> materials);
  void add_tubes(const Figure& figure, std::size_t points);
  void add_balls(const Figure& figure, std::size_t points);
  void add_tube_triangles(const Tube& tube);
  void add_ball(std::uint32_t point, float radius, std::uint32_t shape);
  void end_part(std::uint32_t material);
  static void put_tube(Tube& tube, std::span<const DVec3> points, std::vector<Vec3>& vertices);

  MotionMesh mesh_;
  std::vector<std::uint32_t> point_of_;  ///< Point of each vertex of a surface.
  std::vector<Tube> tubes_;
  std::vector<Ball> balls_;
  std::vector<std::vector<Vec3>> shapes_;              ///< Vertices of balls of radius 1.
  std::vector<std::vector<std::uint32_t>> triangles_;  ///< Triangles of the same.
  std::uint32_t next_vertex_ = 0;
  std::uint32_t part_begin_ = 0;
};

}  // namespace hooke::app
