#include "solver/surface/surface_truncation.h"

#include "base/assert.h"
#include "solver/surface/surface_detection.h"
#include "solver/surface/surface_kernels.h"
#include "solver/surface/surface_tuning.h"

#include <algorithm>
#include <array>
#include <limits>

namespace hooke::solver {

namespace {

/// Measures how far apart pairs are. Returns whether one is nearer than it may be.
bool measure_pairs(const SurfaceContacts& contacts, SurfaceGroup& group, Real certain = Real(0)) {
  const bool faces = wide::measure_pairs(group.face_pairs, false, certain, contacts.position.data());
  const bool edges = wide::measure_pairs(group.edge_pairs, true, certain, contacts.position.data());
  return faces || edges;
}

/// Sets how far apart pairs stay in this substep, from where they were measured last, and measures them.
bool measure_pairs_first(const SurfaceContacts& contacts, SurfaceGroup& group) {
  return measure_pairs(contacts, group, Real(3) * group.reserve);
}

/// Moves the vertices of one group and looks at its pairs.
class Truncation {
 public:
  Truncation(Real h, SurfaceContacts& contacts, SurfaceGroup& group, state::Tables& tables)
      : h_(h),
        c_(contacts),
        group_(group),
        tables_(tables),
        particles_(tables.particles),
        displacement_(vector_cast<Real>(group.displacement)) {}

  void run() {
    if (group_.overflows) return hold_all();
    clip_all();
    group_.pieces.clear();
    part_pairs();
    give_back_momentum();
  }

 private:
  void part_pairs() {
    int rounds = 0;
    for (bool near = measure_pairs_first(c_, group_); near; near = measure_pairs(c_, group_)) {
      if (rounds == kCorrectionRounds || work_ > kMostCorrectionWork) return hold_back();
      list_hot();
      while (rounds < kCorrectionRounds && work_ <= kMostCorrectionWork) {
        ++rounds;
        if (!correct_hot()) break;
      }
    }
  }

  [[nodiscard]] Vec3 x(std::uint32_t vertex) const { return c_.position[vertex].x; }

  /// Where the vertex is, relative to its cage.
  [[nodiscard]] Vec3 displacement_of(std::uint32_t vertex) const {
    return x(vertex) - c_.found_at[vertex].x - displacement_;
  }

  void move(std::uint32_t vertex, Vec3 by) {
    state::PositionRecord& record = particles_.position[c_.surfaces.particle[vertex]];
    record.x += by;
    c_.position[vertex].x = record.x + c_.shift[c_.surfaces.mesh_of[vertex]];
  }

  void clip_all() {
    for_vertices(c_, group_, [&](std::uint32_t vertex, std::uint32_t mesh) {
      c_.position[vertex].x = particles_.position[c_.surfaces.particle[vertex]].x + c_.shift[mesh];
      const Vec3 displacement = displacement_of(vertex);
      Vec3 clipped = displacement;
      if (!clip_to_cage(c_.cage[vertex], clipped)) return;
      move(vertex, clipped - displacement);
    });
  }

  struct Pair {
    SurfacePairBlock* block;
    int lane;
    std::size_t first_side;  ///< Number of vertices on the first side.

    [[nodiscard]] std::uint32_t vertex(std::size_t k) const { return block->record[k][lane] / 4; }
    [[nodiscard]] Vec3 normal() const {
      return {block->normal[0][lane], block->normal[1][lane], block->normal[2][lane]};
    }
  };

  /// Pairs of faces have even numbers, those of edges odd ones.
  [[nodiscard]] Pair pair_at(std::uint32_t number) {
    const std::uint32_t i = number / 2;
    auto& blocks = number % 2 == 0 ? group_.face_pairs : group_.edge_pairs;
    return {&blocks[i / kLanes], static_cast<int>(i % kLanes),
            number % 2 == 0 ? std::size_t{1} : std::size_t{2}};
  }

  /// Calls `visit` with the number of each pair that is nearer than `slack(block, lane)` allows.
  template <class Slack, class Visit>
  void for_near(Slack slack, Visit visit) {
    for (std::uint32_t kind = 0; kind < 2; ++kind) {
      const auto& blocks = kind == 0 ? group_.face_pairs : group_.edge_pairs;
      for (std::uint32_t i = 0; i < blocks.size(); ++i) {
        for (int lane = 0; lane < blocks[i].count; ++lane) {
          if (blocks[i].now[lane] < blocks[i].least[lane] + slack(blocks[i], lane))
            visit(2 * (i * kLanes + static_cast<std::uint32_t>(lane)) + kind);
        }
      }
    }
  }

  void list_hot() {
    group_.hot.clear();
    for_near(
        [](const SurfacePairBlock& block, int lane) { return kHotShare / kKeptShare * block.most[lane]; },
        [&](std::uint32_t number) { group_.hot.push_back(number); });
  }

  /// The vertices of both sides that are nearest to the other side, and how far apart they are.
  struct Critical {
    std::uint32_t first = 0, second = 0;
    Real gap = Real(0);
  };

  [[nodiscard]] Critical critical_of(const Pair& pair) const {
    const Vec3 n = pair.normal();
    Critical found;
    Real least = std::numeric_limits<Real>::infinity();
    Real most = -least;
    for (std::size_t k = 0; k < 4; ++k) {
      const Real at = dot(n, x(pair.vertex(k)));
      if (k < pair.first_side && at < least) {
        least = at;
        found.first = pair.vertex(k);
      } else if (k >= pair.first_side && at > most) {
        most = at;
        found.second = pair.vertex(k);
      }
    }
    found.gap = least - most;
    return found;
  }

  /// Changes the velocity of a vertex by what it was moved, and notes the momentum.
  void speed_up(std::uint32_t vertex, Vec3 moved) {
    state::VelocityRecord& record = particles_.velocity[c_.surfaces.particle[vertex]];
    if (!(record.inverse_mass > Real(0))) return;
    record.v += (Real(1) / h_) * moved;
    gained_ += (1 / static_cast<double>(record.inverse_mass)) * vector_cast<double>(moved);
  }

  [[nodiscard]] Real inverse_mass(std::uint32_t vertex) const {
    return particles_.velocity[c_.surfaces.particle[vertex]].inverse_mass;
  }

  /// Moves a vertex as far as its cage allows, which becomes velocity.
  void correct(std::uint32_t vertex, Vec3 by) {
    const Vec3 displacement = displacement_of(vertex);
    Vec3 clipped = displacement + by;
    clip_to_cage(c_.cage[vertex], clipped);
    const Vec3 moved = clipped - displacement;
    move(vertex, moved);
    speed_up(vertex, moved);
  }

  /// What moves where a vertex is pushed: the vertex, or the piece of a stiff solid that it belongs to.
  struct Mover {
    std::uint32_t vertex = 0;
    SolidPiece* piece = nullptr;
    DVec3 place = {};         ///< Where a piece is pushed, from its object's origin [m].
    Real mobility = Real(0);  ///< [1/kg]
  };

  [[nodiscard]] DVec3 place_of(std::uint32_t vertex) const {
    return vector_cast<double>(particles_.position[c_.surfaces.particle[vertex]].x);
  }

  /// A piece is pushed at `place`, from the group's origin: both sides at the same one, so that they keep
  /// their angular momentum.
  [[nodiscard]] Mover mover_of(std::uint32_t vertex, Vec3 n, Vec3 place, bool whole) {
    const std::uint32_t object = c_.surfaces.object_of(vertex);
    if (!whole || c_.stiff[object] == 0) return {vertex, nullptr, {}, inverse_mass(vertex)};
    SolidPiece& piece = group_.pieces.piece_at(tables_, object, c_.surfaces.particle[vertex]);
    const DVec3 at = vector_cast<double>(place - c_.shift[c_.surfaces.mesh_of[vertex]]);
    const double mobility = piece.inverse_mass > 0 ? piece.mobility(at, vector_cast<double>(n)) : 0;
    return {vertex, &piece, at, static_cast<Real>(mobility)};
  }

  /// How much of a displacement the cage of a vertex allows, from 0 to 1.
  [[nodiscard]] Real share_within(std::uint32_t vertex, Vec3 by) const {
    const Vec3 displacement = displacement_of(vertex);
    Vec3 clipped = displacement + by;
    if (!clip_to_cage(c_.cage[vertex], clipped)) return Real(1);
    const Real length = length_squared(by);
    return length > Real(0) ? std::clamp(dot(clipped - displacement, by) / length, Real(0), Real(1))
                            : Real(1);
  }

  /// How much of an impulse times time the cages of a piece allow it to take, from 0 to 1.
  [[nodiscard]] Real share_of(const Mover& mover, Vec3 push) {
    Real share = Real(1);
    if (mover.piece == nullptr || !(mover.mobility > Real(0))) return share;
    const SurfaceMesh& mesh = c_.surfaces.meshes[c_.surfaces.mesh_of[mover.vertex]];
    for (std::uint32_t vertex = mesh.first_vertex; vertex < mesh.end_vertex(); ++vertex) {
      if (!group_.pieces.has(tables_, *mover.piece, c_.surfaces.particle[vertex])) continue;
      const DVec3 by = mover.piece->change_at(mover.place, vector_cast<double>(push), place_of(vertex));
      share = std::min(share, share_within(vertex, vector_cast<Real>(by)));
    }
    return share;
  }

  /// Moves what is pushed, which becomes velocity.
  void push_away(const Mover& mover, Vec3 push) {
    if (!(mover.mobility > Real(0))) return;
    if (mover.piece == nullptr) return correct(mover.vertex, mover.mobility * push);
    SolidPiece& piece = *mover.piece;
    const DVec3 impulse = vector_cast<double>(push);
    const state::Rows rows = tables_.objects[piece.object].particles;
    work_ += rows.count / 4;
    for (std::uint32_t p = rows.first; p < rows.end(); ++p) {
      if (!group_.pieces.has(tables_, piece, p)) continue;
      const DVec3 place = vector_cast<double>(particles_.position[p].x);
      const Vec3 by = vector_cast<Real>(piece.change_at(mover.place, impulse, place));
      particles_.position[p].x += by;
      particles_.velocity[p].v += (Real(1) / h_) * by;
    }
    const std::uint32_t number = c_.surfaces.mesh_of[mover.vertex];
    const SurfaceMesh& mesh = c_.surfaces.meshes[number];
    for (std::uint32_t vertex = mesh.first_vertex; vertex < mesh.end_vertex(); ++vertex)
      c_.position[vertex].x = particles_.position[c_.surfaces.particle[vertex]].x + c_.shift[number];
    piece.center += piece.inverse_mass * impulse;
    gained_ += impulse;
  }

  /// Moves the nearest vertices of a pair apart, in equal shares of momentum, until it has its distance.
  /// Stiff solids move as wholes, but where that does not do. Returns whether it was too near.
  bool correct_pair(const Pair& pair) {
    constexpr int kTries = 6;
    constexpr int kWholeTries = 4;
    const Real least = pair.block->least[pair.lane];
    for (int i = 0; i < kTries; ++i) {
      const Critical critical = critical_of(pair);
      ++work_;
      if (!(critical.gap < least)) return i > 0;
      work_ += 8;
      const Vec3 n = pair.normal();
      const Vec3 place =
          pair.first_side == 1 ? x(critical.first) : Real(0.5) * (x(critical.first) + x(critical.second));
      group_.pieces.make_room_for_two();
      Mover first = mover_of(critical.first, n, place, i < kWholeTries);
      Mover second = mover_of(critical.second, n, place, i < kWholeTries);
      const bool is_one = first.piece != nullptr && first.piece == second.piece;
      if (is_one || !(first.mobility + second.mobility > Real(0))) {
        first = mover_of(critical.first, n, place, false);
        second = mover_of(critical.second, n, place, false);
      }
      if (!(first.mobility + second.mobility > Real(0))) return true;
      const Real missing = Real(1.05) * least - critical.gap + Real(0.5) * group_.reserve;
      const Vec3 push = (missing / (first.mobility + second.mobility)) * n;
      const Real share = std::min(share_of(first, push), share_of(second, -push));
      push_away(first, share * push);
      push_away(second, -share * push);
    }
    return true;
  }

  bool correct_hot() {
    bool any = false;
    for (const std::uint32_t number : group_.hot) any = correct_pair(pair_at(number)) || any;
    return any;
  }

  /// Puts vertices of pairs that are still too near back to where they began the substep, moved with the
  /// group, until no pair is left. In the end all would be there, where no pair crosses.
  void hold_back() {
    for_vertices(c_, group_, [&](std::uint32_t vertex, std::uint32_t) { c_.stays[vertex] = 0; });
    for (bool any = true; any;) {
      any = false;
      for_near([](const SurfacePairBlock&, int) { return Real(0); },
               [&](std::uint32_t number) {
                 const Pair pair = pair_at(number);
                 for (std::size_t k = 0; k < 4; ++k) any = stay(pair.vertex(k)) || any;
               });
      (void)measure_pairs(c_, group_);
    }
  }

  void hold_all() {
    for_vertices(c_, group_, [&](std::uint32_t vertex, std::uint32_t mesh) {
      c_.stays[vertex] = 0;
      c_.position[vertex].x = particles_.position[c_.surfaces.particle[vertex]].x + c_.shift[mesh];
      stay(vertex);
    });
  }

  bool stay(std::uint32_t vertex) {
    if (c_.stays[vertex] != 0) return false;
    c_.stays[vertex] = 1;
    ++group_.counts.held_back;
    const std::uint32_t particle = c_.surfaces.particle[vertex];
    const Vec3 before = particles_.position[particle].x;
    move(vertex, c_.start[vertex].x + group_.displacement_now - before);
    speed_up(vertex, particles_.position[particle].x - before);
    return true;
  }

  /// Takes what corrections have given a group of solids as a whole from all of it: nothing outside pushed. A
  /// group of which something is held gets it from there.
  void give_back_momentum() {
    if (group_.held || gained_ == DVec3{}) return;
    const bool all_solid = std::all_of(group_.meshes.begin(), group_.meshes.end(), [&](std::uint32_t mesh) {
      return tables_.objects[c_.surfaces.meshes[mesh].object].tetrahedra.count > 0;
    });
    if (!all_solid) return;
    double mass = 0;
    const auto for_free = [&](auto visit) {
      for (const std::uint32_t mesh : group_.meshes) {
        const state::Rows rows = tables_.objects[c_.surfaces.meshes[mesh].object].particles;
        for (std::uint32_t p = rows.first; p < rows.end(); ++p) {
          if (particles_.velocity[p].inverse_mass > Real(0)) visit(particles_.velocity[p]);
        }
      }
    };
    for_free(
        [&](const state::VelocityRecord& record) { mass += 1 / static_cast<double>(record.inverse_mass); });
    const Vec3 v = vector_cast<Real>((1 / (mass * static_cast<double>(h_))) * gained_);
    if (length_squared(v) < kRoundedSpeed * kRoundedSpeed) return;
    for_free([&](state::VelocityRecord& record) { record.v -= v; });
  }

  Real h_;
  SurfaceContacts& c_;
  SurfaceGroup& group_;
  state::Tables& tables_;
  state::Particles& particles_;
  Vec3 displacement_;
  std::size_t work_ = 0;  ///< Of corrections, as `kMostCorrectionWork` counts it.
  DVec3 gained_ = {};     ///< Momentum that corrections have given the group, times h [kg m].
};

/// How far the group moves in this substep.
Vec3 displacement_of_group(const state::Particles& particles, Real h, const SurfaceContacts& c,
                           const SurfaceGroup& group) {
  return h * mean_velocity(c, group, [&](std::uint32_t vertex) {
           return particles.velocity[c.surfaces.particle[vertex]].v;
         });
}

}  // namespace

bool leaves_cages(const state::Tables& tables, Real h, const SurfaceContacts& contacts,
                  const SurfaceGroup& group) {
  const Vec3 displacement_now = displacement_of_group(tables.particles, h, contacts, group);
  const Vec3 displacement = vector_cast<Real>(group.displacement + vector_cast<double>(displacement_now));
  std::size_t count = 0;
  std::size_t leaving = 0;
  bool pin_leaves = false;
  for_vertices(contacts, group, [&](std::uint32_t vertex, std::uint32_t mesh) {
    const std::uint32_t particle = contacts.surfaces.particle[vertex];
    const state::VelocityRecord& velocity = tables.particles.velocity[particle];
    const Vec3 x = tables.particles.position[particle].x + contacts.shift[mesh] + h * velocity.v;
    Vec3 gone = x - contacts.found_at[vertex].x - displacement;
    ++count;
    if (!clip_to_cage(contacts.cage[vertex], gone)) return;
    ++leaving;
    pin_leaves = pin_leaves || velocity.inverse_mass == Real(0);
  });
  return pin_leaves || static_cast<double>(leaving) > kClippedShare * static_cast<double>(count);
}

bool pairs_would_meet(const state::Tables& tables, Real h, SurfaceContacts& contacts, SurfaceGroup& group) {
  const auto place = [&](Real time) {
    for_vertices(contacts, group, [&](std::uint32_t vertex, std::uint32_t mesh) {
      const std::uint32_t particle = contacts.surfaces.particle[vertex];
      contacts.position[vertex].x = tables.particles.position[particle].x + contacts.shift[mesh] +
                                    time * tables.particles.velocity[particle].v;
    });
  };
  place(h);
  if (measure_pairs_first(contacts, group)) return true;
  place(Real(0));
  (void)measure_pairs(contacts, group);
  return false;
}

void truncate_group(Real h, SurfaceContacts& contacts, SurfaceGroup& group, state::Tables& tables) {
  group.displacement_now = displacement_of_group(tables.particles, h, contacts, group);
  group.displacement += vector_cast<double>(group.displacement_now);
  Truncation(h, contacts, group, tables).run();
}

}  // namespace hooke::solver
