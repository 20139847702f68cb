#include "io/scene/scene_subject.h"

namespace hooke::io {

Subject subject_of(SceneExpectation::Quantity quantity) {
  using Quantity = SceneExpectation::Quantity;
  switch (quantity) {
    case Quantity::kX:
    case Quantity::kY:
    case Quantity::kZ:
    case Quantity::kHeight:
    case Quantity::kSpeed:
      return Subject::kPoint;
    case Quantity::kAngularSpeed:
    case Quantity::kTilt:
      return Subject::kBody;
    case Quantity::kYielded:
    case Quantity::kSoft:
      return Subject::kYields;
    case Quantity::kLowest:
    case Quantity::kHighest:
      return Subject::kObject;
    case Quantity::kExtension:
    case Quantity::kTension:
    case Quantity::kTwist:
      return Subject::kRope;
    case Quantity::kTorque:
      return Subject::kTwists;
    case Quantity::kForce:
    case Quantity::kAngle:
    case Quantity::kWay:
      return Subject::kHook;
    case Quantity::kGap:
      return Subject::kGaps;
    case Quantity::kBroken:
      return Subject::kBreaks;
    default:
      return Subject::kWorld;
  }
}

}  // namespace hooke::io
