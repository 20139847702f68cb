#include "hooke/model_io.h"

#include "peer_engine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ode/ode.h>
#include <vector>

namespace hooke::bench {

namespace {

constexpr int kMaxContacts = 8;  // Contacts of a pair.

/// ODE counts w first.
std::array<dReal, 4> ode(DQuat q) {
  return {static_cast<dReal>(q.w), static_cast<dReal>(q.x), static_cast<dReal>(q.y), static_cast<dReal>(q.z)};
}

DVec3 from_ode(const dReal* v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Capsules and cylinders stand along z in ODE.
DQuat turned_up(DQuat rotation) {
  return rotation * quaternion_about(DVec3{1, 0, 0}, -0.25 * 6.283185307179586);
}

class Ode final : public PeerEngine {
 public:
  explicit Ode(const PeerScene& scene) : scene_(scene) {
    dInitODE2(0);
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    joints_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, scene.gravity.x, scene.gravity.y, scene.gravity.z);
    dWorldSetQuickStepNumIterations(world_, 20);
    dWorldSetERP(world_, 0.2);
    dWorldSetAutoDisableFlag(world_, scene.sleeping ? 1 : 0);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) add(i);
    for (const PeerBall& ball : scene.balls) {
      const dJointID joint = dJointCreateBall(world_, nullptr);
      dJointAttach(joint, bodies_[ball.a], bodies_[ball.b]);
      dJointSetBallAnchor(joint, ball.anchor.x, ball.anchor.y, ball.anchor.z);
    }
  }
  ~Ode() override {
    dJointGroupDestroy(joints_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    for (const dTriMeshDataID mesh : mesh_data_) dGeomTriMeshDataDestroy(mesh);
    dCloseODE();
  }

  void drive(std::size_t body, const PeerMotion& from, const PeerMotion& to) override {
    const auto q = ode(from.pose.rotation);
    dBodySetPosition(bodies_[body], from.pose.position.x, from.pose.position.y, from.pose.position.z);
    dBodySetQuaternion(bodies_[body], q.data());
    dBodySetLinearVel(bodies_[body], to.velocity.x, to.velocity.y, to.velocity.z);
    dBodySetAngularVel(bodies_[body], to.angular_velocity.x, to.angular_velocity.y, to.angular_velocity.z);
  }
  void step(double dt) override {
    contacts_ = 0;
    dSpaceCollide(space_, this,
                  [](void* self, dGeomID a, dGeomID b) { static_cast<Ode*>(self)->touch(a, b); });
    dWorldQuickStep(world_, dt);
    dJointGroupEmpty(joints_);
  }
  [[nodiscard]] PeerMotion motion(std::size_t body) const override {
    if (bodies_[body] == nullptr) return scene_.bodies[body].start;
    const dReal* q = dBodyGetQuaternion(bodies_[body]);
    return {.pose = {from_ode(dBodyGetPosition(bodies_[body])),
                     normalize(DQuat{static_cast<double>(q[1]), static_cast<double>(q[2]),
                                     static_cast<double>(q[3]), static_cast<double>(q[0])})},
            .velocity = from_ode(dBodyGetLinearVel(bodies_[body])),
            .angular_velocity = from_ode(dBodyGetAngularVel(bodies_[body]))};
  }
  [[nodiscard]] std::uint32_t contacts() const override { return contacts_; }

 private:
  void touch(dGeomID a, dGeomID b) {
    const dBodyID body_a = dGeomGetBody(a);
    const dBodyID body_b = dGeomGetBody(b);
    const PeerBody& of_a = scene_.bodies[reinterpret_cast<std::size_t>(dGeomGetData(a))];
    const PeerBody& of_b = scene_.bodies[reinterpret_cast<std::size_t>(dGeomGetData(b))];
    if (of_a.kind != BodyKind::kDynamic && of_b.kind != BodyKind::kDynamic) return;
    if (body_a == body_b || dAreConnectedExcluding(body_a, body_b, dJointTypeContact) != 0) return;
    std::array<dContact, kMaxContacts> found = {};
    const int count = dCollide(a, b, kMaxContacts, &found[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      dContact& contact = found[static_cast<std::size_t>(i)];
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = std::sqrt(of_a.friction * of_b.friction);
      contact.surface.bounce = std::max(of_a.restitution, of_b.restitution);
      if (contact.surface.bounce > 0) contact.surface.mode |= dContactBounce;
      dJointAttach(dJointCreateContact(world_, joints_, &contact), body_a, body_b);
      ++contacts_;
    }
  }

  dGeomID make_mesh(const MeshDesc& mesh) {
    std::vector<float>& corners = mesh_corners_.emplace_back();
    std::vector<dTriIndex>& indices = mesh_indices_.emplace_back();
    for (const Vec3 p : mesh.positions)
      corners.insert(corners.end(),
                     {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), {t[0], t[1], t[2]});
    mesh_data_.push_back(dGeomTriMeshDataCreate());
    dGeomTriMeshDataBuildSingle(mesh_data_.back(), corners.data(), 3 * sizeof(float),
                                static_cast<int>(mesh.positions.size()), indices.data(),
                                static_cast<int>(indices.size()), 3 * sizeof(dTriIndex));
    return dCreateTriMesh(space_, mesh_data_.back(), nullptr, nullptr, nullptr);
  }

  dGeomID make_geom(const PeerShape& from, const PeerPose& body) {
    const Shape& s = from.shape;
    switch (s.kind) {
      case ShapeKind::kHalfSpace: {
        const DVec3 n = rotate(body.rotation, DVec3{0, 1, 0});
        return dCreatePlane(space_, n.x, n.y, n.z, dot(n, body.position));
      }
      case ShapeKind::kSphere:
        return dCreateSphere(space_, s.radius);
      case ShapeKind::kBox:
        return dCreateBox(space_, 2 * s.half_extents.x, 2 * s.half_extents.y, 2 * s.half_extents.z);
      case ShapeKind::kCapsule:
        return dCreateCapsule(space_, s.radius, 2 * s.half_height);
      case ShapeKind::kCylinder:
        return dCreateCylinder(space_, s.radius, 2 * s.half_height);
      default:
        return make_mesh(from.model->mesh);
    }
  }

  void place(dGeomID geom, const PeerShape& shape, const PeerBody& body, dBodyID moved) {
    const ShapeKind kind = shape.shape.kind;
    if (kind == ShapeKind::kHalfSpace) return;
    const bool along_z = kind == ShapeKind::kCapsule || kind == ShapeKind::kCylinder;
    const DQuat own = along_z ? turned_up(shape.pose.rotation) : shape.pose.rotation;
    const DVec3 at = shape.pose.position;
    if (moved != nullptr) {
      dGeomSetBody(geom, moved);
      dGeomSetOffsetPosition(geom, at.x, at.y, at.z);
      dGeomSetOffsetQuaternion(geom, ode(own).data());
      return;
    }
    const PeerPose& pose = body.start.pose;
    const DVec3 there = pose.position + rotate(pose.rotation, at);
    dGeomSetPosition(geom, there.x, there.y, there.z);
    dGeomSetQuaternion(geom, ode(pose.rotation * own).data());
  }

  void add(std::size_t index) {
    const PeerBody& from = scene_.bodies[index];
    const PeerMotion& start = from.start;
    dBodyID body = nullptr;
    if (from.kind != BodyKind::kStatic) {
      body = dBodyCreate(world_);
      dBodySetPosition(body, start.pose.position.x, start.pose.position.y, start.pose.position.z);
      dBodySetQuaternion(body, ode(start.pose.rotation).data());
      dBodySetLinearVel(body, start.velocity.x, start.velocity.y, start.velocity.z);
      dBodySetAngularVel(body, start.angular_velocity.x, start.angular_velocity.y, start.angular_velocity.z);
    }
    if (from.kind == BodyKind::kKinematic) dBodySetKinematic(body);
    if (from.kind == BodyKind::kDynamic) {
      dMass mass;
      dMassSetParameters(&mass, from.mass, 0, 0, 0, from.inertia.x, from.inertia.y, from.inertia.z, 0, 0, 0);
      dBodySetMass(body, &mass);
    }
    bodies_.push_back(body);
    for (const PeerShape& shape : from.shapes) {
      dGeomID geom = make_geom(shape, start.pose);
      dGeomSetData(geom, reinterpret_cast<void*>(index));
      place(geom, shape, from, body);
    }
  }

  const PeerScene& scene_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID joints_ = nullptr;
  std::vector<dBodyID> bodies_;  ///< Null for a body that stands.
  std::vector<dTriMeshDataID> mesh_data_;
  std::vector<std::vector<float>> mesh_corners_;
  std::vector<std::vector<dTriIndex>> mesh_indices_;
  std::uint32_t contacts_ = 0;
};

}  // namespace

Result<std::unique_ptr<PeerEngine>> make_ode(const PeerScene& scene) {
  for (const PeerBody& body : scene.bodies) {
    for (const PeerShape& shape : body.shapes) {
      if (shape.shape.kind == ShapeKind::kHull || shape.shape.kind == ShapeKind::kCone)
        return Error{ErrorCode::kUnsupported, "ode", "its hulls do not meet meshes, and it has no cones"};
    }
  }
  return std::unique_ptr<PeerEngine>(std::make_unique<Ode>(scene));
}

}  // namespace hooke::bench
