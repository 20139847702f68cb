/// Holds the tables of rigid bodies: shapes, parts, filters, the body itself.

#include "io/scene/scene_table.h"
#include "io/scene/scene_table_tags.h"

#include <algorithm>

namespace hooke::io {

namespace {

/// These are the tables of shapes for an Owner whose Shape is at the path `Members...`.
template <class Owner, auto... Members>
struct ShapeTables {
  static const Kind& half_space() {
    static const Kind kind = {.name = "half_space",
                              .help = "Solid below the plane y = 0 of the frame. Has no keys.",
                              .fields = {},
                              .defaults = defaults_of<Owner>};
    return kind;
  }

  static const Kind& sphere() {
    static const Kind kind = {
        .name = "sphere",
        .help = "A ball about the origin of the frame.",
        .fields = {field<Members..., &Shape::radius>("radius", "m", kPositive, "Of the ball.")},
        .defaults = defaults_of<Owner>};
    return kind;
  }

  static const Kind& box() {
    static const Kind kind = {.name = "box",
                              .help = "A box about the origin of the frame.",
                              .fields = {field<Members..., &Shape::half_extents>(
                                  "half_extents", "m", kPositive, "Half the length of each side.")},
                              .defaults = defaults_of<Owner>};
    return kind;
  }

  /// Capsules, cylinders and cones have the same keys.
  static std::vector<Field> round_rows() {
    return {field<Members..., &Shape::radius>("radius", "m", kPositive, "Of the round part."),
            field<Members..., &Shape::half_height>(
                "half_height", "m", kPositive, "Half its height along y; of a capsule without its ends.")};
  }

  static const Kind& capsule() {
    static const Kind kind = {
        .name = "capsule",
        .help = "Along y, about the origin of the frame: a cylinder between half spheres.",
        .fields = round_rows(),
        .defaults = defaults_of<Owner>};
    return kind;
  }

  static const Kind& cylinder() {
    static const Kind kind = {.name = "cylinder",
                              .help = "Along y, about the origin of the frame.",
                              .fields = round_rows(),
                              .defaults = defaults_of<Owner>};
    return kind;
  }

  static const Kind& cone() {
    static const Kind kind = {.name = "cone",
                              .help = "Along y, the tip up, the origin halfway up.",
                              .fields = round_rows(),
                              .defaults = defaults_of<Owner>};
    return kind;
  }

  template <ShapeKind Choice>
  static Field of(Field row) {
    return choice<Choice, Members..., &Shape::kind>(row);
  }

  static std::vector<Field> rows() {
    return {of<ShapeKind::kHalfSpace>(group("half_space", half_space, "Ground without end.")),
            of<ShapeKind::kSphere>(group("sphere", sphere, "A ball.")),
            of<ShapeKind::kBox>(group("box", box, "A box.")),
            of<ShapeKind::kCapsule>(group("capsule", capsule, "A rod with round ends.")),
            of<ShapeKind::kCylinder>(group("cylinder", cylinder, "A drum.")),
            of<ShapeKind::kCone>(group("cone", cone, "A cone.")),
            of<ShapeKind::kMesh>(field<&Owner::mesh>("mesh", "", kNotEmpty,
                                                     "Triangles: a name in `meshes`. A dynamic body "
                                                     "collides by convex parts of the surface, closed.")),
            of<ShapeKind::kHull>(field<&Owner::mesh>("hull", "", kNotEmpty,
                                                     "The convex hull of a mesh: a name in `meshes`."))};
  }
};

using BodyShape = ShapeTables<SceneBody, &SceneBody::desc, &BodyDesc::shape>;
using PartShape = ShapeTables<ScenePart, &ScenePart::desc, &PartDesc::shape>;

const Kind& shape_kind() {
  static const Kind kind = [] {
    Kind made = {.name = "shape",
                 .help = "What a body is. One of the keys.",
                 .fields = BodyShape::rows(),
                 .defaults = defaults_of<SceneBody>};
    made.fields.push_back(BodyShape::of<ShapeKind::kCompound>(
        field<&SceneBody::parts>("parts", "", kNotEmpty, "Several shapes that move as one.")));
    return made;
  }();
  return kind;
}

const Kind& part_shape_kind() {
  static const Kind kind = {.name = "part_shape",
                            .help = "What a part of a body is. One of the keys.",
                            .fields = PartShape::rows(),
                            .defaults = defaults_of<ScenePart>};
  return kind;
}

std::vector<Field> body_rows() {
  constexpr auto kDesc = &SceneBody::desc;
  return {
      required(group("shape", shape_kind, "What it is.")),
      field<&SceneBody::fracture>(
          "fracture", "", kAny,
          "Makes a dynamic box, hull or mesh of glued cells: the bodies `name[0]`, ... and "
          "the hooks `name_glue[0]`, ..."),
      field<&SceneBody::blade>(
          "blade", "", kAny, "Makes a kinematic body cut the ropes, cloths and solids that its edge sweeps."),
      field<&SceneBody::section>(
          "section", "", kAny,
          "Cross section of a bar, which two hooks hold: `hooke load` then tells where it "
          "yields and buckles. It changes no motion."),
      field<kDesc, &BodyDesc::yields>(
          "yields", "", kAny,
          "Makes a dynamic body of one shape a soft solid where it is hit hard, and a body of its new shape "
          "when that has come to rest in itself."),
      field<&SceneBody::visual>("visual", "", kNotEmpty,
                                "What is drawn in place of the shape: a name in `meshes`."),
      field<kDesc, &BodyDesc::kind>("kind", "", kAny,
                                    "Stands still; moves as told; or moves by what acts on it."),
      field<kDesc, &BodyDesc::position>("position", "m", kAny, "Origin of its frame."),
      field<kDesc, &BodyDesc::rotation>("rotation", "", kAny, "Of its frame."),
      field<kDesc, &BodyDesc::velocity>("velocity", "m/s", kAny, "Of the center of mass at the start."),
      field<kDesc, &BodyDesc::angular_velocity>("angular_velocity", "rad/s", kAny,
                                                "At the start, in the world's axes."),
      field<kDesc, &BodyDesc::density>("density", "kg/m^3", kPositive, "Mass of a cubic meter."),
      field<kDesc, &BodyDesc::mass>("mass", "kg", kPositive, "Scales the density to give this mass."),
      field<kDesc, &BodyDesc::linear_damping>("linear_damping", "1/s", kNotNegative,
                                              "Rate at which the velocity decays."),
      field<kDesc, &BodyDesc::angular_damping>("angular_damping", "1/s", kNotNegative,
                                               "Rate at which the spin decays."),
      field<kDesc, &BodyDesc::gravity_scale>("gravity_scale", "", kAny, "Factor on gravity."),
      field<kDesc, &BodyDesc::drag_coefficient>("drag_coefficient", "", between(0, 1e6),
                                                "C_d in air, of the area it shows to the flow."),
      field<kDesc, &BodyDesc::magnus_coefficient>(
          "magnus_coefficient", "", between(-1e6, 1e6),
          "C of the lift C rho V omega x v in air, V its volume; of a ball 0.75 (Rubinow and Keller)."),
      field<kDesc, &BodyDesc::dipole_moment>(
          "dipole_moment", "A m^2", kAny,
          "Magnetic, in the body's frame: magnetic fields and other dipoles turn and pull it."),
      field<kDesc, &BodyDesc::contact, &ContactDesc::surface_velocity>(
          "surface_velocity", "m/s", kAny, "Of a conveyor belt, in the body's frame."),
      field<kDesc, &BodyDesc::filter, &FilterDesc::category>("category", "", kAny, "Bits of its categories."),
      field<kDesc, &BodyDesc::filter, &FilterDesc::mask>("mask", "", kAny,
                                                         "Bits of the categories it collides with."),
      field<kDesc, &BodyDesc::filter, &FilterDesc::group>(
          "group", "", kAny, "Bodies of one negative group never collide, of one positive group always."),
      field<kDesc, &BodyDesc::motion>("motion", "", kAny, "Path of a kinematic body."),
      field<kDesc, &BodyDesc::collides>("collides", "", kAny, "False: only drawn."),
      field<kDesc, &BodyDesc::sensor>("sensor", "", kAny, "Reports what overlaps it and pushes nothing."),
      field<kDesc, &BodyDesc::bullet>("bullet", "", kAny, "Swept against moving bodies too."),
      field<kDesc, &BodyDesc::can_sleep>("can_sleep", "", kAny, "May rest until something wakes it.")};
}

/// A blade is moved as told, and has an edge.
bool check_blade(Reader& reader, const JsonNode& node, const SceneBody& body) {
  if (!body.blade) return true;
  if (body.desc.kind != BodyKind::kKinematic)
    return reader.fail(node, ErrorCode::kOutOfRange, "'blade' is for a kinematic body, which nothing stops");
  if (length(body.blade->edge[1] - body.blade->edge[0]) > Real(0)) return true;
  return reader.fail(node, ErrorCode::kOutOfRange, "the two ends of the 'edge' of 'blade' must not be equal");
}

/// A section is told in one way, and has a hole that fits.
bool check_section(Reader& reader, const JsonNode& node, const void* object) {
  const auto& section = *static_cast<const SceneSection*>(object);
  const auto refuse = [&](const char* why) { return reader.fail(node, ErrorCode::kOutOfRange, why); };
  const bool is_box = section.width || section.height;
  if ((section.area ? 1 : 0) + (section.radius ? 1 : 0) + (is_box ? 1 : 0) != 1)
    return refuse("needs one of 'area', 'radius', and 'width' with 'height'");
  if (is_box && !(section.width && section.height)) return refuse("needs both 'width' and 'height'");
  if (section.second_moment && !section.area)
    return refuse("'second_moment' is for 'area'; a shape has its own");
  if (!section.thickness) return true;
  if (section.area) return refuse("'thickness' is for a shape, not for 'area'");
  const Real inside =
      section.radius ? *section.radius : Real(0.5) * std::min(*section.width, *section.height);
  if (*section.thickness < inside) return true;
  return refuse("'thickness' must be below half of the section; leave it out for a solid one");
}

/// A body that is to break is one that moves, and whose inside is known.
bool check_body(Reader& reader, const JsonNode& node, const void* object) {
  if (!check_tagged<SceneBody>(reader, node, object)) return false;
  const auto& body = *static_cast<const SceneBody*>(object);
  if (!check_blade(reader, node, body)) return false;
  if (body.fracture && body.desc.yields)
    return reader.fail(node, ErrorCode::kOutOfRange, "'fracture' and 'yields' are one or the other");
  if (!body.fracture) return true;
  if (body.desc.kind != BodyKind::kDynamic) {
    return reader.fail(node, ErrorCode::kOutOfRange,
                       "'fracture' is for a dynamic body; hooks to the world may hold its cells");
  }
  const ShapeKind kind = body.desc.shape.kind;
  if (kind == ShapeKind::kBox || kind == ShapeKind::kHull || kind == ShapeKind::kMesh) return true;
  return reader.fail(node, ErrorCode::kOutOfRange, "'fracture' is for a box, a hull or a mesh");
}

}  // namespace

template <>
const Kind& kind_of<SceneFracture>() {
  constexpr auto kDesc = &SceneFracture::desc;
  static const Kind kind = {
      .name = "fracture",
      .help =
          "How a body is broken beforehand: into the Voronoi cells of seeds, which are glued where they "
          "share a "
          "face. The glue is made of `fixed` hooks.",
      .fields = {field<kDesc, &FractureDesc::cells>("cells", "", between(1, 4096),
                                                    "Number of seeds that are spread at random."),
                 field<kDesc, &FractureDesc::seed>("seed", "", kAny, "Of the random numbers."),
                 field<kDesc, &FractureDesc::seeds>(
                     "seeds", "m", kNotEmpty,
                     "Places of the seeds in the body's frame, in place of `cells`."),
                 field<kDesc, &FractureDesc::impact>(
                     "impact", "m", kAny, "Place in the body's frame about which random seeds crowd."),
                 field<kDesc, &FractureDesc::impact_radius>(
                     "impact_radius", "", between(0.001, 1),
                     "Within this share of the diagonal of its box from `impact` cells grow no smaller."),
                 field<kDesc, &FractureDesc::least_share>(
                     "least_share", "", between(0, 0.5),
                     "Cells of less than this share of the mean volume go to their neighbors."),
                 field<kDesc, &FractureDesc::least_face>(
                     "least_face", "", between(0, 1),
                     "Faces below this share of the largest face of each of their cells are not glued."),
                 field<&SceneFracture::strength>("strength", "Pa", kPositiveOrRigid,
                                                 "A face takes this times its area as a force, and this "
                                                 "times its section modulus as a torque.")},
      .defaults = defaults_of<SceneFracture>};
  return kind;
}

template <>
const Kind& kind_of<SceneBlade>() {
  static const Kind kind = {
      .name = "blade",
      .help =
          "The sharp edge of a kinematic body. In each step it cuts what it has swept: ropes lose segments, "
          "triangles of cloths and tetrahedra of solids part.",
      .fields = {required(field<&SceneBlade::edge>("edge", "m", kAny, "Its two ends in the body's frame.")),
                 field<&SceneBlade::cuts>(
                     "cuts", "", kNotEmpty,
                     "Names of the ropes, cloths and solids that it cuts; all by default.")},
      .defaults = defaults_of<SceneBlade>};
  return kind;
}

template <>
const Kind& kind_of<SceneSection>() {
  static const Kind kind = {
      .name = "section",
      .help =
          "Cross section of a bar: its `area`, also with `second_moment`; or its shape, by `radius`, or "
          "`width` and "
          "`height`; hollow with a `thickness`.",
      .fields = {field<&SceneSection::area>("area", "m^2", kPositive, "Of the section."),
                 field<&SceneSection::second_moment>("second_moment", "m^4", kPositive,
                                                     "Of area, the least one; without it nothing buckles."),
                 field<&SceneSection::radius>("radius", "m", kPositive, "Of a round bar or tube, outside."),
                 field<&SceneSection::width>("width", "m", kPositive, "Of a rectangle, outside."),
                 field<&SceneSection::height>("height", "m", kPositive, "Of a rectangle, outside."),
                 field<&SceneSection::thickness>("thickness", "m", kPositive,
                                                 "Of the wall of a tube or box."),
                 field<&SceneSection::young_modulus>("young_modulus", "Pa", kPositive,
                                                     "E; that of the material by default."),
                 field<&SceneSection::yield_stress>("yield_stress", "Pa", kPositive,
                                                    "Force over area at which it yields."),
                 field<&SceneSection::length_factor>("length_factor", "", between(0.1, 10),
                                                     "K of Euler's load pi^2 E I / (K L)^2: 1 for hinged "
                                                     "ends, 0.5 for clamped, 2 for a free end.")},
      .defaults = defaults_of<SceneSection>,
      .check = check_section};
  return kind;
}

template <>
const Kind& kind_of<YieldsDesc>() {
  static const Kind kind = {
      .name = "yields",
      .help =
          "When a body becomes a soft solid, of what material that is, and when it is rigid again. Its hooks "
          "are `ball`, `hinge`, `fixed`, `distance` or `rope_slide`.",
      .fields =
          {field<&YieldsDesc::impulse>("impulse", "N s", kPositive,
                                       "It yields in the step in which one other object gives it more."),
           field<&YieldsDesc::cell>("cell", "m", kNotNegative,
                                    "Size of the solid's cells, about; 0: a tenth of its longest side."),
           field<&YieldsDesc::young_modulus>("young_modulus", "Pa", between(1e-6, 1e12),
                                             "Stiffness of the solid."),
           field<&YieldsDesc::poisson_ratio>("poisson_ratio", "", between(0, 0.499),
                                             "How much it narrows when it is stretched."),
           field<&YieldsDesc::damping>("damping", "s", between(0, 0.1), "Its viscosity over stiffness."),
           field<&YieldsDesc::yield_stress>("yield_stress", "Pa", kPositiveOrRigid,
                                            "Stress above which it dents for good."),
           field<&YieldsDesc::thickness>("thickness", "m", kPositive,
                                         "Half of it is the distance its points keep."),
           field<&YieldsDesc::freeze_below>(
               "freeze_below", "m/s", kPositive,
               "Largest speed of a point against the whole at which it counts as at rest in itself."),
           field<&YieldsDesc::freeze_after>("freeze_after", "s", kNotNegative,
                                            "Time at rest in itself after which it is rigid.")},
      .defaults = defaults_of<YieldsDesc>};
  return kind;
}

template <>
const Kind& kind_of<ScenePart>() {
  constexpr auto kDesc = &ScenePart::desc;
  static const Kind kind = {
      .name = "part",
      .help = "One shape of a body that has several.",
      .fields = {required(group("shape", part_shape_kind, "What it is.")),
                 field<kDesc, &PartDesc::position>("position", "m", kAny, "Of its frame in the body's."),
                 field<kDesc, &PartDesc::rotation>("rotation", "", kAny, "Of its frame in the body's."),
                 field<kDesc, &PartDesc::density>("density", "kg/m^3", kPositive, "Mass of a cubic meter."),
                 field<&ScenePart::material>("material", "", kNotEmpty,
                                             "A name in `materials`; the body's by default.")},
      .defaults = defaults_of<ScenePart>};
  return kind;
}

template <>
const Kind& kind_of<SceneBody>() {
  static const Kind kind = [] {
    Kind made = {.name = "body",
                 .help = "A rigid body: ground, walls, and what falls on them.",
                 .fields = body_rows(),
                 .defaults = defaults_of<SceneBody>,
                 .check = check_body};
    add_tag_rows<SceneBody>(made.fields);
    return made;
  }();
  return kind;
}

template <>
const Kind& kind_of<ScenePair>() {
  constexpr auto kDesc = &ScenePair::desc;
  static const Kind kind = {
      .name = "material_pair",
      .help = "What two materials do to each other, in place of what their own numbers would give.",
      .fields = {required(field<&ScenePair::a>("a", "", kNotEmpty, "A name in `materials`.")),
                 required(
                     field<&ScenePair::b>("b", "", kNotEmpty, "A name in `materials`; may be the same.")),
                 field<kDesc, &MaterialPairDesc::friction>("friction", "", between(0, 100), "While sliding."),
                 field<kDesc, &MaterialPairDesc::static_friction>("static_friction", "", between(0, 100),
                                                                  "While at rest; not below `friction`."),
                 field<kDesc, &MaterialPairDesc::restitution>("restitution", "", between(0, 1),
                                                              "Speed after over speed before.")},
      .defaults = defaults_of<ScenePair>};
  return kind;
}

std::span<const Kind* const> body_kinds() {
  static const Kind* const kinds[] = {&kind_of<SceneBody>(),    &shape_kind(),
                                      &BodyShape::half_space(), &BodyShape::sphere(),
                                      &BodyShape::box(),        &BodyShape::capsule(),
                                      &BodyShape::cylinder(),   &BodyShape::cone(),
                                      &kind_of<ScenePart>(),    &part_shape_kind(),
                                      &kind_of<ScenePair>(),    &kind_of<SceneFracture>(),
                                      &kind_of<SceneBlade>(),   &kind_of<SceneSection>(),
                                      &kind_of<YieldsDesc>()};
  return kinds;
}

template <>
std::span<const EnumName> names_of<BodyKind>() {
  static constexpr EnumName kNames[] = {{"static", static_cast<int>(BodyKind::kStatic)},
                                        {"kinematic", static_cast<int>(BodyKind::kKinematic)},
                                        {"dynamic", static_cast<int>(BodyKind::kDynamic)}};
  return kNames;
}

}  // namespace hooke::io
