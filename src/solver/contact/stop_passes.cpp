#include "solver/contact/stop_passes.h"

#include "base/sort_unique.h"
#include "solver/soft/element_contact_solve.h"
#include "solver/soft/particle_contact_solve.h"
#include "solver/soft/soft_tuning.h"

#include <algorithm>
#include <vector>

namespace hooke::solver {

void stop_passes(Real h, std::span<state::ElementContact> passes, BackingContacts& backing,
                 BodyContacts& contacts, state::Tables& t) {
  backing.begin(h, t.bodies, contacts);
  for (const state::ElementContact& pass : passes) {
    if (state::gives_way(t.bodies, pass.body)) backing.reach(pass.body);
  }
  std::vector<std::uint32_t> points;
  for (const state::ElementContact& pass : passes)
    points.insert(points.end(), pass.particle.begin(), pass.particle.begin() + pass.count);
  base::sort_unique(points);
  Real enough = Real(0);
  for (int sweep = 0; sweep < kMostPassSweeps; ++sweep) {
    Real largest = Real(0);
    for (state::ElementContact& pass : passes) largest = std::max(largest, stop_pass(h, pass, t));
    for (const std::uint32_t point : points) stop_at_ground(point, h, t);
    if (sweep == 0) enough = kPassAccuracy * largest;
    largest = std::max(largest, backing.solve(enough, t.bodies, contacts));
    if (largest <= enough) return;
  }
}

}  // namespace hooke::solver
