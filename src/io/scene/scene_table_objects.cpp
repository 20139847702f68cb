#include "io/scene/scene_table.h"
#include "io/scene/scene_table_tags.h"

namespace hooke::io {

namespace {

const Kind& sine_kind() {
  static const Kind kind = {
      .name = "sine",
      .help = "Displacement amplitude (sin(2 pi f t + phase) - sin(phase)).",
      .fields = {required(field<&MotionDesc::amplitude>("amplitude", "m", kAny, "Direction and size.")),
                 field<&MotionDesc::frequency_hz>("frequency_hz", "Hz", kAny, "f."),
                 field<&MotionDesc::phase>("phase", "rad", kAny, "Where in the cycle it starts.")},
      .defaults = defaults_of<MotionDesc>};
  return kind;
}

bool check_motion(Reader& reader, const JsonNode& node, const void* object) {
  const auto& frames = static_cast<const MotionDesc*>(object)->keyframes;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].time > frames[i - 1].time) continue;
    return reader.fail(
        node, ErrorCode::kOutOfRange,
        "the times of the keyframes must increase; keyframe " + std::to_string(i) + " does not");
  }
  return true;
}

}  // namespace

template <>
const Kind& kind_of<MotionDesc>() {
  static const Kind kind = {
      .name = "motion",
      .help = "A displacement as a function of time, zero at the start. One of the keys.",
      .fields = {choice<MotionDesc::Kind::kConstantVelocity, &MotionDesc::kind>(
                     field<&MotionDesc::velocity>("velocity", "m/s", kAny, "Constant.")),
                 choice<MotionDesc::Kind::kSine, &MotionDesc::kind>(group("sine", sine_kind, "To and fro.")),
                 choice<MotionDesc::Kind::kKeyframes, &MotionDesc::kind>(field<&MotionDesc::keyframes>(
                     "keyframes", "", kNotEmpty, "Straight lines between given offsets; times increase."))},
      .defaults = defaults_of<MotionDesc>,
      .check = check_motion};
  return kind;
}

template <>
const Kind& kind_of<MotionDesc::Keyframe>() {
  static const Kind kind = {
      .name = "motion_keyframe",
      .help = "Where a moved point is at a time.",
      .fields = {required(
                     field<&MotionDesc::Keyframe::time>("time", "s", kAny, "From the start of the motion.")),
                 required(field<&MotionDesc::Keyframe::offset>("offset", "m", kAny, "From the start."))},
      .defaults = defaults_of<MotionDesc::Keyframe>};
  return kind;
}

template <>
const Kind& kind_of<ScenePin>() {
  static const Kind kind = {
      .name = "pin",
      .help =
          "Points that are held. One of `point`, `column`, `row`, `topmost`. A number or `\"last\"` alone "
          "is short for `{\"point\": ...}`.",
      .fields = {choice<ScenePin::Pick::kPoint, &ScenePin::pick>(
                     field<&ScenePin::point>("point", "", kAny, "One point.")),
                 choice<ScenePin::Pick::kColumn, &ScenePin::pick>(
                     field<&ScenePin::point>("column", "", kAny, "A column of a cloth's grid.")),
                 choice<ScenePin::Pick::kRow, &ScenePin::pick>(
                     field<&ScenePin::point>("row", "", kAny, "A row of a cloth's grid.")),
                 choice<ScenePin::Pick::kTopmost, &ScenePin::pick>(field<&ScenePin::within>(
                     "topmost", "m", kNotNegative, "All points not further than this below the highest.")),
                 field<&ScenePin::motion>("motion", "", kAny, "Moves them; they stand still by default.")},
      .defaults = defaults_of<ScenePin>};
  return kind;
}

template <>
const Kind& kind_of<SceneLoad>() {
  static const Kind kind = {
      .name = "load",
      .help = "Mass added to a point.",
      .fields = {required(field<&SceneLoad::point>("point", "", kAny, "Which one.")),
                 required(field<&SceneLoad::mass>("mass", "kg", kNotNegative, "Added to the point's own."))},
      .defaults = defaults_of<SceneLoad>};
  return kind;
}

namespace {

/// Returns what is wrong with a key of an array of this kind; null if nothing.
const char* misplaced(const std::string& key, SceneArray::Kind kind) {
  const bool random = kind == SceneArray::Kind::kRandom;
  const bool list = kind == SceneArray::Kind::kList;
  if (key == "spacing" && random) return "has no effect on a random array";
  if (key == "spacing" && list) return "has no effect on a list";
  if ((key == "seed" || key == "box") && !random) return "is for a random array only";
  if (key == "rotations" && !list) return "is for a list only";
  return nullptr;
}

bool check_array(Reader& reader, const JsonNode& node, const void* object) {
  const auto& array = *static_cast<const SceneArray*>(object);
  for (const JsonNode& child : node.children) {
    const char* complaint = misplaced(child.key, array.kind);
    if (complaint == nullptr) continue;
    reader.fail_key(child, complaint);
    return false;
  }
  if (!array.rotations.empty() && array.rotations.size() != array.list.size()) {
    return reader.fail(node, ErrorCode::kOutOfRange,
                       "there are " + std::to_string(array.rotations.size()) + " rotations for a list of " +
                           std::to_string(array.list.size()));
  }
  const DVec3 size = array.box[1] - array.box[0];
  if (size.x >= 0 && size.y >= 0 && size.z >= 0) return true;
  return reader.fail(node, ErrorCode::kOutOfRange, "the box must be given as [[smallest], [largest]]");
}

}  // namespace

template <>
const Kind& kind_of<SceneArray>() {
  constexpr Rule kCopies = between(1, 1e6);
  static const Kind kind = {
      .name = "array",
      .help = "Copies of an object. One of `grid`, `pyramid`, `random`, `list`.",
      .fields = {choice<SceneArray::Kind::kGrid, &SceneArray::kind>(field<&SceneArray::grid>(
                     "grid", "", kCopies, "Copies along x, y and z; x counts fastest.")),
                 choice<SceneArray::Kind::kPyramid, &SceneArray::kind>(field<&SceneArray::pyramid>(
                     "pyramid", "", between(1, 1000),
                     "Copies in the lowest row along x; one less in each row above.")),
                 choice<SceneArray::Kind::kRandom, &SceneArray::kind>(field<&SceneArray::random>(
                     "random", "", kCopies, "Copies, evenly spread in `box`, the same on every machine.")),
                 choice<SceneArray::Kind::kList, &SceneArray::kind>(field<&SceneArray::list>(
                     "list", "m", kNotEmpty, "Offsets from the object, one for each copy.")),
                 field<&SceneArray::spacing>("spacing", "m", kAny, "Of a grid or pyramid."),
                 field<&SceneArray::seed>("seed", "", kAny, "Of a random array."),
                 field<&SceneArray::box>("box", "m", kAny,
                                         "Of a random array: smallest and largest offset from the object."),
                 field<&SceneArray::rotations>(
                     "rotations", "", kAny,
                     "Of a list of bodies: one for each copy, about its origin, after the body's own.")},
      .defaults = defaults_of<SceneArray>,
      .check = check_array};
  return kind;
}

namespace {

std::vector<Field> joined(std::vector<Field> first, const std::vector<Field>& last) {
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

/// Has a rope's keys under the names of the paper's builder, then the others of what it is made of.
std::vector<Field> rope_form_rows() {
  constexpr auto kDesc = &SceneRope::desc;
  return {
      field<kDesc, &RopeDesc::hook_point>("hook_point", "m", kAny, "Position of the first point."),
      field<kDesc, &RopeDesc::direction>("direction", "", kAny,
                                         "From the first point on; any length but zero."),
      field<kDesc, &RopeDesc::total_mass>("total_mass", "kg", kPositive,
                                          "Of the rope; half a segment's share on each end."),
      field<kDesc, &RopeDesc::masses>("masses", "", between(2, 65536), "Number of points."),
      field<kDesc, &RopeDesc::length_at_rest>("length_at_rest", "m", kPositive, "From end to end."),
      field<kDesc, &RopeDesc::stiffness>("stiffness", "N/m", kPositiveOrRigid, "k; see `stiffness_of`."),
      field<kDesc, &RopeDesc::inner_friction>("inner_friction", "N s/m", kNotNegative,
                                              "Damping along each segment."),
      field<kDesc, &RopeDesc::air_friction>("air_friction", "N s/m", kNotNegative,
                                            "Viscous drag of the whole rope, shared out by length."),
      field<kDesc, &RopeDesc::extension_max>("extension_max", "", kPositiveOrRigid,
                                             "Largest relative extension of a segment, such as 0.05."),
      field<kDesc, &RopeDesc::strength>("strength", "N", kPositive,
                                        "Takes no more tension, and snaps if it needs more; any by default."),
      field<kDesc, &RopeDesc::stiffness_of>("stiffness_of", "", kAny,
                                            "Of the rope, whatever the number of points; or of each segment, "
                                            "as in the paper: more points make a "
                                            "softer rope."),
      field<kDesc, &RopeDesc::bend_stiffness>(
          "bend_stiffness", "N m^2", kNotNegative,
          "EI: resistance to bending; straight at rest, clamped where two end points are pinned."),
      field<kDesc, &RopeDesc::bend_damping>("bend_damping", "s", kNotNegative, "Of bending, over EI."),
      field<kDesc, &RopeDesc::twist_stiffness>(
          "twist_stiffness", "N m^2", kNotNegative,
          "GJ: resistance to twist between places where two neighboring points or more are pinned, or hooked "
          "by balls to the world or to one body. Needs `bend_stiffness`."),
      field<kDesc, &RopeDesc::twist>("twist", "rad", kAny,
                                     "Of the whole rope at the start, even over its length."),
      field<kDesc, &RopeDesc::young_modulus>("young_modulus", "Pa", kPositive,
                                             "E: replaces the stiffness and those against bending and twist "
                                             "by those of a round rod of `radius`."),
      field<kDesc, &RopeDesc::poisson_ratio>("poisson_ratio", "", between(-0.99, 0.5),
                                             "Of `young_modulus`: G = E / 2 (1 + `poisson_ratio`)."),
      field<kDesc, &RopeDesc::axial_stiffness>("axial_stiffness", "N", kPositiveOrRigid,
                                               "EA; replaces `stiffness` by EA / `length_at_rest`."),
      field<kDesc, &RopeDesc::points>(
          "points", "m", kAny,
          "Replaces `hook_point`, `direction`, `masses`, `length_at_rest`: the points, taken as at rest."),
  };
}

std::vector<Field> rope_rows() {
  constexpr auto kDesc = &SceneRope::desc;
  return joined(
      rope_form_rows(),
      {
          field<&SceneRope::pins>("pins", "", kAny,
                                  "Points that are held; the first one by default, `[]` for none."),
          field<&SceneRope::loads>("loads", "", kAny, "Masses added to points."),
          field<kDesc, &RopeDesc::radius>("radius", "m", kPositive,
                                          "Of the strand: for contact, wind, drawing."),
          field<kDesc, &RopeDesc::drag_coefficient>("drag_coefficient", "", kNotNegative,
                                                    "Of a cylinder across the flow."),
          field<kDesc, &RopeDesc::charge>("charge", "C", kAny, "Shared out by mass."),
          field<kDesc, &RopeDesc::velocity>("velocity", "m/s", kAny, "Of all points at the start."),
          field<kDesc, &RopeDesc::touches_ropes>(
              "touches_ropes", "", kAny, "It touches other ropes that say so too, and itself: knots hold."),
          field<kDesc, &RopeDesc::touches_surfaces>(
              "touches_surfaces", "", kAny, "It touches cloths, solids and other ropes that say so too."),
          field<kDesc, &RopeDesc::filter, &FilterDesc::category>(
              "category", "", kAny, "Bits of its categories, for contact with other deformables."),
          field<kDesc, &RopeDesc::filter, &FilterDesc::mask>(
              "mask", "", kAny, "Bits of the categories of other deformables that it touches."),
          field<kDesc, &RopeDesc::filter, &FilterDesc::group>(
              "group", "", kAny,
              "Deformables of one negative group never touch, of one positive group always."),
          field<kDesc, &RopeDesc::repulsion_strength>(
              "repulsion_strength", "N m^2", kNotNegative,
              "s: points of ropes with one push each other away with s (1 "
              "/ d^2 - 1 / r^2): thick hair. 0: none."),
          field<kDesc, &RopeDesc::repulsion_range>(
              "repulsion_range", "m", kPositive,
              "r, best above the distance of points: none of it farther away."),
      });
}

/// Has what a cloth is made of.
std::vector<Field> cloth_form_rows() {
  constexpr auto kDesc = &SceneCloth::desc;
  return {
      field<kDesc, &ClothDesc::columns>("columns", "", between(2, 4096), "Points along `column_direction`."),
      field<kDesc, &ClothDesc::rows>("rows", "", between(2, 4096), "Points along `row_direction`."),
      field<kDesc, &ClothDesc::corner>("corner", "m", kAny,
                                       "Position of point 0; point (column, row) is row x columns + column."),
      field<kDesc, &ClothDesc::column_direction>("column_direction", "", kAny, "Any length but zero."),
      field<kDesc, &ClothDesc::row_direction>("row_direction", "", kAny, "Any length but zero."),
      field<kDesc, &ClothDesc::width>("width", "m", kPositive, "Between the first and last column."),
      field<kDesc, &ClothDesc::height>("height", "m", kPositive, "Between the first and last row."),
      field<&SceneCloth::mesh>("mesh", "", kNotEmpty, "Replaces the grid: a name in `meshes`."),
      field<kDesc, &ClothDesc::position>("position", "m", kAny, "Of the mesh's frame."),
      field<kDesc, &ClothDesc::rotation>("rotation", "", kAny, "Of the mesh's frame."),
      field<kDesc, &ClothDesc::areal_density>("areal_density", "kg/m^2", kPositive,
                                              "Mass of a square meter."),
      field<kDesc, &ClothDesc::total_mass>("total_mass", "kg", kPositive, "Replaces `areal_density`."),
      field<kDesc, &ClothDesc::thickness>("thickness", "m", kPositive,
                                          "Points keep half of it from what they touch."),
      field<kDesc, &ClothDesc::self_contact>("self_contact", "", kAny, "Whether it touches itself."),
      field<kDesc, &ClothDesc::filter, &FilterDesc::category>(
          "category", "", kAny, "Bits of its categories, for contact with other deformables."),
      field<kDesc, &ClothDesc::filter, &FilterDesc::mask>(
          "mask", "", kAny, "Bits of the categories of other deformables that it touches."),
      field<kDesc, &ClothDesc::filter, &FilterDesc::group>(
          "group", "", kAny, "Deformables of one negative group never touch, of one positive group always."),
      field<kDesc, &ClothDesc::stretch_stiffness>("stretch_stiffness", "N/m", kNotNegativeOrRigid,
                                                  "Of each spring along an edge."),
      field<kDesc, &ClothDesc::shear_stiffness>("shear_stiffness", "N/m", kNotNegativeOrRigid,
                                                "Of each spring across a cell."),
      field<kDesc, &ClothDesc::bend_stiffness>("bend_stiffness", "N m or N/m", kNotNegative, "See `bend`."),
      field<kDesc, &ClothDesc::damping>("damping", "N s/m", kNotNegative,
                                        "Of each stretch and shear spring."),
      field<kDesc, &ClothDesc::bend_damping>("bend_damping", "s", kNotNegative,
                                             "Of each bend row, in units of `bend_stiffness`."),
      field<kDesc, &ClothDesc::yield_angle>("yield_angle", "rad", kPositiveOrRigid,
                                            "What an edge is bent beyond this it keeps, as a fold."),
      field<kDesc, &ClothDesc::bend>("bend", "", kAny,
                                     "By the curvature along rows and columns of a grid [N m] (a mesh: by "
                                     "angle), by the angle or the curvature at "
                                     "each edge [N m], by springs to the second neighbor [N/m], or not."),
      field<kDesc, &ClothDesc::extension_max>("extension_max", "", kPositiveOrRigid,
                                              "Largest relative extension of a stretch spring."),
      field<kDesc, &ClothDesc::strength>("strength", "N/m", kPositive,
                                         "Force per width that it takes; beyond it tears. Any by default."),
      field<kDesc, &ClothDesc::tear_strain>("tear_strain", "", kPositive,
                                            "Strain at which it tears; besides or in place of `strength`."),
  };
}

std::vector<Field> cloth_rows() {
  constexpr auto kDesc = &SceneCloth::desc;
  return joined(
      cloth_form_rows(),
      {
          field<kDesc, &ClothDesc::tethers>(
              "tethers", "", kAny,
              "Hold points within their rest distance of the pins; by default if the "
              "cloth is stiff."),
          field<kDesc, &ClothDesc::pressure>("pressure", "Pa", between(-1e5, 1e8),
                                             "Of gas in a closed mesh, above that of the air, at the start."),
          field<kDesc, &ClothDesc::drag_coefficient>("drag_coefficient", "", kNotNegative,
                                                     "Of a triangle across the flow."),
          field<kDesc, &ClothDesc::lift_coefficient>("lift_coefficient", "", kNotNegative,
                                                     "Of a slanted triangle."),
          field<kDesc, &ClothDesc::air_friction>("air_friction", "N s/m", kNotNegative,
                                                 "Viscous drag of the whole cloth, shared out by area."),
          field<&SceneCloth::pins>("pins", "", kAny, "Points that are held."),
          field<&SceneCloth::loads>("loads", "", kAny, "Masses added to points."),
          field<kDesc, &ClothDesc::charge>("charge", "C", kAny, "Shared out by mass."),
          field<kDesc, &ClothDesc::velocity>("velocity", "m/s", kAny, "Of all points at the start."),
      });
}

std::vector<Field> solid_rows() {
  constexpr auto kDesc = &SceneSolid::desc;
  return {
      field<kDesc, &SolidDesc::cells>("cells", "", between(1, 256), "Of the box along x, y, z."),
      field<kDesc, &SolidDesc::size>("size", "m", kAny, "Of the box about `position`, each positive."),
      field<&SceneSolid::mesh>(
          "mesh", "", kNotEmpty,
          "Replaces the box: the name in `meshes` of a surface that is closed and filled."),
      field<&SceneSolid::visual>("visual", "", kNotEmpty,
                                 "What is drawn and carried along in place of the mesh or the box: a name in "
                                 "`meshes`."),
      field<kDesc, &SolidDesc::cell>("cell", "m", kPositive,
                                     "Size of the cells that fill a mesh; thinner parts become as thick."),
      field<kDesc, &SolidDesc::position>("position", "m", kAny, "Of the box's center or the mesh's frame."),
      field<kDesc, &SolidDesc::rotation>("rotation", "", kAny, "Of the same."),
      field<kDesc, &SolidDesc::density>("density", "kg/m^3", kPositive, "Mass of a cubic meter."),
      field<kDesc, &SolidDesc::total_mass>("total_mass", "kg", kPositive, "Replaces `density`."),
      field<kDesc, &SolidDesc::elasticity>("elasticity", "", kAny,
                                           "A material of tetrahedra; or cheaper, every point drawn to its "
                                           "place in the form at rest, of a mesh "
                                           "its vertices."),
      field<kDesc, &SolidDesc::match_hz>("match_hz", "Hz", kPositiveOrRigid,
                                         "Of shape_matching: at which any deformation swings."),
      field<kDesc, &SolidDesc::match_damping_ratio>("match_damping_ratio", "", between(0, 100),
                                                    "The same: 1 is critical."),
      field<kDesc, &SolidDesc::young_modulus>(
          "young_modulus", "Pa", kPositive,
          "Stiffness; what is stiffer than a substep carries takes more time."),
      field<kDesc, &SolidDesc::poisson_ratio>("poisson_ratio", "", between(0, 0.499),
                                              "How far it narrows when it is pulled; near 0.5 it keeps its "
                                              "volume."),
      field<kDesc, &SolidDesc::damping>("damping", "s", between(0, 0.1), "Viscosity over stiffness."),
      field<kDesc, &SolidDesc::yield_stress>("yield_stress", "Pa", kPositiveOrRigid,
                                             "Above this von Mises' stress it flows and keeps its new form."),
      field<kDesc, &SolidDesc::strength>(
          "strength", "Pa", kPositive,
          "Largest principal stress that it takes; beyond it tears. Any by default. It needs tetrahedra."),
      field<kDesc, &SolidDesc::thickness>("thickness", "m", kPositive,
                                          "Points keep half of it from what they touch."),
      field<kDesc, &SolidDesc::self_contact>("self_contact", "", kAny, "Whether it touches itself."),
      field<kDesc, &SolidDesc::filter, &FilterDesc::category>(
          "category", "", kAny, "Bits of its categories, for contact with other deformables."),
      field<kDesc, &SolidDesc::filter, &FilterDesc::mask>(
          "mask", "", kAny, "Bits of the categories of other deformables that it touches."),
      field<kDesc, &SolidDesc::filter, &FilterDesc::group>(
          "group", "", kAny, "Deformables of one negative group never touch, of one positive group always."),
      field<kDesc, &SolidDesc::air_friction>("air_friction", "N s/m", kNotNegative,
                                             "Viscous drag of the whole solid, shared out by volume."),
      field<&SceneSolid::pins>("pins", "", kAny, "Points that are held."),
      field<kDesc, &SolidDesc::charge>("charge", "C", kAny, "Shared out by volume."),
      field<kDesc, &SolidDesc::velocity>("velocity", "m/s", kAny, "Of all points at the start."),
  };
}

std::vector<Field> particles_rows() {
  constexpr auto kDesc = &SceneParticles::desc;
  return {
      required(field<kDesc, &ParticlesDesc::particles>("particles", "", kNotEmpty, "The point masses.")),
      field<kDesc, &ParticlesDesc::springs>("springs", "", kAny, "Between two of them each."),
      field<kDesc, &ParticlesDesc::direction>("direction", "", kAny,
                                              "Where a spring's direction is taken: at the start of a "
                                              "substep (keeps energy), or where the points are "
                                              "about to be (quieter on stiff lattices)."),
      field<kDesc, &ParticlesDesc::damping>(
          "damping", "", kAny, "Along the spring, or of the whole relative velocity as in the paper."),
      field<kDesc, &ParticlesDesc::air_friction>("air_friction", "N s/m", kNotNegative,
                                                 "Viscous drag of each particle."),
      field<kDesc, &ParticlesDesc::drag_coefficient>("drag_coefficient", "", kNotNegative,
                                                     "Of each particle as a sphere of its radius."),
      field<&SceneParticles::pins>("pins", "", kAny, "Particles that are held."),
  };
}

template <class T>
Kind make_object_kind(const char* name, const char* help, const std::vector<Field>& rows) {
  Kind made = {
      .name = name, .help = help, .fields = rows, .defaults = defaults_of<T>, .check = check_tagged<T>};
  add_tag_rows<T>(made.fields);
  return made;
}

}  // namespace

template <>
const Kind& kind_of<SceneRope>() {
  static const Kind kind = make_object_kind<SceneRope>(
      "rope", "A chain of point masses that stretches no more than its stiffness says.", rope_rows());
  return kind;
}

template <>
const Kind& kind_of<SceneCloth>() {
  static const Kind kind = make_object_kind<SceneCloth>(
      "cloth", "A surface of point masses: a grid, or the triangles of a mesh.", cloth_rows());
  return kind;
}

template <>
const Kind& kind_of<SceneSolid>() {
  static const Kind kind =
      make_object_kind<SceneSolid>("solid", "A soft solid: a box of cells, or a closed mesh.", solid_rows());
  return kind;
}

template <>
const Kind& kind_of<SceneParticles>() {
  static const Kind kind = make_object_kind<SceneParticles>(
      "particles", "Loose point masses and the springs between them.", particles_rows());
  return kind;
}

template <>
const Kind& kind_of<ParticleDesc>() {
  static const Kind kind = {
      .name = "particle",
      .help = "A point mass.",
      .fields = {required(field<&ParticleDesc::position>("position", "m", kAny, "At the start.")),
                 field<&ParticleDesc::velocity>("velocity", "m/s", kAny, "At the start."),
                 field<&ParticleDesc::mass>("mass", "kg", kPositive, "Of the particle."),
                 field<&ParticleDesc::charge>("charge", "C", kAny, "Of the particle."),
                 field<&ParticleDesc::radius>("radius", "m", kPositive, "For contact and drawing.")},
      .defaults = defaults_of<ParticleDesc>};
  return kind;
}

template <>
const Kind& kind_of<SpringDesc>() {
  static const Kind kind = {
      .name = "spring",
      .help = "A damped spring between two particles of the same object.",
      .fields = {required(field<&SpringDesc::a>("a", "", kAny, "Index of a particle.")),
                 required(field<&SpringDesc::b>("b", "", kAny, "Index of another.")),
                 field<&SpringDesc::stiffness>("stiffness", "N/m", kNotNegativeOrRigid, "k."),
                 field<&SpringDesc::damping>("damping", "N s/m", kNotNegative, "c."),
                 field<&SpringDesc::rest_length>("rest_length", "m", kNotNegative,
                                                 "The distance at the start by default.")},
      .defaults = defaults_of<SpringDesc>};
  return kind;
}

namespace {

const Kind& uniform_kind() {
  static const Kind kind = {.name = "uniform",
                            .help = "The same acceleration everywhere.",
                            .fields = {required(field<&SceneField::desc, &FieldDesc::vector>(
                                "acceleration", "m/s^2", kAny, "Of every particle and body."))},
                            .defaults = defaults_of<SceneField>};
  return kind;
}

const Kind& inverse_square_kind() {
  static const Kind kind = {
      .name = "inverse_square",
      .help = "Acceleration -strength (x - center) / |x - center|^3.",
      .fields = {field<&SceneField::desc, &FieldDesc::center>("center", "m", kAny, "Where it points to."),
                 required(field<&SceneField::desc, &FieldDesc::strength>("strength", "m^3/s^2", kAny,
                                                                         "Positive attracts."))},
      .defaults = defaults_of<SceneField>};
  return kind;
}

const Kind& magnetic_kind() {
  constexpr auto kDesc = &SceneField::desc;
  static const Kind kind = {
      .name = "magnetic",
      .help =
          "Force q v x B on charged particles; turns bodies with a dipole moment, and pulls them up a "
          "gradient.",
      .fields = {required(field<kDesc, &FieldDesc::vector>("flux_density", "T", kAny, "B at the center.")),
                 field<kDesc, &FieldDesc::strength>(
                     "gradient", "T/m", between(-1e9, 1e9),
                     "Of B along its own direction; across it B falls by half of that."),
                 field<kDesc, &FieldDesc::center>("center", "m", kAny, "Where B is as given.")},
      .defaults = defaults_of<SceneField>};
  return kind;
}

const Kind& dipole_kind() {
  constexpr auto kDesc = &SceneField::desc;
  static const Kind kind = {
      .name = "dipole",
      .help = "A magnet at rest, small against the way to it.",
      .fields = {field<kDesc, &FieldDesc::center>("center", "m", kAny, "Where it is."),
                 required(field<kDesc, &FieldDesc::vector>("moment", "A m^2", kAny,
                                                           "From its south pole to its north pole."))},
      .defaults = defaults_of<SceneField>};
  return kind;
}

const Kind& liquid_kind() {
  constexpr auto kDesc = &SceneField::desc;
  static const Kind kind = {
      .name = "liquid",
      .help = "Lifts by the weight of what is displaced, and drags. The liquid itself does not move.",
      .fields = {required(field<kDesc, &FieldDesc::height>(
                     "height", "m", between(-1e9, 1e9), "Of the surface above the origin, against gravity.")),
                 field<kDesc, &FieldDesc::density>("density", "kg/m^3", between(0, 1e6),
                                                   "Mass of a cubic meter."),
                 field<kDesc, &FieldDesc::drag>(
                     "drag", "1/s", between(0, 1e6),
                     "Rate at which the motion of a body decays that displaces its own mass."),
                 field<kDesc, &FieldDesc::vector>("flow", "m/s", kAny, "Of the current.")},
      .defaults = defaults_of<SceneField>};
  return kind;
}

Field falloff_row() {
  return field<&SceneField::desc, &FieldDesc::falloff>("falloff", "", between(0, 8),
                                                       "Exponent n of (1 - r / reach)^n.");
}

Field reach_row() {
  return required(field<&SceneField::desc, &FieldDesc::reach>("reach", "m", between(1e-6, 1e9),
                                                              "From there on nothing is felt."));
}

const Kind& suction_kind() {
  constexpr auto kDesc = &SceneField::desc;
  static const Kind kind = {
      .name = "suction",
      .help = "Acceleration strength (1 - r / reach)^falloff towards the center, r the distance from it.",
      .fields = {field<kDesc, &FieldDesc::center>("center", "m", kAny, "Where it points to."),
                 required(field<kDesc, &FieldDesc::strength>("strength", "m/s^2", kAny, "Negative blows.")),
                 reach_row(), falloff_row()},
      .defaults = defaults_of<SceneField>};
  return kind;
}

const Kind& vortex_kind() {
  constexpr auto kDesc = &SceneField::desc;
  static const Kind kind = {
      .name = "vortex",
      .help = "Acceleration strength (1 - r / reach)^falloff about an axis, r the distance from that.",
      .fields = {field<kDesc, &FieldDesc::center>("center", "m", kAny, "A point of the axis."),
                 required(field<kDesc, &FieldDesc::vector>("axis", "", kAny, "Any length but zero.")),
                 required(field<kDesc, &FieldDesc::strength>(
                     "strength", "m/s^2", kAny, "Positive: counter-clockwise seen from the axis's tip.")),
                 reach_row(), falloff_row()},
      .defaults = defaults_of<SceneField>};
  return kind;
}

const Kind& explosion_kind() {
  constexpr auto kDesc = &SceneField::desc;
  static const Kind kind = {
      .name = "explosion",
      .help = "Once, the velocity changes by strength (1 - r / reach)^falloff away from the center.",
      .fields = {field<kDesc, &FieldDesc::center>("center", "m", kAny, "Where it happens."),
                 required(field<kDesc, &FieldDesc::time>("time", "s", kNotNegative, "When it happens.")),
                 required(
                     field<kDesc, &FieldDesc::strength>("strength", "m/s", kAny, "Positive drives away.")),
                 reach_row(), falloff_row()},
      .defaults = defaults_of<SceneField>};
  return kind;
}

bool check_field(Reader& reader, const JsonNode& node, const void* object) {
  return check_named(reader, node, static_cast<const SceneField*>(object)->name);
}

}  // namespace

template <>
const Kind& kind_of<SceneField>() {
  constexpr auto kDesc = &SceneField::desc;
  static const Kind kind = {
      .name = "field",
      .help =
          "A force on every particle and body of the world. One of `uniform`, `inverse_square`, `magnetic`, "
          "`liquid`, `suction`, `vortex`, `explosion`, `dipole`.",
      .fields = {field<&SceneField::name>("name", "", kNotEmpty, "Unique."),
                 choice<FieldDesc::Kind::kUniform, kDesc, &FieldDesc::kind>(
                     group("uniform", uniform_kind, "Like gravity.")),
                 choice<FieldDesc::Kind::kInverseSquare, kDesc, &FieldDesc::kind>(
                     group("inverse_square", inverse_square_kind, "Like a planet's.")),
                 choice<FieldDesc::Kind::kMagnetic, kDesc, &FieldDesc::kind>(
                     group("magnetic", magnetic_kind, "A magnet's.")),
                 choice<FieldDesc::Kind::kLiquid, kDesc, &FieldDesc::kind>(
                     group("liquid", liquid_kind, "Water that things float in.")),
                 choice<FieldDesc::Kind::kSuction, kDesc, &FieldDesc::kind>(
                     group("suction", suction_kind, "Towards a point.")),
                 choice<FieldDesc::Kind::kVortex, kDesc, &FieldDesc::kind>(
                     group("vortex", vortex_kind, "Round an axis.")),
                 choice<FieldDesc::Kind::kExplosion, kDesc, &FieldDesc::kind>(
                     group("explosion", explosion_kind, "Away from a point, once.")),
                 choice<FieldDesc::Kind::kDipole, kDesc, &FieldDesc::kind>(
                     group("dipole", dipole_kind, "A small magnet's."))},
      .defaults = defaults_of<SceneField>,
      .check = check_field};
  return kind;
}

std::span<const Kind* const> object_kinds() {
  static const std::array kinds = {&kind_of<SceneRope>(),
                                   &kind_of<SceneCloth>(),
                                   &kind_of<SceneSolid>(),
                                   &kind_of<SceneParticles>(),
                                   &kind_of<ParticleDesc>(),
                                   &kind_of<SpringDesc>(),
                                   &kind_of<SceneField>(),
                                   &uniform_kind(),
                                   &inverse_square_kind(),
                                   &magnetic_kind(),
                                   &liquid_kind(),
                                   &suction_kind(),
                                   &vortex_kind(),
                                   &explosion_kind(),
                                   &dipole_kind(),
                                   &kind_of<ScenePin>(),
                                   &kind_of<SceneLoad>(),
                                   &kind_of<MotionDesc>(),
                                   &sine_kind(),
                                   &kind_of<MotionDesc::Keyframe>(),
                                   &kind_of<SceneArray>(),
                                   &kind_of<Quat>()};
  return kinds;
}

// -- Codecs.
// --------------------------------------------------------------------------------------------------

bool Codec<ScenePoint>::read(Reader& reader, const JsonNode& node, const Rule& rule, ScenePoint& value) {
  if (node.kind == JsonNode::Kind::kString) {
    if (node.text != "last") {
      return reader.fail(node, ErrorCode::kOutOfRange, in_quotes(node.text) + " is not an index or \"last\"");
    }
    value = {.index = 0, .last = true};
    return true;
  }
  value = {};
  return Codec<std::uint32_t>::read(reader, node, rule, value.index);
}

JsonNode Codec<ScenePoint>::write(const ScenePoint& value) {
  return value.last ? make_string("last") : make_integer(value.index);
}

JsonNode Codec<ScenePoint>::schema(const Rule& rule) {
  JsonNode words = make_array();
  words.add(make_string("last"));
  JsonNode word = make_object();
  word.add("enum", std::move(words));
  JsonNode forms = make_array();
  forms.add(Codec<std::uint32_t>::schema(rule));
  forms.add(std::move(word));
  JsonNode schema = make_object();
  schema.add("anyOf", std::move(forms));
  return schema;
}

bool Codec<ConnectionPointDesc>::read(Reader& reader, const JsonNode& node, const Rule& rule,
                                      ConnectionPointDesc& value) {
  if (node.kind == JsonNode::Kind::kArray) return Codec<DVec3>::read(reader, node, rule, value.position);
  if (node.kind == JsonNode::Kind::kNumber)
    return Codec<std::optional<std::uint32_t>>::read(reader, node, rule, value.point);
  return reader.fail_type(node, "a place [x, y, z] or the number of a point");
}

JsonNode Codec<ConnectionPointDesc>::write(const ConnectionPointDesc& value) {
  return value.point ? make_integer(*value.point) : Codec<DVec3>::write(value.position);
}

bool Codec<ConnectionPointDesc>::same(const ConnectionPointDesc& a, const ConnectionPointDesc& b) {
  return a.point == b.point && a.position == b.position;
}

JsonNode Codec<ConnectionPointDesc>::schema(const Rule& rule) {
  JsonNode forms = make_array();
  forms.add(Codec<DVec3>::schema(rule));
  forms.add(Codec<std::uint32_t>::schema(rule));
  JsonNode schema = make_object();
  schema.add("anyOf", std::move(forms));
  return schema;
}

bool Codec<ScenePin>::read(Reader& reader, const JsonNode& node, const Rule& rule, ScenePin& value) {
  if (node.kind == JsonNode::Kind::kObject) return read_object(reader, node, kind_of<ScenePin>(), &value);
  value = {};
  return Codec<ScenePoint>::read(reader, node, rule, value.point);
}

JsonNode Codec<ScenePin>::write(const ScenePin& value) {
  const bool still = value.motion == MotionDesc{};
  if (value.pick == ScenePin::Pick::kPoint && still) return Codec<ScenePoint>::write(value.point);
  return write_object(kind_of<ScenePin>(), &value);
}

bool Codec<ScenePin>::same(const ScenePin& a, const ScenePin& b) {
  return same_object(kind_of<ScenePin>(), &a, &b);
}

JsonNode Codec<ScenePin>::schema(const Rule& rule) {
  JsonNode schema = Codec<ScenePoint>::schema(rule);
  schema.children.front().add(schema_reference(kind_of<ScenePin>()));
  return schema;
}

template <>
std::span<const EnumName> names_of<RopeDesc::StiffnessOf>() {
  static constexpr EnumName kNames[] = {{"rope", static_cast<int>(RopeDesc::StiffnessOf::kRope)},
                                        {"segment", static_cast<int>(RopeDesc::StiffnessOf::kSegment)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<ClothDesc::Bend>() {
  static constexpr EnumName kNames[] = {{"angle", static_cast<int>(ClothDesc::Bend::kAngle)},
                                        {"spring", static_cast<int>(ClothDesc::Bend::kSpring)},
                                        {"none", static_cast<int>(ClothDesc::Bend::kNone)},
                                        {"isometric", static_cast<int>(ClothDesc::Bend::kIsometric)},
                                        {"yarn", static_cast<int>(ClothDesc::Bend::kYarn)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<SolidDesc::Elasticity>() {
  static constexpr EnumName kNames[] = {
      {"tetrahedra", static_cast<int>(SolidDesc::Elasticity::kTetrahedra)},
      {"shape_matching", static_cast<int>(SolidDesc::Elasticity::kShapeMatching)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<ParticlesDesc::Direction>() {
  static constexpr EnumName kNames[] = {
      {"explicit", static_cast<int>(ParticlesDesc::Direction::kExplicit)},
      {"predicted", static_cast<int>(ParticlesDesc::Direction::kPredicted)}};
  return kNames;
}

template <>
std::span<const EnumName> names_of<ParticlesDesc::Damping>() {
  static constexpr EnumName kNames[] = {{"central", static_cast<int>(ParticlesDesc::Damping::kCentral)},
                                        {"isotropic", static_cast<int>(ParticlesDesc::Damping::kIsotropic)}};
  return kNames;
}

}  // namespace hooke::io
