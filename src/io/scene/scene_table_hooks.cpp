/// Holds the tables of hooks: limits, springs, motors, freedoms, the hook itself.

#include "io/scene/scene_table.h"
#include "io/scene/scene_table_tags.h"

namespace hooke::io {

namespace {

constexpr Rule kConeRange = {.least = 0, .most = 3.15, .above_least = true};

bool check_hook(Reader& reader, const JsonNode& node, const void* object) {
  const auto& hook = *static_cast<const SceneHook*>(object);
  if (!hook.array.rotations.empty()) {
    return reader.fail(node, ErrorCode::kOutOfRange, "only an array of bodies has 'rotations'");
  }
  return check_named(reader, node, hook.name);
}

bool check_seam(Reader& reader, const JsonNode& node, const void* object) {
  const auto& seam = *static_cast<const SceneSeam*>(object);
  if (!seam.array.rotations.empty()) {
    return reader.fail(node, ErrorCode::kOutOfRange, "only an array of bodies has 'rotations'");
  }
  return check_named(reader, node, seam.name);
}

std::vector<Field> seam_rows() {
  return {
      field<&SceneSeam::name>("name", "", kNotEmpty, "Unique. Its stitches are the hooks `name[0]`, ..."),
      required(field<&SceneSeam::a>(
          "a", "", kNotEmpty,
          "An edge of a cloth, as `cloth.left`; or the name of a cloth or solid, with `a_points`.")),
      required(field<&SceneSeam::b>("b", "", kNotEmpty, "The same.")),
      field<&SceneSeam::a_points>("a_points", "", kAny,
                                  "Points of `a` one after the other; of a closed line the first once more."),
      field<&SceneSeam::b_points>("b_points", "", kAny, "The same of `b`."),
      field<&SceneSeam::strength>("strength", "N/m", kPositiveOrRigid,
                                  "A stitch lets go above this times its share of the length."),
      field<&SceneSeam::array>(
          "array", "", kAny,
          "Copies. Copy i sews copy i of `a` and `b`, counted from the one that is named.")};
}

std::vector<Field> hook_rows() {
  constexpr auto kDesc = &SceneHook::desc;
  return {
      field<&SceneHook::name>("name", "", kNotEmpty,
                              "Unique. Without it the hook is called by its place, as `hooks[0]`."),
      field<kDesc, &HookDesc::kind>(
          "kind", "", kAny,
          "One point in common; turning about `axis`; sliding along it; moving as "
          "one; a distance; a wheel; what `freedoms` says; or b sliding along rope a. "
          "With points: ball, distance, rope_slide, slider."),
      field<&SceneHook::a>(
          "a", "", kNotEmpty,
          "Name of a body, rope, cloth, solid or particles, also with one of its connection points, "
          "as `rope.end`; the world without it."),
      required(field<&SceneHook::b>("b", "", kNotEmpty, "The same; never the world.")),
      field<&SceneHook::a_point>(
          "a_point", "", kAny,
          "Which point of `a`; without it the place nearest to `anchor`: also within a "
          "segment, triangle or tetrahedron."),
      field<&SceneHook::b_point>("b_point", "", kAny, "Which point of `b`; as `a_point`."),
      field<&SceneHook::anchor>("anchor", "m", kAny,
                                "Where it holds both, in the world; of a distance, a. Needed unless a point "
                                "says where."),
      field<kDesc, &HookDesc::anchor_b>("anchor_b", "m", kAny,
                                        "Of a distance: where it holds b; `anchor` by default."),
      field<kDesc, &HookDesc::axis>("axis", "", kAny,
                                    "In the world, any length but zero. Of a wheel, its suspension."),
      field<kDesc, &HookDesc::second_axis>("second_axis", "", kAny,
                                           "Across `axis`, any direction by default. Of a wheel, its axle."),
      field<kDesc, &HookDesc::limits>("limits", "", kAny,
                                      "Of what moves: angle, way, distance, twist of a ball."),
      field<kDesc, &HookDesc::cone>("cone", "rad", kConeRange,
                                    "Of a ball: largest angle between the two axes."),
      field<kDesc, &HookDesc::spring>("spring", "", kAny, "Of what moves; of a ball, about every axis."),
      field<kDesc, &HookDesc::motor>(
          "motor", "", kAny,
          "Of what moves; of a wheel, about the axle; of a ball, about `axis`, and "
          "friction about every axis."),
      field<kDesc, &HookDesc::steering>(
          "steering", "", kAny, "Of a wheel, about `axis`; held at the angle of its spring's target."),
      field<kDesc, &HookDesc::freedoms>(
          "freedoms", "", kAny, "Of six_degrees: ways along x (`axis`), y, z, then angles about them."),
      field<kDesc, &HookDesc::break_force>("break_force", "N", kPositiveOrRigid,
                                           "Takes no more, and breaks if it needs more."),
      field<kDesc, &HookDesc::break_torque>("break_torque", "N m", kPositiveOrRigid,
                                            "The same of its torque."),
      field<kDesc, &HookDesc::collide>("collide", "", kAny, "Whether the two bodies may touch each other."),
      field<&SceneHook::section>(
          "section", "", kAny,
          "Cross section of a distance that is a bar: `hooke load` then tells where it yields "
          "and buckles. It changes no motion."),
      field<&SceneHook::array>(
          "array", "", kAny,
          "Copies, named `name[0]`, ... Copy i holds copy i of `a` and `b`, counted from "
          "the one that is named.")};
}

}  // namespace

template <>
const Kind& kind_of<HookLimits>() {
  static const Kind kind = {
      .name = "limits",
      .help = "Bounds of a freedom, from how things stood when hooked; of a distance, lengths.",
      .fields = {field<&HookLimits::lower>("lower", "rad or m", kAny, "None without it."),
                 field<&HookLimits::upper>("upper", "rad or m", kAny, "None without it.")},
      .defaults = defaults_of<HookLimits>};
  return kind;
}

template <>
const Kind& kind_of<HookSpring>() {
  static const Kind kind = {
      .name = "hook_spring",
      .help = "F = -stiffness (value - target) - damping speed.",
      .fields = {field<&HookSpring::stiffness>("stiffness", "N/m or N m/rad", kNotNegative, "k."),
                 field<&HookSpring::damping>("damping", "N s/m or N m s/rad", kNotNegative, "c."),
                 field<&HookSpring::target>("target", "m or rad", kAny,
                                            "Value at rest, from how things stood when hooked.")},
      .defaults = defaults_of<HookSpring>};
  return kind;
}

template <>
const Kind& kind_of<HookMotor>() {
  static const Kind kind = {
      .name = "motor",
      .help = "Drives a freedom at a speed with a force that is limited. Without speed it is friction.",
      .fields = {field<&HookMotor::speed>("speed", "m/s or rad/s", kAny, "Of b relative to a."),
                 field<&HookMotor::max_force>("max_force", "N or N m", kNotNegative,
                                              "0 switches the motor off.")},
      .defaults = defaults_of<HookMotor>};
  return kind;
}

template <>
const Kind& kind_of<HookFreedom>() {
  static const Kind kind = {
      .name = "freedom",
      .help = "One way in which b may move relative to a.",
      .fields = {required(
                     field<&HookFreedom::locked>("locked", "", kAny, "Held at the target of its spring.")),
                 field<&HookFreedom::limits>("limits", "", kAny, "Bounds."),
                 field<&HookFreedom::spring>("spring", "", kAny, "Towards its target."),
                 field<&HookFreedom::motor>("motor", "", kAny, "Drives it, or is its friction.")},
      .defaults = defaults_of<HookFreedom>};
  return kind;
}

template <>
const Kind& kind_of<SceneHook>() {
  static const Kind kind = {.name = "hook",
                            .help =
                                "Holds two things together: bodies, points of ropes, cloths, solids "
                                "and particles, the world.",
                            .fields = hook_rows(),
                            .defaults = defaults_of<SceneHook>,
                            .check = check_hook};
  return kind;
}

template <>
const Kind& kind_of<SceneSeam>() {
  static const Kind kind = {.name = "seam",
                            .help =
                                "Sews two lines of points together from end to end, whatever the number of "
                                "their points.",
                            .fields = seam_rows(),
                            .defaults = defaults_of<SceneSeam>,
                            .check = check_seam};
  return kind;
}

std::span<const Kind* const> hook_kinds() {
  static const Kind* const kinds[] = {&kind_of<SceneHook>(), &kind_of<HookLimits>(),  &kind_of<HookSpring>(),
                                      &kind_of<HookMotor>(), &kind_of<HookFreedom>(), &kind_of<SceneSeam>()};
  return kinds;
}

template <>
std::span<const EnumName> names_of<HookKind>() {
  static constexpr EnumName kNames[] = {{"ball", static_cast<int>(HookKind::kBall)},
                                        {"hinge", static_cast<int>(HookKind::kHinge)},
                                        {"slider", static_cast<int>(HookKind::kSlider)},
                                        {"fixed", static_cast<int>(HookKind::kFixed)},
                                        {"distance", static_cast<int>(HookKind::kDistance)},
                                        {"wheel", static_cast<int>(HookKind::kWheel)},
                                        {"six_degrees", static_cast<int>(HookKind::kSixDegrees)},
                                        {"rope_slide", static_cast<int>(HookKind::kRopeSlide)}};
  return kNames;
}

}  // namespace hooke::io
