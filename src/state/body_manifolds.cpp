#include "state/body_manifolds.h"

namespace hooke::state {

void BodyManifolds::list(const Tables& t) {
  if (!rows_.empty()) return;
  rows_.fill(t.bodies.motion.size(), [&](auto visit) {
    for (std::uint32_t row = 0; row < t.pairs.manifold.size(); ++row) {
      for (const std::uint32_t body : {t.pairs.manifold[row].body_a, t.pairs.manifold[row].body_b}) {
        if (gives_way(t.bodies, body)) visit(body, row);
      }
    }
  });
}

}  // namespace hooke::state
