#pragma once

#include "solver/solid/weighted_points.h"
#include "state/bodies.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hooke::solver {

/// What a contact or a hook joins points of stiff solids to: the world, or a body that is six unknowns of the
/// solution.
struct StiffEnd {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::uint32_t body = kNone;   ///< Row of the body, if it gives way.
  std::uint32_t mover = kNone;  ///< That body in StiffSolution::holders of the first point's part.
  double share = 1;             ///< Share of its mass that this part has [ratio].
  DVec3 lever = {};             ///< From its center of mass [m].

  /// The body as unknowns of the solution, null if the end does not give way.
  template <std::size_t N>
  [[nodiscard]] HoldingBody* mover_of(StiffParts parts, const WeightedPoints<N>& points) const {
    return mover == kNone ? nullptr : &parts[points.part[0]]->stiff.holders[mover];
  }

  /// The velocity at which the points leave the end, in a vector and the six numbers of bodies [m/s].
  template <std::size_t N>
  [[nodiscard]] DVec3 leaving(StiffParts parts, const WeightedPoints<N>& points,
                              std::vector<double> StiffSolution::*of_points,
                              HoldingBody::Six HoldingBody::*of_bodies) const {
    const DVec3 u = points.sum(parts, of_points);
    const HoldingBody* body_of = mover_of(parts, points);
    return body_of != nullptr ? u - velocity_at(body_of->*of_bodies, lever) : u;
  }

  /// Adds an impulse [N s] to the points, and the opposite one to the body.
  template <std::size_t N>
  void push(StiffParts parts, const WeightedPoints<N>& points, DVec3 impulse,
            std::vector<double> StiffSolution::*to_points, HoldingBody::Six HoldingBody::*to_bodies) const {
    points.push(parts, impulse, to_points);
    if (HoldingBody* body_of = mover_of(parts, points)) add_impulse(-impulse, lever, body_of->*to_bodies);
  }
};

/// A body with a share of its mass.
[[nodiscard]] HoldingBody holding_body(const state::Bodies& bodies, std::uint32_t body, double share);

/// Lets the body of an end be an unknown of the solution of the points' first part.
template <std::size_t N>
void take_mover(const state::Bodies& bodies, StiffParts parts, const WeightedPoints<N>& points,
                StiffEnd& end) {
  end.mover = StiffEnd::kNone;
  if (end.body == StiffEnd::kNone) return;
  StiffSolution& stiff = parts[points.part[0]]->stiff;
  if (stiff.find_holder(end.body) == nullptr)
    stiff.holders.push_back(holding_body(bodies, end.body, end.share));
  const HoldingBody* holder = stiff.find_holder(end.body);
  if (holder->moves) end.mover = static_cast<std::uint32_t>(holder - stiff.holders.data());
}

}  // namespace hooke::solver
