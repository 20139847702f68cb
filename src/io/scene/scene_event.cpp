#include "io/scene/scene_event.h"

namespace hooke::io {

const char* key_of(SceneEvent::Kind kind) {
  switch (kind) {
    case SceneEvent::Kind::kMotion:
      return ".motion";
    case SceneEvent::Kind::kUnpin:
      return ".unpin";
    case SceneEvent::Kind::kForce:
      return ".force";
    case SceneEvent::Kind::kImpulse:
      return ".impulse";
    case SceneEvent::Kind::kVelocity:
      return ".velocity";
    case SceneEvent::Kind::kMotor:
      return ".motor";
    case SceneEvent::Kind::kSpring:
      return ".spring";
    case SceneEvent::Kind::kSteering:
      return ".steering";
    default:
      return "";
  }
}

bool acts_on_hook(SceneEvent::Kind kind) {
  return kind == SceneEvent::Kind::kMotor || kind == SceneEvent::Kind::kSpring ||
         kind == SceneEvent::Kind::kSteering;
}

bool has_part(HookKind hook, SceneEvent::Kind event) {
  if (event == SceneEvent::Kind::kSteering) return hook == HookKind::kWheel;
  return hook != HookKind::kFixed && hook != HookKind::kSixDegrees && hook != HookKind::kRopeSlide;
}

std::string refusal_of(const SceneEvent& event, const BodyDesc& body) {
  using EventKind = SceneEvent::Kind;
  const bool pushes = event.kind == EventKind::kForce || event.kind == EventKind::kImpulse;
  if (event.kind == EventKind::kUnpin) return " is a body, which is not pinned";
  if (pushes && body.kind != BodyKind::kDynamic) return " is not dynamic: nothing pushes it";
  if (event.kind == EventKind::kMotion && body.kind != BodyKind::kKinematic) {
    return " is not kinematic: only such a body moves as told";
  }
  if (event.kind != EventKind::kVelocity) return "";
  if (body.kind == BodyKind::kStatic) return " is static: it never moves";
  const bool has_path = body.kind == BodyKind::kKinematic && body.motion.kind != MotionDesc::Kind::kStill;
  return has_path && event.velocity ? " moves by its 'motion', which gives its velocity" : "";
}

}  // namespace hooke::io
