#include "peer_scene.h"

#include "hooke/model_io.h"

#include "geometry/convex/convex_hull.h"
#include "geometry/convex/mass_properties.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <unordered_map>

namespace hooke::bench {

namespace {

using geometry::MassProperties;

DQuat wide(Quat q) {
  return {q.x, q.y, q.z, q.w};
}

Quat narrow(DQuat q) {
  return {static_cast<Real>(q.x), static_cast<Real>(q.y), static_cast<Real>(q.z), static_cast<Real>(q.w)};
}

/// Returns the pose `inner` of a frame within the frame `outer`.
PeerPose compose(const PeerPose& outer, const PeerPose& inner) {
  return {outer.position + rotate(outer.rotation, inner.position), outer.rotation * inner.rotation};
}

PeerPose inverse_of(const PeerPose& pose) {
  const DQuat back = conjugate(pose.rotation);
  return {-rotate(back, pose.position), back};
}

/// This is a shape in the body's frame, and its density.
struct Piece {
  PeerShape shape;
  MassProperties solid;  ///< In the body's frame, of density 1.
  double density = 1000;
};

Result<Piece> make_piece(const Shape& shape, const std::shared_ptr<const Model>& model, const PeerPose& pose,
                         double density) {
  Piece piece = {
      .shape = {.shape = shape, .pose = pose}, .solid = geometry::mass_of(shape), .density = density};
  if (shape.kind == ShapeKind::kHull) {
    const Result<geometry::ConvexHull> hull = geometry::make_convex_hull(model->mesh.positions);
    if (!hull) return hull.error();
    for (const Vec3 vertex : hull.value().vertices) piece.shape.points.push_back(vector_cast<double>(vertex));
    piece.solid = geometry::mass_of(hull.value());
  }
  if (shape.kind == ShapeKind::kMesh) piece.shape.model = model;
  piece.solid = geometry::moved(piece.solid, narrow(pose.rotation), pose.position);
  return piece;
}

Result<std::vector<Piece>> pieces_of(const SceneBody& body, const SceneObject& object) {
  std::vector<Piece> pieces;
  if (object.parts.empty()) {
    Result<Piece> only = make_piece(object.shape, object.model, {}, static_cast<double>(body.desc.density));
    if (!only) return only.error();
    pieces.push_back(std::move(only).value());
  }
  for (std::size_t i = 0; i < object.parts.size(); ++i) {
    const SceneObject::Part& part = object.parts[i];
    Result<Piece> piece = make_piece(part.shape, part.model,
                                     {vector_cast<double>(part.position), normalize(wide(part.rotation))},
                                     static_cast<double>(body.parts[i].desc.density));
    if (!piece) return piece.error();
    pieces.push_back(std::move(piece).value());
  }
  return pieces;
}

/// Computes mass, inertia and principal frame of a body that forces move.
void weigh(const std::vector<Piece>& pieces, double mass, PeerBody& body) {
  MassProperties sum;
  for (const Piece& piece : pieces) sum = geometry::joined(sum, 1, piece.solid, piece.density);
  const geometry::PrincipalAxes axes = geometry::principal_axes(sum.inertia);
  body.mass = mass;
  body.inertia = (mass / sum.volume) * axes.moments;
  body.own = {sum.center, axes.rotation};
}

Result<PeerBody> make_body(const SceneBody& from, const SceneObject& object, const World& world) {
  const Result<std::vector<Piece>> pieces = pieces_of(from, object);
  if (!pieces) return pieces.error();
  PeerBody body;
  body.kind = from.desc.kind;
  if (body.kind == BodyKind::kDynamic)
    weigh(pieces.value(), static_cast<double>(world.mass(object.body)), body);
  const Pose pose = world.pose(object.body);
  body.start = {.pose = compose({pose.position, normalize(wide(pose.rotation))}, body.own),
                .velocity = vector_cast<double>(world.velocity(object.body)),
                .angular_velocity = vector_cast<double>(world.angular_velocity(object.body))};
  const PeerPose to_own = inverse_of(body.own);
  for (Piece piece : pieces.value()) {
    piece.shape.pose = compose(to_own, piece.shape.pose);
    body.shapes.push_back(std::move(piece.shape));
  }
  const bool named = !from.tag.material.empty();
  const Real friction = named ? object.look.friction : ContactDesc{}.friction;
  body.friction = static_cast<double>(from.tag.friction.value_or(friction));
  body.restitution = static_cast<double>(named ? object.look.restitution : from.desc.contact.restitution);
  return body;
}

/// Tells whether a hook is a joint that every engine has.
bool is_free_ball(const SceneHook& hook) {
  const HookDesc& desc = hook.desc;
  return desc.kind == HookKind::kBall && desc.limits == HookLimits{} && desc.spring == HookSpring{} &&
         desc.motor == HookMotor{} && !desc.cone && !desc.collide && desc.break_force == kRigid &&
         desc.break_torque == kRigid && hook.anchor;
}

/// Returns the ball joints of the scene, or an Error if it has other hooks.
Result<std::vector<PeerBall>> make_balls(const Scene& scene, const Simulation& simulation) {
  std::unordered_map<std::string_view, std::size_t> body_of;
  std::vector<const SceneObject*> hooks;
  for (const SceneObject& object : simulation.objects()) {
    if (object.kind == SceneObject::Kind::kBody) body_of.emplace(object.name, body_of.size());
    if (object.kind == SceneObject::Kind::kHook) hooks.push_back(&object);
  }
  std::vector<PeerBall> balls;
  for (const SceneHook& hook : scene.objects.hooks) {
    for (std::size_t i = 0; i < hook.array.count(); ++i) {
      const auto& held = hooks[balls.size()]->hooked;
      const auto a = body_of.find(held[0]);
      const auto b = body_of.find(held[1]);
      if (a == body_of.end() || b == body_of.end())
        return Error{ErrorCode::kUnsupported, hook.name,
                     "is not between two bodies, which peers are not given"};
      balls.push_back({a->second, b->second, *hook.anchor + hook.array.offset(i)});
    }
  }
  return balls;
}

/// Returns what no peer supports; empty for a scene that all can have.
std::string beyond_bodies(const Scene& scene) {
  if (!scene.objects.ropes.empty()) return "ropes";
  if (!scene.objects.cloths.empty()) return "cloths";
  if (!scene.objects.solids.empty()) return "solids";
  if (!std::all_of(scene.objects.hooks.begin(), scene.objects.hooks.end(), is_free_ball))
    return "other hooks than balls";
  if (!scene.objects.seams.empty()) return "seams";
  if (!scene.objects.particles.empty()) return "particles";
  if (!scene.objects.fields.empty()) return "fields";
  if (!scene.timeline.empty()) return "events";
  if (!scene.material_pairs.empty()) return "pairs of materials";
  for (const SceneBody& body : scene.objects.bodies) {
    if (body.desc.sensor || !body.desc.collides) return "bodies that others pass through";
    if (body.fracture) return "bodies that break";
  }
  return {};
}

}  // namespace

Result<PeerScene> make_peer_scene(const Scene& scene, const Simulation& simulation) {
  if (const std::string what = beyond_bodies(scene); !what.empty())
    return Error{ErrorCode::kUnsupported, "scene", "has " + what + ", which peers are not given"};
  PeerScene peer = {.gravity = vector_cast<double>(scene.world.gravity),
                    .sleeping = scene.world.sleeping,
                    .dt = static_cast<double>(scene.dt)};
  std::size_t next = 0;
  for (const SceneBody& body : scene.objects.bodies) {
    for (std::size_t i = 0; i < body.tag.array.count(); ++i) {
      Result<PeerBody> made = make_body(body, simulation.objects()[next++], simulation.world());
      if (!made) return made.error();
      peer.bodies.push_back(std::move(made).value());
    }
  }
  Result<std::vector<PeerBall>> balls = make_balls(scene, simulation);
  if (!balls) return balls.error();
  peer.balls = std::move(balls).value();
  return peer;
}

Result<double> deepest_overlap(const Scene& scene, const PeerScene& peer,
                               const std::vector<PeerMotion>& now) {
  Scene still = scene;
  still.world.sleeping = false;
  still.objects.hooks.clear();
  still.expect.clear();
  Loaded<Simulation> made = Simulation::create(std::move(still));
  if (!made) return made.errors.front();
  Simulation& simulation = *made.value;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const BodyId id = simulation.objects()[i].body;
    const PeerPose pose = compose(now[i].pose, inverse_of(peer.bodies[i].own));
    World& world = simulation.world();
    // A static body keeps its position.
    if (peer.bodies[i].kind == BodyKind::kStatic) continue;
    for (const Result<void>& done : {world.set_pose(id, {pose.position, narrow(pose.rotation)}),
                                     world.set_velocity(id, {}), world.set_angular_velocity(id, {})}) {
      if (!done) return done.error();
    }
  }
  // A step too short to move anything finds where bodies overlap.
  simulation.world().step(Real(1e-9));
  return simulation.world().measure().largest_penetration;
}

double kinetic_energy(const PeerScene& peer, const std::vector<PeerMotion>& now) {
  double sum = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const PeerBody& body = peer.bodies[i];
    const DVec3 spin = rotate(conjugate(now[i].pose.rotation), now[i].angular_velocity);
    sum += 0.5 * body.mass * length_squared(now[i].velocity);
    sum += 0.5 * (body.inertia.x * spin.x * spin.x + body.inertia.y * spin.y * spin.y +
                  body.inertia.z * spin.z * spin.z);
  }
  return sum;
}

}  // namespace hooke::bench
