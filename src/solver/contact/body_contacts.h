#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"
#include "parallel/range.h"
#include "parallel/thread_pool.h"
#include "solver/contact/contact_colors.h"
#include "solver/contact/contact_tuning.h"
#include "state/bodies.h"
#include "state/manifolds.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Contacts between bodies: soft rows at velocity level, in colors, 16 manifolds to a block.
///
/// The order of calls in a step, with those of solver/body/body_motion.h. `each color` is a loop over
/// color_begin, and blocks of one color may be shared out over threads:
///
///   prepare_bodies, prepare_body_contacts                          once
///   accelerate_bodies
///   solve_body_contacts, each color, `sweeps` times
///   move_bodies
///   relax_body_contacts, each color                                substeps times
///   finish_bodies, store_body_contacts                             once
///
/// For one point, with n the normal from A to B, s its separation, v = n.(v_b - v_a) + j_b.omega_b -
/// j_a.omega_a in scaled coordinates (state/bodies.h) and m = 1 / (w_a + w_b + |j_a|^2 + |j_b|^2), the row
/// is:
///
///   separation   s = s_0 + n.(dx_b - dx_a) + j_b.theta_b - j_a.theta_a     linear within a step
///   apart        s > 0:   lambda' = max(0, lambda - m (v + s/h))           reach the surface, and no farther
///                relax:   lambda' = 0 if it bounces: solver/contact/impacts.h needs the closing speed
///   overlapping  bias:    lambda' = max(0, lambda - m (mu v + max(mu beta s, -3 m/s)) - gamma lambda)
///                relax:   lambda' = max(0, lambda - m v)                   takes out what the bias put in
///
/// The bias is an implicit step of a damped spring of frequency f and damping ratio zeta: omega = 2 pi f,
/// a_1 = 2 zeta + h omega, a_2 = h omega a_1, beta = omega / a_1, gamma = 1 / (1 + a_2), mu = 1 - gamma (soft
/// constraints: Catto, "Soft Constraints", GDC 2011; bias, move, relax: "Solver2D", 2024). At rest the row is
/// a spring of stiffness m omega^2.
///
/// Friction is solved after its points: one row of twist about the normal and one of two directions at the
/// mean contact, on an exact disc. It sticks while its impulse is within mu_static N and slides with mu N.

namespace hooke::solver {

inline constexpr int kContactLanes = 16;

/// Rows of up to 16 manifolds of one color: no two of them share a body that moves. A always moves; where
/// only one body does, it is made A. The last lane that holds a manifold is repeated up to the end, so that a
/// partly filled block can be computed, and stored, in full vectors.
struct alignas(64) ContactBlock {
  using Lane = Real[kContactLanes];

  struct Point {
    Lane j_a[3], j_b[3];
    Lane separation;  ///< At the start of the step [m].
    Lane mass;        ///< Effective mass; 0 for a point the manifold lacks [kg].
    Lane impulse;     ///< [N s]
  };

  // Read by passes over points alone.
  std::uint32_t record_a[kContactLanes];  ///< 16 times body A's row: where its record begins, in numbers.
  std::uint32_t record_b[kContactLanes];
  Lane normal[3];
  Lane w_a, w_b;
  std::array<Point, state::Manifold::kMaxPoints> point;

  // Friction: t_1 and t_2 = n x t_1 at the mean contact, and twist.
  Lane tangent[3];
  Lane friction_j_a[2][3], friction_j_b[2][3];
  Lane friction_mass[3];  ///< Inverse of the 2x2 matrix: 11, 12, 22.
  Lane friction_impulse[2];
  Lane surface_speed[2];  ///< Of B's surface relative to A's, along the tangents [m/s].
  Lane friction, static_friction;
  Lane twist_j_a[3], twist_j_b[3];
  Lane twist_mass, twist_impulse;
  Lane twist_lever[state::Manifold::kMaxPoints];  ///< Largest twist impulse per impulse of the point [m].
  Lane restitution;                               ///< Read only where the block `bounces`.
  Lane pushed;  ///< Largest sum of the points' impulses after a pass with friction [N s].

  int count = 0;          ///< Lanes with a manifold of their own.
  int point_count = 0;    ///< The largest number of points of its lanes.
  bool anchored = false;  ///< B is not written: it stands, sleeps or is moved by hand.
  /// How its manifolds are solved. Of those that are not soft only rolling is solved here.
  state::ContactRoute route = state::ContactRoute::kSoft;
  bool bounces = false;   ///< Some lane has restitution.
  int first_rolling = 0;  ///< Index of its first rolling row.
  int rolling_count = 0;

  [[nodiscard]] bool is_soft() const { return route == state::ContactRoute::kSoft; }
  [[nodiscard]] bool is_coupled() const { return route == state::ContactRoute::kCoupled; }
};

/// A vector quantity of one lane.
inline Vec3 vector_of(const ContactBlock::Lane (&from)[3], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}

/// Rolling resistance: opposes relative angular velocity across the normal, within lever times normal
/// impulse.
struct RollingRow {
  int lane = 0;
  Real lever = Real(0);                 ///< [m]
  math::Symmetric3<Real> inertia = {};  ///< Effective inertia [kg m^2].
  Vec3 impulse = {};                    ///< Angular impulse on B [N m s].
};

/// One lane of a block.
struct ContactLane {
  int block = 0;
  int lane = 0;
  std::uint32_t manifold = 0;  ///< Row of the manifold.
};

struct BodyContacts {
  static constexpr std::uint32_t kNoManifold = 0xFFFFFFFF;

  std::vector<ContactBlock> blocks;
  std::vector<int> color_begin = {0};  ///< Blocks of color c are [color_begin[c], color_begin[c + 1]).
  /// Row of each lane's manifold; kNoManifold where there is none.
  std::vector<std::uint32_t> manifold_of;
  std::vector<RollingRow> rolling;
  /// Lanes of manifolds that are refreshed each substep: soft and coupled ones.
  std::vector<ContactLane> refreshed;
  ContactColors colors;

  [[nodiscard]] int color_count() const { return static_cast<int>(color_begin.size()) - 1; }
};

/// Settings of all contacts in a step.
struct ContactStep {
  Vec3 gravity = {};              ///< [m/s^2]
  Real h = Real(0);               ///< Length of a substep [s].
  Real hz = Real(60);             ///< Frequency of the spring that undoes overlap.
  Real damping_ratio = Real(5);   ///< Damping ratio of that spring.
  int sweeps = 1;                 ///< Calls of solve_body_contacts in a substep.
  bool friction_in_bias = false;  ///< Friction also in solve_body_contacts: quieter at rest, and slower.
  Real impulse_scale = Real(1);   ///< Scale of the impulses carried over: h now over h then.
};

/// How the rows of one pass treat overlap.
struct ContactSoftness {
  Real rate = Real(0);           ///< mu beta: speed demanded per overlap [1/s].
  Real mass_scale = Real(1);     ///< mu
  Real impulse_scale = Real(0);  ///< gamma
};

/// Softness of bias passes. Contacts with what does not move (`anchored`) have twice the frequency and half
/// the damping ratio. With one sweep the frequency is at most 1/(8h), with more 1/(4h): above, contacts slide
/// apart.
[[nodiscard]] ContactSoftness contact_softness(const ContactStep& step, bool anchored);

/// Colors manifolds in their order and makes their rows from where bodies are now and the impulses of the
/// step before. Removes those impulses from bodies.free_motion, so that the first accelerate_bodies applies
/// them. Manifolds without points, of sensors, or of bodies none of which moves have no rows.
void prepare_body_contacts(parallel::ThreadPool& pool, const std::vector<state::Manifold>& manifolds,
                           state::Bodies& bodies, const ContactStep& step, BodyContacts& contacts);

/// Makes one pass with bias over blocks of one color. It changes velocities only.
void solve_body_contacts(parallel::Range blocks, const ContactStep& step, BodyContacts& contacts,
                         state::Bodies& bodies);

/// Makes one pass without bias over blocks of one color, with rolling resistance first and friction last.
void relax_body_contacts(parallel::Range blocks, const ContactStep& step, BodyContacts& contacts,
                         state::Bodies& bodies);

/// Takes back what a soft lane did in the substep before. It follows accelerate_bodies, which repeats that
/// impulse.
void drop_warm_start(const ContactLane& lane, const std::vector<state::Manifold>& manifolds,
                     BodyContacts& contacts, state::Bodies& bodies);

/// Copies the impulses of some lanes to their manifolds in the middle of a step, except those of direct
/// contacts.
void store_lanes(std::span<const ContactLane> lanes, const BodyContacts& contacts,
                 std::vector<state::Manifold>& manifolds);

/// Makes the rows of these lanes again from their new manifolds, whose separations are those of `time` [s]
/// from now. For the warm start of the next substep, the impulses of this one count as if the new rows had
/// applied them. The velocities and angular momenta stay as the old rows have made them.
void refill_lanes(std::span<const ContactLane> lanes, const std::vector<state::Manifold>& manifolds,
                  Real time, state::Bodies& bodies, BodyContacts& contacts);

/// Acceleration of a body by all but contacts; zero if they do not move it [m/s^2].
[[nodiscard]] Vec3 free_acceleration(const state::Bodies& bodies, std::uint32_t row, Vec3 gravity);

/// Copies impulses back to the manifolds.
void store_body_contacts(parallel::Range blocks, const BodyContacts& contacts,
                         std::vector<state::Manifold>& manifolds);

}  // namespace hooke::solver
