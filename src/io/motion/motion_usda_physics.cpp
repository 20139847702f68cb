#include "io/motion/motion_usda_physics.h"

#include <array>
#include <cmath>
#include <numbers>

namespace hooke::io {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// Returns the smallest rotation from the x axis to `axis`.
Quaternion<double> rotation_to(Vec3 axis) {
  const DVec3 to = normalize(vector_cast<double>(axis));
  const DVec3 from = {1, 0, 0};
  if (to.x < -0.999999) return {0, 1, 0, 0};  // half a turn about y
  const DVec3 middle = cross(from, to);
  return normalize(Quaternion<double>{middle.x, middle.y, middle.z, 1 + to.x});
}

Quaternion<double> double_rotation(Quat q) {
  return normalize(Quaternion<double>{static_cast<double>(q.x), static_cast<double>(q.y),
                                      static_cast<double>(q.z), static_cast<double>(q.w)});
}

const char* joint_schema(HookKind kind) {
  switch (kind) {
    case HookKind::kBall:
      return "PhysicsSphericalJoint";
    case HookKind::kHinge:
      return "PhysicsRevoluteJoint";
    case HookKind::kSlider:
      return "PhysicsPrismaticJoint";
    case HookKind::kFixed:
      return "PhysicsFixedJoint";
    case HookKind::kDistance:
      return "PhysicsDistanceJoint";
    default:
      return nullptr;
  }
}

void put_limits(UsdaText& text, const MotionJoint& joint) {
  const double lower = static_cast<double>(joint.limits.lower);
  const double upper = static_cast<double>(joint.limits.upper);
  if (joint.kind == HookKind::kHinge || joint.kind == HookKind::kSlider) {
    const double unit = joint.kind == HookKind::kHinge ? kDegrees : 1;
    text.line("uniform token physics:axis = \"X\"");
    if (std::isfinite(lower)) text.line("float physics:lowerLimit = " + usda_number(unit * lower));
    if (std::isfinite(upper)) text.line("float physics:upperLimit = " + usda_number(unit * upper));
  }
  if (joint.kind == HookKind::kBall) {
    text.line("uniform token physics:axis = \"X\"");
    if (joint.cone) {
      const std::string cone = usda_number(kDegrees * static_cast<double>(*joint.cone));
      text.line("float physics:coneAngle0Limit = " + cone);
      text.line("float physics:coneAngle1Limit = " + cone);
    }
  }
  if (joint.kind == HookKind::kDistance) {
    const double now = length(joint.anchors[1] - joint.anchors[0]);
    const bool is_free = !std::isfinite(lower) && !std::isfinite(upper);
    if (is_free || std::isfinite(lower)) {
      text.line("float physics:minDistance = " + usda_number(is_free ? now : lower));
    }
    if (is_free || std::isfinite(upper)) {
      text.line("float physics:maxDistance = " + usda_number(is_free ? now : upper));
    }
  }
}

}  // namespace

std::vector<std::string> physics_schemas(const MotionObject& body) {
  if (body.body_kind == BodyKind::kStatic) return {};
  return {"PhysicsRigidBodyAPI", "PhysicsMassAPI"};
}

void put_body_physics(UsdaText& text, const MotionObject& body, const MotionState& start) {
  if (body.body_kind == BodyKind::kStatic) return;
  if (body.body_kind == BodyKind::kKinematic) text.line("bool physics:kinematicEnabled = 1");
  if (body.mass > Real(0)) {
    text.line("float physics:mass = " + usda_number(static_cast<double>(body.mass)));
    text.line("point3f physics:centerOfMass = " + usda_vector(vector_cast<double>(body.center_of_mass)));
  }
  text.line("vector3f physics:velocity = " + usda_vector(vector_cast<double>(start.velocity)));
  const DVec3 spin = kDegrees * vector_cast<double>(start.angular_velocity);
  text.line("vector3f physics:angularVelocity = " + usda_vector(spin));
}

bool collides_by_triangles(const MotionObject& body, const MotionPiece& piece) {
  return body.collides && (piece.shape.kind == ShapeKind::kMesh || piece.shape.kind == ShapeKind::kHull);
}

void put_piece_place(UsdaText& text, const MotionPiece& piece, DVec3 scale) {
  std::string order;
  const auto add = [&](const char* operation, const std::string& line) {
    text.line(line);
    order += (order.empty() ? "\"" : ", \"") + std::string(operation) + "\"";
  };
  if (piece.position != Vec3{}) {
    add("xformOp:translate",
        "double3 xformOp:translate = " + usda_vector(vector_cast<double>(piece.position)));
  }
  if (piece.rotation != Quat{}) {
    text.begin_value("quatf xformOp:orient");
    text.put_rotation(piece.rotation);
    text.end_value();
    order += (order.empty() ? "" : ", ") + std::string("\"xformOp:orient\"");
  }
  if (scale != DVec3{1, 1, 1}) add("xformOp:scale", "float3 xformOp:scale = " + usda_vector(scale));
  if (!order.empty()) text.line("uniform token[] xformOpOrder = [" + order + "]");
}

void put_collider(UsdaText& text, const MotionPiece& piece, const std::string& name) {
  const Shape& shape = piece.shape;
  const std::string radius = usda_number(static_cast<double>(shape.radius));
  const std::string height = usda_number(2 * static_cast<double>(shape.half_height));
  const auto begin = [&](const char* type) {
    const std::array<std::string, 1> schemas = {"prepend apiSchemas = [\"PhysicsCollisionAPI\"]"};
    text.begin("def " + std::string(type) + " \"" + name + "\"", schemas);
    text.line("uniform token purpose = \"guide\"");
  };
  DVec3 scale = {1, 1, 1};
  switch (shape.kind) {
    case ShapeKind::kSphere:
      begin("Sphere");
      text.line("double radius = " + radius);
      break;
    case ShapeKind::kBox:
      begin("Cube");
      text.line("double size = 2");
      scale = vector_cast<double>(shape.half_extents);
      break;
    case ShapeKind::kHalfSpace:
      begin("Plane");
      text.line("uniform token axis = \"Y\"");
      break;
    case ShapeKind::kCapsule:
    case ShapeKind::kCylinder:
    case ShapeKind::kCone:
      begin(shape.kind == ShapeKind::kCapsule ? "Capsule"
            : shape.kind == ShapeKind::kCone  ? "Cone"
                                              : "Cylinder");
      text.line("uniform token axis = \"Y\"");
      text.line("double height = " + height);
      text.line("double radius = " + radius);
      break;
    default:
      return;
  }
  put_piece_place(text, piece, scale);
  text.end();
}

bool put_joint(UsdaText& text, const MotionJoint& joint, const std::string& name, const UsdaJointEnd& a,
               const UsdaJointEnd& b) {
  const char* schema = joint_schema(joint.kind);
  if (schema == nullptr) return false;
  text.begin("def " + std::string(schema) + " \"" + name + "\"");
  const Quaternion<double> axis = rotation_to(joint.axis);
  const std::array<const UsdaJointEnd*, 2> ends = {&a, &b};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string number = std::to_string(i);
    const bool is_world = ends[i]->prim.empty();
    const Quaternion<double> back =
        is_world ? Quaternion<double>{} : conjugate(double_rotation(ends[i]->state.rotation));
    const DVec3 place = is_world ? joint.anchors[i] : joint.anchors[i] - ends[i]->state.position;
    if (!is_world) text.line("rel physics:body" + number + " = <" + ends[i]->prim + ">");
    text.line("point3f physics:localPos" + number + " = " + usda_vector(rotate(back, place)));
    const Quaternion<double> turn = back * axis;
    text.line("quatf physics:localRot" + number + " = (" + usda_number(turn.w) + ", " + usda_number(turn.x) +
              ", " + usda_number(turn.y) + ", " + usda_number(turn.z) + ")");
  }
  put_limits(text, joint);
  const auto put_strength = [&](const char* attribute, Real strength) {
    if (std::isfinite(strength)) text.line(attribute + usda_number(static_cast<double>(strength)));
  };
  put_strength("float physics:breakForce = ", joint.break_force);
  put_strength("float physics:breakTorque = ", joint.break_torque);
  text.end();
  return true;
}

}  // namespace hooke::io
