#pragma once

#include "collision/deformable/contact_frames.h"
#include "parallel/range.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// What rope segments and cloth triangles touch between their points: a narrow body would pass between the
/// points of a coarse cloth, and a rope would hang in an edge. Between its points an element is a little
/// thinner than the points are (kRopeThinning, kClothThinning), so that where points describe a contact, on a
/// face or a gentle curve, nothing is found and nothing is paid for.
///
/// Of convex shapes, and of the ridges and peaks of meshes; a half-space has nothing that could pass between
/// points. docs/decisions/0021.

namespace hooke::collision {

/// By how much an edge is thinner in its middle than at its ends, over the radius of these: of a rope, whose
/// nodes must not hook into what it slides over, and of a cloth.
inline constexpr Real kRopeThinning = Real(0.2);
inline constexpr Real kClothThinning = Real(0.5);

/// Memory of find_inner_contacts.
struct ElementContactFinder {
  /// How far a point is from the shape that is looked at, now and at the end of the step.
  struct PointGap {
    std::uint32_t pass = 0;  ///< Of which shape, counted by `pass`.
    std::array<Real, 2> distance = {};
    std::array<Vec3, 2> normal = {};
    std::array<Vec3, 2> x = {};  ///< In the shape's frame.
  };
  std::vector<state::ElementContact> contacts;  ///< Those found; then those of the step before.
  std::vector<PointGap> gaps;                   ///< Of the object's particles.
  std::vector<std::uint32_t> triangles;         ///< Of a mesh, near one element.
  std::uint32_t pass = 0;
};

/// An object and the shapes that its points may touch.
struct ElementContactQuery {
  std::uint32_t object = 0;
  std::span<const std::uint32_t> colliders;
  std::span<const Frame> frames;  ///< Of those.
  const std::vector<Hooked>& hooked;
  Real step = Real(0);   ///< [s]
  Real reach = Real(0);  ///< Of the point that reaches farthest within the step [m].
};

/// Appends a row for each element of the object into which a shape may protrude within the step, now or where
/// it will be.
///
/// The signed distance d to a convex shape is convex: with n its gradient at a point a of the element,
/// d(x) >= d(a) + n.(x - a). That bounds how far the element between its points is nearer to the shape than
/// the nearest point of them; over a face not at all, over a curve by twice what is so. The gradient in the
/// middle decides then. Half of what an edge is thinner than its ends is left for what the bound does not
/// know of the step.
///
/// A body that forces move, that is wider than a cloth's meshes and that touches three of its points or more,
/// or will within the step, is carried by these and has no such rows; nor has one that is near to more than
/// twelve such elements, unless one of them held it in the step before.
void find_element_contacts(const state::Tables& tables, const ElementContactQuery& query,
                           ElementContactFinder& finder);

/// Rows of both tables stand in order: one walk carries forces, normals and weights over.
void carry_element_forces(std::span<const state::ElementContact> from, std::span<state::ElementContact> to);

/// Place, normal, separation and surface of each row, where element and body are now; where they meet within
/// the next `h` [s], those of then. A shape in which a point of the element is belongs to that point; one
/// that only crosses the element keeps the normal by which it came.
void update_element_contacts(parallel::Range range, Real h, state::Tables& tables);

}  // namespace hooke::collision
