#include "hooke/model_io.h"

#include "peer_engine.h"

#include <btBulletDynamicsCommon.h>
#include <cmath>
#include <vector>

namespace hooke::bench {

namespace {

constexpr btScalar kHullMargin = btScalar(0.01);  // Distance by which the hull grows [m].

btVector3 bullet(DVec3 v) {
  return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), static_cast<btScalar>(v.z)};
}

btTransform bullet(const PeerPose& pose) {
  const DQuat& q = pose.rotation;
  return btTransform(btQuaternion(static_cast<btScalar>(q.x), static_cast<btScalar>(q.y),
                                  static_cast<btScalar>(q.z), static_cast<btScalar>(q.w)),
                     bullet(pose.position));
}

DVec3 from_bullet(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

bool is_identity(const PeerPose& pose) {
  return length(pose.position) < 1e-9 && std::abs(std::abs(pose.rotation.w) - 1) < 1e-12;
}

/// Owns shapes and bodies, which are freed with the world.
class Bullet final : public PeerEngine {
 public:
  explicit Bullet(const PeerScene& scene)
      : dispatcher_(&configuration_), world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
    world_.setGravity(bullet(scene.gravity));
    world_.getSolverInfo().m_numIterations = 10;
    world_.getSolverInfo().m_splitImpulse = 1;
    world_.getDispatchInfo().m_useContinuous = false;
    for (const PeerBody& body : scene.bodies) add(body, scene.sleeping);
    for (const PeerBall& ball : scene.balls) add(ball);
  }
  ~Bullet() override {
    for (const auto& joint : joints_) world_.removeConstraint(joint.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void drive(std::size_t body, const PeerMotion& from, const PeerMotion& to) override {
    bodies_[body]->setWorldTransform(bullet(from.pose));
    bodies_[body]->setInterpolationWorldTransform(bullet(from.pose));
    bodies_[body]->getMotionState()->setWorldTransform(bullet(to.pose));
  }
  void step(double dt) override { world_.stepSimulation(static_cast<btScalar>(dt), 0); }

  [[nodiscard]] PeerMotion motion(std::size_t body) const override {
    const btRigidBody& b = *bodies_[body];
    const btQuaternion q = b.getOrientation();
    return {.pose = {from_bullet(b.getCenterOfMassPosition()),
                     normalize(DQuat{static_cast<double>(q.x()), static_cast<double>(q.y()),
                                     static_cast<double>(q.z()), static_cast<double>(q.w())})},
            .velocity = from_bullet(b.getLinearVelocity()),
            .angular_velocity = from_bullet(b.getAngularVelocity())};
  }
  [[nodiscard]] std::uint32_t contacts() const override {
    std::uint32_t count = 0;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(i);
      for (int k = 0; k < manifold->getNumContacts(); ++k) {
        if (manifold->getContactPoint(k).getDistance() <= 0) ++count;
      }
    }
    return count;
  }

 private:
  template <class T, class... Arguments>
  T* make(Arguments&&... arguments) {
    auto shape = std::make_unique<T>(std::forward<Arguments>(arguments)...);
    T* raw = shape.get();
    shapes_.push_back(std::move(shape));
    return raw;
  }

  btCollisionShape* make_mesh(const MeshDesc& mesh) {
    auto triangles = std::make_unique<btTriangleMesh>();
    const auto corner = [&](std::uint32_t i) { return bullet(vector_cast<double>(mesh.positions[i])); };
    for (const auto& t : mesh.triangles) triangles->addTriangle(corner(t[0]), corner(t[1]), corner(t[2]));
    meshes_.push_back(std::move(triangles));
    return make<btBvhTriangleMeshShape>(meshes_.back().get(), true);
  }

  btCollisionShape* make_hull(const std::vector<DVec3>& points) {
    auto* hull = make<btConvexHullShape>();
    for (const DVec3 p : points) hull->addPoint(bullet(p), false);
    hull->recalcLocalAabb();
    hull->setMargin(kHullMargin);
    return hull;
  }

  btCollisionShape* make_shape(const PeerShape& from) {
    const Shape& s = from.shape;
    const auto radius = static_cast<btScalar>(s.radius);
    const auto half = static_cast<btScalar>(s.half_height);
    switch (s.kind) {
      case ShapeKind::kHalfSpace:
        return make<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
      case ShapeKind::kSphere:
        return make<btSphereShape>(radius);
      case ShapeKind::kBox:
        return make<btBoxShape>(bullet(vector_cast<double>(s.half_extents)));
      case ShapeKind::kCapsule:
        return make<btCapsuleShape>(radius, 2 * half);
      case ShapeKind::kCylinder:
        return make<btCylinderShape>(btVector3(radius, half, radius));
      case ShapeKind::kCone:
        return make<btConeShape>(radius, 2 * half);
      case ShapeKind::kHull:
        return make_hull(from.points);
      default:
        return make_mesh(from.model->mesh);
    }
  }

  void add(const PeerBody& from, bool sleeping) {
    btCollisionShape* shape = nullptr;
    if (from.shapes.size() == 1 && is_identity(from.shapes[0].pose)) {
      shape = make_shape(from.shapes[0]);
    } else {
      auto* compound = make<btCompoundShape>();
      for (const PeerShape& part : from.shapes) compound->addChildShape(bullet(part.pose), make_shape(part));
      shape = compound;
    }
    states_.push_back(std::make_unique<btDefaultMotionState>(bullet(from.start.pose)));
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(from.mass), states_.back().get(),
                                                  shape, bullet(from.inertia));
    // Bullet multiplies the frictions of a pair.
    info.m_friction = static_cast<btScalar>(std::sqrt(from.friction));
    info.m_restitution = static_cast<btScalar>(from.restitution);
    auto body = std::make_unique<btRigidBody>(info);
    body->setLinearVelocity(bullet(from.start.velocity));
    body->setAngularVelocity(bullet(from.start.angular_velocity));
    if (from.kind == BodyKind::kKinematic)
      body->setCollisionFlags(body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    if (from.kind == BodyKind::kKinematic || !sleeping) body->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(body.get());
    bodies_.push_back(std::move(body));
  }

  void add(const PeerBall& ball) {
    btRigidBody& a = *bodies_[ball.a];
    btRigidBody& b = *bodies_[ball.b];
    const btVector3 anchor = bullet(ball.anchor);
    joints_.push_back(
        std::make_unique<btPoint2PointConstraint>(a, b, a.getCenterOfMassTransform().inverse() * anchor,
                                                  b.getCenterOfMassTransform().inverse() * anchor));
    world_.addConstraint(joints_.back().get(), true);
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btDefaultMotionState>> states_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btPoint2PointConstraint>> joints_;
};

}  // namespace

Result<std::unique_ptr<PeerEngine>> make_bullet(const PeerScene& scene) {
  return std::unique_ptr<PeerEngine>(std::make_unique<Bullet>(scene));
}

}  // namespace hooke::bench
