#pragma once

#include <cstdint>

/// \file
/// Handles. A handle is a value: copy it, compare it. It is never a pointer, so it can be stale but it cannot
/// dangle. A default-constructed handle refers to nothing. One of another World is refused like a stale one.
///
/// For a file, or for another World that the same calls built, take slot and generation, and leave `world` 0.

namespace hooke {

template <class Tag>
struct Id {
  std::uint32_t slot = 0;        ///< Row of the slot table plus one; 0 means "none".
  std::uint32_t generation = 0;  ///< Of objects made since a World was last restored.
  std::uint32_t world = 0;  ///< Which World of this process made it; 0, which no World gives: any. State and
                            ///< hashes do not know it.

  friend constexpr bool operator==(Id, Id) = default;
  explicit constexpr operator bool() const { return slot != 0; }
};

using MeshId = Id<struct MeshTag>;            ///< Triangles shared by bodies and cloths.
using BodyId = Id<struct BodyTag>;            ///< A shape with a pose.
using HookId = Id<struct HookTag>;            ///< What holds two things together.
using RopeId = Id<struct RopeTag>;            ///< A chain of point masses.
using ClothId = Id<struct ClothTag>;          ///< A surface of point masses.
using SolidId = Id<struct SolidTag>;          ///< Tetrahedra of point masses.
using ParticlesId = Id<struct ParticlesTag>;  ///< Loose point masses and their springs.
using FieldId = Id<struct FieldTag>;          ///< Gravity-like, radial or magnetic.
using ForceLawId = Id<struct ForceLawTag>;    ///< The user's own force.

/// One point of a deformable object, in the order its maker gave the points.
struct PointRef {
  enum class Kind : std::uint8_t { kNone, kParticles, kRope, kCloth, kSolid };

  /// Of a hook: the place of the object that is nearest to the hook's anchor: on a segment of a rope, on a
  /// triangle of a cloth, in a tetrahedron of a solid, at a loose particle.
  static constexpr std::uint32_t kNearest = 0xFFFFFFFF;

  Kind kind = Kind::kNone;
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;
  std::uint32_t index = 0;
  std::uint32_t world = 0;  ///< As of Id.

  friend constexpr bool operator==(PointRef, PointRef) = default;
};

constexpr PointRef point(ParticlesId id, std::uint32_t index) {
  return {PointRef::Kind::kParticles, id.slot, id.generation, index, id.world};
}
constexpr PointRef point(RopeId id, std::uint32_t index) {
  return {PointRef::Kind::kRope, id.slot, id.generation, index, id.world};
}
constexpr PointRef point(ClothId id, std::uint32_t index) {
  return {PointRef::Kind::kCloth, id.slot, id.generation, index, id.world};
}
constexpr PointRef point(SolidId id, std::uint32_t index) {
  return {PointRef::Kind::kSolid, id.slot, id.generation, index, id.world};
}

/// One shape of a body.
struct BodyPart {
  BodyId body = {};
  std::uint32_t part = 0;  ///< Index into BodyDesc::parts; 0 for a body of one shape.

  friend constexpr bool operator==(BodyPart, BodyPart) = default;
};

}  // namespace hooke
