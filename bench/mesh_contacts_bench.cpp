/// Measures contacts of two solids of triangles by trees of oriented boxes and by all pairs, over the number
/// of their faces: two rings that are linked and touch.

#include "geometry/meshes.h"
#include "lab/shape/mesh_contacts.h"

#include <benchmark/benchmark.h>
#include <cmath>

namespace {

using hooke::DVec3;
using hooke::Real;
using hooke::geometry::ContactMesh;
using hooke::geometry::Search;

void contacts(benchmark::State& state, Search search) {
  const auto across = static_cast<std::uint32_t>(state.range(0));
  const ContactMesh ring =
      hooke::geometry::make_contact_mesh(hooke::test::make_torus(1, Real(0.2), 2 * across, across)).value();
  const auto upright = hooke::quaternion_about(DVec3{1, 0, 0}, std::acos(-1.0) / 2);
  std::vector<hooke::collision::MeshContact> found;
  for ([[maybe_unused]] auto _ : state) {
    hooke::collision::find_mesh_contacts(ring, {}, ring, {{1.61, 0, 0}, upright}, {1e-4, search}, found);
    benchmark::DoNotOptimize(found.data());
  }
  state.counters["faces"] = static_cast<double>(ring.triangles.size());
  state.counters["contacts"] = static_cast<double>(found.size());
}

BENCHMARK_CAPTURE(contacts, tree, Search::kTree)
    ->RangeMultiplier(2)
    ->Range(4, 64)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(contacts, all, Search::kAll)
    ->RangeMultiplier(2)
    ->Range(4, 16)
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
