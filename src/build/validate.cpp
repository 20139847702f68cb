#include "build/build.h"
#include "build/checks.h"

namespace hooke::build {

namespace {

double most_strength(FieldDesc::Kind kind) {
  switch (kind) {
    case FieldDesc::Kind::kSuction:
    case FieldDesc::Kind::kVortex:
      return limits::kAcceleration;
    case FieldDesc::Kind::kExplosion:
      return limits::kSpeed;
    case FieldDesc::Kind::kInverseSquare:
      return 1e30;
    default:
      return 1e9;
  }
}

double most_vector(FieldDesc::Kind kind) {
  if (kind == FieldDesc::Kind::kUniform) return limits::kAcceleration;
  return kind == FieldDesc::Kind::kLiquid ? limits::kSpeed : 1e30;
}

}  // namespace

Result<void> validate(const WindDesc& wind) {
  return Checks("wind")
      .require(wind.gusts <= WindDesc::Gusts::kPaper, "gusts", "must be one of WindDesc::Gusts")
      .velocity("velocity", wind.velocity)
      .in_range("gust", static_cast<double>(wind.gust), 0, 10)
      .in_range("side_gust", static_cast<double>(wind.side_gust), 0, 10)
      .in_range("correlation_time", static_cast<double>(wind.correlation_time), 1e-6, 1e9)
      .in_range("correlation_length", static_cast<double>(wind.correlation_length), 1e-6, 1e9)
      .up_to("air_density", static_cast<double>(wind.air_density), 1e6)
      .result();
}

Result<void> validate(const WorldDesc& desc) {
  Checks checks =
      Checks("world")
          .within("gravity", desc.gravity, limits::kAcceleration)
          .in_range("substeps", desc.substeps, 1, 64)
          .in_range("particle_substeps", desc.particle_substeps, 1, 64)
          .in_range("workers", desc.workers, 1, 64)
          .in_range("contact_hz", static_cast<double>(desc.contact_hz), 0.1, 1000)
          .in_range("contact_damping_ratio", static_cast<double>(desc.contact_damping_ratio), 0.01, 100)
          .in_range("bias_sweeps", desc.bias_sweeps, 1, 8);
  for (std::size_t i = 0; i < desc.materials.size() && checks.good(); ++i) {
    const MaterialPairDesc& pair = desc.materials[i];
    const std::string where = indexed("materials", i);
    const Real at_rest = pair.static_friction.value_or(pair.friction);
    checks.in_range(where + ".friction", static_cast<double>(pair.friction), 0, 100)
        .in_range(where + ".static_friction", static_cast<double>(at_rest), 0, 100)
        .in_range(where + ".restitution", static_cast<double>(pair.restitution), 0, 1);
  }
  if (!checks.good()) return checks.result();
  Result<void> wind = validate(desc.wind);
  if (wind) return wind;
  Error error = wind.error();
  error.where = "world." + error.where;
  return error;
}

Result<void> validate(const FieldDesc& field) {
  Checks checks("field");
  using Kind = FieldDesc::Kind;
  checks.require(field.kind <= Kind::kDipole, "kind", "must be one of FieldDesc::Kind");
  checks.within("vector", field.vector, most_vector(field.kind))
      .place("center", field.center)
      .in_range("strength", field.strength, -most_strength(field.kind), most_strength(field.kind))
      .in_range("reach", field.reach, 1e-6, 1e9)
      .in_range("falloff", field.falloff, 0, 8)
      .in_range("height", field.height, -1e9, 1e9)
      .in_range("density", field.density, 0, 1e6)
      .in_range("drag", field.drag, 0, 1e6)
      .in_range("time", field.time, -1e15, 1e15);
  const double size = length(vector_cast<double>(field.vector));
  if (field.kind == FieldDesc::Kind::kVortex)
    checks.require(size >= 1e-6 && size <= 1e6, "vector", "must be an axis, 1e-6 to 1e6 long");
  if (field.kind == FieldDesc::Kind::kDipole)
    checks.require(size <= 1e9, "vector", "must be at most 1e9 long");
  if (field.kind == FieldDesc::Kind::kMagnetic) {
    checks.require(size > 0 || field.strength == 0, "vector", "must say along which axis the field changes");
  }
  return checks.result();
}

Result<void> validate(const MotionDesc& motion, const std::string& where) {
  Checks checks(where);
  checks.require(motion.kind <= MotionDesc::Kind::kKeyframes, "kind", "must be one of MotionDesc::Kind");
  constexpr double kTurn = 6.283185307179586;
  checks.velocity("velocity", motion.velocity)
      .within("amplitude", motion.amplitude, limits::kPlace)
      .up_to("frequency_hz", static_cast<double>(motion.frequency_hz), limits::kSpin)
      .in_range("phase", static_cast<double>(motion.phase), -limits::kSpin, limits::kSpin);
  if (motion.kind == MotionDesc::Kind::kSine) {
    const DVec3 fastest =
        kTurn * static_cast<double>(motion.frequency_hz) * vector_cast<double>(motion.amplitude);
    checks.velocity("amplitude", fastest);
  }
  if (motion.kind == MotionDesc::Kind::kKeyframes) {
    checks.require(!motion.keyframes.empty(), "keyframes", "needs at least one keyframe");
  }
  for (std::size_t i = 0; i < motion.keyframes.size(); ++i) {
    const std::string key = indexed("keyframes", i);
    checks.in_range(key + ".time", motion.keyframes[i].time, -1e15, 1e15)
        .within(key + ".offset", motion.keyframes[i].offset, limits::kPlace);
    const bool later = i == 0 || motion.keyframes[i].time > motion.keyframes[i - 1].time;
    checks.require(later, key + ".time", motion.keyframes[i].time,
                   "must be later than the keyframe before it");
  }
  return checks.result();
}

}  // namespace hooke::build
