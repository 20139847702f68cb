#include "solver/soft/yarns.h"

#include "base/assert.h"
#include "solver/soft/yarn_kernels.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace hooke::solver {

namespace {

/// A yarn, as the springs [first, first + count) of a list of rows.
struct Chain {
  std::uint32_t material = 0;
  bool along_columns = false;
  Real bend_damping = Real(0);
  bool bends = false;
  std::uint32_t first = 0;
  std::uint32_t count = 0;

  /// What yarns of one pass, and of one block, have in common.
  [[nodiscard]] auto pass_key() const { return std::tuple(along_columns, material); }
  [[nodiscard]] auto block_key() const { return std::tuple(along_columns, material, bends, bend_damping); }
};

constexpr std::uint32_t kNoRow = std::numeric_limits<std::uint32_t>::max();

/// A link of a yarn, and the bend at the node where it begins, as rows of the tables.
struct Link {
  std::uint32_t spring = kNoRow;
  std::uint32_t bend = kNoRow;
};

/// What yarns are made of.
struct Tables {
  const state::Springs& springs;
  const state::Bends& bends;
  const state::Particles& particles;
  std::uint32_t first_spring = 0;
  std::uint32_t first_bend = 0;
};

struct Found {
  std::vector<YarnMaterial>& materials;
  std::vector<Link> links;
  std::vector<Chain> chains;
  TakenRows& taken;
};

/// The stretch springs of a cloth along one direction of its grid, their limits and their bends, by the point
/// at which they begin.
class YarnsOfCloth {
 public:
  YarnsOfCloth(const state::Deformable& object, const Tables& tables, std::uint32_t stride)
      : tables_(tables),
        stride_(stride),
        spring_(object.particles.count, kNoRow),
        limit_(spring_),
        bend_(spring_) {
    const state::Springs& springs = tables.springs;
    const std::uint32_t first = object.particles.first;
    for (std::uint32_t row = object.springs.first; row < object.springs.end(); ++row) {
      const bool is_limit = springs.kind[row] == state::SpringClass::kLimit;
      if (!is_limit && springs.kind[row] != state::SpringClass::kStretch) continue;
      if (springs.form[row] != state::SpringForm::kExplicit) continue;
      if (springs.particle_b[row] - springs.particle_a[row] != stride) continue;
      (is_limit ? limit_ : spring_)[springs.particle_a[row] - first] = row;
    }
    for (std::uint32_t row = object.bends.first; row < object.bends.end(); ++row) {
      const state::Bends::Stencil& s = tables.bends.stencil[row];
      if (tables.bends.is_along_yarn(row) && s.edge_a - s.wing_a == stride && s.wing_b - s.edge_a == stride)
        bend_[s.edge_a - first] = row;
    }
  }

  void list(bool along_columns, Found& found) {
    for (std::uint32_t start = 0; start < spring_.size(); ++start) {
      if (spring_[start] == kNoRow) continue;
      const YarnMaterial material = material_at(start);
      const auto of = std::find(found.materials.begin(), found.materials.end(), material);
      Chain chain = {.material = static_cast<std::uint32_t>(of - found.materials.begin()),
                     .along_columns = along_columns,
                     .first = static_cast<std::uint32_t>(found.links.size())};
      if (of == found.materials.end()) found.materials.push_back(material);
      for (std::uint32_t at = start; at < spring_.size() && spring_[at] != kNoRow; at += stride_) {
        if (at != start && material_at(at) != material) break;
        take(at, chain, found);
      }
      found.chains.push_back(chain);
    }
  }

 private:
  [[nodiscard]] YarnMaterial material_at(std::uint32_t at) const {
    const std::uint32_t row = spring_[at];
    YarnMaterial material;
    material.spring = material_of_spring(tables_.springs, row);
    if (limit_[at] == kNoRow) return material;
    material.limit = material_of_spring(tables_.springs, limit_[at]);
    material.most_extension =
        tables_.springs.rest_length[limit_[at]] / tables_.springs.rest_length[row] - Real(1);
    return material;
  }

  /// Appends the link that begins at a point to the chain, with the bend there, if the chain has come here.
  void take(std::uint32_t at, Chain& chain, Found& found) {
    Link link = {spring_[at], kNoRow};
    found.taken.springs[link.spring - tables_.first_spring] = 1;
    if (limit_[at] != kNoRow) found.taken.springs[limit_[at] - tables_.first_spring] = 1;
    if (chain.count > 0 && bend_[at] != kNoRow) {
      link.bend = bend_[at];
      found.taken.bends[link.bend - tables_.first_bend] = 1;
      chain.bends = true;
      chain.bend_damping = tables_.bends.damping[link.bend];
    }
    found.links.push_back(link);
    spring_[at] = kNoRow;
    ++chain.count;
  }

  const Tables& tables_;
  std::uint32_t stride_;
  std::vector<std::uint32_t> spring_;  ///< kNoRow where there is none, or none that is left.
  std::vector<std::uint32_t> limit_;
  std::vector<std::uint32_t> bend_;
};

/// The rows of a block.
struct BlockRows {
  std::span<YarnRow> rows;
  std::span<YarnBendRow> bends;  ///< None if no yarn of the block resists bending.
};

void set_lane(const Tables& tables, std::span<const Link> links, std::size_t lane,
              std::uint32_t first_particle, const BlockRows& to) {
  const state::Springs& springs = tables.springs;
  const auto record = [&](std::uint32_t particle) { return 4 * (particle - first_particle); };
  for (std::size_t i = 0; i < to.rows.size(); ++i) {
    const bool is_link = i < links.size();
    const std::uint32_t row = links[is_link ? i : links.size() - 1].spring;
    to.rows[i].rest_length[lane] = is_link ? springs.rest_length[row] : Real(0);
    to.rows[i].record[lane] = record(is_link ? springs.particle_a[row] : springs.particle_b[row]);
    if (to.bends.empty()) continue;
    to.bends[i].per_rest[lane] = is_link ? 1 / static_cast<double>(springs.rest_length[row]) : 0;
    const bool is_bend = is_link && links[i].bend != kNoRow;
    to.bends[i].stiffness[lane] = is_bend ? static_cast<double>(state::stiffness_beside_clamp(
                                                tables.bends, links[i].bend, tables.particles))
                                          : 0;
  }
}

/// Puts chains with one key into blocks of 16.
class Blocks {
 public:
  Blocks(const Tables& tables, const Found& found, Yarns& yarns)
      : tables_(tables), found_(found), yarns_(yarns) {
    for (const Chain& chain : found.chains) any_bends_ = any_bends_ || chain.bends;
  }

  void append(std::span<const Chain> chains) {
    for (std::size_t i = 0; i < chains.size(); i += kLanes) append_block(chains.subspan(i));
  }

 private:
  /// Makes a block of the first chains; the first of them is the longest.
  void append_block(std::span<const Chain> chains) {
    YarnBlock block = {.first_row = static_cast<std::uint32_t>(yarns_.rows.size()),
                       .row_count = chains[0].count + 1,
                       .count = static_cast<int>(std::min<std::size_t>(chains.size(), kLanes)),
                       .bends = chains[0].bends,
                       .bend_damping = chains[0].bend_damping};
    yarns_.rows.resize(yarns_.rows.size() + block.row_count);
    if (any_bends_) yarns_.bend_rows.resize(yarns_.rows.size());
    BlockRows rows = {.rows = {yarns_.rows.data() + block.first_row, block.row_count}, .bends = {}};
    if (block.bends) rows.bends = {yarns_.bend_rows.data() + block.first_row, block.row_count};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Chain& chain = chains[std::min(lane, static_cast<std::size_t>(block.count) - 1)];
      set_lane(tables_, std::span(found_.links).subspan(chain.first, chain.count), lane,
               yarns_.first_particle, rows);
    }
    yarns_.blocks.push_back(block);
  }

  const Tables& tables_;
  const Found& found_;
  Yarns& yarns_;
  bool any_bends_ = false;
};

}  // namespace

void build_yarns(std::span<const state::Deformable> objects, const state::Springs& springs,
                 const state::Bends& bends, const state::Particles& particles, TakenRows& taken,
                 Yarns& yarns) {
  yarns = {};
  yarns.first_particle = rows_of(objects, &state::Deformable::particles).first;
  const Tables tables = {springs, bends, particles, rows_of(objects, &state::Deformable::springs).first,
                         rows_of(objects, &state::Deformable::bends).first};
  Found found = {.materials = yarns.materials, .links = {}, .chains = {}, .taken = taken};
  for (const state::Deformable& object : objects) {
    if (object.kind != PointRef::Kind::kCloth || object.columns < 2) continue;
    YarnsOfCloth(object, tables, 1).list(false, found);
    YarnsOfCloth(object, tables, object.columns).list(true, found);
  }
  // The longest first, so that yarns of about one length share a block.
  std::vector<Chain>& chains = found.chains;
  std::stable_sort(chains.begin(), chains.end(), [](const Chain& a, const Chain& b) {
    return a.block_key() != b.block_key() ? a.block_key() < b.block_key() : a.count > b.count;
  });
  Blocks blocks(tables, found, yarns);
  for (std::size_t first = 0, end = 0; first < chains.size(); first = end) {
    while (end < chains.size() && chains[end].block_key() == chains[first].block_key()) ++end;
    const bool goes_on = first > 0 && chains[first - 1].pass_key() == chains[first].pass_key();
    if (!goes_on) {
      yarns.passes.push_back(
          {.material = chains[first].material, .first = static_cast<int>(yarns.blocks.size())});
    }
    blocks.append(std::span(chains).subspan(first, end - first));
    yarns.passes.back().end = static_cast<int>(yarns.blocks.size());
  }
}

void prepare_yarns(Yarns& yarns, Real h) {
  yarns.h = h;
  for (YarnMaterial& material : yarns.materials) {
    prepare_spring(material.spring, h);
    prepare_spring(material.limit, h);
    // gamma h p is the extension at the end of the substep.
    material.most_impulse = material.most_extension / (material.spring.gamma * h);
  }
}

void solve_yarns(Yarns& yarns, const YarnPass& pass, parallel::Range blocks, state::Particles& particles) {
  HOOKE_ASSERT(blocks.begin >= pass.first && blocks.end <= pass.end);
  HOOKE_ASSERT(yarns.first_particle < particles.position.size());
  for (int i = blocks.begin; i < blocks.end; ++i) {
    const YarnBlock& block = yarns.blocks[i];
    wide::solve_yarns(block, yarns.rows.data() + block.first_row, yarns.materials[pass.material], yarns.h,
                      particles.position.data() + yarns.first_particle,
                      particles.velocity.data() + yarns.first_particle);
  }
}

void bend_yarns(Yarns& yarns, const YarnPass& pass, parallel::Range blocks, state::Particles& particles) {
  HOOKE_ASSERT(blocks.begin >= pass.first && blocks.end <= pass.end);
  const auto h = static_cast<double>(yarns.h);
  for (int i = blocks.begin; i < blocks.end; ++i) {
    const YarnBlock& block = yarns.blocks[i];
    if (!block.bends) continue;
    const wide::YarnBendTime time = {h, h * (h + static_cast<double>(block.bend_damping))};
    wide::bend_yarns(block, yarns.rows.data() + block.first_row, yarns.bend_rows.data() + block.first_row,
                     time, particles.position.data() + yarns.first_particle,
                     particles.velocity.data() + yarns.first_particle);
  }
}

}  // namespace hooke::solver
