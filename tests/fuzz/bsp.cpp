/// Trees of planes: built of solids, written, changed, read, asked.

#include "hooke/bsp.h"

#include "fuzz/bytes.h"
#include "fuzz/mesh_maker.h"
#include "fuzz/target.h"

#include <cmath>

namespace hooke::fuzz {

namespace {

constexpr std::size_t kHeader = 24;
constexpr std::size_t kNode = 48;

/// Answers of a sound tree, whatever it is of.
void ask(const BspTree& tree, Random& random) {
  const auto place = [&] { return random.chance(0.1) ? DVec3{bad_number(random), 0, 0} : random.place(3); };
  for (int i = 0; i < 4; ++i) {
    const DVec3 p = place();
    const DVec3 way = random.chance(0.1) ? DVec3{} : place();
    (void)is_solid_at(tree, p);
    std::vector<BspCrossing> crossings;
    find_crossings(tree, p, way, random.chance(0.5) ? 1.0 : std::numeric_limits<double>::infinity(),
                   crossings);
    double last = 0;
    for (const BspCrossing& crossing : crossings) {
      expect(crossing.fraction >= last, "crossings out of order");
      expect(crossing.node < tree.nodes.size(), "a crossing at no node");
      last = crossing.fraction;
      const std::uint32_t triangle = triangle_at(tree, crossing.node, p + crossing.fraction * way);
      expect(triangle != 0xFFFFFFFF || tree.nodes[crossing.node].face_count == 0, "no triangle among faces");
    }
    (void)cast_ray(tree, p, way);
    for (const auto& hit : {move_point(tree, p, way), move_sphere(tree, p, way, random.between(0, 1))}) {
      if (hit) expect(hit->fraction >= 0 && hit->fraction <= 1, "a hit off the way");
    }
    std::vector<std::uint32_t> order;
    order_back_to_front(tree, p, order);
    std::vector<bool> seen(tree.faces.size(), false);
    for (const std::uint32_t face : order) {
      expect(face < seen.size() && !seen[face], "a face twice in painter's order");
      seen[face] = true;
    }
    if (is_finite(p)) expect(order.size() == tree.faces.size(), "a face that painter's order leaves out");
  }
  expect(size_of(tree).nodes == tree.nodes.size(), "nodes that do not count");
}

/// A tree that is only depth: each plane below the other.
std::vector<std::byte> make_chain(Random& random) {
  BspTree tree;
  const std::uint32_t depth = 1 + random.index(3000);
  for (std::uint32_t i = 0; i < depth; ++i) {
    tree.nodes.push_back({.normal = {0, 1, 0},
                          .offset = -1.0 * i,
                          .above = kBspEmpty,
                          .below = i + 1 < depth ? i + 1 : kBspSolid});
  }
  return save_bsp(tree);
}

std::vector<std::byte> make_tree(Random& random) {
  if (random.chance(0.05)) return make_chain(random);
  Result<BspTree> tree = build_bsp(random.chance(0.7) ? make_solid(random, 1) : make_hostile_mesh(random, 1));
  if (!tree) return save_bsp({.nodes = {{.normal = {0, 1, 0}}}});
  return save_bsp(*tree);
}

/// Changes what a node says: where its bytes mean something.
void change_node(Random& random, std::vector<std::byte>& bytes) {
  const std::size_t nodes = bytes.size() > kHeader ? (bytes.size() - kHeader) / kNode : 0;
  const std::size_t node = kHeader + kNode * random.below(std::min<std::size_t>(nodes, 40));
  switch (random.below(4)) {
    case 0:
      patch(bytes, node + 24, random.chance(0.5) ? random.between(-2, 2) : bad_number(random));
      break;
    case 1:
      patch(bytes, node + 32 + 4 * random.below(2),
            random.pick<std::uint32_t>({kBspEmpty, kBspSolid, random.index(40), bad_count(random)}));
      break;
    case 2:
      patch(bytes, node + 40, random.index(30));
      break;
    default:
      patch(bytes, node + 44, random.index(8));
  }
}

void check_with(std::span<const std::byte> bytes, Random& random) {
  const Result<BspTree> tree = load_bsp(bytes);
  if (!tree) {
    expect(!tree.error().message.empty(), "refused without a word");
    return;
  }
  const std::vector<std::byte> again = save_bsp(*tree);
  expect(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()), "does not come back as it was");
  ask(*tree, random);
}

}  // namespace

void check_bsp(std::span<const std::byte> bytes) {
  Random random(bytes.size());
  check_with(bytes, random);
}

void try_bsp(Random& random) {
  std::vector<std::byte> bytes = make_tree(random);
  const int changes = random.integer(0, 4);
  for (int i = 0; i < changes; ++i) {
    if (random.chance(0.6)) {
      change_node(random, bytes);
    } else {
      change_bytes(random, bytes);
    }
  }
  save_tried(bytes);
  check_with(bytes, random);
}

}  // namespace hooke::fuzz
