#pragma once

#include "parallel/range.h"
#include "solver/linear/coloring.h"
#include "solver/simd/lanes.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

/// \file
/// Springs in the order of the kernels: blocks of 16 rows that share no particle, and the blocks of one
/// color after another.

namespace hooke::solver {

/// 16 rows of one color and one material. The last block of a pass may hold fewer: copies of its last row
/// fill it.
struct SpringBlock {
  std::uint32_t record_a[kLanes];  ///< 4 times the row of particle a, counted from
                                   ///< SpringBlocks::first_particle: where its record begins, in numbers.
  std::uint32_t record_b[kLanes];
  Real rest_length[kLanes];
};

/// What all rows of a block have in common. The coefficients are those of one substep of length h.
struct SpringMaterial {
  Real stiffness = Real(0);
  Real damping = Real(0);
  Real damped_mass = std::numeric_limits<Real>::infinity();
  bool one_sided = false;  ///< The spring only pulls.
  bool anchored = false;   ///< Particle b is pinned and not written.
  state::SpringForm form = state::SpringForm::kExplicit;
  Real bias = Real(0);   ///< b = k / (c + h k) [1/s]; written by prepare_springs.
  Real gamma = Real(0);  ///< 1 / (h (c + h k)) [1/kg]; written by prepare_springs.
  /// A rigid spring takes back at most this [m] of its error in a substep, and of the error's growth at most
  /// that of `recovery_time` [s]. Written by prepare_springs.
  Real recovery = kWhole;
  Real recovery_time = Real(0);

  static constexpr Real kWhole = Real(1e30);

  [[nodiscard]] bool is_rigid() const { return recovery < kWhole; }

  friend bool operator==(const SpringMaterial&, const SpringMaterial&) = default;
};

/// The coefficients of an implicit Euler step of h [s] for a stiffness k and a damping c, see
/// solver/soft/spring_solve.h.
struct Softness {
  Real bias = Real(0);  ///< b = k / (c + h k) [1/s]; 1 / h where k is infinite, 0 where both are zero.
  Real gamma =
      Real(0);  ///< 1 / (h (c + h k)), in the units of an inverse mass; infinite where both are zero.
};
[[nodiscard]] Softness softness(Real stiffness, Real damping, Real h);

/// Blocks [first, end) hold rows of one color and one material: no two rows share a particle that is
/// written.
struct SpringPass {
  std::uint32_t material = 0;
  int first = 0;
  int end = 0;
  int last_count = kLanes;  ///< Rows in the last block.
  state::SpringClass kind = state::SpringClass::kStretch;
};

struct SpringBlocks {
  std::uint32_t first_particle = 0;  ///< Row of the particle that records count from.
  std::vector<SpringBlock> blocks;
  std::vector<SpringMaterial> materials;
  std::vector<SpringPass> passes;  ///< In the order of the solution; passes of one color follow each other.
};

/// Colors the springs of these objects, class by class, greedily in the order of the table, 16 to a block. It
/// leaves out rows that `taken` marks, from the objects' first one on, if there are marks, and tethers whose
/// anchor is not pinned.
void build_spring_blocks(std::span<const state::Deformable> objects, const state::Springs& springs,
                         const state::Particles& particles, std::span<const std::uint8_t> taken,
                         SpringBlocks& blocks);

/// The material of a row, without its coefficients.
[[nodiscard]] SpringMaterial material_of_spring(const state::Springs& springs, std::size_t row);

/// Gives springs the numbers of their materials in a list, to which it adds new ones. Torn cloth has one for
/// nearly each spring along its cracks.
class MaterialNumbers {
 public:
  explicit MaterialNumbers(std::vector<SpringMaterial>& materials);

  [[nodiscard]] std::uint32_t of(const state::Springs& springs, std::size_t row);
  [[nodiscard]] std::size_t count() const { return materials_.size(); }

 private:
  struct IsLess {
    bool operator()(const SpringMaterial& a, const SpringMaterial& b) const;
  };

  std::vector<SpringMaterial>& materials_;
  std::map<SpringMaterial, std::uint32_t, IsLess> numbers_;
  std::uint32_t last_ = 0;  ///< Most springs are like the one before.
};

/// Largest c of a damper beside a spring k that counts in one pass over a sheet of points of a mass: m / 2 h
/// or 10 h k, whichever is more. See solver/soft/spring_solve.h. Of 1000 random sheets 8 pass any speed
/// without this limit, 5 with ten times as much, none with twice as much.
[[nodiscard]] Real most_damping(Real mass, Real stiffness, Real h);

/// Sets b and gamma of a material for a substep of `h` [s].
void prepare_spring(SpringMaterial& material, Real h);

/// Sets those of every material.
void prepare_springs(std::vector<SpringMaterial>& materials, Real h);

}  // namespace hooke::solver
