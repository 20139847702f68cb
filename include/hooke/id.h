#pragma once

#include <cstdint>

/// \file
/// Handles, the parts of objects that they lead to, and references to points. A handle is a value: copy it,
/// compare it. It is never a pointer, so it can be stale but it cannot dangle. A default-constructed handle
/// refers to nothing. One of another World is refused like a stale one.
///
/// For a file, or for another World that the same calls built, take slot and generation, and leave `world` 0.

namespace hooke {

/// The handle of an object in a World. `Tag` keeps handles of different kinds apart, and is never defined.
template <class Tag>
struct Id {
  std::uint32_t slot = 0;  ///< Number of the object of its kind, from 1 on; 0 refers to nothing.
  /// Tells objects apart that had the same slot before and after World::restore. A World begins with 1.
  std::uint32_t generation = 0;
  /// Number of the World that made the handle, from 1 on in each process; 0 fits every World. Neither the
  /// saved state nor the hash contains it.
  std::uint32_t world = 0;

  friend constexpr bool operator==(Id, Id) = default;
  /// Whether it refers to anything at all. The object may be gone all the same.
  explicit constexpr operator bool() const { return slot != 0; }
};

using MeshId = Id<struct MeshTag>;            ///< Triangles shared by bodies and cloths.
using BodyId = Id<struct BodyTag>;            ///< A shape with a pose.
using HookId = Id<struct HookTag>;            ///< A joint between two things.
using RopeId = Id<struct RopeTag>;            ///< A chain of point masses.
using ClothId = Id<struct ClothTag>;          ///< A surface of point masses.
using SolidId = Id<struct SolidTag>;          ///< A soft body of point masses.
using ParticlesId = Id<struct ParticlesTag>;  ///< Loose point masses and their springs.
using FieldId = Id<struct FieldTag>;          ///< A force on everything: FieldDesc.
using ForceLawId = Id<struct ForceLawTag>;    ///< The user's own function of forces.

/// One point of a deformable object, in the order its maker gave the points.
struct PointRef {
  /// What the point belongs to.
  enum class Kind : std::uint8_t {
    kNone,       ///< Nothing: the reference is empty.
    kParticles,  ///< An object of ParticlesDesc.
    kRope,       ///< A rope.
    kCloth,      ///< A cloth.
    kSolid       ///< A soft solid.
  };

  /// As the index of a hook's end: the place of the object that is nearest to the hook's anchor. It lies on a
  /// segment of a rope, on a triangle of a cloth, in a tetrahedron of a solid, or at a loose particle.
  static constexpr std::uint32_t kNearest = 0xFFFFFFFF;

  Kind kind = Kind::kNone;       ///< Kind of the object.
  std::uint32_t slot = 0;        ///< Id::slot of the object.
  std::uint32_t generation = 0;  ///< Id::generation of the object.
  std::uint32_t index = 0;       ///< Number of the point in the object, from 0 on; or kNearest.
  std::uint32_t world = 0;       ///< Id::world of the object.

  friend constexpr bool operator==(PointRef, PointRef) = default;
};

///@{
/// Makes a reference to point `index` of an object. Nothing is checked before the reference is used.
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
///@}

/// One shape of a body.
struct BodyPart {
  /// The body that has the shape.
  BodyId body = {};
  std::uint32_t part = 0;  ///< Index into BodyDesc::parts; 0 for a body of one shape.

  friend constexpr bool operator==(BodyPart, BodyPart) = default;
};

}  // namespace hooke
