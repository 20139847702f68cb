#include "state/body_manifolds.h"

#include <array>

namespace hooke::state {

void BodyManifolds::list(const Tables& t) {
  if (!first_.empty()) return;
  const auto for_ends = [&](auto visit) {
    for (std::uint32_t row = 0; row < t.pairs.manifold.size(); ++row) {
      for (const std::uint32_t body : {t.pairs.manifold[row].body_a, t.pairs.manifold[row].body_b}) {
        if (gives_way(t.bodies, body)) visit(body, row);
      }
    }
  };
  first_.assign(t.bodies.motion.size() + 2, 0);
  for_ends([&](std::uint32_t body, std::uint32_t) { ++first_[body + 2]; });
  for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
  row_.resize(first_.back());
  for_ends([&](std::uint32_t body, std::uint32_t row) { row_[first_[body + 1]++] = row; });
}

}  // namespace hooke::state
