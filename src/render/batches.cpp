#include "render/batches.h"

#include "render/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <tuple>
#include <unordered_map>

namespace hooke::render {

namespace {

constexpr float kFloorFlatness = 20;    ///< Floors are wider than this many times their thickness,
constexpr float kFloorWidth = 3;        ///< and than this many times all that is not flat.
constexpr float kStrandRelief = 0.35F;  ///< Height of a rope's strands, in its radii.

/// An Item is a copy of a mesh that will go into a batch.
struct Item {
  Batch batch;
  Instance instance;
  std::size_t geometry_order = 0;
  std::array<std::size_t, 3> texture_order = {};
  float eye_distance = 0;
};

auto batch_key(const Item& item) {
  const Batch& b = item.batch;
  return std::tuple(b.alpha, b.shading, b.density, item.geometry_order, item.texture_order, b.first_index,
                    b.index_count, b.two_sided, b.mirrored, b.casts_shadow);
}

/// Copies of one mesh are drawn from near to far: what they hide of each other is not shaded.
bool drawn_before(const Item& a, const Item& b) {
  if (a.batch.is_in_order || b.batch.is_in_order) return a.batch.is_in_order && !b.batch.is_in_order;
  const bool blends = a.batch.alpha == AlphaMode::kBlend && b.batch.alpha == AlphaMode::kBlend;
  if (blends) return a.eye_distance > b.eye_distance;
  const auto key_a = batch_key(a);
  const auto key_b = batch_key(b);
  return key_a == key_b ? a.eye_distance < b.eye_distance : key_a < key_b;
}

std::array<float, 12> rows_of(const Mat4& a) {
  return {a.m[0][0], a.m[1][0], a.m[2][0], a.m[3][0], a.m[0][1], a.m[1][1],
          a.m[2][1], a.m[3][1], a.m[0][2], a.m[1][2], a.m[2][2], a.m[3][2]};
}

std::array<float, 4> linear_of(Color color, float opacity) {
  const auto c = linear_of(color);
  return {c[0], c[1], c[2], std::clamp(opacity, 0.0F, 1.0F)};
}

/// Returns the box for the shadow map. A floor casts shadows too, but would take the whole map if it is much
/// wider than all that stands on it; its box is left out then, and its shadow ends where the map does.
Bounds box_of_casters(const std::vector<Bounds>& casters) {
  const auto is_flat = [](const Bounds& box) {
    const Vec3 size = box.high - box.low;
    return std::min(size.x, size.z) > kFloorFlatness * size.y;
  };
  Bounds upright;
  for (const Bounds& box : casters)
    if (!is_flat(box)) extend(upright, box);
  const float widest = is_empty(upright) ? 0 : kFloorWidth * length(upright.high - upright.low);
  Bounds result = upright;
  for (const Bounds& box : casters)
    if (is_flat(box) && (widest == 0 || length(box.high - box.low) <= widest)) extend(result, box);
  return result;
}

Instance make_instance(const Mat4& transform, const std::array<float, 4>& color, const Surface& surface) {
  const auto share = [](float x) { return std::clamp(x, 0.0F, 1.0F); };
  return {rows_of(transform),
          color,
          {share(surface.metalness), share(surface.roughness), share(surface.sheen),
           std::max(surface.threads, 0.0F)},
          {share(surface.transmission), surface.relief, 0, 0}};
}

/// Glass takes little of the light, jelly some.
float shadow_density(const DrawMesh& mesh) {
  return std::clamp(mesh.opacity, 0.0F, 1.0F) *
         (1 - 0.65F * std::clamp(mesh.surface.transmission, 0.0F, 1.0F));
}

/// Collects items; it keeps each geometry's box and order of appearance.
class Collector {
 public:
  explicit Collector(Vec3 eye) : eye_(eye) {}

  void add(Item item, const Mat4& transform) {
    const auto [place, is_new] = boxes_.try_emplace(item.batch.geometry.get());
    if (is_new) {
      place->second.order = boxes_.size();
      for (const Vertex& vertex : item.batch.geometry->vertices) extend(place->second.box, vertex.position);
    }
    item.geometry_order = place->second.order;
    const std::array images = {item.batch.texture.get(), item.batch.normals.get(), item.batch.finish.get()};
    for (std::size_t i = 0; i < images.size(); ++i)
      item.texture_order[i] = textures_.try_emplace(images[i], textures_.size()).first->second;
    const Bounds box = transformed(place->second.box, transform);
    item.eye_distance = is_empty(box) ? 0 : length(center_of(box) - eye_);
    result_.objects.push_back(box);
    if (item.batch.casts_shadow && !is_empty(box)) casters_.push_back(box);
    items_.push_back(std::move(item));
  }

  Batches finish() {
    result_.casters = box_of_casters(casters_);
    std::stable_sort(items_.begin(), items_.end(), drawn_before);
    const Item* previous = nullptr;
    for (const Item& item : items_) {
      // See-through copies stay apart, because others may lie between them.
      const bool joins = previous != nullptr && item.batch.alpha != AlphaMode::kBlend &&
                         !item.batch.is_in_order && batch_key(*previous) == batch_key(item);
      if (!joins) {
        result_.batches.push_back(item.batch);
        result_.batches.back().first_instance = result_.instances.size();
      }
      ++result_.batches.back().instance_count;
      result_.instances.push_back(item.instance);
      previous = &item;
    }
    return std::move(result_);
  }

 private:
  struct Known {
    Bounds box;
    std::size_t order = 0;
  };

  Vec3 eye_;
  Batches result_;
  std::vector<Item> items_;
  std::vector<Bounds> casters_;
  std::unordered_map<const MeshGeometry*, Known> boxes_;
  std::unordered_map<const Image*, std::size_t> textures_;
};

Result<Item> make_item(const DrawMesh& mesh, std::size_t index) {
  const std::size_t total = mesh.geometry->indices.size();
  const std::string where = "meshes[" + std::to_string(index) + "]";
  if (mesh.first_index > total || mesh.index_count > total - mesh.first_index) {
    return Error{ErrorCode::kOutOfRange, where,
                 "first_index " + std::to_string(mesh.first_index) + " and index_count " +
                     std::to_string(mesh.index_count) + " leave the " + std::to_string(total) + " indices"};
  }
  Item item;
  Batch& batch = item.batch;
  batch.geometry = mesh.geometry;
  batch.texture = mesh.texture;
  batch.normals = mesh.normals;
  batch.finish = mesh.finish;
  batch.first_index = mesh.first_index;
  batch.index_count = mesh.index_count > 0 ? mesh.index_count : total - mesh.first_index;
  if (batch.index_count % 3 != 0) {
    return Error{ErrorCode::kOutOfRange, where,
                 std::to_string(batch.index_count) + " indices are not whole triangles"};
  }
  const bool see_through =
      mesh.opacity < 1 || mesh.surface.transmission > 0 || mesh.alpha == AlphaMode::kBlend;
  batch.alpha = see_through ? AlphaMode::kBlend : mesh.alpha;
  batch.two_sided = mesh.two_sided;
  batch.mirrored = determinant(linear_part(mesh.transform)) < 0;
  batch.shading = mesh.surface.shading;
  batch.density = shadow_density(mesh);
  batch.casts_shadow = mesh.casts_shadow && batch.density > 0.02F;
  batch.is_in_order = mesh.is_in_order && batch.alpha == AlphaMode::kOpaque;
  batch.mesh = index;
  item.instance = make_instance(mesh.transform, linear_of(mesh.color, mesh.opacity), mesh.surface);
  return item;
}

std::vector<Vec3> roots_of_hairs(const DrawList& list) {
  std::vector<Vec3> roots;
  for (const DrawRope& rope : list.ropes) {
    if (rope.surface.shading != Shading::kHair) continue;
    roots.push_back(rope.points.empty() ? Vec3{NAN, NAN, NAN} : rope.points.front());
  }
  return roots;
}

/// Whether ropes are tubes, or tufts of hair with all hairs or a part of them.
enum class RopeLook : std::uint8_t { kTubes, kTufts, kFewHairs };

/// Adds all tubes, or all tufts of hair, to one mesh, each as a range of its own.
void collect_ropes(const DrawList& list, RopeLook look, MeshGeometry& mesh,
                   const std::shared_ptr<MeshGeometry>& owner, Collector& collector) {
  mesh.vertices.clear();
  mesh.indices.clear();
  ++mesh.vertex_revision;
  ++mesh.topology_revision;
  std::vector<Item> items;
  const bool hairs = look != RopeLook::kTubes;
  const std::vector<Vec3> roots = hairs ? roots_of_hairs(list) : std::vector<Vec3>{};
  std::uint32_t tuft = 0;
  for (const DrawRope& rope : list.ropes) {
    if ((rope.surface.shading == Shading::kHair) != hairs) continue;
    Item item;
    item.batch.first_index = mesh.indices.size();
    if (hairs) {
      const float spread = tuft_spread(roots, tuft, rope.radius);
      const bool few = look == RopeLook::kFewHairs;
      add_tuft(rope.points, {rope.radius, spread, tuft++, few}, list.camera.eye, mesh);
    } else {
      add_tube(rope.points, rope.radius, mesh);
    }
    item.batch.index_count = mesh.indices.size() - item.batch.first_index;
    if (item.batch.index_count == 0) continue;
    item.batch.geometry = owner;
    item.batch.shading = rope.surface.shading;
    item.batch.two_sided = hairs;
    Surface surface = rope.surface;
    if (surface.shading == Shading::kRope) surface.threads = kStrandRelief * rope.radius;
    item.instance = make_instance(Mat4{}, linear_of(rope.color, 1), surface);
    items.push_back(std::move(item));
  }
  // Only now is the mesh complete and its box known.
  for (Item& item : items) collector.add(std::move(item), Mat4{});
}

void collect_spheres(const DrawList& list, int height_px, const SharedMeshes& shared, Collector& collector) {
  const float half_angle = list.camera.vertical_fov_deg * std::numbers::pi_v<float> / 360;
  const float pixels = 0.5F * static_cast<float>(height_px) / std::max(std::tan(half_angle), 1e-3F);
  for (const DrawSphere& sphere : list.spheres) {
    if (!is_finite(sphere.center) || !(sphere.radius > 0)) continue;
    const float distance = std::max(length(sphere.center - list.camera.eye), 1e-3F);
    const float radius_px = pixels * sphere.radius / distance;
    // The silhouette of each sphere is within half a pixel of the circle at the size where the next one
    // starts.
    const std::size_t detail = radius_px < 8 ? 0 : radius_px < 60 ? 1 : 2;
    Item item;
    item.batch.geometry = shared.spheres[detail];
    item.batch.index_count = item.batch.geometry->indices.size();
    const float r = sphere.radius;
    const Mat4 transform = affine(Mat3{{r, 0, 0}, {0, r, 0}, {0, 0, r}}, sphere.center);
    item.batch.shading = sphere.surface.shading;
    item.instance = make_instance(transform, linear_of(sphere.color, 1), sphere.surface);
    collector.add(std::move(item), transform);
  }
}

}  // namespace

SharedMeshes make_shared_meshes() {
  SharedMeshes shared;
  for (std::size_t i = 0; i < shared.spheres.size(); ++i) {
    shared.spheres[i] = std::make_shared<const MeshGeometry>(make_sphere(static_cast<int>(i) + 2));
  }
  shared.ropes = std::make_shared<MeshGeometry>();
  shared.hairs = std::make_shared<MeshGeometry>();
  return shared;
}

Result<Batches> make_batches(const DrawList& list, int height_px, bool fast, SharedMeshes& shared) {
  Collector collector(list.camera.eye);
  for (std::size_t i = 0; i < list.meshes.size(); ++i) {
    const DrawMesh& mesh = list.meshes[i];
    if (!mesh.geometry || mesh.geometry->indices.empty() || !(mesh.opacity > 0)) continue;
    auto item = make_item(mesh, i);
    if (!item) return item.error();
    collector.add(std::move(item).value(), mesh.transform);
  }
  collect_ropes(list, RopeLook::kTubes, *shared.ropes, shared.ropes, collector);
  collect_ropes(list, fast ? RopeLook::kFewHairs : RopeLook::kTufts, *shared.hairs, shared.hairs, collector);
  collect_spheres(list, height_px, shared, collector);
  return collector.finish();
}

std::array<float, 3> linear_of(Color color) {
  const auto decode = [](float c) {
    const float x = std::clamp(c, 0.0F, 1.0F);
    return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
  };
  return {decode(color.r), decode(color.g), decode(color.b)};
}

}  // namespace hooke::render
