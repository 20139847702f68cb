#pragma once

#include "base/lists_by_key.h"
#include "state/tables.h"

#include <cstdint>
#include <span>

/// \file
/// Which manifolds a body has, for what asks by body.

namespace hooke::state {

/// Rows of Pairs::manifold by body. They stay the same within a step, also where points are found again.
class BodyManifolds {
 public:
  /// Forgets everything; the next look lists them anew.
  void clear() { rows_.clear(); }

  /// Lists the manifolds of all bodies, unless that has been done since clear().
  void list(const Tables& tables);

  /// Rows of the body's manifolds, in order. Bodies that do not give way have none.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t body) const { return rows_.of(body); }

 private:
  base::ListsByKey<std::uint32_t> rows_;
};

}  // namespace hooke::state
