/// Tests arches of blocks without mortar.

#include "validation/cases.h"
#include "validation/rig.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace hooke::check {

namespace {

constexpr int kBlocks = 25;

/// Makes a block of a half circle of radius 1 m, about its center. `thickness` is a share of the radius;
/// blocks are half a meter deep.
MeshDesc block_of(double from, double to, double thickness) {
  MeshDesc mesh;
  for (const double z : {-0.25, 0.25}) {
    for (const double angle : {from, to}) {
      for (const double r : {1 - thickness / 2, 1 + thickness / 2})
        mesh.positions.push_back(real(DVec3{r * std::cos(angle), r * std::sin(angle), z}));
    }
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

/// Tells whether the key stone is still where it was.
bool arch_stands(const CheckSetting& setting, double thickness) {
  Rig rig(setting, sleepless());
  rig.add(level_ground(1));
  std::vector<BodyId> blocks;
  for (int i = 0; i < kBlocks; ++i) {
    const double angle = kTau / 2 / kBlocks;
    const MeshDesc mesh = block_of(i * angle, (i + 1) * angle, thickness);
    BodyDesc desc = moving(Shape::hull_of(must(rig.world().add_mesh(mesh))), {});
    desc.density = real(2300);
    desc.contact.friction = real(1);
    blocks.push_back(rig.add(desc));
  }
  const double key = rig.center(blocks[kBlocks / 2]).y;
  for (int i = 0; i < 10; ++i) {
    rig.run(1);
    if (rig.center(blocks[kBlocks / 2]).y < key - 0.1) return false;
  }
  return true;
}

}  // namespace

/// A half circle of blocks that do not slip stands if its thickness is at least 0.1075 of its radius
/// (Milankovitch 1907, for blocks without size; Heyman 1969: 0.106).
Rows stone_arch(const CheckSetting& setting) {
  const double expected = 0.1075;
  const double found =
      bisect(1.3 * expected, 0.8 * expected, 6, [&](double share) { return arch_stands(setting, share); });
  CheckRow row =
      relative_row("least thickness of an arch of 25 blocks, over its radius", "", expected, found, 0.05);
  row.solver = "bodies";
  return {row};
}

}  // namespace hooke::check
