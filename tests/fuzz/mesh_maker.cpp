#include "fuzz/mesh_maker.h"

#include <cmath>
#include <utility>

namespace hooke::fuzz {

namespace {

constexpr double kTurn = 6.283185307179586;

/// A closed band of `sides` x `rings` quads with the corners where `place` says, closed by fans at both ends
/// unless it is a ring.
template <class Place>
MeshDesc make_band(std::uint32_t sides, std::uint32_t rings, bool is_ring, const Place& place) {
  MeshDesc mesh;
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t s = 0; s < sides; ++s) mesh.positions.push_back(place(s, r));
  }
  const std::uint32_t quads = is_ring ? rings : rings - 1;
  for (std::uint32_t r = 0; r < quads; ++r) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t a = r * sides + s;
      const std::uint32_t b = r * sides + (s + 1) % sides;
      const std::uint32_t c = (r + 1) % rings * sides + s;
      const std::uint32_t d = (r + 1) % rings * sides + (s + 1) % sides;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  for (std::uint32_t s = 1; !is_ring && s + 1 < sides; ++s) {
    const std::uint32_t top = (rings - 1) * sides;
    mesh.triangles.push_back({0, s, s + 1});
    mesh.triangles.push_back({top, top + s + 1, top + s});
  }
  return mesh;
}

/// A prism, or a star with corners at two radii.
MeshDesc make_prism(Random& random, double size) {
  const std::uint32_t sides = 3 + random.index(7);
  const std::uint32_t rings = 2 + random.index(3);
  const double height = size * random.between(0.1, 2);
  const double waist = random.chance(0.5) ? 1 : random.between(0.2, 1);
  const double taper = random.chance(0.7) ? 1 : random.between(0.1, 1);
  return make_band(sides, rings, false, [&](std::uint32_t s, std::uint32_t r) {
    const double angle = kTurn * s / sides;
    const double up = static_cast<double>(r) / (rings - 1);
    const double radius = size * (s % 2 == 0 ? 1 : waist) * (1 + (taper - 1) * up);
    return Vec3{static_cast<Real>(radius * std::cos(angle)), static_cast<Real>(height * (up - 0.5)),
                static_cast<Real>(-radius * std::sin(angle))};
  });
}

MeshDesc make_ring(Random& random, double size) {
  const std::uint32_t sides = 3 + random.index(4);
  const std::uint32_t rings = 3 + random.index(6);
  const double thick = size * random.between(0.05, 0.45);
  return make_band(sides, rings, true, [&](std::uint32_t s, std::uint32_t r) {
    const double a = kTurn * s / sides;
    const double b = kTurn * r / rings;
    const double radius = size + thick * std::cos(a);
    return Vec3{static_cast<Real>(radius * std::cos(b)), static_cast<Real>(thick * std::sin(a)),
                static_cast<Real>(radius * std::sin(b))};
  });
}

void append(const MeshDesc& other, Vec3 offset, MeshDesc& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3 p : other.positions) mesh.positions.push_back(p + offset);
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

MeshDesc make_soup(Random& random, double size) {
  MeshDesc mesh;
  const int points = random.integer(3, 30);
  for (int i = 0; i < points; ++i) mesh.positions.push_back(random.vector(size));
  const int triangles = random.integer(0, 40);
  for (int i = 0; i < triangles; ++i) {
    mesh.triangles.push_back({random.index(mesh.positions.size()), random.index(mesh.positions.size()),
                              random.index(mesh.positions.size())});
  }
  return mesh;
}

void spoil_point(Random& random, double size, MeshDesc& mesh) {
  Vec3& p = mesh.positions[random.below(mesh.positions.size())];
  switch (random.below(5)) {
    case 0:
      p = p + random.vector(size);
      break;
    case 1:
      p = mesh.positions[random.below(mesh.positions.size())];
      break;
    case 2:
      p = p + random.vector(1e-6 * size);
      break;
    case 3:
      p.x = static_cast<Real>(bad_number(random));
      break;
    default:
      p = static_cast<Real>(random.pick<double>({0, 1e-4, 1e3, 1e6})) * p;
  }
}

void spoil_triangle(Random& random, MeshDesc& mesh) {
  const std::size_t i = random.below(mesh.triangles.size());
  auto& triangle = mesh.triangles[i];
  switch (random.below(6)) {
    case 0:
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    case 1:
      mesh.triangles.push_back(std::array(triangle));
      break;
    case 2:
      std::swap(triangle[0], triangle[1]);
      break;
    case 3:
      triangle[random.below(3)] = random.index(mesh.positions.size());
      break;
    case 4:
      triangle[0] = triangle[1];
      break;
    default:
      triangle[random.below(3)] = static_cast<std::uint32_t>(
          random.pick<std::uint64_t>({mesh.positions.size(), 0xFFFFFFFF, 0x7FFFFFFF, 1U << 24}));
  }
}

}  // namespace

MeshDesc make_solid(Random& random, double size) {
  MeshDesc mesh = random.chance(0.3) ? make_ring(random, size) : make_prism(random, size);
  if (random.chance(0.1)) append(make_prism(random, size), {static_cast<Real>(4 * size), 0, 0}, mesh);
  return mesh;
}

MeshDesc make_hostile_mesh(Random& random, double size) {
  MeshDesc mesh = random.chance(0.25) ? make_soup(random, size) : make_solid(random, size);
  if (random.chance(0.1)) append(make_solid(random, size), random.vector(size), mesh);
  const int changes = random.integer(0, 4);
  for (int i = 0; i < changes && !mesh.triangles.empty(); ++i) {
    if (random.chance(0.5)) {
      spoil_point(random, size, mesh);
    } else {
      spoil_triangle(random, mesh);
    }
  }
  return mesh;
}

}  // namespace hooke::fuzz
