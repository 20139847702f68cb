#include "build/build.h"
#include "build/common.h"
#include "build/connection_points.h"

#include <numbers>

namespace hooke::build {

namespace {

constexpr std::size_t kMostParticles = std::size_t{1} << 24;

Checks check(const ParticlesDesc& desc) {
  Checks checks("particles");
  const std::size_t count = desc.particles.size();
  checks
      .require(desc.direction <= ParticlesDesc::Direction::kPredicted, "direction",
               "must be one of ParticlesDesc::Direction")
      .require(desc.damping <= ParticlesDesc::Damping::kIsotropic, "damping",
               "must be one of ParticlesDesc::Damping")
      .in_range("particles", static_cast<double>(count), 1, static_cast<double>(kMostParticles))
      .up_to("air_friction", static_cast<double>(desc.air_friction), limits::kResistance)
      .up_to("drag_coefficient", static_cast<double>(desc.drag_coefficient), 1e6)
      .in_range("contact.friction", static_cast<double>(desc.contact.friction), 0, 100)
      .require(desc.hit_speed >= Real(0), "hit_speed", static_cast<double>(desc.hit_speed),
               "must not be negative");
  for (std::size_t i = 0; i < count && checks.good(); ++i) {
    const ParticleDesc& p = desc.particles[i];
    const std::string where = indexed("particles", i);
    checks.place(where + ".position", p.position)
        .velocity(where + ".velocity", p.velocity)
        .mass(where + ".mass", static_cast<double>(p.mass))
        .in_range(where + ".charge", static_cast<double>(p.charge), -1e9, 1e9)
        .size(where + ".radius", static_cast<double>(p.radius));
  }
  for (std::size_t i = 0; i < desc.springs.size() && checks.good(); ++i) {
    const SpringDesc& s = desc.springs[i];
    const std::string where = indexed("springs", i);
    const double last = static_cast<double>(count) - 1;
    checks.in_range(where + ".a", s.a, 0, last)
        .in_range(where + ".b", s.b, 0, last)
        .require(s.a != s.b, where + ".b", "joins a particle to itself")
        .stiffness_or_none(where + ".stiffness", static_cast<double>(s.stiffness))
        .up_to(where + ".damping", static_cast<double>(s.damping), limits::kResistance);
    if (s.rest_length)
      checks.up_to(where + ".rest_length", static_cast<double>(*s.rest_length), limits::kPlace);
  }
  check_points(checks, desc.pins, {}, count);
  check_connection_points(checks, desc.connection_points, count);
  return checks;
}

state::SpringForm form_of(const ParticlesDesc& desc) {
  const bool predicted = desc.direction == ParticlesDesc::Direction::kPredicted;
  if (desc.damping == ParticlesDesc::Damping::kIsotropic) {
    return predicted ? state::SpringForm::kPredictedIsotropic : state::SpringForm::kExplicitIsotropic;
  }
  return predicted ? state::SpringForm::kPredicted : state::SpringForm::kExplicit;
}

state::NamedPlaces standard_connection_points(const ParticlesDesc& desc) {
  if (desc.particles.size() == 1) return {named_point("center", 0)};
  if (desc.springs.empty()) return {};
  return {named_point("start", desc.springs.front().a), named_point("end", desc.springs.back().b)};
}

}  // namespace

Result<void> add_particles(const ParticlesDesc& desc, state::Tables& tables) {
  const Checks checks = check(desc);
  if (!checks.good()) return checks.result();

  Points points(desc.particles.size());
  for (std::size_t i = 0; i < desc.particles.size(); ++i) {
    const ParticleDesc& p = desc.particles[i];
    points.position[i] = p.position;
    points.velocity[i] = p.velocity;
    points.mass[i] = p.mass;
    points.charge[i] = p.charge;
    points.radius[i] = p.radius;
    points.viscous_drag[i] = desc.air_friction;
    points.drag_area[i] = Real(0.5) * desc.drag_coefficient * std::numbers::pi_v<Real> * p.radius * p.radius;
  }
  state::Deformable& object = append_object(PointRef::Kind::kParticles, points, desc.pins, tables);
  object.friction = desc.contact.friction;
  report_contacts(desc.reports_contacts, desc.hit_speed, tables);
  for (const SpringDesc& s : desc.springs) {
    const double distance = length(desc.particles[s.a].position - desc.particles[s.b].position);
    append_spring({.a = s.a,
                   .b = s.b,
                   .rest_length = s.rest_length.value_or(static_cast<Real>(distance)),
                   .stiffness = s.stiffness,
                   .damping = s.damping,
                   .kind = state::SpringClass::kStretch,
                   .form = form_of(desc)},
                  tables);
  }
  append_connection_points(desc.connection_points, {}, standard_connection_points(desc), tables);
  return {};
}

}  // namespace hooke::build
