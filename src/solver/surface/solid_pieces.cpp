#include "solver/surface/solid_pieces.h"

#include <cstddef>

namespace hooke::solver {

namespace {

/// Calls `visit(record, place)` with the points of a piece that have a mass, or are held.
template <class Visit>
void for_points(const state::Tables& t, base::DisjointSets& sets, const SolidPiece& piece, Visit visit) {
  const state::Rows rows = t.objects[piece.object].particles;
  for (std::uint32_t i = 0; i < rows.count; ++i) {
    if (sets.root(i) != piece.root) continue;
    visit(static_cast<double>(t.particles.velocity[rows.first + i].inverse_mass),
          vector_cast<double>(t.particles.position[rows.first + i].x));
  }
}

/// Takes mass, center and inertia of a piece from its points.
void weigh(const state::Tables& t, base::DisjointSets& sets, SolidPiece& piece) {
  double mass = 0;
  bool held = false;
  DVec3 sum;
  for_points(t, sets, piece, [&](double inverse_mass, DVec3 x) {
    held = held || !(inverse_mass > 0);
    if (held) return;
    mass += 1 / inverse_mass;
    sum += (1 / inverse_mass) * x;
  });
  if (held || !(mass > 0)) return;
  piece.inverse_mass = 1 / mass;
  piece.center = piece.inverse_mass * sum;
  math::Symmetric3<double> inertia;
  for_points(t, sets, piece, [&](double inverse_mass, DVec3 x) {
    inertia = inertia + math::inertia_of_point(1 / inverse_mass, x - piece.center);
  });
  piece.inverse_inertia = math::inverse(inertia);
}

}  // namespace

double SolidPiece::mobility(DVec3 place, DVec3 n) const {
  return dot(n, change_at(place, n, place));
}

DVec3 SolidPiece::change_at(DVec3 place, DVec3 impulse, DVec3 point) const {
  const DVec3 turn = inverse_inertia * cross(place - center, impulse);
  return inverse_mass * impulse + cross(turn, point - center);
}

SolidPieces::Solid& SolidPieces::solid_of(const state::Tables& t, std::uint32_t object) {
  for (std::size_t i = 0; i < solids_used_; ++i) {
    if (solids_[i].object == object) return solids_[i];
  }
  if (solids_used_ == solids_.size()) solids_.emplace_back();
  Solid& solid = solids_[solids_used_++];
  solid.object = object;
  const state::Deformable& of = t.objects[object];
  solid.sets.reset(of.particles.count);
  for (std::uint32_t i = of.tetrahedra.first; i < of.tetrahedra.end(); ++i) {
    const auto& [a, b, c, d] = t.tetrahedra.corners[i];
    for (const std::uint32_t p : {b, c, d}) solid.sets.merge(a - of.particles.first, p - of.particles.first);
  }
  return solid;
}

SolidPiece& SolidPieces::piece_at(const state::Tables& t, std::uint32_t object, std::uint32_t particle) {
  Solid& solid = solid_of(t, object);
  const std::uint32_t root = solid.sets.root(particle - t.objects[object].particles.first);
  for (SolidPiece& piece : pieces_) {
    if (piece.object == object && piece.root == root) return piece;
  }
  pieces_.push_back({.object = object, .root = root});
  weigh(t, solid.sets, pieces_.back());
  return pieces_.back();
}

bool SolidPieces::has(const state::Tables& t, const SolidPiece& piece, std::uint32_t particle) {
  return solid_of(t, piece.object).sets.root(particle - t.objects[piece.object].particles.first) ==
         piece.root;
}

}  // namespace hooke::solver
