#pragma once

#include "collision/deformable/contact_frames.h"
#include "collision/deformable/deformable_tuning.h"
#include "parallel/range.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Contacts of rope segments and cloth triangles between their points. Without them a narrow body would pass
/// between the points of a coarse cloth, and a rope would catch on an edge. Between its points an element is
/// a little thinner than the points are (kRopeThinning, kClothThinning). So where points describe a contact,
/// on a face or a gentle curve, nothing is found and nothing is paid for.
///
/// Contacts are found with convex shapes, and with the ridges and peaks of meshes; a half-space has nothing
/// that could pass between points. docs/decisions/0021-contacts-between-points.md.

namespace hooke::collision {

/// Memory of find_element_contacts.
struct ElementContactFinder {
  /// Distance of a point from the current shape, now and at the end of the step.
  struct PointGap {
    std::uint32_t pass = 0;  ///< Number of the shape, counted by `pass`.
    std::array<Real, 2> distance = {};
    std::array<Vec3, 2> normal = {};
    std::array<Vec3, 2> x = {};  ///< Positions in the shape's frame.
  };
  std::vector<state::ElementContact> contacts;  ///< The contacts found; then those of the step before.
  std::vector<PointGap> gaps;                   ///< One for each particle of the object.
  std::vector<std::uint32_t> triangles;         ///< Triangles of a mesh near one element.
  std::uint32_t pass = 0;
};

/// An object and the shapes that its points may touch.
struct ElementContactQuery {
  std::uint32_t object = 0;
  std::span<const std::uint32_t> colliders;
  std::span<const Frame> frames;  ///< Frames of `colliders`.
  const std::vector<Hooked>& hooked;
  Real step = Real(0);   ///< Length of the step [s].
  Real reach = Real(0);  ///< Reach of the point that can get farthest within the step [m].
};

/// Appends a row for each element of the object into which a shape may protrude within the step, at its
/// present position or at that of the end.
///
/// The signed distance d to a convex shape is convex: with n its gradient at a point a of the element, d(x)
/// >= d(a) + n.(x - a). That bounds by how much the element between its points is nearer to the shape than
/// the nearest of them. Over a face the bound is zero, over a curve it is twice the true value; there the
/// gradient in the middle decides. Half of what an edge is thinner than its ends is left for what the bound
/// does not know of the step.
///
/// A dynamic body that is wider than a cloth's meshes and touches three of its points or more, now or within
/// the step, is carried by these points and has no such rows. Neither has one that is near to more than
/// twelve such elements, unless one of them held it in the step before.
void find_element_contacts(const state::Tables& tables, const ElementContactQuery& query,
                           ElementContactFinder& finder);

/// Carries forces, normals and weights over from the rows of the last step. Rows of both tables stand in
/// order, so one walk is enough.
void carry_element_forces(std::span<const state::ElementContact> from, std::span<state::ElementContact> to);

/// Finds the position, normal, separation and surface of each row from where element and body are now. If
/// they meet within the next `h` [s], it uses the positions at that time. If a point of the element is in a
/// shape, the contact is left to that point. A shape that only crosses the element keeps the normal by which
/// it came.
void update_element_contacts(parallel::Range range, Real h, state::Tables& tables);

}  // namespace hooke::collision
