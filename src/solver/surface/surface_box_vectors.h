/// How the boxes of surfaces are compared with vectors: BoxTests of solver/surface/surface_box_lanes.h.
/// Sixteen pairs of boxes stand side by side, in one vector or several. Included anew for each instruction
/// set.

#if defined(HOOKE_SOLVER_SURFACE_SURFACE_BOX_VECTORS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SURFACE_SURFACE_BOX_VECTORS_H
#undef HOOKE_SOLVER_SURFACE_SURFACE_BOX_VECTORS_H
#else
#define HOOKE_SOLVER_SURFACE_SURFACE_BOX_VECTORS_H
#endif

#include "solver/simd/vectors.h"
#include "solver/surface/surface_box_lanes.h"

#include <cstdint>
#include <cstring>
#include <hwy/highway.h>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

/// Which of four boxes stands in each of sixteen lanes.
struct BoxLanes {
  std::int32_t of[kLanes];

  template <class Choose>
  explicit constexpr BoxLanes(Choose choose) : of{} {
    for (int i = 0; i < kLanes; ++i) of[i] = static_cast<std::int32_t>(choose(static_cast<unsigned>(i)));
  }
};
constexpr BoxLanes kFirstChildren(ChildPair::first);
constexpr BoxLanes kSecondChildren(ChildPair::second);
/// Each four times, and all four times.
constexpr BoxLanes kByFours([](unsigned i) { return i / 4; });
constexpr BoxLanes kInFours([](unsigned i) { return i % 4; });
/// Each twice, and two of them four times: of one side in the lower eight lanes, of the other in the upper
/// ones.
constexpr BoxLanes kByTwos([](unsigned i) { return i % 8 / 2 + (kWidth == 16 ? i / 8 * 8 : 0); });
constexpr BoxLanes kInTwos([](unsigned i) { return i % 2; });

/// By the bits of a mask of up to eight lanes: the numbers of its lanes, then some others.
struct PackedLanes {
  std::uint8_t of[256][8];

  constexpr PackedLanes() : of{} {
    for (unsigned bits = 0; bits < 256; ++bits) {
      std::size_t count = 0;
      for (unsigned lane = 0; lane < 8; ++lane) {
        if ((bits >> lane & 1U) != 0) of[bits][count++] = static_cast<std::uint8_t>(lane);
      }
    }
  }
};
constexpr PackedLanes kPackedLanes;

/// Stores the lanes of a mask one after the other, then some more. Up to eight lanes are looked up in a table
/// of our own: GCC copies that of hn::Compress to the stack each time, which was half of a search.
template <class Words>
class LanePacker {
  using Word = hn::Vec<Words>;

 public:
  HWY_INLINE explicit LanePacker(hn::Mask<Words> mask) : packed_(packed(mask)) {}

  HWY_INLINE void put(Word lanes, std::uint32_t* to) const {
    if constexpr (kWidth > 8) {
      hn::StoreU(hn::Compress(lanes, packed_), Words(), to);
    } else {
      hn::StoreU(hn::TableLookupLanes(lanes, hn::IndicesFromVec(Words(), packed_)), Words(), to);
    }
  }

 private:
  static HWY_INLINE auto packed(hn::Mask<Words> mask) {
    if constexpr (kWidth > 8) {
      return mask;
    } else {
      std::uint8_t bits[8];
      hn::StoreMaskBits(Words(), mask, bits);
      return hn::PromoteTo(Words(), hn::LoadU(hn::Rebind<std::uint8_t, Words>(), kPackedLanes.of[bits[0]]));
    }
  }

  std::conditional_t<(kWidth > 8), hn::Mask<Words>, Word> packed_;
};

template <>
struct BoxTests<Wide> {
  using Words = hn::RebindToUnsigned<Lanes>;
  using Word = hn::Vec<Words>;
  using Four = hn::Vec<Line>;
  using LaneMask = hn::Mask<Lanes>;

  static constexpr int kChunks = kLanes / kWidth;

  /// Lanes of `line`, as the chunk of the table says.
  template <class D, class T>
  static HWY_INLINE hn::Vec<D> spread(D tag, const std::array<T, 4>& line, const BoxLanes& lanes, int chunk) {
    return hn::TableLookupLanes(hn::LoadDup128(tag, line.data()),
                                hn::SetTableIndices(tag, lanes.of + chunk * kWidth));
  }

  /// Where boxes overlap whose lower and negated upper bounds a and b give, both for an axis and a side.
  template <class A, class B>
  static HWY_INLINE LaneMask overlap_where(A a, B b) {
    const Vector zero = hn::Zero(kTag);
    const auto along = [&](std::size_t k) HWY_ATTR {
      return hn::And(hn::Le(hn::Add(a(k, false), b(k, true)), zero),
                     hn::Le(hn::Add(b(k, false), a(k, true)), zero));
    };
    return hn::And(along(0), hn::And(along(1), along(2)));
  }

  static HWY_INLINE unsigned overlap_one(const SurfaceBox& a, const SurfaceBox4& b) {
    const Line tag;
    const Four zero = hn::Zero(tag);
    const auto along = [&](std::size_t k) HWY_ATTR {
      const Four below = hn::Add(hn::Set(tag, a.lower[k]), hn::Load(tag, b.negated_upper[k].data()));
      const Four above = hn::Add(hn::Load(tag, b.lower[k].data()), hn::Set(tag, a.negated_upper[k]));
      return hn::And(hn::Le(below, zero), hn::Le(above, zero));
    };
    std::uint8_t bits[8];
    hn::StoreMaskBits(tag, hn::And(along(0), hn::And(along(1), along(2))), bits);
    return bits[0] & 15U;
  }

  static HWY_INLINE const std::array<float, 4>& line_of(const SurfaceBox4& box, std::size_t k, bool upper) {
    return upper ? box.negated_upper[k] : box.lower[k];
  }

  static HWY_INLINE unsigned overlap_children(const SurfaceBox4& a, const SurfaceBox4& b) {
    unsigned all = 0;
    for (int chunk = 0; chunk < kChunks; ++chunk) {
      const LaneMask mask =
          overlap_where([&](std::size_t k, bool upper)
                            HWY_ATTR { return spread(kTag, line_of(a, k, upper), kFirstChildren, chunk); },
                        [&](std::size_t k, bool upper)
                            HWY_ATTR { return spread(kTag, line_of(b, k, upper), kSecondChildren, chunk); });
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(kTag, mask, bytes);
      std::uint16_t bits = 0;
      std::memcpy(&bits, bytes, sizeof(bits));
      all |= (bits & ((1U << kWidth) - 1U)) << (chunk * kWidth);
    }
    return all;
  }

  static HWY_INLINE Word lanes_of(const BoxLanes& lanes, int chunk) {
    return hn::BitCast(Words(), hn::LoadU(hn::RebindToSigned<Lanes>(), lanes.of + chunk * kWidth));
  }

  static HWY_INLINE void add_edges(const SurfaceSide& a, const SurfaceSide& b, unsigned pairs,
                                   SurfaceCandidates& to) {
    const Words words;
    for (int chunk = 0; chunk < kChunks; ++chunk) {
      const auto first = [&](std::size_t k, bool upper) HWY_ATTR {
        return spread(kTag, line_of(a.boxes.edges, k, upper), kByFours, chunk);
      };
      const auto second = [&](std::size_t k, bool upper) HWY_ATTR {
        return hn::LoadDup128(kTag, line_of(b.boxes.edges, k, upper).data());
      };
      const LaneMask overlaps = overlap_where(first, second);
      if (hn::AllFalse(kTag, overlaps)) continue;
      auto mask = hn::RebindMask(words, overlaps);
      if (pairs != kAllPairs) {
        const unsigned of_chunk = pairs >> (chunk * kWidth);
        const std::uint8_t bits[8] = {static_cast<std::uint8_t>(of_chunk),
                                      static_cast<std::uint8_t>(of_chunk >> 8U)};
        mask = hn::And(mask, hn::LoadMaskBits(words, bits));
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const Word joined_a = spread(words, a.part.joined_edge[k / 2], kByFours, chunk);
        const Word joined_b = hn::LoadDup128(words, b.part.joined_edge[k % 2].data());
        mask = hn::AndNot(hn::Eq(joined_a, joined_b), mask);
      }
      if (hn::AllFalse(words, mask)) continue;
      const std::uint32_t at = to.count;
      const LanePacker<Words> packer(mask);
      for (std::size_t k = 0; k < 2; ++k) {
        packer.put(hn::ShiftLeft<2>(spread(words, a.part.edge[k], kByFours, chunk)), to.record[k] + at);
        packer.put(hn::ShiftLeft<2>(hn::LoadDup128(words, b.part.edge[k].data())), to.record[2 + k] + at);
      }
      packer.put(hn::Add(hn::Set(words, a.part.first_edge), lanes_of(kByFours, chunk)), to.feature[0] + at);
      packer.put(hn::Add(hn::Set(words, b.part.first_edge), lanes_of(kInFours, chunk)), to.feature[1] + at);
      to.count += static_cast<std::uint32_t>(hn::CountTrue(words, mask));
    }
  }

  /// `a` in the lower eight of sixteen lanes, `b` in the upper ones, each repeated.
  template <class D, class T>
  static HWY_INLINE hn::Vec<D> load_both(D tag, const std::array<T, 4>& a, const std::array<T, 4>& b,
                                         int chunk) {
    if constexpr (kWidth == 16) {
      const hn::Half<D> half;
      return hn::Combine(tag, hn::LoadDup128(half, b.data()), hn::LoadDup128(half, a.data()));
    } else {
      return hn::LoadDup128(tag, chunk * kWidth < 8 ? a.data() : b.data());
    }
  }

  static HWY_INLINE Word set_both(std::uint32_t a, std::uint32_t b, int chunk) {
    const Words words;
    if constexpr (kWidth == 16) {
      const hn::Half<Words> half;
      return hn::Combine(words, hn::Set(half, b), hn::Set(half, a));
    } else {
      return hn::Set(words, chunk * kWidth < 8 ? a : b);
    }
  }

  static HWY_INLINE void add_faces(const SurfaceSide& a, const SurfaceSide& b, bool same,
                                   SurfaceCandidates& to) {
    const Words words;
    for (int chunk = 0; chunk < (same && kWidth < 16 ? kChunks / 2 : kChunks); ++chunk) {
      const auto by_twos = [&]<class D, class T>(D tag, const std::array<T, 4>& x,
                                                 const std::array<T, 4>& y) HWY_ATTR {
        return hn::TableLookupLanes(load_both(tag, x, y, chunk),
                                    hn::SetTableIndices(tag, kByTwos.of + chunk * kWidth));
      };
      const auto points = [&](std::size_t k, bool upper) HWY_ATTR {
        return by_twos(kTag, line_of(a.boxes.vertices, k, upper), line_of(b.boxes.vertices, k, upper));
      };
      const auto faces = [&](std::size_t k, bool upper) HWY_ATTR {
        return load_both(kTag, line_of(b.boxes.triangles, k, upper), line_of(a.boxes.triangles, k, upper),
                         chunk);
      };
      LaneMask overlaps = overlap_where(points, faces);
      if (same && kWidth == 16) overlaps = hn::And(overlaps, hn::FirstN(kTag, 8));
      if (hn::AllFalse(kTag, overlaps)) continue;
      auto mask = hn::RebindMask(words, overlaps);
      const Word joined = by_twos(words, a.part.joined_vertex, b.part.joined_vertex);
      for (std::size_t k = 0; k < 3; ++k) {
        const Word corner = load_both(words, b.part.joined_triangle[k], a.part.joined_triangle[k], chunk);
        mask = hn::AndNot(hn::Eq(joined, corner), mask);
      }
      if (hn::AllFalse(words, mask)) continue;
      const std::uint32_t at = to.count;
      const LanePacker<Words> packer(mask);
      packer.put(hn::ShiftLeft<2>(by_twos(words, a.part.vertex, b.part.vertex)), to.record[0] + at);
      for (std::size_t k = 0; k < 3; ++k) {
        packer.put(hn::ShiftLeft<2>(load_both(words, b.part.triangle[k], a.part.triangle[k], chunk)),
                   to.record[1 + k] + at);
      }
      const Word row = hn::And(lanes_of(kByTwos, chunk), hn::Set(words, 7));
      packer.put(hn::Add(set_both(a.part.first_vertex, b.part.first_vertex, chunk), row), to.feature[0] + at);
      packer.put(
          hn::Add(set_both(b.part.first_triangle, a.part.first_triangle | SurfaceCandidates::kTurned, chunk),
                  lanes_of(kInTwos, chunk)),
          to.feature[1] + at);
      to.count += static_cast<std::uint32_t>(hn::CountTrue(words, mask));
    }
  }
};

#endif

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
