#include "build/build.h"
#include "build/checks.h"

namespace hooke::build {

Result<void> validate(const WindDesc& wind) {
  return Checks("wind")
      .finite("velocity", wind.velocity)
      .in_range("gust", static_cast<double>(wind.gust), 0, 10)
      .in_range("side_gust", static_cast<double>(wind.side_gust), 0, 10)
      .positive("correlation_time", static_cast<double>(wind.correlation_time))
      .positive("correlation_length", static_cast<double>(wind.correlation_length))
      .not_negative("air_density", static_cast<double>(wind.air_density))
      .result();
}

Result<void> validate(const WorldDesc& desc) {
  const Checks checks =
      Checks("world")
          .finite("gravity", desc.gravity)
          .in_range("substeps", desc.substeps, 1, 64)
          .in_range("particle_substeps", desc.particle_substeps, 1, 64)
          .in_range("workers", desc.workers, 1, 64)
          .in_range("contact_hz", static_cast<double>(desc.contact_hz), 0.1, 1000)
          .in_range("contact_damping_ratio", static_cast<double>(desc.contact_damping_ratio), 0.01, 100)
          .in_range("bias_sweeps", desc.bias_sweeps, 1, 8);
  if (!checks.good()) return checks.result();
  Result<void> wind = validate(desc.wind);
  if (wind) return wind;
  Error error = wind.error();
  error.where = "world." + error.where;
  return error;
}

Result<void> validate(const FieldDesc& field) {
  Checks checks("field");
  checks.finite("vector", field.vector)
      .place("center", field.center)
      .finite("strength", field.strength)
      .in_range("reach", field.reach, 1e-6, 1e9)
      .in_range("falloff", field.falloff, 0, 8)
      .in_range("height", field.height, -1e9, 1e9)
      .in_range("density", field.density, 0, 1e6)
      .in_range("drag", field.drag, 0, 1e6)
      .finite("time", field.time);
  const double size = length(vector_cast<double>(field.vector));
  if (field.kind == FieldDesc::Kind::kVortex)
    checks.require(size >= 1e-6 && size <= 1e6, "vector", "must be an axis, 1e-6 to 1e6 long");
  if (field.kind == FieldDesc::Kind::kDipole)
    checks.require(size <= 1e9, "vector", "must be at most 1e9 long");
  if (field.kind == FieldDesc::Kind::kMagnetic) {
    checks.in_range("strength", field.strength, -1e9, 1e9)
        .require(size > 0 || field.strength == 0, "vector", "must say along which axis the field changes");
  }
  return checks.result();
}

Result<void> validate(const MotionDesc& motion, const std::string& where) {
  Checks checks(where);
  checks.finite("velocity", motion.velocity)
      .finite("amplitude", motion.amplitude)
      .not_negative("frequency_hz", static_cast<double>(motion.frequency_hz))
      .finite("phase", static_cast<double>(motion.phase));
  if (motion.kind == MotionDesc::Kind::kKeyframes) {
    checks.require(!motion.keyframes.empty(), "keyframes", "needs at least one keyframe");
  }
  for (std::size_t i = 0; i < motion.keyframes.size(); ++i) {
    const std::string key = indexed("keyframes", i);
    checks.finite(key + ".time", motion.keyframes[i].time)
        .finite(key + ".offset", motion.keyframes[i].offset);
    const bool later = i == 0 || motion.keyframes[i].time > motion.keyframes[i - 1].time;
    checks.require(later, key + ".time", motion.keyframes[i].time,
                   "must be later than the keyframe before it");
  }
  return checks.result();
}

}  // namespace hooke::build
