#pragma once

#include "lab/methods/part.h"
#include "lab/rigid/body_preselection.h"
#include "lab/rigid/dense.h"
#include "lab/rigid/impulses.h"
#include "lab/rigid/rigid_body.h"

#include <compare>
#include <cstdint>
#include <vector>

/// \file
/// Moves bodies that may meet, with rollback (the paper's 4.3.2, listing 11). It adds what the listing lacks:
/// processed time counts, a resting contact is no collision, the limit of tries has an outcome, and the path
/// is tested as well as its end.

namespace hooke::lab {

/// A BodyPair is two bodies, as indices into Region's list; the first is the lower row.
struct BodyPair {
  std::uint32_t a = 0, b = 0;
  friend auto operator<=>(const BodyPair&, const BodyPair&) = default;
};

/// This is what the collider needs to know besides the bodies.
struct CollisionSetting {
  CollisionOptions options = {};
  std::vector<MaterialPairDesc> materials = {};
  double dt = 0;                          ///< Length of an output step [s].
  std::vector<BodyVolumes> volumes = {};  ///< By body.
};

/// A Region is a set of bodies that take their steps together.
class Region {
 public:
  /// `bodies` are all bodies; `members` are those of the region that move, `others` those that stand. `parts`
  /// are all that move, indexed by RigidBody::part.
  Region(const CollisionSetting& setting, const std::vector<RigidBody>& bodies,
         std::vector<std::uint32_t> members, const std::vector<std::uint32_t>& others,
         std::vector<Part>& parts, CollisionReport& report);

  /// Moves its parts from `t` by `dt`. Errors are those of a method.
  Result<void> advance(double t, double dt);

  /// Returns boxes around all that the members, in their order, swept in advance().
  [[nodiscard]] const std::vector<Box>& swept() const { return swept_; }
  [[nodiscard]] const std::vector<std::uint32_t>& members() const { return members_; }

 private:
  struct Overlap {
    BodyPair pair = {};
    double distance = 0;
    DVec3 normal = {};
  };
  /// An Attempt is a step that was tried.
  struct Attempt {
    double h = 0;
    std::vector<State> ends = {};           ///< Of the members.
    std::vector<DenseMotion> motions = {};  ///< By index of the body.
    std::vector<Overlap> overlaps = {};     ///< Overlaps at the end.
    bool deep = false;                      ///< Some pair is deeper than allowed, at the end or on the path.
    bool touches = false;
    BodyPair pair = {};        ///< The deepest pair.
    double depth = 0;          ///< Its depth at the end [m]; 0 where only the test of the path saw it.
    double closing_speed = 0;  ///< Its speed at the end [m/s].
    double first_share = 1;    ///< Share of the step at which the path reached a contact; 1 if it did not.
  };
  struct Pull {
    DVec3 linear = {}, angular = {};  ///< [m/s^2], [rad/s^2]
  };

  Result<void> step_all(Attempt& attempt);
  void cancel(const Attempt& attempt);
  bool keep(const Attempt& attempt);
  void finish(double end);
  double shorter_step(const Attempt& attempt);
  double longer_step(const Attempt& attempt);
  double backward_error(const Attempt& attempt);
  void reset();
  void accept(const Attempt& attempt);
  void give_up(const Attempt& attempt);
  void project(BodyPair pair, double distance, DVec3 normal);
  void project_by_rotating(BodyPair pair);

  // These are in region_crossings.cpp.
  void find_pairs(const Attempt& attempt);
  void evaluate(Attempt& attempt);
  void evaluate_end(Attempt& attempt, BodyPair pair);
  void evaluate_path(Attempt& attempt);

  // These are in region_respond.cpp.
  bool respond(double h);
  void write_velocities(const std::vector<ImpulseBody>& bodies);
  void carry(double h);
  std::vector<Pull> pulls();
  [[nodiscard]] std::vector<ImpulseBody> impulse_bodies() const;
  [[nodiscard]] std::vector<Contact> contacts_of(BodyPair pair, const BodyMotion& a,
                                                 const BodyMotion& b) const;
  [[nodiscard]] bool is_resting(BodyPair pair) const;
  [[nodiscard]] bool rested(BodyPair pair, const Contact& contact, double closing_speed, double h) const;

  [[nodiscard]] BodyMotion now(std::uint32_t body) const;
  [[nodiscard]] DensePair dense(const Attempt& attempt, BodyPair pair) const;
  [[nodiscard]] Part& part(std::uint32_t body);

  const CollisionSetting& setting_;
  const std::vector<RigidBody>& bodies_;
  std::vector<std::uint32_t> members_;
  const std::vector<std::uint32_t>& others_;
  std::vector<Part>& parts_;
  CollisionReport& report_;
  std::vector<Box> swept_;
  std::vector<BodyPair> pairs_;        ///< Candidates of the last attempt.
  std::vector<ImpulsePoint> resting_;  ///< Contacts of the last clear state that do not separate.
  std::vector<Pull> pulls_;            ///< Accelerations of that state, by body.
  double time_ = 0;                    ///< Time of the last clear state [s].
  double known_ = 0;                   ///< Time from it to a known collision [s]; 0: none.
  double depth_known_ = 0;             ///< Depth of the overlap there [m].
  BodyPair pair_known_ = {};
  int tries_ = 0;        ///< Canceled attempts in a row.
  bool patient_ = true;  ///< False when impacts come without end; then nothing bounces.
};

/// Returns a box around all that a body sweeps over.
[[nodiscard]] Box swept_bounds(const RigidBody& body, const DenseMotion& motion);

}  // namespace hooke::lab
