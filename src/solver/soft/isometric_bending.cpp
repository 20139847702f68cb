#include "solver/soft/isometric_bending.h"

#include "base/assert.h"
#include "base/counting_sort.h"
#include "solver/soft/isometric_bending_kernels.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace hooke::solver {

namespace {

using Stencil = state::Bends::Stencil;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

Pair ordered(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Springs that an element can hold, by their two particles.
class SpringsByEnds {
 public:
  SpringsByEnds(const state::Springs& springs, state::Rows rows, state::Rows particles)
      : first_(rows.first), first_particle_(particles.first), begin_(std::size_t{particles.count} + 1, 0) {
    for (std::uint32_t row = rows.first; row < rows.end(); ++row) {
      if (springs.kind[row] > state::SpringClass::kBend || springs.form[row] != state::SpringForm::kExplicit)
        continue;
      rows_.push_back({ordered(springs.particle_a[row], springs.particle_b[row]), row});
      ++begin_[rows_.back().first.first - first_particle_ + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    base::counting_sort(rows_, particles.count,
                        [this](const Row& row) { return row.first.first - first_particle_; });
    for (std::size_t i = 0; i + 1 < begin_.size(); ++i)
      std::sort(rows_.begin() + begin_[i], rows_.begin() + begin_[i + 1]);
  }

  /// Takes the first spring that is in no element yet, and marks it in `taken`.
  std::optional<std::uint32_t> take(std::uint32_t a, std::uint32_t b,
                                    std::vector<std::uint8_t>& taken) const {
    const Pair ends = ordered(a, b);
    const std::size_t bucket = ends.first - first_particle_;
    const auto end = rows_.begin() + begin_[bucket + 1];
    for (auto row = std::lower_bound(rows_.begin() + begin_[bucket], end, Row{ends, 0U});
         row != end && row->first == ends; ++row) {
      std::uint8_t& mark = taken[row->second - first_];
      if (mark != 0) continue;
      mark = 1;
      return row->second;
    }
    return std::nullopt;
  }

 private:
  using Row = std::pair<Pair, std::uint32_t>;

  std::uint32_t first_;           ///< Row of the first spring.
  std::uint32_t first_particle_;  ///< Row of the first particle.
  std::vector<Row> rows_;         ///< In order.
  std::vector<std::uint32_t>
      begin_;  ///< By the lower particle of a row, where its rows begin; one end marker.
};

struct Spring {
  std::uint32_t material = kNoSpring;
  Real rest_length = Real(0);
};

struct IsometricBend {
  std::uint32_t bend = 0;
  std::uint32_t object = 0;  ///< Its place among the objects.
  Spring edge, wings;
  int color = 0;
  Real damping = Real(0);
  Real damped_mass = std::numeric_limits<Real>::infinity();  ///< Of the springs of its object [kg].
  Real stiffest = Real(0);  ///< Of the elements of its object with the same key.

  /// What elements of one object that share a pass have in common.
  [[nodiscard]] auto key() const { return std::tie(color, edge.material, wings.material, damping); }
  [[nodiscard]] bool shares_pass(const IsometricBend& other) const {
    return key() == other.key() && stiffest == other.stiffest && damped_mass == other.damped_mass;
  }
};

Spring load_spring(std::optional<std::uint32_t> row, const state::Springs& springs,
                   MaterialNumbers& materials) {
  if (!row) return {};
  return {materials.of(springs, *row), springs.rest_length[*row]};
}

void set_lane(const IsometricBend& isometric, const state::Bends& bends, std::size_t lane,
              IsometricBendBlocks& of) {
  IsometricBendBlock& block = of.blocks.back();
  const Stencil& s = bends.stencil[isometric.bend];
  const std::uint32_t ends[4] = {s.edge_a, s.edge_b, s.wing_a, s.wing_b};
  for (int k = 0; k < 4; ++k) block.record[k][lane] = 4 * (ends[k] - of.first_particle);
  for (int k = 0; k < 3; ++k) block.weight[k][lane] = bends.weights[isometric.bend][k + 1];
  block.edge_length[lane] = isometric.edge.rest_length;
  block.wing_length[lane] = isometric.wings.rest_length;
  of.stiffness.back()[lane] = bends.stiffness[isometric.bend];
}

/// k sum |weight|^2 of a bend [N/m]: over the mass of a point it is the square of the bend's frequency.
Real resistance(const state::Bends& bends, std::uint32_t row) {
  Real sum = Real(0);
  for (const Real weight : bends.weights[row]) sum += weight * weight;
  return bends.stiffness[row] * sum;
}

/// Isometric bends with their springs, in the order of the table.
std::vector<IsometricBend> list_isometric_bends(std::span<const state::Deformable> objects,
                                                const state::Bends& bends, const state::Springs& springs,
                                                TakenRows& taken, MaterialNumbers materials) {
  const SpringsByEnds by_ends(springs, rows_of(objects, &state::Deformable::springs),
                              rows_of(objects, &state::Deformable::particles));
  const std::uint32_t first_bend = rows_of(objects, &state::Deformable::bends).first;
  std::vector<IsometricBend> list;
  std::vector<Stencil> stencils;
  for (std::uint32_t object = 0; object < objects.size(); ++object) {
    const state::Rows rows = objects[object].bends;
    // Shear of woven cloth is solved by itself: yarns come after it, and hooks on cells shook where they
    // followed elements that hold both diagonals of a cell.
    const bool is_woven = objects[object].columns > 0;
    for (std::uint32_t row = rows.first; row < rows.end(); ++row) {
      if (!bends.is_isometric(row) || taken.bends[row - first_bend] != 0) continue;
      const Stencil& s = bends.stencil[row];
      std::optional<std::uint32_t> edge, wings;
      if (!is_woven) {
        edge = by_ends.take(s.edge_a, s.edge_b, taken.springs);
        wings = by_ends.take(s.wing_a, s.wing_b, taken.springs);
      }
      list.push_back({.bend = row,
                      .object = object,
                      .edge = load_spring(edge, springs, materials),
                      .wings = load_spring(wings, springs, materials),
                      .damping = bends.damping[row],
                      .damped_mass = objects[object].springs.count > 0
                                         ? springs.damped_mass[objects[object].springs.first]
                                         : std::numeric_limits<Real>::infinity()});
      stencils.push_back(s);
    }
  }
  const std::vector<int> color =
      color_fours<Stencil>(stencils, rows_of(objects, &state::Deformable::particles));
  for (std::size_t i = 0; i < list.size(); ++i) list[i].color = color[i];
  return list;
}

/// Sorts elements by color and materials, those of one object one after another, and finds the stiffest of
/// each object. How far a bend is damped depends on it, and must not depend on which other objects there are.
void sort_isometric_bends(const state::Bends& bends, std::size_t materials,
                          std::vector<IsometricBend>& list) {
  const auto same = [&](const IsometricBend& bend) { return bend.damping == list.front().damping; };
  if (!std::all_of(list.begin(), list.end(), same)) {
    std::stable_sort(list.begin(), list.end(),
                     [](const IsometricBend& a, const IsometricBend& b) { return a.damping < b.damping; });
  }
  int colors = 0;
  for (const IsometricBend& bend : list) colors = std::max(colors, bend.color + 1);
  base::counting_sort(list, materials, [](const IsometricBend& bend) { return bend.wings.material; });
  base::counting_sort(list, materials, [](const IsometricBend& bend) { return bend.edge.material; });
  base::counting_sort(list, static_cast<std::size_t>(colors),
                      [](const IsometricBend& bend) { return bend.color; });
  for (std::size_t first = 0, end = 0; first < list.size(); first = end) {
    const IsometricBend& head = list[first];
    Real stiffest = Real(0);
    for (; end < list.size() && list[end].object == head.object && list[end].key() == head.key(); ++end)
      stiffest = std::max(stiffest, resistance(bends, list[end].bend));
    for (std::size_t i = first; i < end; ++i) list[i].stiffest = stiffest;
  }
}

}  // namespace

void build_isometric_bend_blocks(std::span<const state::Deformable> objects, const state::Bends& bends,
                                 const state::Springs& springs, TakenRows& taken,
                                 IsometricBendBlocks& isometric_bends) {
  HOOKE_ASSERT(taken.springs.size() == rows_of(objects, &state::Deformable::springs).count);
  HOOKE_ASSERT(taken.bends.size() == rows_of(objects, &state::Deformable::bends).count);
  isometric_bends = {};
  isometric_bends.first_particle = rows_of(objects, &state::Deformable::particles).first;
  isometric_bends.materials.push_back({});  // kNoSpring
  std::vector<IsometricBend> list =
      list_isometric_bends(objects, bends, springs, taken, MaterialNumbers(isometric_bends.materials));
  sort_isometric_bends(bends, isometric_bends.materials.size(), list);

  std::size_t i = 0;
  while (i < list.size()) {
    const IsometricBend& head = list[i];
    IsometricBendPass pass{.edge = head.edge.material,
                           .wings = head.wings.material,
                           .damping = head.damping,
                           .damped_mass = head.damped_mass,
                           .stiffest = head.stiffest,
                           .first = static_cast<int>(isometric_bends.blocks.size())};
    const auto more = [&] { return i < list.size() && list[i].shares_pass(head); };
    while (more()) {
      isometric_bends.blocks.emplace_back();
      isometric_bends.stiffness.emplace_back();
      pass.last_count = 0;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool own = more();
        set_lane(list[own ? i++ : i - 1], bends, lane, isometric_bends);
        if (own) ++pass.last_count;
      }
    }
    pass.end = static_cast<int>(isometric_bends.blocks.size());
    isometric_bends.passes.push_back(pass);
  }
}

void prepare_isometric_bends(IsometricBendBlocks& isometric_bends, Real h) {
  HOOKE_ASSERT(isometric_bends.stiffness.size() == isometric_bends.blocks.size());
  prepare_springs(isometric_bends.materials, h);
  for (IsometricBendPass& pass : isometric_bends.passes) {
    const Real most = most_damping(pass.damped_mass, pass.stiffest, h) / pass.stiffest;
    const Real damped = Real(1) / (std::min(pass.damping, most) + h);
    pass.softness = {.bias = Real(1) / h, .damped_bias = damped, .gamma_share = h * damped};
  }
  for (std::size_t i = 0; i < isometric_bends.blocks.size(); ++i) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      isometric_bends.blocks[i].gamma[lane] = Real(1) / (h * h * isometric_bends.stiffness[i][lane]);
  }
}

void solve_isometric_bends(const IsometricBendBlocks& isometric_bends, const IsometricBendPass& pass,
                           parallel::Range blocks, state::Particles& particles) {
  HOOKE_ASSERT(blocks.begin >= pass.first && blocks.end <= pass.end);
  HOOKE_ASSERT(std::max(pass.edge, pass.wings) < isometric_bends.materials.size());
  const wide::IsometricBendRun run = {
      .blocks = {isometric_bends.blocks.data() + blocks.begin, static_cast<std::size_t>(blocks.count())},
      .last_count = blocks.end == pass.end ? pass.last_count : kLanes};
  const wide::IsometricBendMaterials materials = {
      .bend = pass.softness,
      .edge = isometric_bends.materials[pass.edge],
      .wings = pass.wings == kNoSpring ? nullptr : &isometric_bends.materials[pass.wings]};
  HOOKE_ASSERT(isometric_bends.first_particle < particles.position.size());
  wide::solve_isometric_bends(run, materials, particles.position.data() + isometric_bends.first_particle,
                              particles.velocity.data() + isometric_bends.first_particle);
}

}  // namespace hooke::solver
