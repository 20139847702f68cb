#include "hooke/statics.h"

#include "base/float_environment.h"
#include "geometry/statics/eigen6.h"
#include "math/rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace hooke {

namespace {

using geometry::Eigen6;
using geometry::Matrix6;
using geometry::Vector6;

// Lengths are in units of the distance of the farthest attachment from the center, forces in units of weight.
constexpr std::size_t kCablesMax = 16;
constexpr double kPenalty = 100;     ///< Stiffness of a cable that does not reach.
constexpr int kRounds = 60;          ///< Most corrections of the tensions.
constexpr int kNewtonSteps = 100;    ///< Most steps between two corrections.
constexpr double kTooLong = 1e-12;   ///< A cable that is longer by this share has its length.
constexpr double kBalanced = 1e-11;  ///< Unbalanced force that counts as none.
constexpr double kNeutral = 1e-7;    ///< Second derivatives up to this are those of a neutral way.
constexpr double kSamePose = 1e-5;   ///< Poses nearer than this are one.
constexpr double kUnreached = 1e-9;  ///< What stays longer than this after all rounds is out of reach.
constexpr int kEscapes = 20;         ///< Most steps off a saddle.

/// Where a solid is. Its cables' tensions are multipliers of the constraints on their lengths.
struct Hang {
  DVec3 center = {};
  Quaternion<double> rotation = {};
  std::vector<double> tensions = {};
};

/// A cable in units of the search, its attachment from the center of mass.
struct ScaledCable {
  DVec3 arm = {};
  DVec3 anchor = {};
  double length = 0;
};

/// The energy of a hanging solid with the terms of the augmented Lagrangian for its cables (Hestenes 1969,
/// Powell 1969; inequalities by Rockafellar 1973): y + sum of (k / 2) max(0, l - L + t / k)^2, l being the
/// distance that the cable of length L must span. Its minimum for the right tensions t is the equilibrium.
class HangEnergy {
 public:
  HangEnergy(std::vector<ScaledCable> cables, double penalty)
      : cables_(std::move(cables)), penalty_(penalty) {}

  [[nodiscard]] const std::vector<ScaledCable>& cables() const { return cables_; }

  /// How much longer the way of a cable is than the cable.
  [[nodiscard]] double excess(const Hang& hang, std::size_t i) const {
    return length(way(hang, i)) - cables_[i].length;
  }

  /// Force of a cable as the penalty and its multiplier have it.
  [[nodiscard]] double tension(const Hang& hang, std::size_t i) const {
    return std::max(0.0, hang.tensions[i] + penalty_ * excess(hang, i));
  }

  [[nodiscard]] double value(const Hang& hang) const {
    double sum = hang.center.y;
    for (std::size_t i = 0; i < cables_.size(); ++i) {
      const double t = tension(hang, i);
      sum += 0.5 * t * t / penalty_;
    }
    return sum;
  }

  /// First and second derivative by a shift and a turn.
  void differentiate(const Hang& hang, Vector6& gradient, Matrix6& hessian) const {
    gradient = {0, 1, 0, 0, 0, 0};
    hessian = {};
    for (std::size_t i = 0; i < cables_.size(); ++i) {
      const double t = tension(hang, i);
      if (t > 0) add_cable(hang, i, t, gradient, hessian);
    }
  }

  /// Derivative of the length of a cable's way by a shift and a turn.
  [[nodiscard]] Vector6 length_gradient(const Hang& hang, std::size_t i) const {
    const DVec3 u = normalize(way(hang, i));
    const DVec3 turn = cross(rotate(hang.rotation, cables_[i].arm), u);
    return {u.x, u.y, u.z, turn.x, turn.y, turn.z};
  }

 private:
  /// From the anchor to the attachment.
  [[nodiscard]] DVec3 way(const Hang& hang, std::size_t i) const {
    return hang.center + rotate(hang.rotation, cables_[i].arm) - cables_[i].anchor;
  }

  /// A turn by the vector w moves an attachment at s from the center by w x s + w x (w x s) / 2. So the
  /// length l along the unit vector u has the derivatives (u, s x u) and, with J = (1, -[s]x), J^T (1 - u
  /// u^T) J / l + (0, (u s^T + s u^T) / 2 - (u s) 1).
  void add_cable(const Hang& hang, std::size_t i, double t, Vector6& gradient, Matrix6& hessian) const {
    const DVec3 d = way(hang, i);
    const double l = std::max(length(d), 1e-9 * cables_[i].length);
    const DVec3 u = (1 / l) * d;
    const DVec3 s = rotate(hang.rotation, cables_[i].arm);
    const Vector6 g = length_gradient(hang, i);
    const std::array<DVec3, 6> columns = {DVec3{1, 0, 0},      DVec3{0, 1, 0},      DVec3{0, 0, 1},
                                          DVec3{0, -s.z, s.y}, DVec3{s.z, 0, -s.x}, DVec3{-s.y, s.x, 0}};
    for (std::size_t a = 0; a < 6; ++a) {
      gradient[a] += t * g[a];
      for (std::size_t b = 0; b < 6; ++b) {
        const double bent = dot(columns[a], columns[b]) - dot(columns[a], u) * dot(columns[b], u);
        hessian[a][b] += penalty_ * g[a] * g[b] + t * bent / l;
      }
    }
    const double us[3] = {u.x, u.y, u.z};
    const double ss[3] = {s.x, s.y, s.z};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        hessian[a + 3][b + 3] += t * (0.5 * (us[a] * ss[b] + ss[a] * us[b]) - (a == b ? dot(u, s) : 0.0));
      }
    }
  }

  std::vector<ScaledCable> cables_;
  double penalty_ = 0;
};

double size_of(const Vector6& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

Hang moved(Hang hang, const Vector6& way, double share) {
  hang.center += share * DVec3{way[0], way[1], way[2]};
  hang.rotation = normalize(math::quaternion_of(share * DVec3{way[3], way[4], way[5]}) * hang.rotation);
  return hang;
}

/// The way down by Newton, with second derivatives taken as positive, and no farther than a unit.
Vector6 newton_way(const Eigen6& eigen, const Vector6& gradient) {
  Vector6 way = {};
  for (std::size_t k = 0; k < 6; ++k) {
    double along = 0;
    for (std::size_t a = 0; a < 6; ++a) along += eigen.vectors[k][a] * gradient[a];
    const double curvature = std::max(std::abs(eigen.values[k]), 1e-9);
    for (std::size_t a = 0; a < 6; ++a) way[a] -= along / curvature * eigen.vectors[k][a];
  }
  const double size = size_of(way);
  for (double& x : way) x *= size > 1 ? 1 / size : 1;
  return way;
}

/// Goes down to a minimum for the tensions as they are. A saddle is left along its falling way.
void descend(const HangEnergy& energy, Hang& hang) {
  Vector6 gradient;
  Matrix6 hessian;
  int escapes = 0;
  for (int step = 0; step < kNewtonSteps; ++step) {
    energy.differentiate(hang, gradient, hessian);
    const Eigen6 eigen = geometry::eigen_of(hessian);
    if (size_of(gradient) <= kBalanced) {
      if (eigen.values[0] > -kNeutral || escapes++ == kEscapes) return;
      hang = moved(hang, eigen.vectors[0], 0.1);
      continue;
    }
    const Vector6 way = newton_way(eigen, gradient);
    const double before = energy.value(hang);
    double share = 1;
    Hang next = moved(hang, way, share);
    // Near the minimum the energy no longer tells, because its last digits are rounded.
    while (energy.value(next) > before + 1e-14 * (1 + std::abs(before)) && share > 1e-6) {
      share *= 0.5;
      next = moved(hang, way, share);
    }
    hang = std::move(next);
  }
}

double longest_excess(const HangEnergy& energy, const Hang& hang, std::size_t& cable) {
  double most = 0;
  for (std::size_t i = 0; i < energy.cables().size(); ++i) {
    const double excess = energy.excess(hang, i);
    if (!(excess > most)) continue;
    most = excess;
    cable = i;
  }
  return most;
}

/// Whether every cable has its length, and those that are slack pull nothing.
bool has_tensions(const HangEnergy& energy, const Hang& hang) {
  for (std::size_t i = 0; i < energy.cables().size(); ++i) {
    const double excess = energy.excess(hang, i);
    const double limit = kTooLong * (1 + energy.cables()[i].length);
    if (excess > limit || (hang.tensions[i] > 0 && excess < -limit)) return false;
  }
  return true;
}

/// Finds the equilibrium that a start leads to: descends, corrects the tensions, and again.
void come_to_rest(const HangEnergy& energy, Hang& hang) {
  for (int round = 0; round < kRounds; ++round) {
    descend(energy, hang);
    std::vector<double> tensions(hang.tensions.size());
    for (std::size_t i = 0; i < tensions.size(); ++i) tensions[i] = energy.tension(hang, i);
    hang.tensions = std::move(tensions);
    if (has_tensions(energy, hang)) return;
  }
}

/// The identity and the other 23 rotations of a cube, and one that is none of them, because a cube's
/// rotations may all be saddles.
std::vector<Quaternion<double>> start_rotations() {
  const double h = std::sqrt(0.5);
  std::vector<Quaternion<double>> list;
  const Quaternion<double> faces[] = {{0, 0, 0, 1},  {1, 0, 0, 0}, {h, 0, 0, h},
                                      {-h, 0, 0, h}, {0, 0, h, h}, {0, 0, -h, h}};
  const Quaternion<double> turns[] = {{0, 0, 0, 1}, {0, h, 0, h}, {0, -h, 0, h}, {0, 1, 0, 0}};
  for (const auto& face : faces) {
    for (const auto& turn : turns) list.push_back(normalize(face * turn));
  }
  list.push_back(normalize(Quaternion<double>{0.3, 0.5, -0.2, 0.8}));
  return list;
}

/// The unit of lengths: the distance of the farthest attachment from the center, or if all are there the
/// longest cable.
double length_unit(const HangingSolid& solid) {
  double arm = 0;
  double cable = 0;
  for (const Cable& one : solid.cables) {
    arm = std::max(arm, length(one.attachment - solid.center));
    cable = std::max(cable, one.length);
  }
  return arm > 1e-6 * cable ? arm : cable;
}

std::vector<ScaledCable> scaled_cables(const HangingSolid& solid, double unit) {
  std::vector<ScaledCable> cables;
  for (const Cable& one : solid.cables) {
    cables.push_back({(1 / unit) * (one.attachment - solid.center),
                      (1 / unit) * (one.anchor - solid.cables[0].anchor), one.length / unit});
  }
  return cables;
}

/// Whether what pulls can be shared in other ways: the gradients of the taut lengths depend on each other.
bool is_indeterminate(const HangEnergy& energy, const Hang& hang) {
  Matrix6 sum = {};
  std::size_t taut = 0;
  for (std::size_t i = 0; i < hang.tensions.size(); ++i) {
    if (!(hang.tensions[i] > kNeutral)) continue;
    ++taut;
    const Vector6 g = energy.length_gradient(hang, i);
    for (std::size_t a = 0; a < 6; ++a) {
      for (std::size_t b = 0; b < 6; ++b) sum[a][b] += g[a] * g[b];
    }
  }
  const Eigen6 eigen = geometry::eigen_of(sum);
  std::size_t rank = 0;
  for (const double value : eigen.values) rank += value > 1e-9 ? 1 : 0;
  return rank < taut;
}

HangingPose pose_of_hang(const HangingSolid& solid, const std::vector<ScaledCable>& cables, const Hang& hang,
                         double unit) {
  const double weight = solid.mass * solid.gravity;
  HangingPose pose;
  pose.center = solid.cables[0].anchor + unit * hang.center;
  pose.rotation = hang.rotation;
  pose.position = pose.center - rotate(pose.rotation, solid.center);
  for (const double tension : hang.tensions) pose.tensions.push_back(weight * tension);
  // Almost rigid cables leave the second derivatives of ways that keep the lengths.
  Vector6 gradient;
  Matrix6 hessian;
  const HangEnergy soft(cables, kPenalty);
  soft.differentiate(hang, gradient, hessian);
  pose.residual = size_of(gradient);
  const HangEnergy stiff(cables, 1e4 * kPenalty);
  Vector6 unused;
  stiff.differentiate(hang, unused, hessian);
  for (const double value : geometry::eigen_of(hessian).values) {
    if (value <= kNeutral) {
      ++pose.neutral;
    } else if (pose.stiffness == 0) {
      pose.stiffness = value * weight / unit;
    }
  }
  pose.is_indeterminate = is_indeterminate(soft, hang);
  return pose;
}

/// Whether two poses differ at most by a turn about the vertical or by what is neutral.
bool is_same(const HangingPose& a, const HangingPose& b, double unit, double weight) {
  if (a.neutral != b.neutral || std::abs(a.center.y - b.center.y) > kSamePose * unit) return false;
  for (std::size_t i = 0; i < a.tensions.size(); ++i) {
    if (!a.is_indeterminate && std::abs(a.tensions[i] - b.tensions[i]) > kSamePose * weight) return false;
  }
  if (a.neutral > 1) return true;
  const auto down = [](const HangingPose& pose) { return rotate(conjugate(pose.rotation), DVec3{0, -1, 0}); };
  return length(down(a) - down(b)) < kSamePose && length(a.center - b.center) < kSamePose * unit;
}

Error out_of_reach(std::size_t cable, double excess) {
  return {ErrorCode::kOutOfRange, "cables[" + std::to_string(cable) + "].length",
          "the cables are too short to reach the solid together: this one lacks " + std::to_string(excess) +
              " m; make it longer, or bring the anchors nearer"};
}

Result<void> check_hanging(const HangingSolid& solid) {
  const auto refuse = [](std::string where, const char* what) {
    return Error{ErrorCode::kOutOfRange, std::move(where), what};
  };
  if (!is_finite(solid.center)) return refuse("center", "a coordinate is not finite");
  if (!(solid.mass > 0) || !std::isfinite(solid.mass)) return refuse("mass", "must be positive and finite");
  if (!(solid.gravity > 0) || !std::isfinite(solid.gravity)) {
    return refuse("gravity", "must be positive and finite");
  }
  if (solid.cables.empty() || solid.cables.size() > kCablesMax) {
    return refuse("cables", "must be 1 to 16; what no cable holds falls");
  }
  const double unit = length_unit(solid);
  for (std::size_t i = 0; i < solid.cables.size(); ++i) {
    const Cable& cable = solid.cables[i];
    const std::string where = "cables[" + std::to_string(i) + "].";
    if (!is_finite(cable.attachment)) return refuse(where + "attachment", "a coordinate is not finite");
    if (!is_finite(cable.anchor)) return refuse(where + "anchor", "a coordinate is not finite");
    if (!std::isfinite(cable.length) || !(cable.length > 1e-4 * unit)) {
      return refuse(where + "length", "must be finite, and more than 1e-4 of the solid's reach");
    }
  }
  return {};
}

}  // namespace

Result<std::vector<HangingPose>> find_hanging_poses(const HangingSolid& solid) {
  const base::FloatEnvironment environment;
  if (auto checked = check_hanging(solid); !checked) return checked.error();
  const double unit = length_unit(solid);
  const std::vector<ScaledCable> cables = scaled_cables(solid, unit);
  double shortest = std::numeric_limits<double>::infinity();
  DVec3 anchors = {};
  double lengths = 0;
  for (const ScaledCable& cable : cables) {
    shortest = std::min(shortest, cable.length);
    anchors += (1.0 / double(cables.size())) * cable.anchor;
    lengths += cable.length / double(cables.size());
  }
  const HangEnergy energy(cables, kPenalty * std::max(1.0, 1 / shortest));
  std::vector<HangingPose> poses;
  std::size_t short_cable = 0;
  double short_of = std::numeric_limits<double>::infinity();
  for (const Quaternion<double>& rotation : start_rotations()) {
    Hang hang = {.center = anchors - DVec3{0, lengths, 0},
                 .rotation = rotation,
                 .tensions = std::vector<double>(cables.size(), 0)};
    come_to_rest(energy, hang);
    std::size_t cable = 0;
    const double excess = longest_excess(energy, hang, cable);
    if (excess > kUnreached * (1 + energy.cables()[cable].length)) {
      if (excess < short_of) short_cable = cable;
      short_of = std::min(short_of, excess);
      continue;
    }
    HangingPose pose = pose_of_hang(solid, cables, hang, unit);
    const bool known = std::any_of(poses.begin(), poses.end(), [&](const HangingPose& one) {
      return is_same(one, pose, unit, solid.mass * solid.gravity);
    });
    if (!known && pose.residual < 1e-8) poses.push_back(std::move(pose));
  }
  if (poses.empty()) return out_of_reach(short_cable, short_of * unit);
  std::stable_sort(poses.begin(), poses.end(), [&](const HangingPose& a, const HangingPose& b) {
    return a.center.y < b.center.y - kSamePose * unit;
  });
  return poses;
}

}  // namespace hooke
