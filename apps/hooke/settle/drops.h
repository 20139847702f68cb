#pragma once

#include "hooke/result.h"
#include "hooke/shape.h"
#include "hooke/statics.h"

#include <cstdint>
#include <vector>

namespace hooke::app {

/// How a solid is dropped again and again.
struct DropOptions {
  int count = 0;
  std::uint64_t seed = 1;
  double height = 0;  ///< Height of its lowest point at the start [m].
  double friction = 0.5;
  double restitution = 0;
};

/// Where the drops ended.
struct DropCounts {
  std::vector<int> poses;  ///< For each stable pose, the number of drops that ended in it.
  int elsewhere = 0;       ///< Drops that came to rest in none of the poses, as one that balances on an edge.
  int moving = 0;          ///< Drops that had not come to rest after a minute.
};

/// Drops a closed mesh from random orientations, all equally probable, onto a plane in a World. The same
/// options give the same counts on every machine.
Result<DropCounts> drop(const MeshDesc& mesh, const StablePoses& poses, const DropOptions& options);

}  // namespace hooke::app
