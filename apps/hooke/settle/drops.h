#pragma once

#include "hooke/result.h"
#include "hooke/shape.h"
#include "hooke/statics.h"

#include <cstdint>
#include <vector>

namespace hooke::app {

/// How a solid is dropped again and again, or let go near its poses.
struct DropOptions {
  int count = 0;
  std::uint64_t seed = 1;
  double height = 0;  ///< Height of its lowest point at the start [m].
  double friction = 0.5;
  double restitution = 0;
  int workers = 1;  ///< Threads. Trials start from the same state, so that results do not depend on it.
};

/// A way to lie that is none of the stable poses.
struct OtherPose {
  DVec3 normal = {};  ///< Unit direction that points down, in the mesh's frame.
  int count = 0;      ///< Drops that ended within 2.6 degrees of it.
};

/// Where the drops ended.
struct DropCounts {
  std::vector<int> poses;  ///< For each stable pose, the number of drops that ended in it.
  int elsewhere = 0;       ///< Drops that came to rest in none of the poses, as one that balances on an edge.
  int moving = 0;          ///< Drops that had not come to rest after a minute.
  std::vector<OtherPose> others;  ///< How those elsewhere lie, in the order of the drops. Counts sum to them.
};

/// Returns the distance of the farthest point of a mesh from `center` [m].
double radius_of(const MeshDesc& mesh, DVec3 center);

/// Drops a closed mesh from random orientations, all equally probable, onto a plane in a World. The same
/// options give the same counts on every machine.
Result<DropCounts> drop(const MeshDesc& mesh, const StablePoses& poses, const DropOptions& options);

/// Trials of `disturb` for each pose: one that is lifted, and eight that are turned.
constexpr int kDisturbances = 9;

/// Lays a closed mesh in each of its poses, disturbs it, lets it go in a World, and returns for each pose the
/// number of the kDisturbances trials after which it lay in that pose again. It is lifted by `distance` [m],
/// or turned about eight horizontal axes through its center of mass until its farthest point has gone so far.
/// Its lowest point begins on the plane if it is turned. Of `options` only the contact and workers count.
Result<std::vector<int>> disturb(const MeshDesc& mesh, const StablePoses& poses, double distance,
                                 const DropOptions& options);

}  // namespace hooke::app
