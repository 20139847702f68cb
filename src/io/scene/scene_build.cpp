#include "hooke/fracture.h"

#include "geometry/convex/convex_hull.h"
#include "geometry/solid/tetrahedral_mesh.h"
#include "io/scene/scene_check.h"
#include "io/scene/scene_data.h"
#include "io/scene/scene_source.h"

#include <algorithm>

namespace hooke::io {

namespace {

/// Builds the objects of one list after another, instance by instance.
class Builder {
 public:
  Builder(SimulationData& data, std::vector<Error>& errors) : data_(data), errors_(errors) {}

  void build(const SceneBody& body, const std::string& path);
  void build(const SceneRope& rope, const std::string& path);
  void build(const SceneCloth& cloth, const std::string& path);
  void build(const SceneSolid& solid, const std::string& path);
  void build(const SceneParticles& particles, const std::string& path);
  void build(const SceneField& field, const std::string& path);
  void build(const SceneHook& hook, const std::string& path);
  void build(const SceneSeam& seam, const std::string& path);

 private:
  [[nodiscard]] bool full() const { return errors_.size() >= kMostErrors; }
  void fail(const std::string& path, ErrorCode code, std::string reason) {
    if (!full()) errors_.push_back(error_at(data_.scene.source.get(), path, code, std::move(reason)));
  }
  bool reserve(std::size_t points, const std::string& path);
  [[nodiscard]] const SceneMaterial* find_material(const std::string& name) const;
  [[nodiscard]] Real friction_of(const SceneTag& tag) const;
  [[nodiscard]] ContactDesc surface_of(const std::string& material, ContactDesc surface) const;
  /// Fills in what a body's description names: its material, its mesh, its parts.
  [[nodiscard]] BodyDesc resolve(const SceneBody& body);
  /// Returns what a shape of this kind collides by: the mesh itself, or a closed surface made of it.
  MeshId mesh_of(ShapeKind kind, const std::string& name, bool moves);
  /// Returns the closed surface of a mesh. If there is none it says why, and returns null.
  MeshId solid_mesh_of(const std::string& name);
  /// Pins points of a solid that was made. Returns whether there was room for them.
  bool pin_points(const SceneSolid& solid, SolidId id, const std::string& path);
  /// Says what was added to the cells of a solid so that it is one piece.
  void note_additions(const SolidDesc& desc, const std::string& mesh, const std::string& path);
  /// Adds the connection points of an object. Those of a mesh that it is made of are placed in its frame,
  /// under other names.
  void add_places_of(const std::string& mesh, Vec3 position, Quat rotation,
                     std::vector<ConnectionPointDesc>& points) const;
  /// Returns what is drawn for a shape that refers to a mesh of this name; null for other shapes.
  std::shared_ptr<const Model> drawn_model(ShapeKind kind, const std::string& mesh);
  std::vector<SceneObject::Part> drawn_parts(const SceneBody& body);
  [[nodiscard]] SceneObject make_object(const SceneTag& tag, SceneObject::Kind kind, const std::string& path,
                                        std::size_t instance) const;
  /// Returns the object that copy `i` of a hook names; null for the world.
  Result<const SceneObject*> find_end(const std::string& name, const SceneArray& array, std::size_t i) const;
  /// Returns the object at an end of copy `i` of a hook; of a fractured body without a number, the cell that
  /// the hook's anchor or the end's connection point chooses.
  Result<const SceneObject*> find_hooked(const SceneHook& hook, const EndName& end, std::size_t i) const;
  /// Returns the closed surface of a body that is to be divided. If there is none it says why.
  std::optional<MeshDesc> surface_of(const SceneBody& body, const std::string& path);
  /// Adds the cells of the copies of a body that is broken beforehand, and their glue.
  void build_fractured(const SceneBody& body, BodyDesc desc, const std::string& path);
  bool keep_cells(const SceneBody& body, const Fracture& pieces, const FracturedBody& made,
                  const std::string& path);
  [[nodiscard]] HookEnd end_at(const SceneObject* object, const std::optional<ScenePoint>& point) const;
  /// Splits the name of an end into an object, or the first copy of an array, and a point.
  [[nodiscard]] EndName split_end(const std::string& name) const;
  template <class IdType>
  bool keep(SceneObject& object, IdType SceneObject::*member, const Result<IdType>& added);
  /// Returns the points of one instance that a pin holds.
  std::vector<std::uint32_t> pick(const ScenePin& pin, const std::vector<DVec3>& points, std::size_t columns);
  std::vector<PinDesc> pins_of(const std::vector<ScenePin>& pins, const std::vector<DVec3>& points,
                               std::size_t columns, const std::string& path);

  SimulationData& data_;
  std::vector<Error>& errors_;
};

bool Builder::reserve(std::size_t points, const std::string& path) {
  data_.points += points;
  if (data_.points <= kMostScenePoints) return true;
  fail(path, ErrorCode::kLimitExceeded,
       "with this object the scene has more than " + std::to_string(kMostScenePoints) + " points");
  return false;
}

const SceneMaterial* Builder::find_material(const std::string& name) const {
  const auto found = data_.material_of.find(name);
  return found == data_.material_of.end() ? nullptr : &data_.scene.materials[found->second];
}

Real Builder::friction_of(const SceneTag& tag) const {
  if (tag.friction.has_value()) return *tag.friction;
  const SceneMaterial* material = find_material(tag.material);
  return material != nullptr ? material->friction : ContactDesc{}.friction;
}

ContactDesc Builder::surface_of(const std::string& name, ContactDesc surface) const {
  const SceneMaterial* material = find_material(name);
  if (material == nullptr) return surface;
  surface.friction = material->friction;
  surface.static_friction = material->static_friction;
  surface.restitution = material->restitution;
  surface.rolling_friction = material->rolling_friction;
  surface.spinning_friction = material->spinning_friction;
  surface.material = material_number(data_.scene, name);
  return surface;
}

MeshId Builder::mesh_of(ShapeKind kind, const std::string& name, bool moves) {
  const auto found = data_.models.find(name);
  if (found == data_.models.end()) return {};
  if (kind != ShapeKind::kMesh) return found->second.id;
  return moves || is_made_of_voxels(data_.scene, name) ? solid_mesh_of(name) : found->second.id;
}

MeshId Builder::solid_mesh_of(const std::string& name) {
  const Result<MeshId> solid = find_solid_mesh(data_, name);
  if (solid) return solid.value();
  fail("meshes." + name + solid.error().where, solid.error().code, solid.error().message);
  return {};
}

BodyDesc Builder::resolve(const SceneBody& body) {
  const bool moves = body.desc.kind == BodyKind::kDynamic;
  BodyDesc desc = body.desc;
  desc.contact = surface_of(body.tag.material, desc.contact);
  desc.contact.friction = friction_of(body.tag);
  desc.shape.mesh = mesh_of(desc.shape.kind, body.mesh, moves);
  add_places_of(body.mesh, {}, {}, desc.connection_points);
  for (const ScenePart& part : body.parts) {
    PartDesc made = part.desc;
    made.shape.mesh = mesh_of(made.shape.kind, part.mesh, moves);
    made.contact = part.material.empty() ? desc.contact : surface_of(part.material, made.contact);
    desc.parts.push_back(made);
    add_places_of(part.mesh, made.position, normalize(made.rotation), desc.connection_points);
  }
  return desc;
}

void Builder::add_places_of(const std::string& mesh, Vec3 position, Quat rotation,
                            std::vector<ConnectionPointDesc>& points) const {
  const auto found = data_.models.find(mesh);
  if (found == data_.models.end()) return;
  const Quaternion<double> turn = {rotation.x, rotation.y, rotation.z, rotation.w};
  for (ConnectionPointDesc point : found->second.connection_points) {
    const auto same = [&](const ConnectionPointDesc& one) { return one.name == point.name; };
    if (std::any_of(points.begin(), points.end(), same)) continue;
    point.position = vector_cast<double>(position) + rotate(turn, point.position);
    points.push_back(point);
  }
}

/// Makes a model that shows each face as flat.
std::shared_ptr<const Model> flat_model(const MeshDesc& faces) {
  // This crease angle [rad] is far less than that of any two faces of a hull that the eye can tell apart.
  constexpr double kFlat = 1e-3;
  return std::make_shared<const Model>(model_of(faces, kFlat));
}

/// Makes polygons as fans, with flat faces. It returns null for points without a hull, which the world then
/// reports.
std::shared_ptr<const Model> hull_model(const MeshDesc& mesh) {
  const Result<geometry::ConvexHull> hull = geometry::make_convex_hull(mesh.positions);
  if (!hull) return nullptr;
  MeshDesc faces;
  faces.positions = hull.value().vertices;
  for (const geometry::ConvexHull::Face& face : hull.value().faces) {
    const auto corner = [&](std::size_t k) -> std::uint32_t { return hull.value().loop[face.first + k]; };
    for (std::size_t k = 1; k + 1 < face.count; ++k) {
      faces.triangles.push_back({corner(0), corner(k), corner(k + 1)});
    }
  }
  return flat_model(faces);
}

std::shared_ptr<const Model> Builder::drawn_model(ShapeKind kind, const std::string& mesh) {
  const auto found = data_.models.find(mesh);
  if (found == data_.models.end()) return nullptr;
  SceneModel& model = found->second;
  if (kind != ShapeKind::kHull) return model.model;
  if (model.hull == nullptr) model.hull = hull_model(model.model->mesh);
  return model.hull;
}

std::vector<SceneObject::Part> Builder::drawn_parts(const SceneBody& body) {
  std::vector<SceneObject::Part> parts;
  for (const ScenePart& part : body.parts) {
    const std::string& material = part.material.empty() ? body.tag.material : part.material;
    const SceneMaterial* look = find_material(material);
    parts.push_back({.shape = part.desc.shape,
                     .position = part.desc.position,
                     .rotation = normalize(part.desc.rotation),
                     .model = drawn_model(part.desc.shape.kind, part.mesh),
                     .look = look != nullptr ? *look : SceneMaterial{},
                     .material = material});
  }
  return parts;
}

SceneObject Builder::make_object(const SceneTag& tag, SceneObject::Kind kind, const std::string& path,
                                 std::size_t instance) const {
  SceneObject object;
  object.name = tag.name.empty() ? path : tag.name;
  if (tag.array.kind != SceneArray::Kind::kSingle) object.name = indexed(object.name, instance);
  object.kind = kind;
  object.path = path;
  object.material = tag.material;
  object.stepper = tag.stepper;
  const SceneMaterial* material = find_material(tag.material);
  if (material != nullptr) object.look = *material;
  return object;
}

template <class IdType>
bool Builder::keep(SceneObject& object, IdType SceneObject::*member, const Result<IdType>& added) {
  if (!added) {
    if (!full()) errors_.push_back(scene_error(data_.scene, object.path, added.error()));
    return false;
  }
  object.*member = added.value();
  data_.row_of[object.name] = data_.objects.size();
  data_.objects.push_back(std::move(object));
  data_.saved_objects = nullptr;
  return true;
}

std::vector<std::uint32_t> Builder::pick(const ScenePin& pin, const std::vector<DVec3>& points,
                                         std::size_t columns) {
  const std::size_t rows = columns > 0 ? points.size() / columns : 0;
  const std::size_t lines = pin.pick == ScenePin::Pick::kPoint    ? points.size()
                            : pin.pick == ScenePin::Pick::kColumn ? columns
                                                                  : rows;
  const std::size_t line = pin.point.last && lines > 0 ? lines - 1 : pin.point.index;
  const auto highest = std::max_element(points.begin(), points.end(),
                                        [](const DVec3& a, const DVec3& b) { return a.y < b.y; });
  const auto picked = [&](std::size_t i) {
    switch (pin.pick) {
      case ScenePin::Pick::kPoint:
        return i == line;
      case ScenePin::Pick::kColumn:
        return columns > 0 && i % columns == line;
      case ScenePin::Pick::kRow:
        return columns > 0 && i / columns == line;
      case ScenePin::Pick::kTopmost:
        return points[i].y >= highest->y - static_cast<double>(pin.within);
    }
    return false;
  };
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (picked(i)) result.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

std::vector<PinDesc> Builder::pins_of(const std::vector<ScenePin>& pins, const std::vector<DVec3>& points,
                                      std::size_t columns, const std::string& path) {
  std::vector<PinDesc> result;
  std::vector<bool> held(points.size(), false);
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const std::vector<std::uint32_t> picked = pick(pins[i], points, columns);
    if (picked.empty()) fail(indexed(path + ".pins", i), ErrorCode::kOutOfRange, "there is no such point");
    for (const std::uint32_t point : picked) {
      // The first pin of a point counts, because a corner belongs to a row and to a column.
      if (!held[point]) result.push_back({.point = point, .motion = pins[i].motion});
      held[point] = true;
    }
  }
  return result;
}

std::vector<LoadDesc> loads_of(const std::vector<SceneLoad>& loads, std::size_t count) {
  std::vector<LoadDesc> result;
  for (const SceneLoad& load : loads) {
    const std::size_t index = load.point.last && count > 0 ? count - 1 : load.point.index;
    result.push_back({.point = static_cast<std::uint32_t>(index), .mass = load.mass});
  }
  return result;
}

std::vector<DVec3> points_of(const RopeDesc& rope) {
  if (!rope.points.empty()) return rope.points;
  const auto segments = static_cast<double>(std::max(rope.masses - 1, 1));
  const DVec3 step =
      (static_cast<double>(rope.length_at_rest) / segments) * normalize(vector_cast<double>(rope.direction));
  std::vector<DVec3> points(static_cast<std::size_t>(std::max(rope.masses, 0)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = rope.hook_point + static_cast<double>(i) * step;
  }
  return points;
}

std::vector<DVec3> points_of(const ClothDesc& cloth, const Model* model) {
  std::vector<DVec3> points;
  if (model != nullptr) {
    const Quaternion<double> turn = {cloth.rotation.x, cloth.rotation.y, cloth.rotation.z, cloth.rotation.w};
    for (const Vec3& vertex : model->mesh.positions) {
      points.push_back(cloth.position + rotate(normalize(turn), vector_cast<double>(vertex)));
    }
    return points;
  }
  const DVec3 right = (static_cast<double>(cloth.width) / std::max(cloth.columns - 1, 1)) *
                      normalize(vector_cast<double>(cloth.column_direction));
  const DVec3 down = (static_cast<double>(cloth.height) / std::max(cloth.rows - 1, 1)) *
                     normalize(vector_cast<double>(cloth.row_direction));
  for (int row = 0; row < cloth.rows; ++row) {
    for (int column = 0; column < cloth.columns; ++column) {
      points.push_back(cloth.corner + static_cast<double>(column) * right + static_cast<double>(row) * down);
    }
  }
  return points;
}

/// Moves the connection points of a copy of an object whose points are given in the world.
std::vector<ConnectionPointDesc> moved(std::vector<ConnectionPointDesc> points, DVec3 offset) {
  for (ConnectionPointDesc& point : points) point.position += offset;
  return points;
}

double length_of(const std::vector<DVec3>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += length(points[i] - points[i - 1]);
  return sum;
}

void Builder::build(const SceneBody& body, const std::string& path) {
  const std::size_t before = errors_.size();
  BodyDesc desc = resolve(body);
  if (errors_.size() > before) return;
  if (body.fracture) return build_fractured(body, std::move(desc), path);
  const std::shared_ptr<const Model> model = drawn_model(body.desc.shape.kind, body.mesh);
  const std::vector<SceneObject::Part> parts = drawn_parts(body);
  for (std::size_t i = 0; i < body.tag.array.count() && !full(); ++i) {
    if (!reserve(std::max<std::size_t>(parts.size(), 1), path)) return;
    desc.position = body.desc.position + body.tag.array.offset(i);
    desc.rotation = normalize(body.tag.array.rotation(i)) * normalize(body.desc.rotation);
    SceneObject object = make_object(body.tag, SceneObject::Kind::kBody, path, i);
    object.shape = desc.shape;
    object.parts = parts;
    object.model = model;
    object.blade = body.blade;
    if (!body.visual.empty()) object.visual = data_.models[body.visual].model;
    if (!keep(object, &SceneObject::body, data_.world.add_body(placed(desc, data_.placement)))) return;
  }
}

MeshDesc box_mesh(Vec3 half_extents) {
  return geometry::mesh_of(geometry::make_box_hull(half_extents));
}

std::optional<MeshDesc> Builder::surface_of(const SceneBody& body, const std::string& path) {
  const Shape& shape = body.desc.shape;
  if (shape.kind == ShapeKind::kBox) return box_mesh(shape.half_extents);
  if (shape.kind == ShapeKind::kMesh) {
    if (!solid_mesh_of(body.mesh)) return std::nullopt;
    return data_.solid_surfaces[body.mesh];
  }
  const auto found = data_.models.find(body.mesh);
  if (found == data_.models.end()) return std::nullopt;
  const Result<geometry::ConvexHull> hull = geometry::make_convex_hull(found->second.model->mesh.positions);
  if (hull) return geometry::mesh_of(hull.value());
  fail(path + ".shape.hull", hull.error().code, hull.error().message);
  return std::nullopt;
}

bool Builder::keep_cells(const SceneBody& body, const Fracture& pieces, const FracturedBody& made,
                         const std::string& path) {
  const std::string name = body.tag.name.empty() ? path : body.tag.name;
  const auto next_number = [&](const std::string& array) {
    std::size_t number = 0;
    while (data_.row_of.contains(indexed(array, number))) ++number;
    return number;
  };
  const std::size_t first = next_number(name);
  for (std::size_t i = 0; i < made.bodies.size(); ++i) {
    const FractureCell& cell = pieces.cells[i];
    SceneObject object = make_object({.material = body.tag.material}, SceneObject::Kind::kBody, path, 0);
    object.name = indexed(name, first + i);
    object.shape = cell.is_convex ? Shape::hull_of(made.meshes[i]) : Shape::of_mesh(made.meshes[i]);
    object.model = cell.is_convex ? hull_model(cell.mesh) : flat_model(cell.mesh);
    if (!keep(object, &SceneObject::body, Result<BodyId>(made.bodies[i]))) return false;
  }
  const std::size_t first_glue = next_number(glue_name(name));
  for (std::size_t k = 0; k < made.hooks.size(); ++k) {
    SceneObject object = make_object({}, SceneObject::Kind::kHook, path, 0);
    object.name = indexed(glue_name(name), first_glue + k);
    object.hook_kind = HookKind::kFixed;
    object.hooked = {indexed(name, first + pieces.bonds[k].a), indexed(name, first + pieces.bonds[k].b)};
    if (!keep(object, &SceneObject::hook, Result<HookId>(made.hooks[k]))) return false;
  }
  return true;
}

void Builder::build_fractured(const SceneBody& body, BodyDesc desc, const std::string& path) {
  const std::optional<MeshDesc> surface = surface_of(body, path);
  if (!surface) return;
  const Result<Fracture> pieces = fracture(*surface, body.fracture->desc);
  if (!pieces) {
    const std::string where = pieces.error().where.starts_with("mesh") ? "" : "." + pieces.error().where;
    return fail(path + ".fracture" + where, pieces.error().code, pieces.error().message);
  }
  const std::size_t points = pieces.value().cells.size() + pieces.value().bonds.size();
  for (std::size_t i = 0; i < body.tag.array.count() && !full(); ++i) {
    if (!reserve(points, path)) return;
    desc.position = body.desc.position + body.tag.array.offset(i);
    desc.rotation = normalize(body.tag.array.rotation(i)) * normalize(body.desc.rotation);
    const Result<FracturedBody> made =
        add_fractured(data_.world, pieces.value(), placed(desc, data_.placement), body.fracture->strength);
    if (!made)
      return fail(path + ".fracture", made.error().code, made.error().where + ": " + made.error().message);
    if (!keep_cells(body, pieces.value(), made.value(), path)) return;
  }
}

void Builder::build(const SceneRope& rope, const std::string& path) {
  RopeDesc desc = rope.desc;
  const std::vector<DVec3> points = points_of(desc);
  desc.contact.friction = friction_of(rope.tag);
  desc.pins = pins_of(rope.pins, points, 0, path);
  desc.loads = loads_of(rope.loads, points.size());
  for (std::size_t i = 0; i < rope.tag.array.count() && !full(); ++i) {
    if (!reserve(points.size(), path)) return;
    const DVec3 offset = rope.tag.array.offset(i);
    desc.hook_point = rope.desc.hook_point + offset;
    for (std::size_t k = 0; k < desc.points.size(); ++k) desc.points[k] = rope.desc.points[k] + offset;
    desc.connection_points = moved(rope.desc.connection_points, offset);
    SceneObject object = make_object(rope.tag, SceneObject::Kind::kRope, path, i);
    object.radius = desc.radius;
    object.rest_length = desc.points.empty() ? static_cast<double>(desc.length_at_rest) : length_of(points);
    if (!keep(object, &SceneObject::rope, data_.world.add_rope(placed(desc, data_.placement)))) return;
  }
}

void Builder::build(const SceneCloth& cloth, const std::string& path) {
  ClothDesc desc = cloth.desc;
  SceneModel model;
  if (!cloth.mesh.empty()) {
    model = data_.models[cloth.mesh];
    desc.mesh = model.id;
    add_places_of(cloth.mesh, {}, {}, desc.connection_points);
  }
  const std::vector<DVec3> points = points_of(desc, model.model.get());
  const std::size_t columns = model.model == nullptr ? static_cast<std::size_t>(desc.columns) : 0;
  desc.contact.friction = friction_of(cloth.tag);
  desc.pins = pins_of(cloth.pins, points, columns, path);
  desc.loads = loads_of(cloth.loads, points.size());
  for (std::size_t i = 0; i < cloth.tag.array.count() && !full(); ++i) {
    if (!reserve(points.size(), path)) return;
    desc.corner = cloth.desc.corner + cloth.tag.array.offset(i);
    desc.position = cloth.desc.position + cloth.tag.array.offset(i);
    if (columns > 0) desc.connection_points = moved(cloth.desc.connection_points, cloth.tag.array.offset(i));
    SceneObject object = make_object(cloth.tag, SceneObject::Kind::kCloth, path, i);
    object.radius = Real(0.5) * desc.thickness;
    object.columns = static_cast<std::uint32_t>(columns);
    object.rows = columns > 0 ? static_cast<std::uint32_t>(desc.rows) : 0;
    object.model = model.model;
    if (!keep(object, &SceneObject::cloth, data_.world.add_cloth(placed(desc, data_.placement)))) return;
  }
}

void Builder::note_additions(const SolidDesc& desc, const std::string& mesh, const std::string& path) {
  const auto cell = static_cast<double>(desc.cell);
  // What fill_solid refuses, the world reports.
  const auto additions = geometry::measure_additions(data_.solid_surfaces[mesh], cell);
  if (!additions || additions.value().thin + additions.value().bridges == 0) return;
  const geometry::CellAdditions& added = additions.value();
  const std::string joined =
      std::to_string(added.bridges) + " to join " + std::to_string(added.pieces) + " pieces";
  const std::string text =
      added.thin > 0
          ? "is thinner than its cells in places: " + std::to_string(added.thin) +
                " cells were added along thin parts, which are as thick as a cell now, and " + joined
          : "has parts that do not hold together in its cells: cells were added, " + joined;
  data_.notes.push_back(error_at(data_.scene.source.get(), path + ".cell", ErrorCode::kOutOfRange,
                                 text + "; a smaller 'cell' needs fewer"));
}

void Builder::build(const SceneSolid& solid, const std::string& path) {
  SolidDesc desc = solid.desc;
  const std::string& visual = solid.visual.empty() ? solid.mesh : solid.visual;
  std::shared_ptr<const Model> model;
  double volume = 0;
  if (!solid.mesh.empty()) {
    const bool is_filled = desc.elasticity == SolidDesc::Elasticity::kTetrahedra;
    desc.mesh = is_filled ? solid_mesh_of(solid.mesh) : data_.models[solid.mesh].id;
    if (!desc.mesh) return;
    if (is_filled) note_additions(desc, solid.mesh, path);
    volume = data_.models[solid.mesh].volume;
    add_places_of(solid.mesh, {}, {}, desc.connection_points);
  }
  if (!visual.empty()) {
    model = data_.models[visual].model;
    // What is drawn is carried along unless it is the filled surface itself, which is so anyway.
    if (data_.models[visual].id != desc.mesh) desc.visual = data_.models[visual].id;
  }
  desc.contact.friction = friction_of(solid.tag);
  for (std::size_t i = 0; i < solid.tag.array.count() && !full(); ++i) {
    desc.position = solid.desc.position + solid.tag.array.offset(i);
    SceneObject object = make_object(solid.tag, SceneObject::Kind::kSolid, path, i);
    object.radius = Real(0.5) * desc.thickness;
    object.model = model;
    object.mesh_volume = volume;
    if (!solid.visual.empty()) object.visual = model;
    const Result<SolidId> added = data_.world.add_solid(placed(desc, data_.placement));
    if (!keep(object, &SceneObject::solid, added)) return;
    if (!pin_points(solid, added.value(), path)) return;
  }
}

bool Builder::pin_points(const SceneSolid& solid, SolidId id, const std::string& path) {
  // The points of a solid made of a mesh are known only now.
  std::vector<DVec3> points(data_.world.positions(id).size());
  for (std::size_t k = 0; k < points.size(); ++k)
    points[k] = data_.placement.own_point(data_.world.positions(id)[k]);
  if (!reserve(points.size(), path)) return false;
  for (const PinDesc& pin : pins_of(solid.pins, points, 0, path)) {
    const MotionDesc motion = placed(pin.motion, data_.placement);
    (void)data_.world.pin(point(id, pin.point), motion);  // The motion was checked before.
  }
  return true;
}

void Builder::build(const SceneParticles& particles, const std::string& path) {
  ParticlesDesc desc = particles.desc;
  std::vector<DVec3> points;
  for (const ParticleDesc& particle : desc.particles) points.push_back(particle.position);
  desc.contact.friction = friction_of(particles.tag);
  desc.pins = pins_of(particles.pins, points, 0, path);
  for (std::size_t i = 0; i < particles.tag.array.count() && !full(); ++i) {
    if (!reserve(points.size(), path)) return;
    const DVec3 offset = particles.tag.array.offset(i);
    for (std::size_t k = 0; k < points.size(); ++k) desc.particles[k].position = points[k] + offset;
    desc.connection_points = moved(particles.desc.connection_points, offset);
    SceneObject object = make_object(particles.tag, SceneObject::Kind::kParticles, path, i);
    object.radius = desc.particles.front().radius;
    if (!keep(object, &SceneObject::particles, data_.world.add_particles(placed(desc, data_.placement))))
      return;
  }
}

void Builder::build(const SceneField& field, const std::string& path) {
  SceneObject object;
  object.name = field.name.empty() ? path : field.name;
  object.kind = SceneObject::Kind::kField;
  object.path = path;
  const FieldDesc desc = placed(field.desc, data_.placement, data_.world.desc().gravity);
  keep(object, &SceneObject::field, data_.world.add_field(desc));
}

Result<const SceneObject*> Builder::find_end(const std::string& name, const SceneArray& array,
                                             std::size_t i) const {
  if (name.empty()) return static_cast<const SceneObject*>(nullptr);
  auto found = data_.row_of.find(name);
  if (array.kind != SceneArray::Kind::kSingle) {
    // An object without a name is called by its path, which looks like the name of a copy.
    const bool is_path = found != data_.row_of.end() && data_.objects[found->second].path == name;
    const std::optional<CopyName> first = is_path ? std::nullopt : take_copy_name(name);
    if (found == data_.row_of.end()) {
      found = data_.row_of.find(indexed(name, i));
    } else if (first) {
      found = data_.row_of.find(indexed(first->array, first->copy + i));
    }
  }
  if (found != data_.row_of.end()) return &data_.objects[found->second];
  return Error{ErrorCode::kStaleId, "", "there is no object " + in_quotes(name) + " any more"};
}

EndName Builder::split_end(const std::string& name) const {
  const bool is_object = data_.row_of.contains(name) || data_.row_of.contains(indexed(name, 0));
  return is_object ? EndName{name} : take_end_name(name);
}

Result<const SceneObject*> Builder::find_hooked(const SceneHook& hook, const EndName& end,
                                                std::size_t i) const {
  const bool any_cell = hook.array.kind == SceneArray::Kind::kSingle && !data_.row_of.contains(end.object) &&
                        data_.row_of.contains(indexed(end.object, 0));
  if (!any_cell) return find_end(end.object, hook.array, i);
  const DVec3 anchor = data_.placement.point(hook.anchor.value_or(DVec3{}));
  const SceneObject* cell = find_cell(data_, end, anchor);
  if (cell != nullptr) return cell;
  return Error{
      ErrorCode::kOutOfRange, "",
      "no cell of " + in_quotes(end.object) + " has the connection point " + in_quotes(end.connection_point)};
}

HookEnd Builder::end_at(const SceneObject* object, const std::optional<ScenePoint>& wanted) const {
  if (object == nullptr) return {};
  if (object->kind == SceneObject::Kind::kBody) return {.body = object->body};
  PointRef point = point_of(data_.world, *object, wanted.value_or(ScenePoint{}));
  if (!wanted) point.index = PointRef::kNearest;
  return {.point = point};
}

void Builder::build(const SceneHook& hook, const std::string& path) {
  HookDesc desc = hook.desc;
  for (std::size_t i = 0; i < hook.array.count() && !full(); ++i) {
    if (!reserve(1, path)) return;
    const EndName name_a = split_end(hook.a);
    const EndName name_b = split_end(hook.b);
    const Result<const SceneObject*> a = find_hooked(hook, name_a, i);
    const Result<const SceneObject*> b = find_hooked(hook, name_b, i);
    if (!a || !b) {
      const Error& error = a ? b.error() : a.error();
      return fail(path + (a ? ".b" : ".a"), error.code, error.message);
    }
    desc.a = end_at(a.value(), hook.a_point);
    desc.b = end_at(b.value(), hook.b_point);
    desc.a.connection_point = name_a.connection_point;
    desc.b.connection_point = name_b.connection_point;
    const std::array<std::string, 2> held = {a.value() != nullptr ? a.value()->name : "",
                                             b.value() != nullptr ? b.value()->name : ""};
    const DVec3 offset = hook.array.offset(i);
    desc.anchor = hook.anchor.value_or(DVec3{}) + offset;
    if (hook.desc.anchor_b) desc.anchor_b = *hook.desc.anchor_b + offset;
    SceneObject object =
        make_object({.name = hook.name, .array = hook.array}, SceneObject::Kind::kHook, path, i);
    object.hook_kind = desc.kind;
    object.hooked = held;
    if (!keep(object, &SceneObject::hook, data_.world.add_hook(placed(desc, data_.placement)))) return;
  }
}

SeamEdge edge_at(const World& world, const SceneObject& object, const std::string& edge,
                 const std::vector<std::uint32_t>& points) {
  SeamEdge made;
  made.object = point_of(world, object, ScenePoint{});
  made.edge = edge;
  made.points = points;
  return made;
}

void Builder::build(const SceneSeam& seam, const std::string& path) {
  const EndName name_a = split_end(seam.a);
  const EndName name_b = split_end(seam.b);
  std::size_t stitch = 0;
  for (std::size_t i = 0; i < seam.array.count() && !full(); ++i) {
    const Result<const SceneObject*> a = find_end(name_a.object, seam.array, i);
    const Result<const SceneObject*> b = find_end(name_b.object, seam.array, i);
    if (!a || !b) {
      const Error& error = a ? b.error() : a.error();
      return fail(path + (a ? ".b" : ".a"), error.code, error.message);
    }
    SeamDesc desc;
    desc.a = edge_at(data_.world, *a.value(), name_a.connection_point, seam.a_points);
    desc.b = edge_at(data_.world, *b.value(), name_b.connection_point, seam.b_points);
    desc.strength = seam.strength;
    const std::array<std::string, 2> held = {a.value()->name, b.value()->name};
    const Result<std::vector<HookId>> sewn = data_.world.sew(desc);
    if (!sewn) {
      errors_.push_back(scene_error(data_.scene, path, sewn.error()));
      return;
    }
    if (!reserve(sewn.value().size(), path)) return;
    for (const HookId id : sewn.value()) {
      SceneObject object = make_object({.name = seam.name}, SceneObject::Kind::kHook, path, 0);
      object.name = indexed(object.name, stitch++);
      object.hooked = held;
      if (!keep(object, &SceneObject::hook, Result<HookId>(id))) return;
    }
  }
}

template <class T>
void build_list(Builder& builder, const std::vector<T>& list, const std::string& name) {
  for (std::size_t i = 0; i < list.size(); ++i) builder.build(list[i], indexed(name, i));
}

}  // namespace

std::uint16_t material_number(const Scene& scene, const std::string& name) {
  const auto named = [&](const SceneMaterial& material) { return material.name == name; };
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(), named);
  return found == scene.materials.end() ? 0 : static_cast<std::uint16_t>(found - scene.materials.begin() + 1);
}

WorldDesc world_of(const Scene& scene) {
  WorldDesc desc = scene.world;
  for (const ScenePair& pair : scene.material_pairs) {
    desc.materials.push_back(pair.desc);
    desc.materials.back().a = material_number(scene, pair.a);
    desc.materials.back().b = material_number(scene, pair.b);
  }
  return desc;
}

void build_objects(const SceneObjects& objects, const std::string& prefix, SimulationData& data,
                   std::vector<Error>& errors) {
  Builder builder(data, errors);
  build_list(builder, objects.bodies, prefix + "bodies");
  build_list(builder, objects.ropes, prefix + "ropes");
  build_list(builder, objects.cloths, prefix + "cloths");
  build_list(builder, objects.solids, prefix + "solids");
  build_list(builder, objects.particles, prefix + "particles");
  build_list(builder, objects.fields, prefix + "fields");
  build_list(builder, objects.hooks, prefix + "hooks");
  build_list(builder, objects.seams, prefix + "seams");
}

void index_objects(SimulationData& data) {
  data.saved_objects = nullptr;
  data.row_of.clear();
  for (std::size_t i = 0; i < data.objects.size(); ++i) data.row_of[data.objects[i].name] = i;
}

PointRef point_of(const World& world, const SceneObject& object, ScenePoint wanted) {
  const auto index = [&](std::size_t count) {
    return wanted.last && count > 0 ? static_cast<std::uint32_t>(count - 1) : wanted.index;
  };
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      return point(object.rope, index(world.positions(object.rope).size()));
    case SceneObject::Kind::kCloth:
      return point(object.cloth, index(world.positions(object.cloth).size()));
    case SceneObject::Kind::kSolid:
      return point(object.solid, index(world.positions(object.solid).size()));
    case SceneObject::Kind::kParticles:
      return point(object.particles, index(world.positions(object.particles).size()));
    default:
      return {};
  }
}

Error scene_error(const Scene& scene, const std::string& path, const Error& error) {
  const std::size_t dot = error.where.find('.');
  std::string rest = dot == std::string::npos ? "" : error.where.substr(dot);
  // The world names members by their path in the description, which is another one in the scene.
  if (rest.starts_with(".parts[")) rest.insert(0, ".shape");
  if (rest.starts_with(".contact.")) rest.erase(0, std::string_view(".contact").size());
  if (rest.starts_with(".pins[")) rest = ".pins";
  return error_at(scene.source.get(), path + rest, error.code, error.message);
}

}  // namespace hooke::io
