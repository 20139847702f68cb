#include "solver/joint_rows/hook_rows.h"

#include <cstdint>

namespace hooke::solver {

JointBody joint_end(const state::Tables& t, const state::HookPlace& place) {
  if (!place.is_point()) return joint_body_now(t.bodies, place.body);
  JointBody end;
  end.scale = {};
  end.center = t.objects[place.object].origin;
  for (std::uint32_t i = 0; i < place.particle_count; ++i) {
    const auto weight = static_cast<double>(place.weight[i]);
    const state::VelocityRecord& record = t.particles.velocity[place.particle[i]];
    end.center += weight * vector_cast<double>(t.particles.position[place.particle[i]].x);
    end.v += weight * vector_cast<double>(record.v);
    end.inverse_mass += weight * weight * static_cast<double>(record.inverse_mass);
  }
  return end;
}

int make_rows(state::Hook& hook, const RowEnd& a, const RowEnd& b, double h,
              std::span<JointRow, state::Hook::kMaxRows> rows, double most_push) {
  const int count = make_joint_rows(hook, a.body, b.body, h, rows, most_push);
  for (JointRow& row : rows.first(static_cast<std::size_t>(count))) {
    if (a.given) row.target += dot(row.n, a.body.v) + dot(row.j_a, a.body.omega_scaled);
    if (b.given) row.target -= dot(row.n, b.body.v) + dot(row.j_b, b.body.omega_scaled);
  }
  return count;
}

}  // namespace hooke::solver
