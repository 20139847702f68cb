#pragma once

#include "hooke/scene_io.h"

#include <cstdint>
#include <memory>
#include <vector>

/// \file
/// Describes a scene of rigid bodies by what every engine has, so that Hooke and its peers run the same.

namespace hooke::bench {

using DQuat = Quaternion<double>;

struct PeerPose {
  DVec3 position = {};  ///< [m]
  DQuat rotation = {};
};

/// This is where a body is and how it moves, about its center of mass and along its principal axes.
struct PeerMotion {
  PeerPose pose = {};
  DVec3 velocity = {};          ///< [m/s]
  DVec3 angular_velocity = {};  ///< In world axes [rad/s].
};

/// This is one shape of a body. `pose` is in the body's principal frame.
struct PeerShape {
  Shape shape = {};
  PeerPose pose = {};
  std::vector<DVec3> points = {};           ///< Points of a hull, in the shape's frame.
  std::shared_ptr<const Model> model = {};  ///< Set for a mesh.
};

struct PeerBody {
  BodyKind kind = BodyKind::kStatic;
  double mass = 0;     ///< Mass [kg]; 0 for a body that forces do not move.
  DVec3 inertia = {};  ///< Moments about the principal axes [kg m^2].
  PeerMotion start = {};
  PeerPose own = {};  ///< The principal frame in the frame that Hooke gives the body.
  std::vector<PeerShape> shapes = {};
  double friction = 0.5;  ///< Friction of a pair, the geometric mean.
  double restitution = 0;
};

/// This is a free ball joint of two bodies, which do not touch each other.
struct PeerBall {
  std::size_t a = 0;
  std::size_t b = 0;
  DVec3 anchor = {};  ///< Anchor at the start [m].
};

struct PeerScene {
  std::vector<PeerBody> bodies = {};
  std::vector<PeerBall> balls = {};
  DVec3 gravity = {};  ///< [m/s^2]
  bool sleeping = true;
  double dt = 1.0 / 60;  ///< [s]
};

/// Makes the scene. The Error kUnsupported names what is neither a rigid body nor a free ball joint of two:
/// ropes, cloths, other hooks, pairs of materials, events.
[[nodiscard]] Result<PeerScene> make_peer_scene(const Scene& scene, const Simulation& simulation);

/// Returns the deepest overlap of two bodies of the scene, in these poses, by Hooke's own geometry [m].
[[nodiscard]] Result<double> deepest_overlap(const Scene& scene, const PeerScene& peer,
                                             const std::vector<PeerMotion>& now);

/// Returns the kinetic energy [J].
[[nodiscard]] double kinetic_energy(const PeerScene& peer, const std::vector<PeerMotion>& now);

}  // namespace hooke::bench
