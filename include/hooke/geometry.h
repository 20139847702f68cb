#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Meshes for bodies, planes, polygons, parts of transforms, bounding volumes. Nothing here needs a World.

namespace hooke {

/// A mesh made into the surface of a solid, and what that took. Triangles are named by their index in the
/// given mesh.
struct SolidRepair {
  MeshDesc mesh = {};                ///< The mended mesh: closed, its outside outside.
  std::uint32_t points_dropped = 0;  ///< Number of points welded to another or used by no triangle.
  /// Triangles left out because they have no height, or a corner twice.
  std::vector<std::uint32_t> degenerate = {};
  std::vector<std::uint32_t> duplicate = {};  ///< Triangles left out: they lie on one with the same corners.
  std::vector<std::uint32_t> turned = {};  ///< Triangles turned over, to face outward as their neighbors do.
  std::vector<std::uint32_t> given = {};   ///< For each triangle of `mesh`, its index in the given mesh.
};

/// Mends what can be mended without guessing a shape: points nearer to each other than 1e-6 of the bounding
/// box's diagonal become one; triangles without height go; of several with the same corners one stays, or
/// none where the surface is closed without them (two back to back enclose nothing); triangles turn so that
/// neighbors agree and the outside is outside. A mesh of a solid comes back as it is, in its order.
///
/// Errors name the triangles, eight at most: a coordinate that is not finite, an index out of range, edges
/// with one triangle (the surface is open) or with more than two, sides that cannot agree (a Moebius strip or
/// Klein bottle), no volume (all in one plane), triangles that cross each other, nothing left. 50,000
/// triangles take half a second.
[[nodiscard]] Result<SolidRepair> repair_solid(const MeshDesc& mesh);

/// A closed surface made around a mesh, and how far it lies from the mesh.
struct SolidRemesh {
  MeshDesc mesh = {};         ///< The new surface: closed, each edge with two triangles, its outside outside.
  Real voxel = Real(0);       ///< Length of a voxel's side [m].
  Real moved_mean = Real(0);  ///< Mean distance of the given surface from the new one, by area [m].
  Real moved_max = Real(0);   ///< Largest distance of a point of the given surface from the new one [m].
  Real bridged = Real(0);     ///< Largest distance of the new surface from the given one: over holes [m].
};

/// Closes a mesh that repair_solid cannot mend: open, with branching edges, with sides that cross or
/// disagree, or a mere soup of triangles. It is made anew from voxels, by generalized winding numbers and a
/// surface net.
///
/// - What the mesh winds about more than half a time is inside, so that a hole is closed as by a soap film.
///   Triangles that face the wrong way take from this, and enough of them open the mesh again.
/// - Where the mesh is thinner than a voxel, as a sheet without a back is, it gets a thickness of 1.7 voxels.
/// - Holes inside that nothing from outside reaches are filled, unless the given mesh is closed.
/// - Surface that lies deeper than a voxel inside the new one does not count as moved.
///
/// The result is the same on every machine. 100,000 triangles in 64 voxels along the longest side take about
/// two seconds.
///
/// Errors: a mesh that is not usable (indices, numbers, no triangles), a voxel that is not positive and
/// finite, or so small that the grid has more than 2^24 nodes.
[[nodiscard]] Result<SolidRemesh> remesh_solid(const MeshDesc& mesh, Real voxel);

/// The voxel [m] that is taken where none is given: a 64th of the longest side of the mesh's bounding box.
[[nodiscard]] Real default_voxel(const MeshDesc& mesh);

/// The plane A x + B y + C z + D = 0, with (A, B, C) the normal, of length one, and D = -offset.
struct Plane {
  DVec3 normal = {0, 1, 0};  ///< Normal of unit length.
  double offset = 0;         ///< Distance from the origin along the normal: dot(normal, x) = offset [m].
};

/// Makes the plane through three points, which run counter-clockwise seen from the side the normal points to.
///
/// Errors: points on one line (height over the longest side below 1e-12 of it), one that is not finite.
[[nodiscard]] Result<Plane> plane_through(DVec3 a, DVec3 b, DVec3 c);

/// Makes the plane through a point, across a normal of any length but zero.
///
/// Errors: a normal of no length, numbers that are not finite.
[[nodiscard]] Result<Plane> plane_across(DVec3 normal, DVec3 point);

/// Makes the plane of the equation A x + B y + C z + D = 0 of any scale.
///
/// Errors: A, B and C all zero, numbers that are not finite.
[[nodiscard]] Result<Plane> plane_of_equation(double a, double b, double c, double d);

/// Distance of a point from the plane [m], positive on the side the normal points to. The offset counts: the
/// point (0, 5, 0) is 2 m over the plane y = 3.
[[nodiscard]] inline double signed_distance(const Plane& plane, DVec3 p) {
  return dot(plane.normal, p) - plane.offset;
}

/// The side of the plane that a point is on: 1 over it, -1 under it, 0 within `tolerance` [m] of it or for a
/// point that is not a number.
[[nodiscard]] int side_of(const Plane& plane, DVec3 p, double tolerance);

/// A flat polygon, prepared by make_polygon for the question which points are in it. It may be concave; sides
/// that cross each other give it a winding number beyond one.
struct Polygon {
  std::vector<DVec3> corners = {};  ///< Corners, counter-clockwise seen from the normal's side [m].
  Plane plane = {};                 ///< The plane that the corners lie in, within the tolerance.
  /// One plane through each side, across the polygon and facing inward: side k runs from corner k to k + 1.
  std::vector<Plane> sides = {};
  bool is_convex = true;  ///< Whether every corner turns the same way, and all of them once around.
};

/// Prepares a polygon. Its normal is the sum over all corners (Newell's method), so that no three of them
/// decide it alone.
///
/// Errors: fewer than 3 or more than 65536 corners, one that is not finite, neighbors at one place, no area,
/// a corner farther than `tolerance` [m] from the plane.
[[nodiscard]] Result<Polygon> make_polygon(std::span<const DVec3> corners, double tolerance);

/// Whether a point is in the polygon: at most `tolerance` [m] from its plane and, seen along the normal,
/// inside or at most that far outside a side. This and the next two functions are the paper's (4.2.3). They
/// agree on convex polygons, except near corners, where lines meet farther out than the tolerance.
///
/// This one takes cross products: the point is on the inner side of every side. It is right for convex
/// polygons; of a concave one it accepts the part from which all of it can be seen.
[[nodiscard]] bool is_inside_by_cross_products(const Polygon& polygon, DVec3 p, double tolerance);

/// Whether a point is in the polygon, by dot products with the stored planes of the sides; the answer is that
/// of is_inside_by_cross_products. The paper's "dot product" with the sides themselves is wrong for one point
/// in three around a random triangle.
[[nodiscard]] bool is_inside_by_side_planes(const Polygon& polygon, DVec3 p, double tolerance);

/// Whether a point is in the polygon, by the sum of the signed angles under which it sees the sides: a whole
/// turn inside, none outside. It is right for concave polygons too.
[[nodiscard]] bool is_inside_by_angles(const Polygon& polygon, DVec3 p, double tolerance);

/// How often the polygon runs counter-clockwise around the point, seen along the normal. It counts the sides
/// that cross a ray from the point (Sunday 2001), exactly and without a tolerance. A point on a side has the
/// number of the points on one side of it.
[[nodiscard]] int winding_number(const Polygon& polygon, DVec3 p);

/// Whether a point is in the polygon, by its winding number, which is not zero inside. It is right for
/// concave polygons too, and the quickest that is.
[[nodiscard]] bool is_inside_by_winding(const Polygon& polygon, DVec3 p, double tolerance);

/// Makes a landscape from the heights of columns x rows points [m], row after row. Point (column, row) lies
/// at (column cell, heights[row * columns + column], row cell) in the mesh's frame; the upper side is
/// outside. Two triangles cover each cell, divided from (column, row) to (column + 1, row + 1).
///
/// Errors: columns and rows outside [2, 4096], a cell that is not positive and finite, another number of
/// heights than columns x rows, a height that is not finite.
[[nodiscard]] Result<MeshDesc> make_height_field(int columns, int rows, Real cell,
                                                 std::span<const Real> heights);

/// Makes convex meshes that together are about the given solid: for bodies that move, each as the hull of a
/// part (Shape::hull_of). Planes cut the solid, the deepest concavity first, until the surface lies nowhere
/// deeper than `concavity_max` [m] below its part's hull, or there are `parts_max` parts.
///
/// Where the solid is concave the parts are larger than it, and they may overlap a little. Only what is
/// thinner than 1e-4 of the solid's extent is left out. A mesh of more than 4,096 triangles is first
/// simplified to 3,000, from which the parts keep some thousandths of the extent. It takes about a second for
/// 2,000 triangles, three for 100,000: call it when you load, not between steps.
///
/// Errors: a mesh that is not closed or faces inward, a solid thinner than 1e-4 of its extent, a concavity
/// that is not positive and finite, parts outside [1, 256].
[[nodiscard]] Result<std::vector<MeshDesc>> decompose_convex(const MeshDesc& mesh, Real concavity_max,
                                                             int parts_max);

/// Turns a rotation matrix into a unit quaternion with w >= 0, by the largest of its four components
/// (Shepperd 1978, Quaternion from rotation matrix). Rounding errors of the matrix remain in it, but its
/// length is one.
[[nodiscard]] Quaternion<double> quaternion_from(const Matrix3<double>& rotation);

/// An affine matrix taken apart: M = T R U with U upper triangular; its rows are (scale.x, shear_xy,
/// shear_xz), (0, scale.y, shear_yz), (0, 0, scale.z). Without shear this is T R S.
struct TransformParts {
  DVec3 translation = {};            ///< The translation T [m].
  Quaternion<double> rotation = {};  ///< The rotation R, of unit length.
  DVec3 scale = {1, 1, 1};           ///< Diagonal of U. x and y are not negative; z is in a reflection.
  ///@{
  /// Element of U above its diagonal: shear_xy says how far the image of the y axis leans towards the x axis.
  double shear_xy = 0, shear_xz = 0, shear_yz = 0;
  ///@}
};

/// Takes an affine matrix apart; its last row is not read. Columns are made orthogonal in their order
/// (Gram-Schmidt). Every matrix of finite numbers has parts. A reflection has its negative scale in z,
/// whatever axis it was made with. A column without a direction of its own has scale 0 and takes a direction
/// across those before it; the rotation of the zero matrix is the identity.
[[nodiscard]] TransformParts decompose(const Matrix4<double>& matrix);

/// Makes the matrix of the parts: the inverse of decompose.
[[nodiscard]] Matrix4<double> compose(const TransformParts& parts);

/// The test that tells first, and cheaply, that two objects cannot touch (the paper's preselection, 4.3.1,
/// and its bounding objects, 4.5.2).
enum class Preselection : std::uint8_t {
  kAllPairs,         ///< No test: all pairs are left.
  kVertexSphere,     ///< The paper's sphere about the mean vertex.
  kSphere,           ///< The smallest sphere.
  kBox,              ///< A box along the axes of the world.
  kOrientedBox,      ///< A tight box that turns with the object.
  kSphereTree,       ///< A tree of spheres around groups of triangles.
  kBoxTree,          ///< A tree of boxes along the axes of each object's own frame.
  kOrientedBoxTree,  ///< A tree of tight boxes.
};

/// All values of Preselection, in their order.
inline constexpr Preselection kPreselections[] = {Preselection::kAllPairs,    Preselection::kVertexSphere,
                                                  Preselection::kSphere,      Preselection::kBox,
                                                  Preselection::kOrientedBox, Preselection::kSphereTree,
                                                  Preselection::kBoxTree,     Preselection::kOrientedBoxTree};

/// The name of a preselection in scenes: "all_pairs", "vertex_sphere", "sphere", "box", "oriented_box",
/// "sphere_tree", "box_tree" or "oriented_box_tree". The string lives as long as the program.
[[nodiscard]] const char* name_of(Preselection preselection);

/// What combine_solids makes of two solids.
enum class SolidOperation : std::uint8_t {
  kUnion,         ///< What is in `a` or in `b`.
  kIntersection,  ///< What is in both.
  kDifference,    ///< What is in `a` and not in `b`.
};

/// Combines two solids into one mesh, which has no triangles if nothing is left. It takes about a second for
/// 10,000 triangles.
///
/// - Corners are moved by less than 2^-32 of the longest side of the box around both. From there on all is
///   exact, so that faces, edges and corners that fall together are welded.
/// - Edges shorter than 2e-6 of the result's diagonal are then collapsed, and triangles lower than that are
///   flipped away or lifted, so that the mesh stays closed when a file rounds it.
/// - The result is closed, each of its edges has two triangles, and the triangles at a vertex form one fan:
///   vertices are doubled where the solid touches itself.
///
/// Double or flat triangles and meshes that are inside out are put right. Errors name the triangles: a mesh
/// that is not closed, faces opposite sides, goes through itself or lies on itself; a number that is not
/// finite or beyond 1e9 m; triangles whose planes cut each other into too many pieces.
[[nodiscard]] Result<MeshDesc> combine_solids(const MeshDesc& a, const MeshDesc& b, SolidOperation operation);

}  // namespace hooke
