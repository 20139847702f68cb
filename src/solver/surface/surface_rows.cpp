#include "solver/surface/surface_rows.h"

#include "solver/surface/rope_loads.h"
#include "solver/surface/solid_loads.h"
#include "solver/surface/surface_kernels.h"
#include "solver/surface/surface_tuning.h"

#include <bit>

namespace hooke::solver {

namespace {

void set_lane(const SurfaceRow& row, int lane, SurfaceRowBlock& block) {
  for (std::size_t k = 0; k < 4; ++k) {
    block.record[k][lane] = 4 * row.vertex[k];
    block.weight[k][lane] = row.weight[k];
  }
  block.normal[0][lane] = row.normal.x;
  block.normal[1][lane] = row.normal.y;
  block.normal[2][lane] = row.normal.z;
  block.distance[lane] = row.distance;
  block.friction[lane] = row.friction;
}

void copy_lane(int from, int to, SurfaceRowBlock& block) {
  for (std::size_t k = 0; k < 4; ++k) {
    block.record[k][to] = block.record[k][from];
    block.weight[k][to] = block.weight[k][from];
  }
  for (auto& normal : block.normal) normal[to] = normal[from];
  block.distance[to] = block.distance[from];
  block.friction[to] = block.friction[from];
}

}  // namespace

void SurfaceRowPacker::add(const SurfaceRow& row) {
  std::uint32_t used = 0;
  for (const std::uint32_t vertex : row.vertex) used |= in_open_block_[vertex];
  if (used == ~std::uint32_t{0}) {
    std::uint32_t fullest = 0;
    for (std::uint32_t i = 1; i < kOpenBlocks; ++i) {
      if (open_[i].count > open_[fullest].count) fullest = i;
    }
    close(fullest);
    used &= ~(std::uint32_t{1} << fullest);
  }
  const auto number = static_cast<std::uint32_t>(std::countr_one(used));
  SurfaceRowBlock& block = open_[number];
  set_lane(row, block.count++, block);
  for (const std::uint32_t vertex : row.vertex) in_open_block_[vertex] |= std::uint32_t{1} << number;
  if (block.count == kLanes) close(number);
}

void SurfaceRowPacker::finish() {
  for (std::uint32_t i = 0; i < kOpenBlocks; ++i) close(i);
}

void SurfaceRowPacker::close(std::uint32_t number) {
  SurfaceRowBlock& block = open_[number];
  if (block.count == 0) return;
  for (int lane = 0; lane < block.count; ++lane) {
    for (const auto& record : block.record) in_open_block_[record[lane] / 4] &= ~(std::uint32_t{1} << number);
  }
  for (int lane = block.count; lane < kLanes; ++lane) copy_lane(block.count - 1, lane, block);
  blocks_.push_back(block);
  block.count = 0;
}

void solve_surface_rows(Real h, bool again, SurfaceContacts& contacts, SurfaceGroup& group,
                        state::Particles& particles) {
  if (group.rows.empty()) return;
  const std::vector<std::uint32_t>& particle = contacts.surfaces.particle;
  for_vertices(contacts, group, [&](std::uint32_t vertex, std::uint32_t) {
    contacts.velocity[vertex] = particles.velocity[particle[vertex]];
  });
  if (!again) {
    wide::prepare_surface_rows(group.rows, h, contacts.position.data(), contacts.velocity.data());
    apply_rope_loads(contacts, group);
    apply_solid_loads(contacts, group);
  }
  for (int sweep = 1; sweep <= kSurfaceSweeps; ++sweep)
    wide::solve_surface_rows(group.rows, contacts.velocity.data());
  for_vertices(contacts, group, [&](std::uint32_t vertex, std::uint32_t) {
    particles.velocity[particle[vertex]].v = contacts.velocity[vertex].v;
  });
}

}  // namespace hooke::solver
