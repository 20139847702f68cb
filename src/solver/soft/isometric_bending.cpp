#include "solver/soft/isometric_bending.h"

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

/// Springs that a hinge can hold, by their two particles.
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

  /// The first that is in no hinge yet, which it then is.
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

struct Hinge {
  std::uint32_t bend = 0;
  Spring edge, wings;
  int color = 0;
  Real damping = Real(0);

  [[nodiscard]] auto key() const { return std::tie(color, edge.material, wings.material, damping); }
};

Spring load_spring(std::optional<std::uint32_t> row, const state::Springs& springs, HingeBlocks& hinges) {
  if (!row) return {};
  return {find_or_add_material(springs, *row, hinges.materials), springs.rest_length[*row]};
}

void set_lane(const Hinge& hinge, const state::Bends& bends, std::size_t lane, HingeBlock& block,
              std::array<Real, kLanes>& stiffness) {
  const Stencil& s = bends.stencil[hinge.bend];
  const std::uint32_t ends[4] = {s.edge_a, s.edge_b, s.wing_a, s.wing_b};
  for (int k = 0; k < 4; ++k) block.line[k][lane] = 4 * ends[k];
  for (int k = 0; k < 3; ++k) block.weight[k][lane] = bends.weights[hinge.bend][k + 1];
  block.edge_length[lane] = hinge.edge.rest_length;
  block.wing_length[lane] = hinge.wings.rest_length;
  stiffness[lane] = bends.stiffness[hinge.bend];
}

/// Of a bend, k sum |weight|^2 [N/m]: over the mass of a point the square of how fast it acts.
Real resistance(const state::Bends& bends, std::uint32_t row) {
  Real sum = Real(0);
  for (const Real weight : bends.weights[row]) sum += weight * weight;
  return bends.stiffness[row] * sum;
}

/// Isometric bends with their springs, sorted by color and materials.
std::vector<Hinge> list_hinges(const state::Bends& bends, const state::Springs& springs, int particle_count,
                               std::vector<std::uint8_t>& taken, HingeBlocks& hinges) {
  const SpringsByEnds by_ends(springs);
  std::vector<Hinge> list;
  std::vector<Stencil> stencils;
  for (std::uint32_t row = 0; row < bends.stencil.size(); ++row) {
    if (!bends.is_isometric(row)) continue;
    const Stencil& s = bends.stencil[row];
    const auto edge = by_ends.take(s.edge_a, s.edge_b, taken);
    const auto wings = by_ends.take(s.wing_a, s.wing_b, taken);
    list.push_back({.bend = row,
                    .edge = load_spring(edge, springs, hinges),
                    .wings = load_spring(wings, springs, hinges),
                    .damping = bends.damping[row]});
    stencils.push_back(s);
  }
  const std::vector<int> color = color_fours(stencils, particle_count);
  for (std::size_t i = 0; i < list.size(); ++i) list[i].color = color[i];
  std::stable_sort(list.begin(), list.end(),
                   [](const Hinge& a, const Hinge& b) { return a.key() < b.key(); });
  return list;
}

}  // namespace

std::vector<std::uint8_t> build_hinge_blocks(const state::Bends& bends, const state::Springs& springs,
                                             int particle_count, HingeBlocks& hinges) {
  hinges = {};
  hinges.materials.push_back({});  // kNoSpring
  std::vector<std::uint8_t> taken(springs.kind.size(), 0);
  const std::vector<Hinge> list = list_hinges(bends, springs, particle_count, taken, hinges);

  std::size_t i = 0;
  while (i < list.size()) {
    const Hinge& head = list[i];
    HingePass pass{.edge = head.edge.material,
                   .wings = head.wings.material,
                   .damping = head.damping,
                   .first = static_cast<int>(hinges.blocks.size())};
    const auto more = [&] { return i < list.size() && list[i].key() == head.key(); };
    while (more()) {
      HingeBlock& block = hinges.blocks.emplace_back();
      std::array<Real, kLanes>& stiffness = hinges.stiffness.emplace_back();
      pass.last_count = 0;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool own = more();
        if (own) pass.stiffest = std::max(pass.stiffest, resistance(bends, list[i].bend));
        set_lane(list[own ? i++ : i - 1], bends, lane, block, stiffness);
        if (own) ++pass.last_count;
      }
    }
    pass.end = static_cast<int>(hinges.blocks.size());
    hinges.passes.push_back(pass);
  }
  return taken;
}

void prepare_hinges(HingeBlocks& hinges, Real h) {
  prepare_springs(hinges.materials, h);
  for (HingePass& pass : hinges.passes) {
    const Real mass = hinges.materials[pass.edge].damped_mass;  // of the same cloth
    const Real most = most_damping(mass, pass.stiffest, h) / pass.stiffest;
    const Real damped = Real(1) / (std::min(pass.damping, most) + h);
    pass.softness = {.bias = Real(1) / h, .damped_bias = damped, .gamma_share = h * damped};
  }
  for (std::size_t i = 0; i < hinges.blocks.size(); ++i) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      hinges.blocks[i].gamma[lane] = Real(1) / (h * h * hinges.stiffness[i][lane]);
  }
}

void solve_hinges(const HingeBlocks& hinges, const HingePass& pass, parallel::Range blocks,
                  state::Particles& particles) {
  const wide::HingeRun run = {
      .blocks = {hinges.blocks.data() + blocks.begin, static_cast<std::size_t>(blocks.count())},
      .last_count = blocks.end == pass.end ? pass.last_count : kLanes};
  const wide::HingeMaterials materials = {
      .bend = pass.softness,
      .edge = hinges.materials[pass.edge],
      .wings = pass.wings == kNoSpring ? nullptr : &hinges.materials[pass.wings]};
  wide::solve_hinges(run, materials, particles);
}

}  // namespace hooke::solver
