/// Moves nodes of ropes from the tables' records of four numbers to lanes of double and back. Included anew
/// for each instruction set.

#if defined(HOOKE_SOLVER_ROPE_ROPE_RECORDS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_ROPE_ROPE_RECORDS_H
#undef HOOKE_SOLVER_ROPE_ROPE_RECORDS_H
#else
#define HOOKE_SOLVER_ROPE_ROPE_RECORDS_H
#endif

#include "solver/rope/rope_kernels.h"
#include "solver/simd/numbers.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Reads four numbers from a different position for each lane.
HWY_INLINE void read_record(const Real* base, const std::uint32_t* line, Quad<double>& value) {
  const Real* from = base + *line;
  value = {static_cast<double>(from[0]), static_cast<double>(from[1]), static_cast<double>(from[2]),
           static_cast<double>(from[3])};
}

/// Four numbers of each lane in the type in which they are stored.
template <class Number>
struct StoredRecords {
  alignas(64) Real of[kLanesOf<Number>][4];
};
HWY_INLINE void round_record(const Quad<double>& value, StoredRecords<double>& records) {
  records.of[0][0] = static_cast<Real>(value.x);
  records.of[0][1] = static_cast<Real>(value.y);
  records.of[0][2] = static_cast<Real>(value.z);
  records.of[0][3] = static_cast<Real>(value.w);
}

/// Loads and stores the ropes of the lanes from `lane` on.
template <class Number, int kCount>
class RopeTransfer {
 public:
  HWY_INLINE RopeTransfer(const RopeLocations<kCount>& locations, int lane)
      : locations_(locations), lane_(lane) {}

  HWY_INLINE void load(RopeLanes<kCount>& ropes) const {
    load_nodes(ropes);
    load_tensions(ropes);
  }
  HWY_INLINE void store(double h, const RopeTraits<kCount>& traits, const bool (&chosen)[kCount],
                        const RopeLanes<kCount>& ropes) const {
    store_velocities(traits, chosen, ropes);
    store_tensions(h, chosen, ropes);
  }

 private:
  static constexpr int kWide = kLanesOf<Number>;

  /// Where each lane's first record is in a table whose records have `stride` numbers.
  struct Records {
    std::uint32_t of[kWide];

    HWY_INLINE Records(const std::uint32_t (&first)[kCount], int lane, std::uint32_t stride) {
      for (int k = 0; k < kWide; ++k) of[k] = stride * first[lane + k];
    }
  };

  static HWY_INLINE Triple<Number> vector_at(const Real* base, const Records& records) {
    Quad<Number> q;
    read_record(base, records.of, q);
    return {q.x, q.y, q.z};
  }

  HWY_INLINE void load_nodes(RopeLanes<kCount>& ropes) const {
    const Records records(locations_.first_particle, lane_, 4);
    Triple<Number> x = vector_at(locations_.position, records);
    Triple<Number> before = vector_at(locations_.before, records);
    put3(vector_at(locations_.velocity, records), ropes.nodes[0].v_free, lane_);
    for (std::size_t i = 0; i < ropes.segments.size(); ++i) {
      const std::size_t next = 4 * (i + 1);
      const Triple<Number> next_x = vector_at(locations_.position + next, records);
      const Triple<Number> next_before = vector_at(locations_.before + next, records);
      put3(difference(next_x, x), ropes.segments[i].line, lane_);
      put3(difference(next_before, before), ropes.segments[i].before, lane_);
      put3(vector_at(locations_.velocity + next, records), ropes.nodes[i + 1].v_free, lane_);
      x = next_x;
      before = next_before;
    }
  }

  /// Reads tensions four at a time while there are four left.
  HWY_INLINE void load_tensions(RopeLanes<kCount>& ropes) const {
    const Number zero(0.0);
    const std::size_t count = ropes.segments.size();
    const std::size_t quads = count / 4 * 4;
    const Records records(locations_.first_segment, lane_, 1);
    for (std::size_t i = 0; i < quads; i += 4) {
      Quad<Number> q;
      read_record(locations_.tension + i, records.of, q);
      const Number tension[4] = {q.x, q.y, q.z, q.w};
      for (std::size_t j = 0; j < 4; ++j)
        write(larger(tension[j], zero), ropes.segments[i + j].tension_bound + lane_);
    }
    for (std::size_t i = quads; i < count; ++i) {
      for (int k = 0; k < kWide; ++k) {
        const auto tension = static_cast<double>(locations_.tension[locations_.first_segment[lane_ + k] + i]);
        ropes.segments[i].tension_bound[lane_ + k] = larger(tension, 0.0);
      }
    }
    for (std::size_t i = 0; i < count; ++i) write(zero, ropes.segments[i].limited + lane_);
  }

  HWY_INLINE void store_velocities(const RopeTraits<kCount>& traits, const bool (&chosen)[kCount],
                                   const RopeLanes<kCount>& ropes) const {
    for (std::size_t i = 0; i < ropes.nodes.size(); ++i) {
      const Triple<Number> u = get3<Number>(ropes.nodes[i].u, lane_);
      StoredRecords<Number> records;
      round_record(Quad<Number>{u.x, u.y, u.z, get<Number>(traits.rows[i].w + lane_)}, records);
      for (int k = 0; k < kWide; ++k) {
        if (!chosen[lane_ + k]) continue;
        Real* to = locations_.velocity + 4 * (locations_.first_particle[lane_ + k] + i);
        for (int j = 0; j < 4; ++j) to[j] = records.of[k][j];
      }
    }
  }

  HWY_INLINE void store_tensions(double h, const bool (&chosen)[kCount],
                                 const RopeLanes<kCount>& ropes) const {
    const double per_h = 1 / h;
    const std::size_t count = ropes.segments.size();
    const std::size_t quads = count / 4 * 4;
    const auto pull = [&](std::size_t i)
                          HWY_ATTR { return Number(per_h) * get<Number>(ropes.segments[i].pull + lane_); };
    for (std::size_t i = 0; i < quads; i += 4) {
      StoredRecords<Number> records;
      round_record(Quad<Number>{pull(i), pull(i + 1), pull(i + 2), pull(i + 3)}, records);
      for (int k = 0; k < kWide; ++k) {
        if (chosen[lane_ + k]) store_tension<4>(records.of[k], locations_.first_segment[lane_ + k] + i);
      }
    }
    for (std::size_t i = quads; i < count; ++i) {
      for (int k = 0; k < kWide; ++k) {
        const Real tension = static_cast<Real>(per_h * ropes.segments[i].pull[lane_ + k]);
        if (chosen[lane_ + k]) store_tension<1>(&tension, locations_.first_segment[lane_ + k] + i);
      }
    }
  }

  template <int kNumbers>
  HWY_INLINE void store_tension(const Real* from, std::size_t row) const {
    for (int j = 0; j < kNumbers; ++j) locations_.tension[row + j] = from[j];
    for (int j = 0; j < kNumbers; ++j) locations_.mean_tension[row + j] += from[j];
  }

  const RopeLocations<kCount>& locations_;
  int lane_;
};

template <class Number, int kCount>
HWY_INLINE void load_rope_lanes(const RopeLocations<kCount>& locations, RopeLanes<kCount>& ropes) {
  for (int lane = 0; lane < kCount; lane += kLanesOf<Number>)
    RopeTransfer<Number, kCount>(locations, lane).load(ropes);
}

template <class Number, int kCount>
HWY_INLINE void store_rope_lanes(double h, const RopeLocations<kCount>& locations,
                                 const RopeTraits<kCount>& traits, const bool (&chosen)[kCount],
                                 const RopeLanes<kCount>& ropes) {
  for (int lane = 0; lane < kCount; lane += kLanesOf<Number>)
    RopeTransfer<Number, kCount>(locations, lane).store(h, traits, chosen, ropes);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
