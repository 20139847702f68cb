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
  Truncation(Real h, SurfaceContacts& contacts, SurfaceGroup& group, state::Particles& particles)
      : h_(h),
        c_(contacts),
        group_(group),
        particles_(particles),
        displacement_(vector_cast<Real>(group.displacement)) {}

  void run() {
    if (group_.overflows) return hold_all();
    clip_all();
    int rounds = 0;
    for (bool near = measure_pairs_first(c_, group_); near; near = measure_pairs(c_, group_)) {
      if (rounds == kCorrectionRounds) return hold_back();
      list_hot();
      while (rounds < kCorrectionRounds) {
        ++rounds;
        if (!correct_hot()) break;
      }
    }
  }

 private:
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

  /// Moves a vertex as far as its cage allows, which becomes velocity.
  void correct(std::uint32_t vertex, Vec3 by) {
    const Vec3 displacement = displacement_of(vertex);
    Vec3 clipped = displacement + by;
    clip_to_cage(c_.cage[vertex], clipped);
    const Vec3 moved = clipped - displacement;
    move(vertex, moved);
    particles_.velocity[c_.surfaces.particle[vertex]].v += (Real(1) / h_) * moved;
  }

  [[nodiscard]] Real inverse_mass(std::uint32_t vertex) const {
    return particles_.velocity[c_.surfaces.particle[vertex]].inverse_mass;
  }

  /// Moves the nearest vertices of a pair apart, in equal shares of momentum, until it has its distance.
  /// Returns whether it was too near.
  bool correct_pair(const Pair& pair) {
    constexpr int kTries = 6;
    const Real least = pair.block->least[pair.lane];
    for (int i = 0; i < kTries; ++i) {
      const Critical critical = critical_of(pair);
      if (!(critical.gap < least)) return i > 0;
      const Real first = inverse_mass(critical.first);
      const Real second = inverse_mass(critical.second);
      if (!(first + second > Real(0))) return true;
      const Real missing = Real(1.05) * least - critical.gap + Real(0.5) * group_.reserve;
      const Vec3 by = (missing / (first + second)) * pair.normal();
      if (first > Real(0)) correct(critical.first, first * by);
      if (second > Real(0)) correct(critical.second, -second * by);
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
    const Vec3 moved = particles_.position[particle].x - before;
    state::VelocityRecord& record = particles_.velocity[particle];
    if (record.inverse_mass > Real(0)) record.v += (Real(1) / h_) * moved;
    return true;
  }

  Real h_;
  SurfaceContacts& c_;
  SurfaceGroup& group_;
  state::Particles& particles_;
  Vec3 displacement_;
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

void truncate_group(Real h, SurfaceContacts& contacts, SurfaceGroup& group, state::Particles& particles) {
  group.displacement_now = displacement_of_group(particles, h, contacts, group);
  group.displacement += vector_cast<double>(group.displacement_now);
  Truncation(h, contacts, group, particles).run();
}

}  // namespace hooke::solver
