#include "build/build.h"
#include "build/common.h"
#include "build/connection_points.h"

#include <cmath>
#include <numbers>

namespace hooke::build {

namespace {

constexpr int kMostNodes = 65536;

Checks check(const RopeDesc& desc) {
  Checks checks("rope");
  checks
      .require(desc.stiffness_of <= RopeDesc::StiffnessOf::kSegment, "stiffness_of",
               "must be one of RopeDesc::StiffnessOf")
      .mass("total_mass", static_cast<double>(desc.total_mass))
      .stiffness("stiffness", static_cast<double>(desc.stiffness))
      .up_to("inner_friction", static_cast<double>(desc.inner_friction), limits::kResistance)
      .up_to("air_friction", static_cast<double>(desc.air_friction), limits::kResistance)
      .stiffness("extension_max", static_cast<double>(desc.extension_max))
      .up_to("bend_stiffness", static_cast<double>(desc.bend_stiffness), limits::kResistance)
      .up_to("bend_damping", static_cast<double>(desc.bend_damping), limits::kResistance)
      .up_to("twist_stiffness", static_cast<double>(desc.twist_stiffness), limits::kResistance)
      .in_range("twist", static_cast<double>(desc.twist), -limits::kSpin, limits::kSpin)
      .in_range("poisson_ratio", static_cast<double>(desc.poisson_ratio), -0.99, 0.5)
      .size("radius", static_cast<double>(desc.radius))
      .up_to("drag_coefficient", static_cast<double>(desc.drag_coefficient), 1e6)
      .up_to("repulsion_strength", static_cast<double>(desc.repulsion_strength), limits::kResistance)
      .size("repulsion_range", static_cast<double>(desc.repulsion_range))
      .in_range("charge", static_cast<double>(desc.charge), -1e9, 1e9)
      .velocity("velocity", desc.velocity)
      .in_range("contact.friction", static_cast<double>(desc.contact.friction), 0, 100)
      .require(desc.hit_speed >= Real(0), "hit_speed", static_cast<double>(desc.hit_speed),
               "must not be negative");
  if (desc.axial_stiffness) checks.stiffness("axial_stiffness", static_cast<double>(*desc.axial_stiffness));
  if (desc.strength) checks.positive("strength", static_cast<double>(*desc.strength));
  if (desc.young_modulus)
    checks.in_range("young_modulus", static_cast<double>(*desc.young_modulus), 1e-6, limits::kResistance);
  checks.require(!(desc.twist_stiffness > Real(0)) || desc.bend_stiffness > Real(0) || desc.young_modulus,
                 "twist_stiffness", "needs a bend_stiffness");
  if (desc.points.empty()) {
    checks.in_range("masses", desc.masses, 2, kMostNodes)
        .size("length_at_rest", static_cast<double>(desc.length_at_rest))
        .place("hook_point", desc.hook_point)
        .finite("direction", desc.direction)
        .require(length(vector_cast<double>(desc.direction)) > 0, "direction", "must not be zero");
  } else {
    checks.in_range("points", static_cast<double>(desc.points.size()), 2, kMostNodes);
  }
  for (std::size_t i = 0; i < desc.points.size(); ++i) {
    checks.place(indexed("points", i), desc.points[i]);
    const bool apart = i == 0 || length(desc.points[i] - desc.points[i - 1]) > 0;
    checks.require(apart, indexed("points", i), "equals the point before it");
  }
  const std::size_t count = desc.points.empty() ? static_cast<std::size_t>(desc.masses) : desc.points.size();
  check_points(checks, desc.pins, desc.loads, count);
  check_connection_points(checks, desc.connection_points, count);
  return checks;
}

std::vector<DVec3> node_positions(const RopeDesc& desc) {
  if (!desc.points.empty()) return desc.points;
  std::vector<DVec3> points;
  points.reserve(static_cast<std::size_t>(desc.masses));
  const DVec3 span =
      static_cast<double>(desc.length_at_rest) * normalize(vector_cast<double>(desc.direction));
  for (int i = 0; i < desc.masses; ++i) points.push_back(desc.hook_point + (i / (desc.masses - 1.0)) * span);
  return points;
}

/// Replaces the stiffnesses by those of a round rod if a material is given: EA, EI and GJ.
RopeDesc of_material(const RopeDesc& given) {
  RopeDesc desc = given;
  if (!given.young_modulus) return desc;
  const auto e = static_cast<double>(*given.young_modulus);
  const auto r = static_cast<double>(given.radius);
  const double g = 0.5 * e / (1 + static_cast<double>(given.poisson_ratio));
  const double area = std::numbers::pi * r * r;
  desc.axial_stiffness = static_cast<Real>(e * area);
  desc.stiffness_of = RopeDesc::StiffnessOf::kRope;
  desc.bend_stiffness = static_cast<Real>(e * area * r * r / 4);
  desc.twist_stiffness = static_cast<Real>(g * area * r * r / 2);
  return desc;
}

void append_segments(const RopeDesc& desc, const std::vector<double>& lengths, double total,
                     state::Tables& tables) {
  const double stiffness = desc.axial_stiffness ? static_cast<double>(*desc.axial_stiffness) / total
                                                : static_cast<double>(desc.stiffness);
  for (const double length : lengths) {
    // Segments are springs in series: one with a share of the length is stiffer than the whole by the inverse
    // of that share.
    const double stiffer = desc.stiffness_of == RopeDesc::StiffnessOf::kRope ? total / length : 1.0;
    state::Segments& s = tables.segments;
    s.rest_length.push_back(static_cast<Real>(length));
    s.stiffness.push_back(static_cast<Real>(stiffer * stiffness));
    s.damping.push_back(static_cast<Real>(stiffer * static_cast<double>(desc.inner_friction)));
    s.length_limit.push_back(static_cast<Real>(length * (1.0 + static_cast<double>(desc.extension_max))));
    s.tension.push_back(Real(0));
    s.mean_tension.push_back(Real(0));
    s.limited.push_back(0);
    s.clamped.push_back(0);
    s.hold.push_back(state::SegmentHold::kHolds);
    s.needed_force.push_back(Real(0));
    s.broke_at.push_back(0);
    ++tables.objects.back().segments.count;
  }
}

state::NamedPlaces standard_connection_points(std::size_t count) {
  const auto last = static_cast<std::uint32_t>(count) - 1;
  const std::uint32_t half = last / 2;
  state::NamedPlace middle = named_point("middle", half);
  if (last % 2 != 0) {
    middle.points[1] = half + 1;
    middle.weights = {Real(0.5), Real(0.5)};
  }
  return {named_point("start", 0), middle, named_point("end", last)};
}

}  // namespace

Result<void> add_rope(const RopeDesc& given, state::Tables& tables) {
  const Checks checks = check(given);
  if (!checks.good()) return checks.result();
  const RopeDesc desc = of_material(given);

  const std::vector<DVec3> nodes = node_positions(desc);
  std::vector<double> lengths;
  double total = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    lengths.push_back(length(nodes[i] - nodes[i - 1]));
    total += lengths.back();
  }

  Points points(nodes.size());
  points.position = nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double before = i > 0 ? lengths[i - 1] : 0.0;
    const double after = i < lengths.size() ? lengths[i] : 0.0;
    const double share = 0.5 * (before + after) / total;
    points.velocity[i] = desc.velocity;
    points.mass[i] = static_cast<Real>(share * static_cast<double>(desc.total_mass));
    points.charge[i] = static_cast<Real>(share * static_cast<double>(desc.charge));
    points.viscous_drag[i] = static_cast<Real>(share * static_cast<double>(desc.air_friction));
    points.radius[i] = desc.radius;
  }
  add_loads(desc.loads, points.mass);

  state::Deformable& object = append_object(PointRef::Kind::kRope, points, desc.pins, tables);
  object.friction = desc.contact.friction;
  report_contacts(desc.reports_contacts, desc.hit_speed, tables);
  object.strength = desc.strength.value_or(kRigid);
  object.touches_ropes = desc.touches_ropes;
  object.touches_surfaces = desc.touches_surfaces;
  object.surface = {.rest_points = {},
                    .self_contact = false,
                    .filter = desc.filter,
                    .radius = desc.radius,
                    .self_distance = Real(0),
                    .edge = static_cast<Real>(total / static_cast<double>(lengths.size()))};
  object.repulsion_strength = desc.repulsion_strength;
  object.repulsion_range = desc.repulsion_range;
  object.bend_stiffness = desc.bend_stiffness;
  object.bend_damping = desc.bend_damping;
  object.twist_stiffness = desc.twist_stiffness;
  object.twist_rate = static_cast<Real>(static_cast<double>(desc.twist) / total);
  object.drag_coefficient = desc.drag_coefficient;
  append_segments(desc, lengths, total, tables);
  append_connection_points(desc.connection_points, {}, standard_connection_points(points.position.size()),
                           tables);
  return {};
}

}  // namespace hooke::build
