#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <optional>
#include <vector>

/// \file
/// Where a rigid solid comes to rest, found by statics alone: on a plane, on a slope, hung from cables, about
/// an axis. Nothing here needs a World. Up is +y.

namespace hooke {

/// A way in which a solid lies still on a horizontal plane: on a facet of its convex hull that has the center
/// of mass above it.
struct StablePose {
  DVec3 normal = {};  ///< Outward unit normal of the facet it lies on, in the mesh's frame.
  /// Corners of that facet in the mesh's frame [m], counter-clockwise seen from outside.
  std::vector<DVec3> support = {};
  Quaternion<double> rotation = {};  ///< Shortest rotation of the mesh that turns `normal` straight down.
  /// Where to put the mesh's origin [m]: the solid then lies on the plane y = 0, its center of mass above the
  /// origin.
  DVec3 position = {};
  double height = 0;  ///< Height of the center of mass above the plane [m].
  /// Distance of the center of mass, seen from above, from the nearest side of the facet [m].
  double margin = 0;
  /// Smallest angle [rad] by which the solid must be tipped over a side of the facet until it falls.
  double tip_angle = 0;
  double tip_height = 0;  ///< How far the center of mass rises at least until the solid falls [m].
  /// Share of random orientations that end in this pose if the solid rolls slowly and slides freely.
  double probability = 0;
};

/// All stable poses of a solid on a plane.
struct StablePoses {
  std::vector<StablePose> poses = {};  ///< The most probable first. Probabilities sum to 1.
  DVec3 center = {};                   ///< Center of mass in the mesh's frame [m].
  /// How far points of the mesh stand out of the hull that was used [m]. A hull has 256 corners at most: a
  /// rounder mesh loses some, and its poses are those of the coarser hull.
  double hull_error = 0;
};

/// Finds the poses in which a solid lies still on a horizontal plane, and how probable each is.
///
/// - The center of mass is that of the volume inside the mesh, or `center` in the mesh's frame. With a center
///   given, the mesh may be open: only its convex hull touches the plane.
/// - The solid starts on each facet with the probability of the facet's solid angle, seen from the center of
///   mass. A facet that does not have the center above it passes its probability to the neighbor across the
///   side that the center overhangs most (Goldberg, Mirtich, Zhuang, Craig, Carlisle, Canny 1999, Part pose
///   statistics: estimators and experiments; the quasi-static estimator). Of a solid that bounces and
///   rolls on, poses which are easily tipped come out too probable.
/// - Facets within 2e-5 of the extent of one plane are one facet. A margin below 1e-6 of the largest distance
///   from the hull's center counts as none.
///
/// Errors: a mesh without volume inside if no center is given (its surface is open or faces inward), an index
/// or coordinate out of range, fewer than four points, a hull thinner than 1e-4 of its extent, a center that
/// is not finite or not inside the hull.
[[nodiscard]] Result<StablePoses> find_stable_poses(const MeshDesc& mesh, std::optional<DVec3> center = {});

/// A facet of a solid's convex hull on which it lies on a slope without tipping. A heading is a direction in
/// the facet's plane that points downhill. Friction passes on no more than `friction` times the pressing
/// force: what slides tips as on a slope of atan(friction).
struct SlopePose {
  DVec3 normal = {};  ///< Outward unit normal of the facet, in the mesh's frame.
  std::vector<DVec3> support =
      {};                    ///< Its corners in the mesh's frame [m], counter-clockwise seen from outside.
  double height = 0;         ///< Distance of the center of mass from the slope [m].
  double upright_share = 0;  ///< Share of all headings in which it does not tip; 1 if it never does.
  /// Steepest slope on which it tips in no heading; 0 if the center overhangs the facet [rad].
  double tip_angle = 0;
  double tip_angle_best = 0;  ///< Steepest slope on which it does not tip in its best heading [rad].
  /// The middle of the widest range of headings that do not tip it, in the mesh's frame; the one that leans
  /// least if no heading does.
  DVec3 heading = {};
  DVec3 position = {};               ///< Of the mesh's frame [m] with this heading.
  Quaternion<double> rotation = {};  ///< Of the mesh's frame with this heading.
};

/// Ways to lie on a slope.
struct SlopePoses {
  std::vector<SlopePose> poses =
      {};                         ///< The largest upright_share first; those that always tip are left out.
  bool slides = false;            ///< Whether friction cannot hold the solid on this slope.
  double slide_angle = 0;         ///< Steepest slope that friction holds it on: atan(friction) [rad].
  double acceleration_share = 0;  ///< Acceleration down the slope over gravity; 0 if it does not slide.
  DVec3 center = {};              ///< Center of mass in the mesh's frame [m].
  double hull_error = 0;          ///< As in StablePoses [m].
};

/// Finds the facets of its hull on which a solid lies on the slope y = -x tan(slope) without tipping, and
/// whether it slides. `slope` is from 0 to below pi/2 [rad], `friction` 0 or more.
///
/// Errors: those of find_stable_poses, a slope or friction out of range.
[[nodiscard]] Result<SlopePoses> find_slope_poses(const MeshDesc& mesh, double slope, double friction,
                                                  std::optional<DVec3> center = {});

/// A cable that does not stretch, and pulls a solid only. It passes through everything.
struct Cable {
  DVec3 attachment = {};  ///< Where it holds the solid, in the solid's frame [m].
  DVec3 anchor = {};      ///< Where it is held [m].
  double length = 1;      ///< [m], positive.
};

/// A solid that hangs.
struct HangingSolid {
  DVec3 center = {};               ///< Center of mass in its own frame [m].
  double mass = 1;                 ///< [kg], positive.
  double gravity = 9.81;           ///< [m/s^2], positive, along -y.
  std::vector<Cable> cables = {};  ///< 1 to 16.
};

/// A stable equilibrium of a hanging solid: the potential energy has a minimum there.
struct HangingPose {
  DVec3 position = {};                ///< Of the solid's frame [m].
  Quaternion<double> rotation = {};   ///< Of the solid's frame.
  DVec3 center = {};                  ///< Center of mass [m].
  std::vector<double> tensions = {};  ///< Of each cable [N]; 0 if it is slack.
  /// Smallest second derivative of the energy, but for neutral ways [N/m]. A turn counts as its angle times
  /// the distance of the farthest attachment from the center.
  double stiffness = 0;
  /// Number of independent ways in which it moves on without any force: 1 if it may turn about the vertical,
  /// more if every attitude is an equilibrium.
  int neutral = 0;
  /// Whether other tensions balance the solid as well, as of three cables in one plane. Those found are of
  /// cables of equal stiffness.
  bool is_indeterminate = false;
  double residual = 0;  ///< Largest unbalanced force, over the weight; torque counts over the same distance.
};

/// Finds the stable equilibria of a solid that hangs from cables, the lowest center first. Turned ways that a
/// neutral equilibrium allows are one. The search descends from the solid's own attitude and 24 others, so
/// that an equilibrium to which none of them leads is missed.
///
/// Errors: no cable or more than 16, a value that is not finite or out of range, cables that are too short to
/// reach the solid together.
[[nodiscard]] Result<std::vector<HangingPose>> find_hanging_poses(const HangingSolid& solid);

/// A solid on an axle that may turn.
struct AxleSolid {
  DVec3 center = {};           ///< Center of mass [m].
  DVec3 point = {};            ///< A point of the axis [m].
  DVec3 axis = {0, 0, 1};      ///< Direction of the axis, of any length.
  double mass = 1;             ///< [kg], positive.
  double gravity = 9.81;       ///< [m/s^2], positive, along -y.
  double friction_torque = 0;  ///< Torque that the bearing holds against [N m].
};

/// Where a solid on an axle rests. Angles turn it about the axis, right-handed, from how it is given.
struct AxleRest {
  bool is_indifferent =
      false;                ///< Whether it rests at every angle without friction: no arm, or a vertical axis.
  double stable_angle = 0;  ///< From -pi to pi, center of mass lowest; 0 if indifferent [rad].
  double unstable_angle = 0;  ///< From -pi to pi, center of mass highest; 0 if indifferent [rad].
  double arm = 0;             ///< Distance of the center of mass from the axis [m].
  double largest_torque = 0;  ///< Of gravity about the axis, a quarter turn from rest [N m].
  double torque = 0;          ///< Of gravity about the axis, at the angle as given [N m].
  /// Friction holds it up to so far from the stable and from the unstable angle [rad]; pi for every angle.
  double held_within = 0;
  bool stays = false;                ///< Whether it stays as given.
  DVec3 position = {};               ///< Of the solid's frame at the stable angle [m].
  Quaternion<double> rotation = {};  ///< Of the solid's frame at the stable angle.
};

/// Finds where a solid on an axle rests.
///
/// Errors: an axis of no length, a value that is not finite or out of range.
[[nodiscard]] Result<AxleRest> find_axle_rest(const AxleSolid& solid);

}  // namespace hooke
