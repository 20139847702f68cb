#include "io/scene/scene_check.h"

#include "io/scene/material_library.h"
#include "io/scene/scene_event.h"
#include "io/scene/scene_source.h"
#include "io/scene/scene_subject.h"

#include <algorithm>
#include <filesystem>
#include <unordered_map>
#include <unordered_set>

namespace hooke::io {

namespace {

/// This is what a name stands for.
struct NamedObject {
  std::string path = {};
  SceneObject::Kind kind = SceneObject::Kind::kBody;
  bool is_array = false;
  std::size_t instances = 1;
  std::size_t points = 0;  ///< Points of each instance; 0 if not known.
  const SceneBody* body = nullptr;
  std::optional<HookKind> hook = {};
};

/// Whether objects of a kind may snap, tear or be cut.
bool breaks(SceneObject::Kind kind) {
  return kind == SceneObject::Kind::kRope || kind == SceneObject::Kind::kCloth ||
         kind == SceneObject::Kind::kSolid;
}

class Checker {
 public:
  Checker(const Scene& scene, const JsonDocument& document, std::vector<JsonError>& errors,
          std::vector<JsonError>& ignored)
      : scene_(scene),
        document_(document),
        errors_(errors),
        ignored_(ignored),
        found_before_(errors.size()) {}

  void collect_names();
  void check_references();
  void check_files(bool look);
  void check_points();
  void check_total();

 private:
  void fail(const std::string& path, ErrorCode code, std::string reason) {
    if (full()) return;
    errors_.push_back({document_.find_closest(path).offset, {code, path, std::move(reason)}});
  }
  [[nodiscard]] bool full() const { return errors_.size() >= kMostErrors; }
  /// Reports that what stands at this path changes nothing.
  void ignore(const std::string& path, const std::string& reason) {
    if (ignored_.size() >= kMostErrors) return;
    ignored_.push_back(
        {document_.find_closest(path).offset, {ErrorCode::kOutOfRange, path, "has no effect: " + reason}});
  }
  /// Tells whether the reader found an error here. Members may then be defaults, and more errors would
  /// mislead.
  [[nodiscard]] bool is_damaged(const std::string& path) const {
    return std::any_of(errors_.begin(), errors_.begin() + static_cast<std::ptrdiff_t>(found_before_),
                       [&](const JsonError& one) { return one.error.where.starts_with(path); });
  }
  void add_name(const std::string& name, const NamedObject& object);
  void collect(const SceneObjects& objects, const std::string& prefix);
  void collect_body(const SceneBody& body, const std::string& path);
  void collect_hooks(const SceneObjects& objects, const std::string& prefix);
  void check_tag(const SceneTag& tag, const std::string& path);
  void check_pairs();
  void check_material(const std::string& name, const std::string& path);
  void check_mesh_name(const std::string& name, const std::string& path);
  void check_references(const SceneObjects& objects, const std::string& prefix);
  void check_body(const SceneBody& body, const std::string& path);
  void check_hook(const SceneHook& hook, const std::string& path);
  /// Tells whether this is the name of a fractured body, and not of one of its cells.
  [[nodiscard]] bool names_any_cell(const std::string& name) const;
  void check_hook_end(const SceneHook& hook, const std::string& end, const std::optional<ScenePoint>& point,
                      const std::string& path);
  /// A ball hook that holds points leaves their rotation free, so that rotational keys do nothing.
  void check_ball_of_points(const SceneHook& hook, const std::string& path);
  void check_seam(const SceneSeam& seam, const std::string& path);
  void check_seam_edge(const SceneSeam& seam, const std::string& edge,
                       const std::vector<std::uint32_t>& points, const std::string& path);
  /// Checks that an end has as many copies as an array counts through.
  void check_copies(const SceneArray& array, const std::string& name, const NamedObject& object,
                    const std::string& path);
  void check_event(const SceneEvent& event, const std::string& path);
  void check_event_on_body(const SceneEvent& event, const SceneBody& body, const std::string& inner);
  void check_event_on_points(const SceneEvent& event, const NamedObject& object, const std::string& inner);
  void check_expectation(const SceneExpectation& expectation, const std::string& path);
  void check_subject(const SceneExpectation& expectation, Subject subject, const NamedObject& object,
                     const std::string& path);
  /// Returns the object of a name, or of the name of its array, whatever its copy; null after an error.
  const NamedObject* find_named(const std::string& name, const std::string& path);
  const NamedObject* find_object(const std::string& name, const std::string& path);
  /// Tells whether an object or array has this name, or whether it names a copy of one.
  [[nodiscard]] bool is_known(const std::string& name) const;
  void check_point(ScenePoint point, std::size_t count, const std::string& path);
  void check_pins(const std::vector<ScenePin>& pins, std::size_t count, const ClothDesc* grid,
                  const std::string& path);
  void check_loads(const std::vector<SceneLoad>& loads, std::size_t count, const std::string& path);
  void check_points(const SceneObjects& objects, const std::string& prefix);
  void check_springs(const ParticlesDesc& particles, const std::string& path);
  void count_points(const SceneObjects& objects, const std::string& prefix);

  const Scene& scene_;
  const JsonDocument& document_;
  std::vector<JsonError>& errors_;
  std::vector<JsonError>& ignored_;
  std::size_t found_before_;
  std::unordered_map<std::string, NamedObject> objects_;
  std::unordered_set<std::string> materials_;
  std::unordered_set<std::string> meshes_;
  std::size_t total_ = 0;
  /// Whether some name was not read; references to it would seem to refer to nothing.
  bool names_damaged_ = false;
};

bool has_points(SceneObject::Kind kind) {
  return kind == SceneObject::Kind::kRope || kind == SceneObject::Kind::kCloth ||
         kind == SceneObject::Kind::kSolid || kind == SceneObject::Kind::kParticles;
}

std::size_t saturated_product(std::size_t a, std::size_t b) {
  constexpr std::size_t kFar = std::size_t{1} << 40U;
  if (a == 0 || b == 0) return 0;
  return a > kFar / b ? kFar : a * b;
}

template <class T>
std::string closest_name(const std::vector<T>& list, const std::string& name) {
  for (const T& one : list) {
    if (edit_distance_up_to_2(one.name, name) <= 2) return ", did you mean " + in_quotes(one.name) + "?";
  }
  return "";
}

void Checker::add_name(const std::string& name, const NamedObject& object) {
  const std::string& path = object.path;
  const auto [place, added] = objects_.try_emplace(name.empty() ? path : name, object);
  if (!added) {
    fail(path + ".name", ErrorCode::kOutOfRange,
         in_quotes(name) + " is already the name of " + place->second.path);
  }
}

void Checker::collect(const SceneObjects& objects, const std::string& prefix) {
  const auto add = [&](const SceneTag& tag, const std::string& path, SceneObject::Kind kind,
                       std::size_t points) {
    if (is_damaged(path)) points = 0;
    add_name(tag.name, {.path = path,
                        .kind = kind,
                        .is_array = tag.array.kind != SceneArray::Kind::kSingle,
                        .instances = tag.array.count(),
                        .points = points});
  };
  for (std::size_t i = 0; i < objects.bodies.size(); ++i)
    collect_body(objects.bodies[i], indexed(prefix + "bodies", i));
  for (std::size_t i = 0; i < objects.ropes.size(); ++i) {
    const SceneRope& rope = objects.ropes[i];
    add(rope.tag, indexed(prefix + "ropes", i), SceneObject::Kind::kRope, point_count(rope));
  }
  for (std::size_t i = 0; i < objects.cloths.size(); ++i) {
    const SceneCloth& cloth = objects.cloths[i];
    add(cloth.tag, indexed(prefix + "cloths", i), SceneObject::Kind::kCloth, point_count(cloth));
  }
  for (std::size_t i = 0; i < objects.solids.size(); ++i) {
    const SceneSolid& solid = objects.solids[i];
    add(solid.tag, indexed(prefix + "solids", i), SceneObject::Kind::kSolid, point_count(solid));
  }
  for (std::size_t i = 0; i < objects.particles.size(); ++i) {
    const SceneParticles& particles = objects.particles[i];
    add(particles.tag, indexed(prefix + "particles", i), SceneObject::Kind::kParticles,
        point_count(particles));
  }
  for (std::size_t i = 0; i < objects.fields.size(); ++i) {
    add_name(objects.fields[i].name,
             {.path = indexed(prefix + "fields", i), .kind = SceneObject::Kind::kField});
  }
  collect_hooks(objects, prefix);
}

/// Collects a body, or the cells of one that is broken beforehand, with their glue.
void Checker::collect_body(const SceneBody& body, const std::string& path) {
  const SceneTag& tag = body.tag;
  const bool is_array = tag.array.kind != SceneArray::Kind::kSingle;
  if (!body.fracture) {
    add_name(tag.name, {.path = path, .is_array = is_array, .instances = tag.array.count(), .body = &body});
    return;
  }
  // The number of cells is known only when the body is divided.
  add_name(tag.name, {.path = path, .is_array = true, .instances = kMostScenePoints, .body = &body});
  add_name(glue_name(tag.name.empty() ? path : tag.name), {.path = path,
                                                           .kind = SceneObject::Kind::kHook,
                                                           .is_array = true,
                                                           .instances = kMostScenePoints,
                                                           .hook = HookKind::kFixed});
}

/// Collects hooks, and seams, which are sets of hooks.
void Checker::collect_hooks(const SceneObjects& objects, const std::string& prefix) {
  for (std::size_t i = 0; i < objects.hooks.size(); ++i) {
    const SceneHook& hook = objects.hooks[i];
    add_name(hook.name, {.path = indexed(prefix + "hooks", i),
                         .kind = SceneObject::Kind::kHook,
                         .is_array = hook.array.kind != SceneArray::Kind::kSingle,
                         .instances = hook.array.count(),
                         .hook = hook.desc.kind});
  }
  for (std::size_t i = 0; i < objects.seams.size(); ++i) {
    // The number of stitches is known only when the seam is sewn.
    add_name(objects.seams[i].name, {.path = indexed(prefix + "seams", i),
                                     .kind = SceneObject::Kind::kHook,
                                     .is_array = true,
                                     .instances = kMostScenePoints,
                                     .hook = HookKind::kBall});
  }
}

void Checker::collect_names() {
  for (const SceneMaterial& material : scene_.materials) {
    materials_.insert(material.name);
    if (material.like.empty() || is_in_library(material.like) || full()) continue;
    fail(
        "materials." + material.name + ".like", ErrorCode::kOutOfRange,
        "there is no material " + in_quotes(material.like) + " in the library" + library_hint(material.like));
  }
  for (const SceneMesh& mesh : scene_.meshes) meshes_.insert(mesh.name);
  names_damaged_ = std::any_of(errors_.begin(), errors_.end(),
                               [](const JsonError& one) { return one.error.where.ends_with(".name"); });
  collect(scene_.objects, "");
  for (std::size_t i = 0; i < scene_.timeline.size(); ++i) {
    collect(scene_.timeline[i].add, indexed("timeline", i) + ".add.");
  }
}

void Checker::check_tag(const SceneTag& tag, const std::string& path) {
  check_material(tag.material, path + ".material");
}

void Checker::check_material(const std::string& name, const std::string& path) {
  if (name.empty() || materials_.contains(name) || full()) return;
  const std::string near = closest_name(scene_.materials, name);
  fail(path, ErrorCode::kOutOfRange,
       "there is no material " + in_quotes(name) + (near.empty() ? library_hint(name) : near));
}

void Checker::check_mesh_name(const std::string& name, const std::string& path) {
  if (name.empty() || meshes_.contains(name) || full()) return;
  fail(path, ErrorCode::kOutOfRange,
       "there is no mesh " + in_quotes(name) + closest_name(scene_.meshes, name));
}

void Checker::check_body(const SceneBody& body, const std::string& path) {
  check_tag(body.tag, path);
  const bool hull = body.desc.shape.kind == ShapeKind::kHull;
  check_mesh_name(body.mesh, path + (hull ? ".shape.hull" : ".shape.mesh"));
  check_mesh_name(body.visual, path + ".visual");
  for (std::size_t k = 0; k < body.parts.size(); ++k) {
    const ScenePart& part = body.parts[k];
    const std::string part_path = indexed(path + ".shape.parts", k);
    const bool part_hull = part.desc.shape.kind == ShapeKind::kHull;
    check_mesh_name(part.mesh, part_path + (part_hull ? ".shape.hull" : ".shape.mesh"));
    check_material(part.material, part_path + ".material");
  }
  for (std::size_t k = 0; body.blade && k < body.blade->cuts.size(); ++k) {
    const std::string& name = body.blade->cuts[k];
    const std::string cut_path = indexed(path + ".blade.cuts", k);
    const NamedObject* object = find_named(name, cut_path);
    if (object != nullptr && !breaks(object->kind))
      fail(cut_path, ErrorCode::kOutOfRange, in_quotes(name) + " is neither a rope nor a cloth nor a solid");
  }
}

void Checker::check_references(const SceneObjects& objects, const std::string& prefix) {
  for (std::size_t i = 0; i < objects.bodies.size(); ++i) {
    check_body(objects.bodies[i], indexed(prefix + "bodies", i));
  }
  for (std::size_t i = 0; i < objects.ropes.size(); ++i) {
    check_tag(objects.ropes[i].tag, indexed(prefix + "ropes", i));
  }
  for (std::size_t i = 0; i < objects.cloths.size(); ++i) {
    const std::string path = indexed(prefix + "cloths", i);
    check_tag(objects.cloths[i].tag, path);
    check_mesh_name(objects.cloths[i].mesh, path + ".mesh");
  }
  for (std::size_t i = 0; i < objects.solids.size(); ++i) {
    const std::string path = indexed(prefix + "solids", i);
    check_tag(objects.solids[i].tag, path);
    check_mesh_name(objects.solids[i].mesh, path + ".mesh");
    check_mesh_name(objects.solids[i].visual, path + ".visual");
  }
  for (std::size_t i = 0; i < objects.particles.size(); ++i) {
    check_tag(objects.particles[i].tag, indexed(prefix + "particles", i));
  }
  for (std::size_t i = 0; i < objects.hooks.size(); ++i) {
    check_hook(objects.hooks[i], indexed(prefix + "hooks", i));
  }
  for (std::size_t i = 0; i < objects.seams.size(); ++i) {
    check_seam(objects.seams[i], indexed(prefix + "seams", i));
  }
}

const NamedObject* Checker::find_named(const std::string& name, const std::string& path) {
  if (full() || names_damaged_) return nullptr;
  auto found = objects_.find(name);
  const std::optional<CopyName> copy = take_copy_name(name);
  if (found == objects_.end() && copy) found = objects_.find(copy->array);
  if (found != objects_.end()) return &found->second;
  std::string hint;
  for (const auto& [known, object] : objects_) {
    const bool better = hint.empty() || known < hint;
    if (better && edit_distance_up_to_2(known, copy ? copy->array : name) <= 2) hint = known;
  }
  hint = hint.empty() ? "" : ", did you mean " + in_quotes(hint) + "?";
  fail(path, ErrorCode::kOutOfRange, "there is no object " + in_quotes(name) + hint);
  return nullptr;
}

const NamedObject* Checker::find_object(const std::string& name, const std::string& path) {
  const NamedObject* object = find_named(name, path);
  if (object == nullptr) return nullptr;
  const std::optional<CopyName> copy =
      objects_.contains(name) ? std::optional<CopyName>{} : take_copy_name(name);
  const std::string base = copy ? copy->array : name;
  if (object->is_array != copy.has_value()) {
    fail(path, ErrorCode::kOutOfRange,
         in_quotes(base) + (object->is_array
                                ? " is an array, name one of its objects as " + in_quotes(base + "[0]")
                                : " is not an array"));
    return nullptr;
  }
  if (copy && copy->copy >= object->instances) {
    fail(path, ErrorCode::kOutOfRange,
         in_quotes(base) + " has " + std::to_string(object->instances) + " objects");
    return nullptr;
  }
  return object;
}

bool Checker::is_known(const std::string& name) const {
  const std::optional<CopyName> copy = take_copy_name(name);
  return objects_.contains(name) || (copy && objects_.contains(copy->array));
}

bool Checker::names_any_cell(const std::string& name) const {
  const auto found = objects_.find(name);
  return found != objects_.end() && found->second.body != nullptr && found->second.body->fracture;
}

void Checker::check_hook_end(const SceneHook& hook, const std::string& end,
                             const std::optional<ScenePoint>& point, const std::string& path) {
  const EndName split = is_known(end) ? EndName{end} : take_end_name(end);
  const std::string& name = split.object;
  if (point && !split.connection_point.empty()) {
    fail(path + "_point", ErrorCode::kOutOfRange, in_quotes(end) + " names a point already");
    return;
  }
  const bool single = hook.array.kind == SceneArray::Kind::kSingle;
  const bool any_cell = single && names_any_cell(name);
  const NamedObject* object = single && !any_cell ? find_object(name, path) : find_named(name, path);
  if (object == nullptr) return;
  if (any_cell && split.connection_point.empty() && !hook.anchor) {
    fail(path, ErrorCode::kOutOfRange,
         in_quotes(name) + " is fractured: 'anchor' or one of its connection points chooses the cell");
    return;
  }
  const bool body = object->kind == SceneObject::Kind::kBody;
  if (!body && !has_points(object->kind)) {
    fail(path, ErrorCode::kOutOfRange, in_quotes(name) + " cannot be hooked");
    return;
  }
  if (body && point) {
    fail(path + "_point", ErrorCode::kOutOfRange, in_quotes(name) + " is a body, which has no points");
    return;
  }
  if (point) check_point(*point, object->points, path + "_point");
  check_copies(hook.array, name, *object, path);
}

void Checker::check_copies(const SceneArray& array, const std::string& name, const NamedObject& object,
                           const std::string& path) {
  if (array.kind == SceneArray::Kind::kSingle || !object.is_array) return;
  const std::optional<CopyName> first =
      objects_.contains(name) ? std::optional<CopyName>{} : take_copy_name(name);
  const std::size_t needed = array.count() + (first ? first->copy : 0);
  if (needed <= object.instances) return;
  fail(path, ErrorCode::kOutOfRange,
       in_quotes(name) + " is one of " + std::to_string(object.instances) + " objects, the hooks need " +
           std::to_string(needed));
}

void Checker::check_seam_edge(const SceneSeam& seam, const std::string& edge,
                              const std::vector<std::uint32_t>& points, const std::string& path) {
  const EndName split = is_known(edge) ? EndName{edge} : take_end_name(edge);
  if (split.connection_point.empty() == points.empty()) {
    fail(path, ErrorCode::kOutOfRange,
         points.empty() ? in_quotes(edge) + " names no edge, as " + in_quotes(edge + ".left") +
                              ", and there are no '" + path.substr(path.rfind('.') + 1) + "_points'"
                        : in_quotes(edge) + " names an edge already");
    return;
  }
  const bool single = seam.array.kind == SceneArray::Kind::kSingle;
  const NamedObject* object = single ? find_object(split.object, path) : find_named(split.object, path);
  if (object == nullptr) return;
  if (object->kind != SceneObject::Kind::kCloth && object->kind != SceneObject::Kind::kSolid) {
    fail(path, ErrorCode::kOutOfRange, in_quotes(split.object) + " is neither a cloth nor a solid");
    return;
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    check_point({.index = points[i]}, object->points, indexed(path + "_points", i));
  check_copies(seam.array, split.object, *object, path);
}

void Checker::check_seam(const SceneSeam& seam, const std::string& path) {
  if (is_damaged(path)) return;
  check_seam_edge(seam, seam.a, seam.a_points, path + ".a");
  check_seam_edge(seam, seam.b, seam.b_points, path + ".b");
}

void Checker::check_hook(const SceneHook& hook, const std::string& path) {
  if (is_damaged(path)) return;
  const auto names_point = [&](const std::string& end) {
    return !is_known(end) && !take_end_name(end).connection_point.empty();
  };
  if (!hook.anchor && !hook.a_point && !hook.b_point && !names_point(hook.a) && !names_point(hook.b)) {
    fail(path, ErrorCode::kOutOfRange, "needs 'anchor', or a point of what it holds");
    return;
  }
  if (!hook.a.empty()) check_hook_end(hook, hook.a, hook.a_point, path + ".a");
  check_hook_end(hook, hook.b, hook.b_point, path + ".b");
  check_ball_of_points(hook, path);
}

void Checker::check_ball_of_points(const SceneHook& hook, const std::string& path) {
  const auto is_point = [&](const std::string& end) {
    const auto named = [&](const std::string& name) {
      const std::optional<CopyName> copy = take_copy_name(name);
      auto found = objects_.find(name);
      if (found == objects_.end() && copy) found = objects_.find(copy->array);
      return found;
    };
    const auto found = named(is_known(end) ? end : take_end_name(end).object);
    return found != objects_.end() && has_points(found->second.kind);
  };
  if (hook.desc.kind != HookKind::kBall || (!is_point(hook.a) && !is_point(hook.b))) return;
  const JsonNode& node = document_.find_closest(path);
  for (const char* key : {"limits", "cone", "spring", "motor"}) {
    if (node.find(key) != nullptr) ignore(path + "." + key, "a point has no rotation");
  }
}

void Checker::check_point(ScenePoint point, std::size_t count, const std::string& path) {
  if (point.last || count == 0 || point.index < count) return;
  fail(path, ErrorCode::kOutOfRange,
       std::to_string(point.index) + " is out of range, must be 0 to " + std::to_string(count - 1));
}

void Checker::check_event_on_body(const SceneEvent& event, const SceneBody& body, const std::string& inner) {
  const std::string reason = refusal_of(event, body.desc);
  if (!reason.empty()) {
    fail(inner + ".object", ErrorCode::kOutOfRange, in_quotes(event.object) + reason);
    return;
  }
  if (event.point) ignore(inner + ".point", in_quotes(event.object) + " is a body, which has no points");
}

void Checker::check_event_on_points(const SceneEvent& event, const NamedObject& object,
                                    const std::string& inner) {
  if (!has_points(object.kind)) {
    fail(inner + ".object", ErrorCode::kOutOfRange, in_quotes(event.object) + " has no points");
    return;
  }
  if (!event.point) {
    fail(inner, ErrorCode::kOutOfRange, "needs 'point': " + in_quotes(event.object) + " is no body");
    return;
  }
  check_point(*event.point, object.points, inner + ".point");
  if (event.at) ignore(inner + ".at", "it is for a body; a point is pushed where it is");
  if (event.angular_velocity) ignore(inner + ".angular_velocity", "a point has none");
}

void Checker::check_event(const SceneEvent& event, const std::string& path) {
  if (is_damaged(path)) return;
  if (event.kind == SceneEvent::Kind::kRemove) {
    const auto found = objects_.find(event.object);
    const bool whole_array = found != objects_.end() && found->second.is_array;
    if (!whole_array) find_object(event.object, path + ".remove");
    return;
  }
  const std::string inner = path + key_of(event.kind);
  if (inner == path) return;
  const NamedObject* object = find_object(event.object, inner + ".object");
  if (object == nullptr) return;
  if (acts_on_hook(event.kind)) {
    const bool fits = object->hook && has_part(*object->hook, event.kind);
    const std::string reason = !object->hook ? " is not a hook" : " is a hook of a kind that has none";
    if (!fits) fail(inner + ".object", ErrorCode::kOutOfRange, in_quotes(event.object) + reason);
  } else if (object->body != nullptr) {
    check_event_on_body(event, *object->body, inner);
  } else {
    check_event_on_points(event, *object, inner);
  }
}

/// Says why a quantity cannot be measured on an object, or null if it can.
const char* why_not_subject(Subject subject, const NamedObject& object) {
  using Kind = SceneObject::Kind;
  switch (subject) {
    case Subject::kHook:
    case Subject::kGaps:
      return object.kind == Kind::kHook ? nullptr : " is not a hook";
    case Subject::kBreaks:
      if (object.kind == Kind::kHook || breaks(object.kind)) return nullptr;
      return " is neither a hook nor a rope nor a cloth nor a solid";
    case Subject::kBody:
      return object.kind == Kind::kBody ? nullptr : " is not a body";
    case Subject::kYields:
      return object.body != nullptr && object.body->desc.yields ? nullptr : " is no body with 'yields'";
    case Subject::kPoint:
      return has_points(object.kind) || object.kind == Kind::kBody ? nullptr : " has no points";
    default:
      break;
  }
  if (!has_points(object.kind)) return " has no points";
  return subject == Subject::kRope && object.kind != Kind::kRope ? " is not a rope" : nullptr;
}

/// Whether a quantity may be given a point or segment.
bool is_measured_at_points(Subject subject) {
  return subject == Subject::kPoint || subject == Subject::kRope || subject == Subject::kObject;
}

void Checker::check_subject(const SceneExpectation& expectation, Subject subject, const NamedObject& object,
                            const std::string& path) {
  using Kind = SceneObject::Kind;
  const bool body = object.kind == Kind::kBody;
  if (subject == Subject::kTwists) subject = object.kind == Kind::kRope ? Subject::kRope : Subject::kHook;
  if (const char* reason = why_not_subject(subject, object)) {
    fail(path + ".of", ErrorCode::kOutOfRange, in_quotes(expectation.of) + reason);
  } else if (!is_measured_at_points(subject)) {
    return;
  } else if (subject == Subject::kPoint && !body && !expectation.point.has_value()) {
    fail(path, ErrorCode::kOutOfRange, "this quantity needs 'point'");
  } else if (body && expectation.point.has_value()) {
    ignore(path + ".point", in_quotes(expectation.of) + " is a body, which has no points");
  } else if (expectation.point.has_value() && object.points > 0) {
    const bool segment = subject == Subject::kRope;
    check_point(*expectation.point, object.points - (segment ? 1 : 0), path + ".point");
  }
}

void Checker::check_expectation(const SceneExpectation& expectation, const std::string& path) {
  if (is_damaged(path)) return;
  if (expectation.at_step.value_or(0) > scene_.step_count()) {
    fail(path + ".at_step", ErrorCode::kOutOfRange,
         std::to_string(*expectation.at_step) + " is after the end of the scene, step " +
             std::to_string(scene_.step_count()));
    return;
  }
  const Subject subject = subject_of(expectation.quantity);
  if (subject == Subject::kWorld) {
    if (!expectation.of.empty()) {
      fail(path + ".of", ErrorCode::kOutOfRange,
           "this quantity is measured on the whole world, without 'of'");
    }
    return;
  }
  if (expectation.of.empty()) {
    const bool sums = subject == Subject::kGaps || subject == Subject::kBreaks || subject == Subject::kYields;
    if (sums) return;
    fail(path, ErrorCode::kOutOfRange, "this quantity needs 'of', the name of an object");
    return;
  }
  const NamedObject* object = find_object(expectation.of, path + ".of");
  if (object != nullptr) check_subject(expectation, subject, *object, path);
}

void Checker::check_pairs() {
  for (std::size_t i = 0; i < scene_.material_pairs.size(); ++i) {
    const std::string path = indexed("material_pairs", i);
    check_material(scene_.material_pairs[i].a, path + ".a");
    check_material(scene_.material_pairs[i].b, path + ".b");
  }
}

void Checker::check_references() {
  check_pairs();
  check_references(scene_.objects, "");
  for (std::size_t i = 0; i < scene_.timeline.size(); ++i) {
    const std::string path = indexed("timeline", i);
    check_references(scene_.timeline[i].add, path + ".add.");
    check_event(scene_.timeline[i], path);
  }
  for (std::size_t i = 0; i < scene_.expect.size(); ++i) {
    check_expectation(scene_.expect[i], indexed("expect", i));
  }
}

void Checker::check_files(bool look) {
  const auto check = [&](const std::string& file, const std::string& path) {
    if (file.empty()) return;
    const Result<std::string> found = locate_file(scene_.path, file);
    if (!found) {
      fail(path, found.error().code, found.error().message);
      return;
    }
    std::error_code failure;
    if (look && !std::filesystem::is_regular_file(found.value(), failure)) {
      fail(path, ErrorCode::kFileNotReadable, "no such file " + in_quotes(file));
    }
  };
  for (const SceneMesh& mesh : scene_.meshes) check(mesh.file, "meshes." + mesh.name + ".file");
  for (const SceneMaterial& material : scene_.materials) {
    check(material.texture, "materials." + material.name + ".texture");
    check(material.normal_map, "materials." + material.name + ".normal_map");
    check(material.roughness_map, "materials." + material.name + ".roughness_map");
  }
}

void Checker::check_pins(const std::vector<ScenePin>& pins, std::size_t count, const ClothDesc* grid,
                         const std::string& path) {
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const ScenePin& pin = pins[i];
    const std::string where = indexed(path + ".pins", i);
    if (pin.pick == ScenePin::Pick::kPoint) {
      const bool short_form = document_.find_closest(where).kind != JsonNode::Kind::kObject;
      check_point(pin.point, count, short_form ? where : where + ".point");
      continue;
    }
    if (pin.pick == ScenePin::Pick::kTopmost) continue;
    const bool column = pin.pick == ScenePin::Pick::kColumn;
    const std::string key = where + (column ? ".column" : ".row");
    if (grid == nullptr) {
      fail(key, ErrorCode::kOutOfRange, "is for the grid of a cloth only");
      continue;
    }
    check_point(pin.point, static_cast<std::size_t>(column ? grid->columns : grid->rows), key);
  }
}

void Checker::check_loads(const std::vector<SceneLoad>& loads, std::size_t count, const std::string& path) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    check_point(loads[i].point, count, indexed(path + ".loads", i) + ".point");
  }
}

void Checker::check_springs(const ParticlesDesc& particles, const std::string& path) {
  for (std::size_t i = 0; i < particles.springs.size(); ++i) {
    const SpringDesc& spring = particles.springs[i];
    const std::size_t count = particles.particles.size();
    if (spring.a < count && spring.b < count && spring.a != spring.b) continue;
    const std::string where = indexed(path + ".springs", i);
    check_point({.index = spring.a}, count, where + ".a");
    check_point({.index = spring.b}, count, where + ".b");
    if (spring.a == spring.b) fail(where, ErrorCode::kOutOfRange, "joins a particle with itself");
  }
}

void Checker::check_points(const SceneObjects& objects, const std::string& prefix) {
  for (std::size_t i = 0; i < objects.ropes.size(); ++i) {
    const SceneRope& rope = objects.ropes[i];
    const std::string path = indexed(prefix + "ropes", i);
    if (is_damaged(path)) continue;
    check_pins(rope.pins, point_count(rope), nullptr, path);
    check_loads(rope.loads, point_count(rope), path);
    if (rope.desc.points.size() == 1) {
      fail(path + ".points", ErrorCode::kOutOfRange, "has 1 element, must have at least 2");
    }
  }
  for (std::size_t i = 0; i < objects.cloths.size(); ++i) {
    const SceneCloth& cloth = objects.cloths[i];
    const std::string path = indexed(prefix + "cloths", i);
    if (is_damaged(path)) continue;
    check_pins(cloth.pins, point_count(cloth), cloth.mesh.empty() ? &cloth.desc : nullptr, path);
    check_loads(cloth.loads, point_count(cloth), path);
  }
  for (std::size_t i = 0; i < objects.solids.size(); ++i) {
    const std::string path = indexed(prefix + "solids", i);
    if (!is_damaged(path)) check_pins(objects.solids[i].pins, point_count(objects.solids[i]), nullptr, path);
  }
  for (std::size_t i = 0; i < objects.particles.size(); ++i) {
    const SceneParticles& particles = objects.particles[i];
    const std::string path = indexed(prefix + "particles", i);
    if (is_damaged(path)) continue;
    check_pins(particles.pins, point_count(particles), nullptr, path);
    check_springs(particles.desc, path);
  }
}

void Checker::check_points() {
  check_points(scene_.objects, "");
  for (std::size_t i = 0; i < scene_.timeline.size(); ++i) {
    check_points(scene_.timeline[i].add, indexed("timeline", i) + ".add.");
  }
}

void Checker::count_points(const SceneObjects& objects, const std::string& prefix) {
  const auto count = [&](const SceneArray& array, std::size_t points, const std::string& path) {
    if (total_ > kMostScenePoints) return;
    total_ += saturated_product(array.count(), std::max<std::size_t>(points, 1));
    if (total_ <= kMostScenePoints) return;
    fail(path, ErrorCode::kLimitExceeded,
         "with this object the scene has more than " + std::to_string(kMostScenePoints) + " points");
  };
  for (std::size_t i = 0; i < objects.bodies.size(); ++i) {
    const SceneBody& body = objects.bodies[i];
    const std::size_t seeds = !body.fracture ? 0
                              : body.fracture->desc.seeds.empty()
                                  ? static_cast<std::size_t>(body.fracture->desc.cells)
                                  : body.fracture->desc.seeds.size();
    count(body.tag.array, std::max(body.parts.size(), seeds), indexed(prefix + "bodies", i));
  }
  for (std::size_t i = 0; i < objects.ropes.size(); ++i) {
    count(objects.ropes[i].tag.array, point_count(objects.ropes[i]), indexed(prefix + "ropes", i));
  }
  for (std::size_t i = 0; i < objects.cloths.size(); ++i) {
    count(objects.cloths[i].tag.array, point_count(objects.cloths[i]), indexed(prefix + "cloths", i));
  }
  for (std::size_t i = 0; i < objects.solids.size(); ++i) {
    count(objects.solids[i].tag.array, point_count(objects.solids[i]), indexed(prefix + "solids", i));
  }
  for (std::size_t i = 0; i < objects.particles.size(); ++i) {
    const SceneParticles& particles = objects.particles[i];
    count(particles.tag.array, point_count(particles), indexed(prefix + "particles", i));
  }
  for (std::size_t i = 0; i < objects.hooks.size(); ++i) {
    count(objects.hooks[i].array, 1, indexed(prefix + "hooks", i));
  }
}

void Checker::check_total() {
  count_points(scene_.objects, "");
  for (std::size_t i = 0; i < scene_.timeline.size(); ++i) {
    count_points(scene_.timeline[i].add, indexed("timeline", i) + ".add.");
  }
}

}  // namespace

std::size_t point_count(const SceneRope& rope) {
  return rope.desc.points.empty() ? static_cast<std::size_t>(std::max(rope.desc.masses, 0))
                                  : rope.desc.points.size();
}

std::size_t point_count(const SceneCloth& cloth) {
  if (!cloth.mesh.empty()) return 0;
  return static_cast<std::size_t>(std::max(cloth.desc.columns, 0)) *
         static_cast<std::size_t>(std::max(cloth.desc.rows, 0));
}

std::size_t point_count(const SceneSolid& solid) {
  if (!solid.mesh.empty()) return 0;
  std::size_t corners = 1;
  std::size_t centers = 1;
  for (const std::int32_t cells : solid.desc.cells) {
    const auto count = static_cast<std::size_t>(std::max(cells, 0));
    corners = saturated_product(corners, count + 1);
    centers = saturated_product(centers, count);
  }
  return corners + centers;
}

std::size_t point_count(const SceneParticles& particles) {
  return particles.desc.particles.size();
}

void check_scene(const Scene& scene, const JsonDocument& document, bool files_must_exist,
                 std::vector<JsonError>& errors, std::vector<JsonError>& ignored) {
  const bool clean = errors.empty();
  Checker checker(scene, document, errors, ignored);
  // Too many objects are not checked one by one.
  if (clean) checker.check_total();
  if (clean && !errors.empty()) return;
  checker.collect_names();
  checker.check_files(files_must_exist);
  checker.check_references();
  checker.check_points();
}

}  // namespace hooke::io
