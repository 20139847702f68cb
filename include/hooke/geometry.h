#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Makes meshes for bodies; planes, polygons, parts of transforms, bounding volumes. Needs no World.

namespace hooke {

/// A mesh made into the surface of a solid, and what that took. Numbers are those of the given triangles.
struct SolidRepair {
  MeshDesc mesh = {};
  std::uint32_t points_dropped = 0;            ///< Welded to another, or of no triangle.
  std::vector<std::uint32_t> degenerate = {};  ///< Left out: without height, or with a corner twice.
  std::vector<std::uint32_t> duplicate = {};   ///< Left out: on another with the same corners.
  std::vector<std::uint32_t> turned = {};      ///< Turned over, to face outward as their neighbors do.
  std::vector<std::uint32_t> given = {};       ///< Of each triangle of `mesh`, its number in the given one.
};

/// Mends what can be mended without guessing a shape: points nearer to each other than 1e-6 of the bounding
/// box's diagonal become one; triangles without height go; of several with the same corners one stays, or
/// none where the surface is closed without them (two back to back enclose nothing); triangles turn so that
/// neighbors agree and the outside is outside. A mesh of a solid comes back as it is, in its order.
///
/// Errors name the triangles, eight at most: a coordinate that is not finite, an index out of range, edges
/// with one triangle (the surface is open) or with more than two, sides that cannot agree (a Moebius strip or
/// Klein bottle), no volume (all in one plane), triangles that cross each other, nothing left. Takes half
/// a second for 50,000 triangles.
[[nodiscard]] Result<SolidRepair> repair_solid(const MeshDesc& mesh);

/// A x + B y + C z + D = 0 with (A, B, C) the normal, of length one, and D = -offset.
struct Plane {
  DVec3 normal = {0, 1, 0};  ///< Unit.
  double offset = 0;         ///< dot(normal, x) = offset on the plane [m].
};

/// Through three points, which run counter-clockwise seen from the side the normal points to.
///
/// Errors: points on one line (height over the longest side below 1e-12 of it), one that is not finite.
[[nodiscard]] Result<Plane> plane_through(DVec3 a, DVec3 b, DVec3 c);

/// Through a point, across a normal of any length.
///
/// Errors: a normal of no length, numbers that are not finite.
[[nodiscard]] Result<Plane> plane_across(DVec3 normal, DVec3 point);

/// From an equation A x + B y + C z + D = 0 of any scale.
///
/// Errors: A, B and C all zero, numbers that are not finite.
[[nodiscard]] Result<Plane> plane_of_equation(double a, double b, double c, double d);

/// Positive on the side the normal points to [m]. D counts: the point (0, 5, 0) is 2 m over the plane y = 3.
[[nodiscard]] inline double signed_distance(const Plane& plane, DVec3 p) {
  return dot(plane.normal, p) - plane.offset;
}

/// 1 over the plane, -1 under it, 0 within `tolerance` [m] of it, and for what is not a number.
[[nodiscard]] int side_of(const Plane& plane, DVec3 p, double tolerance);

/// A flat polygon, prepared for the question which points are in it. It may be concave; sides that cross give
/// it a winding number beyond one.
struct Polygon {
  std::vector<DVec3> corners = {};  ///< Counter-clockwise seen from the side the normal points to [m].
  Plane plane = {};
  std::vector<Plane> sides = {};  ///< One through each side, from corner k to k + 1, facing inward.
  bool is_convex = true;
};

/// The normal is the sum of the corners' (Newell), so that no three corners decide it alone.
///
/// Errors: fewer than 3 or more than 65536 corners, one that is not finite, neighbors at one place, no area,
/// a corner farther than `tolerance` [m] from the plane.
[[nodiscard]] Result<Polygon> make_polygon(std::span<const DVec3> corners, double tolerance);

/// Whether a point is in the polygon: at most `tolerance` [m] from its plane and, seen along the normal,
/// inside or at most that far outside a side. All three ask the same of convex polygons (they may differ at
/// corners, where lines meet farther out than the tolerance); they are the paper's (4.2.3).
///
/// By cross products: the point is on the inner side of every side. Convex polygons only; of a concave one
/// this is the part from which all of it can be seen.
[[nodiscard]] bool is_inside_by_cross_products(const Polygon& polygon, DVec3 p, double tolerance);

/// By dot products against the stored planes of the sides, with the same answer. What the paper calls "a dot
/// product" with the sides themselves is wrong for one point in three around a random triangle.
[[nodiscard]] bool is_inside_by_side_planes(const Polygon& polygon, DVec3 p, double tolerance);

/// By the sum of the angles under which the sides are seen, a whole turn inside and none outside, each with
/// its sign: right for concave polygons too.
[[nodiscard]] bool is_inside_by_angles(const Polygon& polygon, DVec3 p, double tolerance);

/// How often the polygon runs counter-clockwise around the point seen along the normal, by which sides cross
/// the ray from it (Sunday 2001): exact, without a tolerance. On a side it is that of either side of it.
[[nodiscard]] int winding_number(const Polygon& polygon, DVec3 p);

/// By the winding number, which is not zero inside; concave polygons too. The quickest that is right for all.
[[nodiscard]] bool is_inside_by_winding(const Polygon& polygon, DVec3 p, double tolerance);

/// A landscape: point (column, row) lies at (column cell, heights[row * columns + column], row cell) in the
/// mesh's frame [m]; the upper side is outside. Each cell is cut from (column, row) to (column + 1, row + 1).
///
/// Errors: columns and rows outside [2, 4096], a cell that is not positive and finite, another number of
/// heights than columns x rows, a height that is not finite.
[[nodiscard]] Result<MeshDesc> make_height_field(int columns, int rows, Real cell,
                                                 std::span<const Real> heights);

/// Convex meshes that together are about the given solid: for bodies that move, each as the hull of a part
/// (Shape::hull_of). The solid is cut by planes, the deepest part first, until the surface lies nowhere
/// deeper than `concavity_max` [m] below its part's hull, or there are `parts_max` parts. Where the solid is
/// concave the parts are larger than it, and they may overlap a little; left out is only what is thinner than
/// 1e-4 of its extent. Takes about a second for 2,000 triangles: for loading, not between steps.
///
/// Errors: a mesh that is not closed or faces inward, a solid thinner than 1e-4 of its extent, a concavity
/// that is not positive and finite, parts outside [1, 256].
[[nodiscard]] Result<std::vector<MeshDesc>> decompose_convex(const MeshDesc& mesh, Real concavity_max,
                                                             int parts_max);

/// A rotation matrix as a unit quaternion, w >= 0 (Shepperd 1978, Quaternion from rotation matrix: by the
/// largest of its four components). Of a matrix with errors of rounding it has them too, and unit length.
[[nodiscard]] Quaternion<double> quaternion_from(const Matrix3<double>& rotation);

/// An affine matrix taken apart: M = T R U with U upper triangular; its rows are (scale.x, shear_xy,
/// shear_xz), (0, scale.y, shear_yz), (0, 0, scale.z). Without shear this is T R S.
struct TransformParts {
  DVec3 translation = {};            ///< [m]
  Quaternion<double> rotation = {};  ///< Unit.
  DVec3 scale = {1, 1, 1};           ///< x and y not negative; z negative in a reflection.
  double shear_xy = 0, shear_xz = 0, shear_yz = 0;
};

/// The parts of an affine matrix (its last row is not read), by columns made orthogonal in order
/// (Gram-Schmidt). Every matrix of finite numbers has them. A reflection has its negative scale in z,
/// whatever axis it was made with. A column without a direction of its own has scale 0, and takes one at
/// right angles to those before it; the zero matrix has the rotation of none.
[[nodiscard]] TransformParts decompose(const Matrix4<double>& matrix);

/// The matrix of the parts: the inverse of decompose.
[[nodiscard]] Matrix4<double> compose(const TransformParts& parts);

/// What tells first that two objects cannot touch (the paper's preselection, 4.3.1, and its bounding objects,
/// 4.5.2).
enum class Preselection : std::uint8_t {
  kAllPairs,      ///< Nothing does.
  kVertexSphere,  ///< The paper's sphere about the mean vertex.
  kSphere,        ///< The smallest.
  kBox,           ///< Along the axes of the world.
  kOrientedBox,   ///< Tight, turning with the object.
  kSphereTree,
  kBoxTree,  ///< Boxes along the axes of each object's own frame.
  kOrientedBoxTree,
};

inline constexpr Preselection kPreselections[] = {Preselection::kAllPairs,    Preselection::kVertexSphere,
                                                  Preselection::kSphere,      Preselection::kBox,
                                                  Preselection::kOrientedBox, Preselection::kSphereTree,
                                                  Preselection::kBoxTree,     Preselection::kOrientedBoxTree};

/// "all_pairs", "vertex_sphere", "sphere", "box", "oriented_box", "sphere_tree", "box_tree",
/// "oriented_box_tree".
[[nodiscard]] const char* name_of(Preselection preselection);

enum class SolidOperation : std::uint8_t {
  kUnion,         ///< What is in `a` or in `b`.
  kIntersection,  ///< What is in both.
  kDifference,    ///< What is in `a` and not in `b`.
};

/// Two solids as one mesh, without triangles if nothing is left. Corners are moved by less than 2^-32 of the
/// longest side of the box around both; from there to the result all is exact, so faces, edges and corners
/// that fall together are welded. Then edges shorter than 2e-6 of the result's diagonal are collapsed, and
/// triangles lower than that flipped away or lifted, so that the mesh is closed in a file, too. It is
/// closed, each of its edges has two triangles, and the triangles at a vertex form one fan: where the solid
/// touches itself, vertices are doubled. Takes about a second for 10,000 triangles.
///
/// Double or flat triangles and meshes that are inside out are put right. Errors name the triangles: a mesh
/// that is not closed, faces opposite sides, goes through itself or lies on itself; a number that is not
/// finite or beyond 1e9 m; triangles whose planes cut each other into too many pieces.
[[nodiscard]] Result<MeshDesc> combine_solids(const MeshDesc& a, const MeshDesc& b, SolidOperation operation);

}  // namespace hooke
