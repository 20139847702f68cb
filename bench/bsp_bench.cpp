/// Casts rays against a bumpy sphere of n triangles and against a building, in one thread, and prints the
/// time per ray: by the BSP tree, by the tree of boxes, by all triangles, and by Embree where it is
/// installed. It then measures the time to build the trees. `hits` is the share of rays that hit, the same
/// for all.

#include "geometry/bsp/bsp_tree.h"
#include "geometry/building.h"
#include "geometry/mesh/bvh.h"
#include "geometry/solids.h"

#include <benchmark/benchmark.h>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#ifdef HOOKE_EMBREE
#include <embree3/rtcore.h>
#endif

namespace {

using namespace hooke;
using geometry::SolidMesh;

struct Ray {
  DVec3 origin, direction;
};

/// Returns a sphere of 8 4^n triangles for n up to 9, and a building of n rooms squared, four storeys, for 10
/// and more.
const SolidMesh& mesh_of(std::int64_t n) {
  static std::map<std::int64_t, SolidMesh> meshes;
  const auto [entry, is_new] = meshes.try_emplace(n);
  if (is_new) {
    std::mt19937 random(1);
    const auto rooms = static_cast<std::size_t>(n);
    entry->second =
        n < 10 ? test::make_star(static_cast<int>(n), 0.8, random)
               : test::moved(test::make_building(rooms, 4, rooms), {}, 0.5 / (2.1 * n), {-1, -0.1, -1});
    // Coordinates are rounded to float, because the tree of boxes would otherwise hold another mesh.
    for (DVec3& p : entry->second.positions) p = vector_cast<double>(vector_cast<float>(p));
  }
  return entry->second;
}

std::vector<Ray> make_rays() {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> at(-1, 1);
  std::vector<Ray> rays(4096);
  for (Ray& ray : rays) {
    ray.origin = {1.2 * at(random), 1.2 * at(random), 1.2 * at(random)};
    ray.direction = {at(random), at(random), at(random)};
  }
  return rays;
}

template <class Ask>
void run(benchmark::State& state, const Ask& ask) {
  static const std::vector<Ray> rays = make_rays();
  std::size_t i = 0;
  std::size_t hits = 0;
  for (auto _ : state) hits += ask(rays[i++ % rays.size()]) ? 1 : 0;
  state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(i);
  state.counters["triangles"] = static_cast<double>(mesh_of(state.range(0)).triangles.size());
}

void ray_bsp(benchmark::State& state) {
  const auto tree = build_bsp(mesh_of(state.range(0))).value();
  run(state, [&](const Ray& ray) { return cast_ray(tree, ray.origin, ray.direction).has_value(); });
}

geometry::Bvh make_boxes(const SolidMesh& mesh) {
  std::vector<Vec3> positions;
  for (const DVec3& p : mesh.positions) positions.push_back(vector_cast<Real>(p));
  return geometry::build_bvh(positions, mesh.triangles);
}

void ray_boxes(benchmark::State& state) {
  const geometry::Bvh boxes = make_boxes(mesh_of(state.range(0)));
  run(state, [&](const Ray& ray) { return cast_ray(boxes, ray.origin, ray.direction).has_value(); });
}

void ray_all_triangles(benchmark::State& state) {
  const SolidMesh& mesh = mesh_of(state.range(0));
  run(state, [&](const Ray& ray) {
    bool hit = false;
    for (const auto& t : mesh.triangles) {
      const DVec3 a = mesh.positions[t[0]] - ray.origin;
      const DVec3 b = mesh.positions[t[1]] - ray.origin;
      const DVec3 c = mesh.positions[t[2]] - ray.origin;
      const double u = dot(ray.direction, cross(b, c));
      const double v = dot(ray.direction, cross(c, a));
      const double w = dot(ray.direction, cross(a, b));
      if ((u < 0 || v < 0 || w < 0) == (u > 0 || v > 0 || w > 0)) continue;
      const DVec3 normal = cross(b - a, c - a);
      hit = dot(normal, a) / dot(normal, ray.direction) >= 0 || hit;
    }
    return hit;
  });
}

#ifdef HOOKE_EMBREE
void ray_embree(benchmark::State& state) {
  const SolidMesh& mesh = mesh_of(state.range(0));
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry shape = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      shape, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
  for (const DVec3& p : mesh.positions) {
    for (const double x : {p.x, p.y, p.z}) *vertices++ = static_cast<float>(x);
  }
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      shape, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t vertex : t) *indices++ = vertex;
  }
  rtcCommitGeometry(shape);
  rtcAttachGeometry(scene, shape);
  rtcReleaseGeometry(shape);
  rtcCommitScene(scene);
  run(state, [&](const Ray& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query = {};
    const auto origin = vector_cast<float>(ray.origin);
    const auto direction = vector_cast<float>(ray.direction);
    query.ray = {origin.x, origin.y, origin.z, 0, direction.x, direction.y, direction.z, 0, 1e30f, ~0u, 0, 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &query);
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  });
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}
BENCHMARK(ray_embree)->DenseRange(2, 6)->Arg(15);
#endif

void inside_bsp(benchmark::State& state) {
  const auto tree = build_bsp(mesh_of(state.range(0))).value();
  run(state, [&](const Ray& ray) { return is_solid_at(tree, ray.origin); });
}

void build_planes(benchmark::State& state) {
  for (auto _ : state) {
    const auto tree = build_bsp(mesh_of(state.range(0))).value();
    const auto size = size_of(tree);
    state.counters["nodes"] = static_cast<double>(size.nodes);
    state.counters["depth"] = static_cast<double>(size.depth);
    state.counters["pieces"] = static_cast<double>(size.faces);
  }
}

void build_boxes(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(make_boxes(mesh_of(state.range(0))));
}

BENCHMARK(ray_bsp)->DenseRange(2, 6)->Arg(15);
BENCHMARK(ray_boxes)->DenseRange(2, 6)->Arg(15);
BENCHMARK(ray_all_triangles)->DenseRange(2, 4);
BENCHMARK(inside_bsp)->DenseRange(2, 6)->Arg(15);
BENCHMARK(build_planes)->DenseRange(2, 6)->Arg(15)->Unit(benchmark::kMillisecond);
BENCHMARK(build_boxes)->DenseRange(2, 6)->Arg(15)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
