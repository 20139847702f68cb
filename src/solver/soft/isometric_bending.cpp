#include "solver/soft/isometric_bending.h"

#include "base/assert.h"
#include "solver/soft/isometric_bending_kernels.h"

#include <algorithm>
#include <array>
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
  explicit SpringsByEnds(const state::Springs& springs) {
    for (std::uint32_t row = 0; row < springs.kind.size(); ++row) {
      const bool plain =
          springs.kind[row] <= state::SpringClass::kBend && springs.form[row] == state::SpringForm::kExplicit;
      if (plain) rows_.push_back({ordered(springs.particle_a[row], springs.particle_b[row]), row});
    }
    std::sort(rows_.begin(), rows_.end());
  }

  /// Takes the first spring that is in no element yet.
  std::optional<std::uint32_t> take(std::uint32_t a, std::uint32_t b,
                                    std::vector<std::uint8_t>& taken) const {
    const Pair ends = ordered(a, b);
    for (auto at = std::lower_bound(rows_.begin(), rows_.end(), std::pair{ends, 0U});
         at != rows_.end() && at->first == ends; ++at) {
      if (taken[at->second] != 0) continue;
      taken[at->second] = 1;
      return at->second;
    }
    return std::nullopt;
  }

 private:
  std::vector<std::pair<Pair, std::uint32_t>> rows_;
};

struct Spring {
  std::uint32_t material = kNoSpring;
  Real rest_length = Real(0);
};

struct IsometricBend {
  std::uint32_t bend = 0;
  Spring edge, wings;
  int color = 0;
  Real damping = Real(0);

  [[nodiscard]] auto key() const { return std::tie(color, edge.material, wings.material, damping); }
};

Spring load_spring(std::optional<std::uint32_t> row, const state::Springs& springs,
                   IsometricBendBlocks& isometric_bends) {
  if (!row) return {};
  return {find_or_add_material(springs, *row, isometric_bends.materials), springs.rest_length[*row]};
}

void set_lane(const IsometricBend& isometric, const state::Bends& bends, std::size_t lane,
              IsometricBendBlock& block, std::array<Real, kLanes>& stiffness) {
  const Stencil& s = bends.stencil[isometric.bend];
  const std::uint32_t ends[4] = {s.edge_a, s.edge_b, s.wing_a, s.wing_b};
  for (int k = 0; k < 4; ++k) block.record[k][lane] = 4 * ends[k];
  for (int k = 0; k < 3; ++k) block.weight[k][lane] = bends.weights[isometric.bend][k + 1];
  block.edge_length[lane] = isometric.edge.rest_length;
  block.wing_length[lane] = isometric.wings.rest_length;
  stiffness[lane] = bends.stiffness[isometric.bend];
}

/// k sum |weight|^2 of a bend [N/m]: over the mass of a point it is the square of the bend's frequency.
Real resistance(const state::Bends& bends, std::uint32_t row) {
  Real sum = Real(0);
  for (const Real weight : bends.weights[row]) sum += weight * weight;
  return bends.stiffness[row] * sum;
}

/// Isometric bends with their springs, sorted by color and materials.
std::vector<IsometricBend> list_isometric_bends(const state::Bends& bends, const state::Springs& springs,
                                                int particle_count, std::vector<std::uint8_t>& taken,
                                                IsometricBendBlocks& isometric_bends) {
  const SpringsByEnds by_ends(springs);
  std::vector<IsometricBend> list;
  std::vector<Stencil> stencils;
  for (std::uint32_t row = 0; row < bends.stencil.size(); ++row) {
    if (!bends.is_isometric(row)) continue;
    const Stencil& s = bends.stencil[row];
    const auto edge = by_ends.take(s.edge_a, s.edge_b, taken);
    const auto wings = by_ends.take(s.wing_a, s.wing_b, taken);
    list.push_back({.bend = row,
                    .edge = load_spring(edge, springs, isometric_bends),
                    .wings = load_spring(wings, springs, isometric_bends),
                    .damping = bends.damping[row]});
    stencils.push_back(s);
  }
  const std::vector<int> color = color_fours(stencils, particle_count);
  for (std::size_t i = 0; i < list.size(); ++i) list[i].color = color[i];
  std::stable_sort(list.begin(), list.end(),
                   [](const IsometricBend& a, const IsometricBend& b) { return a.key() < b.key(); });
  return list;
}

}  // namespace

std::vector<std::uint8_t> build_isometric_bend_blocks(const state::Bends& bends,
                                                      const state::Springs& springs, int particle_count,
                                                      IsometricBendBlocks& isometric_bends) {
  isometric_bends = {};
  isometric_bends.materials.push_back({});  // kNoSpring
  std::vector<std::uint8_t> taken(springs.kind.size(), 0);
  const std::vector<IsometricBend> list =
      list_isometric_bends(bends, springs, particle_count, taken, isometric_bends);

  std::size_t i = 0;
  while (i < list.size()) {
    const IsometricBend& head = list[i];
    IsometricBendPass pass{.edge = head.edge.material,
                           .wings = head.wings.material,
                           .damping = head.damping,
                           .first = static_cast<int>(isometric_bends.blocks.size())};
    const auto more = [&] { return i < list.size() && list[i].key() == head.key(); };
    while (more()) {
      IsometricBendBlock& block = isometric_bends.blocks.emplace_back();
      std::array<Real, kLanes>& stiffness = isometric_bends.stiffness.emplace_back();
      pass.last_count = 0;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool own = more();
        if (own) pass.stiffest = std::max(pass.stiffest, resistance(bends, list[i].bend));
        set_lane(list[own ? i++ : i - 1], bends, lane, block, stiffness);
        if (own) ++pass.last_count;
      }
    }
    pass.end = static_cast<int>(isometric_bends.blocks.size());
    isometric_bends.passes.push_back(pass);
  }
  return taken;
}

void prepare_isometric_bends(IsometricBendBlocks& isometric_bends, Real h) {
  HOOKE_ASSERT(isometric_bends.stiffness.size() == isometric_bends.blocks.size());
  prepare_springs(isometric_bends.materials, h);
  for (IsometricBendPass& pass : isometric_bends.passes) {
    const Real mass = isometric_bends.materials[pass.edge].damped_mass;  // all of one cloth
    const Real most = most_damping(mass, pass.stiffest, h) / pass.stiffest;
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
  wide::solve_isometric_bends(run, materials, particles);
}

}  // namespace hooke::solver
