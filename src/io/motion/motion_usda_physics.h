#pragma once

#include "io/motion/motion_usda_text.h"

#include <string>
#include <vector>

/// \file
/// What a .usda file says of bodies, their colliders and their joints, by the schemas of UsdPhysics.

namespace hooke::io {

/// Returns the schemas of a body.
[[nodiscard]] std::vector<std::string> physics_schemas(const MotionObject& body);

/// Writes the mass and the state at the start of a body that moves.
void put_body_physics(UsdaText& text, const MotionObject& body, const MotionState& start);

/// Tells whether the triangles of a piece collide themselves, as those of a mesh or hull do.
[[nodiscard]] bool collides_by_triangles(const MotionObject& body, const MotionPiece& piece);

/// Writes the collider of a piece with another shape, which is not drawn.
void put_collider(UsdaText& text, const MotionPiece& piece, const std::string& name);

/// Writes the place of a piece in its body, unless it has that of the body.
void put_piece_place(UsdaText& text, const MotionPiece& piece, DVec3 scale);

/// Writes a joint between the prims `a` and `b`, empty for the world, or returns false for a kind that
/// UsdPhysics does not have. The states are those of the bodies when the anchors were taken.
struct UsdaJointEnd {
  std::string prim;
  MotionState state;
};
bool put_joint(UsdaText& text, const MotionJoint& joint, const std::string& name, const UsdaJointEnd& a,
               const UsdaJointEnd& b);

}  // namespace hooke::io
