#pragma once

#include "hooke/scene_io.h"

#include "io/scene/scene_binding.h"

/// \file
/// Declares the tables of the scene format: one Kind for each JSON object. scene_table.cpp has the scene,
/// world, timeline, camera and expectations; scene_table_bodies.cpp has bodies, scene_table_hooks.cpp what
/// joins them, scene_table_objects.cpp all other objects.

namespace hooke::io {

template <>
inline constexpr bool kByName<SceneMesh> = true;
template <>
inline constexpr bool kByName<SceneMaterial> = true;

/// A point is an index, or "last".
template <>
struct Codec<ScenePoint> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, ScenePoint& value);
  static JsonNode write(const ScenePoint& value);
  static bool same(const ScenePoint& a, const ScenePoint& b) { return a == b; }
  static JsonNode schema(const Rule& rule);
  static std::string type() { return "whole number or `\"last\"`"; }
};

/// A connection point is a position, or the number of a point; its name is the key.
template <>
inline constexpr bool kByName<ConnectionPointDesc> = true;
template <>
struct Codec<ConnectionPointDesc> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, ConnectionPointDesc& value);
  static JsonNode write(const ConnectionPointDesc& value);
  static bool same(const ConnectionPointDesc& a, const ConnectionPointDesc& b);
  static JsonNode schema(const Rule& rule);
  static std::string type() { return "[x, y, z] or whole number"; }
};

/// A pin is a point, or an object of kind "pin". A still point is written in the short form.
template <>
struct Codec<ScenePin> {
  static bool read(Reader& reader, const JsonNode& node, const Rule& rule, ScenePin& value);
  static JsonNode write(const ScenePin& value);
  static bool same(const ScenePin& a, const ScenePin& b);
  static JsonNode schema(const Rule& rule);
  static std::string type() { return "[pin](#pin) or point"; }
};

/// Returns every kind, in the order of the documentation.
[[nodiscard]] std::span<const Kind* const> all_kinds();
[[nodiscard]] std::span<const Kind* const> body_kinds();
[[nodiscard]] std::span<const Kind* const> hook_kinds();
[[nodiscard]] std::span<const Kind* const> object_kinds();

template <>
const Kind& kind_of<Scene>();
template <>
const Kind& kind_of<WorldDesc>();
template <>
const Kind& kind_of<WindDesc>();
template <>
const Kind& kind_of<SceneMesh>();
template <>
const Kind& kind_of<SceneMaterial>();
template <>
const Kind& kind_of<SceneObjects>();
template <>
const Kind& kind_of<SceneBody>();
template <>
const Kind& kind_of<ScenePart>();
template <>
const Kind& kind_of<SceneFracture>();
template <>
const Kind& kind_of<SceneBlade>();
template <>
const Kind& kind_of<SceneSection>();
template <>
const Kind& kind_of<YieldsDesc>();
template <>
const Kind& kind_of<ScenePair>();
template <>
const Kind& kind_of<SceneHook>();
template <>
const Kind& kind_of<SceneSeam>();
template <>
const Kind& kind_of<HookLimits>();
template <>
const Kind& kind_of<HookSpring>();
template <>
const Kind& kind_of<HookMotor>();
template <>
const Kind& kind_of<HookFreedom>();
template <>
const Kind& kind_of<SceneRope>();
template <>
const Kind& kind_of<SceneCloth>();
template <>
const Kind& kind_of<SceneSolid>();
template <>
const Kind& kind_of<SceneParticles>();
template <>
const Kind& kind_of<ParticleDesc>();
template <>
const Kind& kind_of<SpringDesc>();
template <>
const Kind& kind_of<SceneField>();
template <>
const Kind& kind_of<ScenePin>();
template <>
const Kind& kind_of<SceneLoad>();
template <>
const Kind& kind_of<MotionDesc>();
template <>
const Kind& kind_of<MotionDesc::Keyframe>();
template <>
const Kind& kind_of<SceneArray>();
template <>
const Kind& kind_of<SceneEvent>();
template <>
const Kind& kind_of<SceneCamera>();
template <>
const Kind& kind_of<SceneKeyframe>();
template <>
const Kind& kind_of<SceneSky>();
template <>
const Kind& kind_of<SceneLight>();
template <>
const Kind& kind_of<SceneAccuracy>();
template <>
const Kind& kind_of<SceneExpectation>();

template <>
std::span<const EnumName> names_of<WindDesc::Gusts>();
template <>
std::span<const EnumName> names_of<MeshTree>();
template <>
std::span<const EnumName> names_of<ModelOrigin>();
template <>
std::span<const EnumName> names_of<UpAxis>();
template <>
std::span<const EnumName> names_of<SceneLight::Kind>();
template <>
std::span<const EnumName> names_of<BodyKind>();
template <>
std::span<const EnumName> names_of<HookKind>();
template <>
std::span<const EnumName> names_of<RopeDesc::StiffnessOf>();
template <>
std::span<const EnumName> names_of<ClothDesc::Bend>();
template <>
std::span<const EnumName> names_of<SolidDesc::Elasticity>();
template <>
std::span<const EnumName> names_of<ParticlesDesc::Direction>();
template <>
std::span<const EnumName> names_of<ParticlesDesc::Damping>();
template <>
std::span<const EnumName> names_of<SceneExpectation::Quantity>();
template <>
std::span<const EnumName> names_of<SceneExpectation::Op>();

}  // namespace hooke::io
