#include "build/common.h"

#include "base/assert.h"
#include "build/build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

namespace hooke::build {

namespace {

DVec3 rounded_middle(const std::vector<DVec3>& points) {
  DVec3 low = points.front();
  DVec3 high = points.front();
  for (const DVec3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const DVec3 middle = 0.5 * (low + high);
  return {std::floor(middle.x + 0.5), std::floor(middle.y + 0.5), std::floor(middle.z + 0.5)};
}

}  // namespace

Points::Points(std::size_t count)
    : position(count),
      velocity(count),
      mass(count),
      charge(count),
      viscous_drag(count),
      drag_area(count),
      radius(count),
      row_of(count) {
  std::iota(row_of.begin(), row_of.end(), 0U);
}

void check_points(Checks& checks, const std::vector<PinDesc>& pins, const std::vector<LoadDesc>& loads,
                  std::size_t count) {
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const std::string where = indexed("pins", i);
    checks.in_range(where + ".point", pins[i].point, 0, static_cast<double>(count) - 1);
    const Result<void> motion = validate(pins[i].motion, "motion");
    if (!motion) checks.require(false, where + "." + motion.error().where, motion.error().message.c_str());
  }
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::string where = indexed("loads", i);
    checks.in_range(where + ".point", loads[i].point, 0, static_cast<double>(count) - 1);
    checks.up_to(where + ".mass", static_cast<double>(loads[i].mass), limits::kMass);
  }
}

void add_loads(const std::vector<LoadDesc>& loads, std::vector<Real>& mass) {
  for (const LoadDesc& load : loads) mass[load.point] += load.mass;
}

state::Deformable& append_object(PointRef::Kind kind, const Points& points, const std::vector<PinDesc>& pins,
                                 state::Tables& tables) {
  const auto count = static_cast<std::uint32_t>(points.position.size());
  HOOKE_ASSERT(count > 0 && points.row_of.size() == count && points.mass.size() == count);
  state::Particles& particles = tables.particles;
  state::Deformable object;
  object.kind = kind;
  object.origin = rounded_middle(points.position);
  object.particles = {static_cast<std::uint32_t>(particles.count()), count};
  object.springs = {static_cast<std::uint32_t>(tables.springs.count()), 0};
  object.bends = {static_cast<std::uint32_t>(tables.bends.count()), 0};
  object.triangles = {static_cast<std::uint32_t>(tables.triangles.count()), 0};
  object.segments = {static_cast<std::uint32_t>(tables.segments.count()), 0};
  object.tetrahedra = {static_cast<std::uint32_t>(tables.tetrahedra.count()), 0};

  const std::size_t first = object.particles.first;
  state::Particles::for_each_column(particles, [&](auto& column) { column.resize(first + count); });
  for (std::uint32_t i = 0; i < count; ++i) {
    HOOKE_ASSERT(points.row_of[i] < count && !(points.mass[i] < Real(0)));
    const std::size_t row = first + points.row_of[i];
    particles.row_of[first + i] = points.row_of[i];
    particles.position[row] = {vector_cast<Real>(points.position[i] - object.origin), points.radius[i]};
    particles.velocity[row] = {points.velocity[i], Real(1) / points.mass[i]};
    particles.mass[row] = points.mass[i];
    particles.charge[row] = points.charge[i];
    particles.viscous_drag[row] = points.viscous_drag[i];
    particles.drag_area[row] = points.drag_area[i];
    object.points_drag =
        object.points_drag || points.viscous_drag[i] > Real(0) || points.drag_area[i] > Real(0);
  }

  const auto object_row = static_cast<std::uint32_t>(tables.objects.size());
  for (const PinDesc& pin : pins) {
    HOOKE_ASSERT(pin.point < count);
    const auto row = static_cast<std::uint32_t>(first + points.row_of[pin.point]);
    if (particles.velocity[row].inverse_mass == Real(0)) continue;  // Of two pins the first one counts.
    particles.velocity[row] = {};
    tables.pins.push_back({object_row, row, points.position[pin.point], tables.time, pin.motion});
  }
  std::sort(tables.pins.begin(), tables.pins.end(),
            [](const state::Pin& a, const state::Pin& b) { return a.particle < b.particle; });
  state::note_change(tables, object);
  tables.objects.push_back(object);
  return tables.objects.back();
}

void report_contacts(bool contacts, Real hit_speed, state::Tables& tables) {
  tables.objects.back().reports_contacts = contacts;
  tables.objects.back().hit_speed = hit_speed;
  tables.any_deformable_reports = tables.any_deformable_reports || contacts || std::isfinite(hit_speed);
}

void append_spring(const SpringRow& spring, state::Tables& tables) {
  state::Deformable& object = tables.objects.back();
  state::Springs& springs = tables.springs;
  HOOKE_ASSERT(spring.a != spring.b && std::max(spring.a, spring.b) < object.particles.count);
  HOOKE_ASSERT(object.springs.end() == springs.particle_a.size());  // no other object has got any since
  springs.particle_a.push_back(row_of(tables, object, spring.a));
  springs.particle_b.push_back(row_of(tables, object, spring.b));
  springs.rest_length.push_back(spring.rest_length);
  springs.stiffness.push_back(spring.stiffness);
  springs.damping.push_back(spring.damping);
  springs.damped_mass.push_back(spring.damped_mass);
  springs.kind.push_back(spring.kind);
  springs.form.push_back(spring.form);
  ++object.springs.count;
}

Result<state::Surface> surface_for_contact(const SurfaceDesc& desc, const Points& points,
                                           const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                           const char* where) {
  const std::vector<DVec3>& x = points.position;
  double sum = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : triangles) {
    for (const double edge : {length(x[b] - x[a]), length(x[c] - x[b]), length(x[a] - x[c])}) {
      sum += edge;
      shortest = std::min(shortest, edge);
    }
  }
  if (triangles.empty()) return state::Surface{};
  const double mean = sum / (3 * static_cast<double>(triangles.size()));
  const auto thickness = static_cast<double>(desc.thickness);
  if (desc.self_contact && thickness > 0.5 * mean) {
    return Error{ErrorCode::kOutOfRange, where,
                 "must be at most half of the mean edge, " + std::to_string(0.5 * mean) +
                     " m, for contact with itself"};
  }
  auto rest = std::make_shared<std::vector<Vec3>>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) (*rest)[points.row_of[i]] = vector_cast<Real>(x[i] - x[0]);
  return state::Surface{.rest_points = std::move(rest),
                        .self_contact = desc.self_contact,
                        .filter = desc.filter,
                        .radius = static_cast<Real>(0.5 * std::min(thickness, 0.5 * mean)),
                        .self_distance = static_cast<Real>(std::min(thickness, 0.5 * shortest)),
                        .edge = static_cast<Real>(mean)};
}

}  // namespace hooke::build
