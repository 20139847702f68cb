#include "lab/system/laws.h"
#include "lab/system/system.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace hooke::lab {

namespace {

double number(Real value) {
  return static_cast<double>(value);
}

const char* noun(PointRef::Kind kind) {
  if (kind == PointRef::Kind::kNone) return "body";
  if (kind == PointRef::Kind::kRope) return "rope";
  if (kind == PointRef::Kind::kSolid) return "solid";
  return kind == PointRef::Kind::kCloth ? "cloth" : "particles";
}

Error rigid(const state::Deformable& object, const char* row, std::size_t index) {
  return {ErrorCode::kUnsupported, std::string(noun(object.kind)) + " " + std::to_string(object.slot),
          std::string(row) + " " + std::to_string(index) +
              " is rigid; the laboratory needs a finite stiffness, for a rigid spring has no force law"};
}

constexpr double kWeight = 9.81;    ///< Of one kilogram [N].
constexpr double kShortest = 1e-3;  ///< Of a rigid spring, as its stiffness counts [m].

}  // namespace

std::string System::name() const {
  return std::string(noun(kind_)) + " " + std::to_string(slot_);
}

Result<System> System::create(const state::Tables& tables, std::uint32_t object_row,
                              const Replacement& replacement) {
  const state::Deformable& object = tables.objects[object_row];
  const bool is_solid = object.kind == PointRef::Kind::kSolid;
  if (is_solid && !replacement.solids_stand) {
    return Error{ErrorCode::kUnsupported, std::string(noun(object.kind)) + " " + std::to_string(object.slot),
                 "is a solid; the laboratory has none"};
  }
  System system;
  system.kind_ = object.kind;
  system.slot_ = object.slot;
  system.wind_ = tables.desc.wind;
  system.wind_step_ = tables.step_count;
  system.feels_air_ = object.feels_air();
  if (is_solid) {
    system.let_stand(tables, object);
    return system;
  }
  system.add_points(tables, object);
  const double stretch = replacement.rigid_stretch;
  if (const auto added = system.add_springs(tables, object, stretch); !added) return added.error();
  if (const auto added = system.add_segments(tables, object, stretch); !added) return added.error();
  system.add_bends(tables, object);
  system.add_air(tables, object);
  const auto asks = [](const state::ForceLawEntry& entry) { return entry.law != nullptr; };
  if (std::any_of(tables.force_laws.begin(), tables.force_laws.end(), asks))
    system.laws_ = std::make_shared<Laws>(tables, object_row);
  system.note(tables, object);
  return system;
}

/// Adds the fields that act on all points and bodies alike; centers of attraction go to their own list.
PointRow System::add_fields(const state::Tables& tables) {
  auto attractors = std::make_shared<std::vector<FieldDesc>>();
  PointRow all = {.uniform = vector_cast<double>(tables.desc.gravity)};
  for (const state::Field& field : tables.fields) {
    const DVec3 vector = vector_cast<double>(field.desc.vector);
    if (field.desc.kind == FieldDesc::Kind::kUniform) all.uniform += vector;
    if (field.desc.kind == FieldDesc::Kind::kMagnetic) all.magnetic += vector;
    if (field.desc.kind == FieldDesc::Kind::kInverseSquare) attractors->push_back(field.desc);
  }
  all.attractors = attractors.get();
  attractors_ = std::move(attractors);
  return all;
}

void System::note_fields(const state::Tables& tables) {
  const auto unknown = [](const state::Field& field) {
    const bool magnetic = field.desc.kind == FieldDesc::Kind::kMagnetic;
    return field.desc.kind > FieldDesc::Kind::kMagnetic || (magnetic && field.desc.strength != 0);
  };
  if (std::any_of(tables.fields.begin(), tables.fields.end(), unknown)) {
    left_out_.emplace_back(
        "liquids, suction, vortices, explosions, dipoles and magnetic gradients: the laboratory has none");
  }
}

void System::add_points(const state::Tables& tables, const state::Deformable& object) {
  const state::Particles& p = tables.particles;
  const PointRow all = add_fields(tables);
  for (std::uint32_t row = 0; row < object.particles.count; ++row) {
    const std::size_t i = object.particles.first + row;
    const bool held = !(p.velocity[i].inverse_mass > Real(0));
    start_x_.push_back(object.origin + vector_cast<double>(p.position[i].x));
    start_v_.push_back(vector_cast<double>(p.velocity[i].v));
    mass_.push_back(number(p.mass[i]));
    radius_.push_back(number(p.position[i].radius));
    free_of_row_.push_back(held ? kHeld : static_cast<int>(free_rows_.size()));
    if (held) continue;
    free_rows_.push_back(row);
    PointRow point = all;
    point.at = {row};
    point.mass = mass_.back();
    point.charge = number(p.charge[i]);
    if (object.points_drag) {
      point.viscous = number(p.viscous_drag[i]);
      point.half_rho_area = number(tables.desc.wind.air_density) * number(p.drag_area[i]);
    }
    points_.push_back(point);
  }
  coordinates_ = 3 * static_cast<Eigen::Index>(free_rows_.size());
  const auto first = p.row_of.begin() + object.particles.first;
  row_of_point_.assign(first, first + object.particles.count);
  pins_.resize(object.particles.count);
  for (const state::Pin& pin : tables.pins) {
    const std::uint32_t row = pin.particle - object.particles.first;
    // The index is unsigned, so that this also excludes rows before the object.
    if (row < object.particles.count) pins_[row] = pin;
  }
}

void System::let_stand(const state::Tables& tables, const state::Deformable& object) {
  const state::Particles& p = tables.particles;
  for (std::uint32_t row = 0; row < object.particles.count; ++row) {
    const std::size_t i = object.particles.first + row;
    start_x_.push_back(object.origin + vector_cast<double>(p.position[i].x));
    start_v_.emplace_back();
    mass_.push_back(number(p.mass[i]));
    radius_.push_back(number(p.position[i].radius));
    free_of_row_.push_back(kHeld);
  }
  const auto first = p.row_of.begin() + object.particles.first;
  row_of_point_.assign(first, first + object.particles.count);
  pins_.resize(object.particles.count);
  note_fields(tables);
  left_out_.emplace_back("the whole solid, which stands still: the laboratory has no forces of solids");
}

double System::stiffness_of_rigid(double rest_length, double rigid_stretch) const {
  double mass = 0;
  for (const std::uint32_t row : free_rows_) mass += mass_[row];
  return mass * kWeight / (rigid_stretch * std::max(rest_length, kShortest));
}

void System::note_rigid(const char* rows, int count, double stiffness, double rigid_stretch) {
  if (count == 0) return;
  char text[160];
  std::snprintf(text, sizeof(text),
                "%d rigid %s: springs stand for them, of up to %.3g N/m, which the object's weight stretches "
                "by %.3g %%",
                count, rows, stiffness, 100 * rigid_stretch);
  left_out_.emplace_back(text);
}

Result<void> System::add_springs(const state::Tables& tables, const state::Deformable& object,
                                 double rigid_stretch) {
  const state::Springs& s = tables.springs;
  bool limits = false;
  int rigid_rows = 0;
  double stiffest = 0;
  for (std::uint32_t i = 0; i < object.springs.count; ++i) {
    const std::size_t row = object.springs.first + i;
    const bool holds =
        s.kind[row] == state::SpringClass::kTether || s.kind[row] == state::SpringClass::kLimit;
    limits = limits || holds;
    if (holds) continue;
    double stiffness = number(s.stiffness[row]);
    if (std::isinf(stiffness)) {
      if (!(rigid_stretch > 0)) return rigid(object, "spring", i);
      stiffness = stiffness_of_rigid(number(s.rest_length[row]), rigid_stretch);
      stiffest = std::max(stiffest, stiffness);
      ++rigid_rows;
    }
    const bool isotropic = s.form[row] == state::SpringForm::kExplicitIsotropic ||
                           s.form[row] == state::SpringForm::kPredictedIsotropic;
    springs_.push_back(
        {.at = {s.particle_a[row] - object.particles.first, s.particle_b[row] - object.particles.first},
         .spring = {stiffness, number(s.damping[row]), number(s.rest_length[row]), isotropic}});
    spring_names_.push_back("spring " + std::to_string(i));
  }
  note_rigid("springs", rigid_rows, stiffest, rigid_stretch);
  if (limits) left_out_.emplace_back("limits of extension and tethers: they have no force law");
  return {};
}

Result<void> System::add_segments(const state::Tables& tables, const state::Deformable& object,
                                  double rigid_stretch) {
  const state::Segments& s = tables.segments;
  bool limits = false;
  int rigid_rows = 0;
  double stiffest = 0;
  for (std::uint32_t i = 0; i < object.segments.count; ++i) {
    const std::size_t row = object.segments.first + i;
    if (!s.joins(row)) continue;
    double stiffness = number(s.stiffness[row]);
    if (std::isinf(stiffness)) {
      if (!(rigid_stretch > 0)) return rigid(object, "segment", i);
      stiffness = stiffness_of_rigid(number(s.rest_length[row]), rigid_stretch);
      stiffest = std::max(stiffest, stiffness);
      ++rigid_rows;
    }
    limits = limits || !std::isinf(s.length_limit[row]);
    springs_.push_back(
        {.at = {i, i + 1}, .spring = {stiffness, number(s.damping[row]), number(s.rest_length[row]), false}});
    spring_names_.push_back("segment " + std::to_string(i));
  }
  note_rigid("segments", rigid_rows, stiffest, rigid_stretch);
  if (limits) left_out_.emplace_back("limits of extension: they have no force law");
  return {};
}

void System::add_bends(const state::Tables& tables, const state::Deformable& object) {
  const std::uint32_t first = object.particles.first;
  for (std::uint32_t i = object.bends.first; i < object.bends.end(); ++i) {
    const state::Bends::Stencil& s = tables.bends.stencil[i];
    const std::array<std::uint32_t, 4> at = {s.edge_a - first, s.edge_b - first, s.wing_a - first,
                                             s.wing_b - first};
    const double stiffness = number(state::stiffness_beside_clamp(tables.bends, i, tables.particles));
    const double damping = number(tables.bends.damping[i]);
    if (tables.bends.is_isometric(i)) {
      curvatures_.push_back({at, stiffness, damping, tables.bends.weights_of(i)});
    } else {
      bends_.push_back({at, stiffness, damping, number(tables.bends.rest_angle[i])});
    }
  }
}

void System::add_air(const state::Tables& tables, const state::Deformable& object) {
  const double density = number(tables.desc.wind.air_density);
  const double drag = number(object.drag_coefficient);
  const double lift = number(object.lift_coefficient);
  if (!(density > 0) || !(drag > 0 || lift > 0)) return;
  for (std::uint32_t i = object.triangles.first; i < object.triangles.end(); ++i) {
    const auto [a, b, c] = tables.triangles.corners[i];
    const std::uint32_t first = object.particles.first;
    sails_.push_back(
        {.at = {a - first, b - first, c - first}, .density = density, .drag = drag, .lift = lift});
  }
  for (std::uint32_t i = 0; i < object.segments.count; ++i) {
    if (!tables.segments.joins(object.segments.first + i)) continue;
    const double length = number(tables.segments.rest_length[object.segments.first + i]);
    strands_.push_back({.at = {i, i + 1}, .half_rho_area = density * drag * radius_[i] * length});
  }
}

/// Notes what the methods must know of the forces as a whole.
void System::note(const state::Tables& tables, const state::Deformable& object) {
  const WindDesc& wind = tables.desc.wind;
  gusts_ = object.feels_air() && (wind.gust != Real(0) || wind.side_gust != Real(0));
  if (gusts_ && wind.gusts == WindDesc::Gusts::kPaper)
    left_out_.emplace_back("the change of the paper's gusts: they are drawn per step of a World, here once");
  bool damped = object.feels_air() || laws_ != nullptr;
  for (const SpringRow& row : springs_) damped = damped || row.spring.damping > 0;
  for (const BendRow& row : bends_) damped = damped || row.damping > 0;
  for (const CurvatureRow& row : curvatures_) damped = damped || row.damping > 0;
  for (const PointRow& row : points_) damped = damped || (row.charge != 0 && row.magnetic != DVec3{});
  velocity_dependent_ = damped;
  ballistic_ = !damped && springs_.empty() && bends_.empty() && curvatures_.empty() && attractors_->empty();
  note_fields(tables);
  const auto holds_point = [&](const state::HookPlace& place) {
    // The index is unsigned, so that this also excludes particles before the object.
    return place.is_point() && place.particle[0] - object.particles.first < object.particles.count;
  };
  const auto held = std::count_if(tables.hooks.begin(), tables.hooks.end(), [&](const state::Hook& hook) {
    return !hook.broken && (holds_point(hook.a) || holds_point(hook.b));
  });
  if (held > 0)
    left_out_.emplace_back(std::to_string(held) + " hooks at its points: objects do not act on one another");
  if (object.yield_angle < kRigid) left_out_.emplace_back("folds that stay: bends are elastic here");
  if (tables.any_force) left_out_.emplace_back("forces of World::apply_force: they last one step of a World");
}

}  // namespace hooke::lab
