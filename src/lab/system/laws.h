#pragma once

#include "lab/system/system.h"
#include "world/access.h"

namespace hooke::lab {

/// Calls the user's force laws. They see a copy of the World's tables, in its precision, with the object
/// where it is now. A law is a black box: it has no derivatives.
class Laws {
 public:
  Laws(const state::Tables& tables, std::uint32_t object)
      : tables_(tables), object_(object), forces_(tables.particles.position.size()) {}

  /// Adds the forces of all laws on the object's rows [N].
  void add(double time, const std::vector<DVec3>& x, const std::vector<DVec3>& v, std::vector<DVec3>& force) {
    const state::Deformable& object = tables_.objects[object_];
    const std::size_t first = object.particles.first;
    for (std::size_t i = 0; i < x.size(); ++i) {
      tables_.particles.position[first + i].x = vector_cast<Real>(x[i] - object.origin);
      tables_.particles.velocity[first + i].v = vector_cast<Real>(v[i]);
      forces_[first + i] = {};
    }
    for (const state::ForceLawEntry& entry : tables_.force_laws) {
      ForceView view = ForceViewAccess::make(tables_, object, time, forces_.data());
      if (entry.law) entry.law(view);
    }
    for (std::size_t i = 0; i < x.size(); ++i) force[i] += vector_cast<double>(forces_[first + i]);
  }

 private:
  state::Tables tables_;
  std::uint32_t object_;
  std::vector<Vec3> forces_;
};

}  // namespace hooke::lab
