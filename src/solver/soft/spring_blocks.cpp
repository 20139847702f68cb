#include "solver/soft/spring_blocks.h"

#include "base/assert.h"
#include "base/counting_sort.h"
#include "solver/soft/soft_tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace hooke::solver {

namespace {

using state::SpringClass;

/// The position of a row: passes are sorted by class, then color, then material.
struct Place {
  SpringClass kind = SpringClass::kStretch;
  int color = 0;
  std::uint32_t material = 0;
  std::uint32_t row = 0;

  [[nodiscard]] bool same_pass(const Place& other) const {
    return kind == other.kind && color == other.color && material == other.material;
  }
};

/// What the blocks are made of.
struct Source {
  const state::Springs& springs;
  const state::Particles& particles;
  std::span<const std::uint8_t> taken;
  state::Rows rows;    ///< Rows of the springs.
  state::Rows points;  ///< Rows of their particles.
};

/// Colors one class: rows of a color share no particle. Returns them in the order of passes.
std::vector<Place> color_class(const Source& source, SpringClass kind, MaterialNumbers& materials) {
  const state::Springs& springs = source.springs;
  std::vector<Place> places;
  std::vector<std::uint64_t> used(source.points.count, 0);
  int lone_color = 64;
  for (std::uint32_t row = source.rows.first; row < source.rows.end(); ++row) {
    if (springs.kind[row] != kind || (!source.taken.empty() && source.taken[row - source.rows.first] != 0))
      continue;
    const std::uint32_t anchor = springs.particle_b[row];
    const std::uint32_t ends[2] = {springs.particle_a[row] - source.points.first,
                                   anchor - source.points.first};
    HOOKE_ASSERT(ends[0] != ends[1]);
    const bool anchored = kind == SpringClass::kTether;
    if (anchored && source.particles.velocity[anchor].inverse_mass > Real(0)) continue;
    int color = take_color(used, ends, anchored ? 1 : 2);
    if (color >= 64) color = lone_color++;
    const std::uint32_t material = materials.of(springs, row);
    places.push_back({kind, color, material, row});
  }
  base::counting_sort(places, materials.count(), [](const Place& place) { return place.material; });
  base::counting_sort(places, static_cast<std::size_t>(lone_color),
                      [](const Place& place) { return place.color; });
  return places;
}

/// Copies the last row into the lanes behind it.
void fill_lanes(SpringBlock& block, int count) {
  HOOKE_ASSERT(count > 0);
  for (int lane = count; lane < kLanes; ++lane) {
    block.record_a[lane] = block.record_a[count - 1];
    block.record_b[lane] = block.record_b[count - 1];
    block.rest_length[lane] = block.rest_length[count - 1];
  }
}

}  // namespace

SpringMaterial material_of_spring(const state::Springs& springs, std::size_t row) {
  const SpringClass kind = springs.kind[row];
  return {.stiffness = springs.stiffness[row],
          .damping = springs.damping[row],
          .damped_mass = springs.damped_mass[row],
          .one_sided = kind == SpringClass::kTether || kind == SpringClass::kLimit,
          .anchored = kind == SpringClass::kTether,
          .form = springs.form[row],
          .bias = Real(0),
          .gamma = Real(0)};
}

MaterialNumbers::MaterialNumbers(std::vector<SpringMaterial>& materials) : materials_(materials) {
  for (std::uint32_t i = 0; i < materials.size(); ++i) numbers_[materials[i]] = i;
}

bool MaterialNumbers::IsLess::operator()(const SpringMaterial& a, const SpringMaterial& b) const {
  const auto key = [](const SpringMaterial& m) {
    return std::tuple(m.stiffness, m.damping, m.damped_mass, m.one_sided, m.anchored, m.form);
  };
  return key(a) < key(b);
}

std::uint32_t MaterialNumbers::of(const state::Springs& springs, std::size_t row) {
  const SpringMaterial material = material_of_spring(springs, row);
  if (last_ < materials_.size() && materials_[last_] == material) return last_;
  const auto [number, is_new] = numbers_.try_emplace(material, static_cast<std::uint32_t>(materials_.size()));
  if (is_new) materials_.push_back(material);
  last_ = number->second;
  return last_;
}

void build_spring_blocks(std::span<const state::Deformable> objects, const state::Springs& springs,
                         const state::Particles& particles, std::span<const std::uint8_t> taken,
                         SpringBlocks& blocks) {
  const Source source = {springs, particles, taken, rows_of(objects, &state::Deformable::springs),
                         rows_of(objects, &state::Deformable::particles)};
  HOOKE_ASSERT(taken.empty() || taken.size() == source.rows.count);
  blocks = {};
  blocks.first_particle = source.points.first;
  MaterialNumbers materials(blocks.materials);
  std::vector<Place> places;
  places.reserve(source.rows.count);
  for (const SpringClass kind : {SpringClass::kStretch, SpringClass::kShear, SpringClass::kBend,
                                 SpringClass::kTether, SpringClass::kLimit}) {
    const std::vector<Place> of_class = color_class(source, kind, materials);
    places.insert(places.end(), of_class.begin(), of_class.end());
  }

  std::size_t i = 0;
  while (i < places.size()) {
    const Place& head = places[i];
    SpringPass pass{
        .material = head.material, .first = static_cast<int>(blocks.blocks.size()), .kind = head.kind};
    for (; i < places.size() && places[i].same_pass(head);) {
      SpringBlock block{};
      int lane = 0;
      for (; lane < kLanes && i < places.size() && places[i].same_pass(head); ++lane, ++i) {
        const std::uint32_t row = places[i].row;
        block.record_a[lane] = 4 * (springs.particle_a[row] - source.points.first);
        block.record_b[lane] = 4 * (springs.particle_b[row] - source.points.first);
        block.rest_length[lane] = springs.rest_length[row];
      }
      fill_lanes(block, lane);
      blocks.blocks.push_back(block);
      pass.last_count = lane;
    }
    pass.end = static_cast<int>(blocks.blocks.size());
    blocks.passes.push_back(pass);
  }
}

Softness softness(Real stiffness, Real damping, Real h) {
  if (std::isinf(stiffness)) return {.bias = Real(1) / h, .gamma = Real(0)};
  const Real s = damping + h * stiffness;
  if (!(s > Real(0))) return {.bias = Real(0), .gamma = std::numeric_limits<Real>::infinity()};
  return {.bias = stiffness / s, .gamma = Real(1) / (h * s)};
}

Real most_damping(Real mass, Real stiffness, Real h) {
  return std::max(kMostDampingOfMass * mass / h, kMostDampingOfStiffness * h * stiffness);
}

void prepare_spring(SpringMaterial& material, Real h) {
  const Real damping = std::min(material.damping, most_damping(material.damped_mass, material.stiffness, h));
  const Softness soft = softness(material.stiffness, damping, h);
  material.bias = soft.bias;
  material.gamma = soft.gamma;
  const bool rigid = std::isinf(material.stiffness);
  const Real speed = material.anchored ? kTetherRecoverySpeed : kRigidSpringRecoverySpeed;
  material.recovery = rigid ? h * speed : SpringMaterial::kWhole;
  material.recovery_time = rigid ? h : Real(0);
}

void prepare_springs(std::vector<SpringMaterial>& materials, Real h) {
  for (SpringMaterial& material : materials) prepare_spring(material, h);
}

}  // namespace hooke::solver
