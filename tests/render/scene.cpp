#include "render/scene.h"

#include "render/shapes.h"

#include <array>
#include <cstdio>

namespace hooke::render_test {

namespace {

using render::DrawList;
using render::DrawMesh;
using render::Image;
using render::MeshGeometry;

constexpr int kClothSide = 60;

std::shared_ptr<MeshGeometry> make_cloth(float time) {
  auto cloth = std::make_shared<MeshGeometry>();
  for (int j = 0; j <= kClothSide; ++j) {
    for (int i = 0; i <= kClothSide; ++i) {
      const float u = static_cast<float>(i) / kClothSide;
      const float v = static_cast<float>(j) / kClothSide;
      // A flag: fixed at u = 0, folds that grow toward the free end.
      const float fold =
          0.16F * u * std::sin(11 * u + 2.5F * v - 6 * time) + 0.05F * u * std::sin(23 * u - 4 * v);
      cloth->vertices.push_back({{1.9F * u, 1.25F * v - 0.12F * u * u, fold}, {}, u, v});
    }
  }
  for (std::uint32_t j = 0; j < kClothSide; ++j) {
    for (std::uint32_t i = 0; i < kClothSide; ++i) {
      const std::uint32_t a = j * (kClothSide + 1) + i;
      const std::uint32_t b = a + kClothSide + 1;
      cloth->indices.insert(cloth->indices.end(), {a, a + 1, b, b, a + 1, b + 1});
    }
  }
  render::update_normals(*cloth);
  return cloth;
}

/// Stripes whose gaps are holes.
std::shared_ptr<const Image> make_lattice() {
  Image image{128, 128, 4, {}};
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      const bool solid = (x + y) % 32 < 12 || (x - y + 128) % 32 < 12;
      const std::uint8_t shade = solid ? 255 : 200;
      image.pixels.insert(image.pixels.end(),
                          {shade, shade, shade, static_cast<std::uint8_t>(solid ? 255 : 0)});
    }
  }
  return std::make_shared<const Image>(image);
}

DrawMesh place(std::shared_ptr<const MeshGeometry> geometry, Vec3 position, Quat rotation = {}) {
  DrawMesh mesh;
  mesh.geometry = std::move(geometry);
  mesh.transform = make_transform(position, rotation, Vec3{1, 1, 1});
  return mesh;
}

void add_solids(DrawList& list) {
  const auto box = std::make_shared<const MeshGeometry>(render::make_box({0.35F, 0.35F, 0.35F}));
  DrawMesh textured = place(box, {-1.3F, 0.35F, 0.9F}, quaternion_about(Vec3{0, 1, 0}, 0.5F));
  textured.texture = make_checkers(4, {0.93F, 0.88F, 0.78F}, {0.30F, 0.45F, 0.62F});
  textured.color = {1, 1, 1};
  list.meshes.push_back(textured);
  const auto plank = std::make_shared<const MeshGeometry>(render::make_box({0.30F, 0.12F, 0.2F}));
  for (int i = 0; i < 4; ++i) {
    DrawMesh brick = place(
        plank, {-0.1F + 0.02F * static_cast<float>(i % 2), 0.12F + 0.24F * static_cast<float>(i), 0.35F},
        quaternion_about(Vec3{0, 1, 0}, 0.4F * static_cast<float>(i)));
    brick.color = {0.72F, 0.36F, 0.27F};
    list.meshes.push_back(brick);
  }
  const auto ball = std::make_shared<const MeshGeometry>(render::make_sphere(4));
  DrawMesh sphere = place(ball, {0.95F, 0.4F, 1.2F});
  sphere.transform = make_transform(Vec3{0.95F, 0.4F, 1.2F}, Quat{}, Vec3{0.4F, 0.4F, 0.4F});
  sphere.color = {0.85F, 0.62F, 0.18F};
  sphere.surface = {.metalness = 1, .roughness = 0.25F};
  list.meshes.push_back(sphere);
  DrawMesh jelly = place(box, {2.2F, 0.35F, 0.4F}, quaternion_about(Vec3{0, 1, 0}, -0.3F));
  jelly.color = {0.35F, 0.70F, 0.40F};
  jelly.surface.transmission = 0.55F;
  jelly.two_sided = true;
  list.meshes.push_back(jelly);
  const auto capsule = std::make_shared<const MeshGeometry>(render::make_capsule(0.16F, 0.3F));
  DrawMesh lying = place(capsule, {-0.35F, 0.16F, 1.5F}, quaternion_about(Vec3{0.25F, 0, 1}, 1.5708F));
  lying.color = {0.50F, 0.42F, 0.68F};
  list.meshes.push_back(lying);
}

void add_flag(DrawList& list, float time) {
  DrawMesh flag = place(make_cloth(time), {-1.6F, 1.35F, -0.5F}, quaternion_about(Vec3{0, 1, 0}, 0.25F));
  flag.texture = make_checkers(6, {0.86F, 0.24F, 0.22F}, {0.95F, 0.92F, 0.86F});
  flag.color = {1, 1, 1};
  flag.two_sided = true;
  flag.surface = {.shading = render::Shading::kCloth, .roughness = 0.8F, .sheen = 0.3F};
  list.meshes.push_back(flag);
  const auto pole = std::make_shared<const MeshGeometry>(render::make_cylinder(0.035F, 1.4F));
  DrawMesh mast = place(pole, {-1.63F, 1.4F, -0.5F});
  mast.color = {0.55F, 0.56F, 0.60F};
  mast.surface = {.metalness = 1, .roughness = 0.4F};
  list.meshes.push_back(mast);
  const auto post = std::make_shared<const MeshGeometry>(render::make_box({0.5F, 0.5F, 0.01F}));
  DrawMesh fence = place(post, {2.4F, 0.5F, -0.9F}, quaternion_about(Vec3{0, 1, 0}, -0.5F));
  fence.texture = make_lattice();
  fence.alpha = render::AlphaMode::kCutout;
  fence.color = {0.85F, 0.80F, 0.70F};
  list.meshes.push_back(fence);
}

void add_ropes(DrawList& list) {
  render::DrawRope hanging;
  hanging.radius = 0.03F;
  for (int i = 0; i <= 16; ++i) {
    const float x = static_cast<float>(i) / 8 - 1;
    hanging.points.push_back({0.95F + 1.0F * x, 1.0F + 0.9F * (std::cosh(1.2F * x) - 1), -0.2F});
  }
  list.ropes.push_back(hanging);
  render::DrawRope coil;
  coil.radius = 0.035F;
  coil.color = {0.30F, 0.40F, 0.55F};
  for (int i = 0; i <= 40; ++i) {
    const float angle = 0.45F * static_cast<float>(i);
    const float r = 0.12F + 0.008F * static_cast<float>(i);
    coil.points.push_back({0.45F + r * std::cos(angle), 0.035F, 2.1F + r * std::sin(angle)});
  }
  list.ropes.push_back(coil);
}

}  // namespace

std::shared_ptr<const Image> make_checkers(int squares, render::Color a, render::Color b) {
  const int side = 64 * squares;
  Image image{side, side, 3, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const render::Color c = (x / 64 + y / 64) % 2 == 0 ? a : b;
      for (const float part : {c.r, c.g, c.b})
        image.pixels.push_back(static_cast<std::uint8_t>(255 * part + 0.5F));
    }
  }
  return std::make_shared<const Image>(image);
}

render::DrawList make_scene(float time) {
  DrawList list;
  list.camera = {{1.6F, 2.0F, 5.6F}, {0.25F, 0.85F, 0}, {0, 1, 0}, 40};
  list.sun.direction = {0.75F, 0.8F, 0.35F};
  add_solids(list);
  add_flag(list, time);
  add_ropes(list);
  for (int i = 0; i < 12; ++i) {
    const float angle = 0.7F * static_cast<float>(i);
    list.spheres.push_back({{-0.9F + 0.25F * std::cos(angle), 0.06F + 0.02F * static_cast<float>(i),
                             2.1F + 0.25F * std::sin(angle)},
                            0.06F,
                            {0.30F, 0.62F, 0.66F}});
  }
  for (int i = 0; i < 30; ++i) {
    const float t = static_cast<float>(i) / 10;
    const float next = static_cast<float>(i + 1) / 10;
    const auto at = [](float s) { return Vec3{-0.5F + 0.9F * s, 0.9F + 1.1F * s - 0.45F * s * s, 0.6F}; };
    list.lines.push_back({at(t), at(next), {0.9F, 0.45F, 0.1F}, 0.8F, 2});
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "t = %.2f s", static_cast<double>(time));
  list.texts.push_back({12, 12, 24, {0.12F, 0.14F, 0.18F}, text.data()});
  return list;
}

}  // namespace hooke::render_test
