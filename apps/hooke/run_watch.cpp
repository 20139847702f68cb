#include "hooke/run_watch.h"

#include "hooke/scene_path.h"
#include "hooke/text_of.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace hooke::app {

namespace {

/// These are kinds of trouble; those of StepReport come after them, in the order of kRefusedCounts.
enum Kind : int {
  kStretch,
  kSlack,
  kGapAtStart,
  kGap,
  kOverlap,
  kTooStiff,
  kCells,
  kLostParts,
  kCrossed,
  kFirstCount
};

constexpr double kBeyondLimit = 1.1;  ///< Stretch over the declared limit from which on it is reported.
constexpr int kMostAlike = 8;         ///< Warnings of one kind that are told one by one.
constexpr double kOpen = 0.01;        ///< Gap of a hook that is reported [m].
/// Overlap of two bodies, over half of the thinnest side of the smaller one.
constexpr double kPressed = 0.25;
constexpr double kOverlapInterval = 0.05;  ///< Time between two checks of all contacts [s].
constexpr double kTooFlexible = 0.25;      ///< Share by which cloth bends farther than declared.
/// Cloth is reported if it is stiffer by this factor than what a substep carries,
constexpr double kSlackFrom = 1.25;
constexpr double kFarStretched = 0.02;  ///< and stretches by this share.
constexpr double kHardlyAny = 2;        ///< Share of extra bending beyond which the estimate gives no number.
constexpr double kFarOff = 1e-3;        ///< Error of rows that were refused from which on it is reported [m].
constexpr double kLost = 0.05;          ///< Share of a mesh's volume that its cells do not have.
constexpr int kCrossedFirst = 1000;     ///< Kinds of crossings with one other object, by its order.
constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();
constexpr std::int32_t kMostSubsteps = 64;  ///< Largest number that a scene may have.

constexpr std::array kRefusedCounts = {
    RefusedCount{&StepReport::rows_quarantined, "rows_quarantined",
                 "particles and bodies were put back because their state was not finite",
                 "less extreme masses, stiffnesses or forces, or more substeps"},
    RefusedCount{&StepReport::ropes_unconverged, "ropes_unconverged",
                 "ropes stayed more than 1 % off their length: Newton's steps did not converge",
                 "more particle_substeps, or a load that is not as heavy", true},
    RefusedCount{
        &StepReport::pairs_left_out, "pairs_left_out",
        "pairs were left out: bodies stand in the middle of many others, and push away the nearest alone",
        "places that are not the same for many bodies"},
    RefusedCount{
        &StepReport::rows_refused, "rows_refused",
        "contacts and hooks were too many to be solved as a whole: stacks may sink or fall, nets may gape",
        "lower stacks (110 equal boxes stand), smaller nets, fewer bodies that lie on much lighter ones or "
        "on what hangs, masses that differ less, or 32 substeps with 'bias_sweeps' 8 and 'contact_hz' 200",
        false, &StepReport::worst_error, "worst_error"},
    RefusedCount{
        &StepReport::coupled_groups_cut_short, "coupled_groups_cut_short",
        "groups of ropes and what they hold took too much work to be solved to the end, or were solved "
        "without taking gaps back",
        "fewer points, fewer ropes that touch each other, fewer bodies on what hangs, or more substeps"},
    RefusedCount{&StepReport::solids_unconverged, "solids_unconverged",
                 "stiff solids took too many passes to be solved to the end, and yield more than they should",
                 "larger cells, less stiffness, or more particle_substeps"},
    RefusedCount{
        &StepReport::cloths_unconverged, "cloths_unconverged",
        "times cloths under loads took too much work to be solved to the end, and stretched more than "
        "they should",
        "fewer points, a load that is not as heavy, or more particle_substeps"},
    RefusedCount{
        &StepReport::cloths_left_to_contacts, "cloths_left_to_contacts",
        "times cloths bore heavy bodies by contacts alone, as these came fast, or the cloths were tangled or "
        "hold gas: they stretch more than they should",
        "slower bodies, more substeps, or coarser cloth"},
    RefusedCount{
        &StepReport::points_held_back, "points_held_back",
        "times points were held back for a substep: surfaces jam, and only that keeps them from crossing",
        "slower motion, stiffer or finer cloth, a smaller thickness, or more substeps"},
    RefusedCount{&StepReport::surfaces_touching, "surfaces_touching",
                 "parts of surfaces touched or crossed when they were looked at, and may cross",
                 "a gap between cloths and solids where the scene begins"},
    RefusedCount{&StepReport::surfaces_crossing, "surfaces_crossing",
                 "edges of cloths, solids or ropes went through others",
                 "places at which they do not cross at the start"},
};

double in_double(Real value) {
  return static_cast<double>(value);
}

double percent(double ratio) {
  return 100 * ratio;
}

/// Returns the description in the scene of an object of the kind that `list` holds.
template <class T>
const T& declared(const Scene& scene, const SceneObject& object, std::vector<T> SceneObjects::*list) {
  static const T usual = {};
  std::size_t row = 0;
  const std::vector<T>& all = objects_of(scene, object.path, row).*list;
  return row < all.size() ? all[row] : usual;
}

double substep_of(const Scene& scene) {
  return in_double(scene.dt) / (scene.world.substeps * scene.world.particle_substeps);
}

/// Returns the setting that makes a substep shorter by `factor`, as advice.
std::string more_substeps(const Scene& scene, double factor, const char* otherwise) {
  const double wanted = std::ceil(scene.world.particle_substeps * factor);
  if (wanted > kMostSubsteps) return otherwise;
  return "particle_substeps " + text_of("%.0f", wanted) + ", or " + otherwise;
}

/// Returns the size of the smallest cell along an edge [m]; 0 for a solid without cells.
double cell_of(const SceneSolid& solid) {
  if (solid.desc.elasticity != SolidDesc::Elasticity::kTetrahedra) return 0;
  if (!solid.mesh.empty()) return in_double(solid.desc.cell);
  const auto edge = [](Real size, std::int32_t cells) { return in_double(size) / std::max(cells, 1); };
  return std::min({edge(solid.desc.size.x, solid.desc.cells[0]), edge(solid.desc.size.y, solid.desc.cells[1]),
                   edge(solid.desc.size.z, solid.desc.cells[2])});
}

double cell_of(const SceneCloth& cloth) {
  if (!cloth.mesh.empty()) return 0;
  return std::min(in_double(cloth.desc.width) / std::max(cloth.desc.columns - 1, 1),
                  in_double(cloth.desc.height) / std::max(cloth.desc.rows - 1, 1));
}

/// Returns half of the thinnest side of a body [m]; 0 where it is not known.
double half_size(const Shape& shape) {
  switch (shape.kind) {
    case ShapeKind::kSphere:
    case ShapeKind::kCapsule:
      return in_double(shape.radius);
    case ShapeKind::kBox:
      return in_double(std::min({shape.half_extents.x, shape.half_extents.y, shape.half_extents.z}));
    case ShapeKind::kCylinder:
    case ShapeKind::kCone:
      return in_double(std::min(shape.radius, shape.half_height));
    default:
      return 0;
  }
}

/// Bends are solved one after the other, once in a substep, and undo in part what their neighbors did. Over n
/// cells of size a, cloth of rigidity D and density rho bends by about 1 + n^1.3 sqrt(D / rho) h / a^2 times
/// as far as it should, measured on strips of 5 and 10 cells that hang from a clamped edge. Under weight, the
/// part of the cloth that acts as one is at most its bending length (D / rho g)^(1/3).
std::optional<RunWarning> softness(const Scene& scene, const SceneCloth& cloth) {
  const ClothDesc& desc = cloth.desc;
  const double cell = cell_of(cloth);
  const double rigidity = in_double(desc.bend_stiffness);
  // Yarns are bent as a whole, with all of it.
  const bool has_bends = desc.bend == ClothDesc::Bend::kAngle || desc.bend == ClothDesc::Bend::kIsometric ||
                         (desc.bend == ClothDesc::Bend::kYarn && desc.yield_angle < kRigid);
  if (!(cell > 0) || !has_bends || !(rigidity > 0)) return std::nullopt;
  const double area = in_double(desc.width) * in_double(desc.height);
  const double density = desc.total_mass ? in_double(*desc.total_mass) / area : in_double(desc.areal_density);
  const double weight = density * in_double(length(scene.world.gravity));
  const double size = in_double(std::max(desc.width, desc.height));
  const double acts_as_one = weight > 0 ? std::min(size, std::cbrt(rigidity / weight)) : size;
  const double excess =
      std::pow(acts_as_one / cell, 1.3) * std::sqrt(rigidity / density) * substep_of(scene) / (cell * cell);
  if (acts_as_one < cell || !(excess > kTooFlexible)) return std::nullopt;
  const std::string far = excess < kHardlyAny ? text_of("bends about %.2g times as far as", 1 + excess)
                                              : std::string("has hardly any of");
  return RunWarning{
      .what =
          far +
          text_of(" its bend_stiffness of %.3g N m%s: a substep of %.3g s carries no more in cells of %.3g m",
                  rigidity, excess < kHardlyAny ? " says" : "", substep_of(scene), cell),
      .worst = 1 + excess,
      .limit = 1,
      .cure = more_substeps(scene, excess / kTooFlexible, "larger cells")};
}

/// Returns the part of the stiffness of a spring along an edge of cloth that a substep carries, k = 1.4 m /
/// h^2 with the mass m of a point [N/m]. Sheets of 9 to 31 points a side whose edge is pulled stretch as if
/// they had no more.
double carried_stiffness(const Scene& scene, const SceneCloth& cloth, std::uint32_t points, double area) {
  const ClothDesc& desc = cloth.desc;
  const double mass = desc.total_mass ? in_double(*desc.total_mass) : in_double(desc.areal_density) * area;
  const double h = substep_of(scene);
  return 1.4 * mass / points / (h * h);
}

/// Points keep half the thickness from what they touch. The cells cannot represent a thickness larger than a
/// cell.
std::optional<RunWarning> thickness(double cell, Real thickness) {
  if (!(cell > 0) || !(in_double(thickness) > cell)) return std::nullopt;
  return RunWarning{
      .what = text_of("has a thickness of %.3g m, more than its cells of %.3g m: its points keep other "
                      "things off by more than they are apart",
                      in_double(thickness), cell),
      .worst = in_double(thickness),
      .limit = cell,
      .unit = "m",
      .cure = "less thickness, or larger cells"};
}

/// A solid that fills a mesh loses parts that are thinner than its cells, and the outermost parts of round
/// shapes.
std::optional<RunWarning> lost_parts(const World& world, const SceneObject& object, const SceneSolid& solid) {
  if (!(cell_of(solid) > 0)) return std::nullopt;
  const double whole = object.mesh_volume;
  const double filled = world.volume(object.solid);
  if (!(whole > 0) || !(filled < (1 - kLost) * whole)) return std::nullopt;
  return RunWarning{
      .what = text_of("fills %.3g %% of its mesh: its cells of %.3g m are too large for its form",
                      percent(filled / whole), cell_of(solid)),
      .worst = filled / whole,
      .limit = 1,
      .cure = "a smaller cell"};
}

/// Whether two entries are of one object: a name may come back with another.
bool are_same(const SceneObject& a, const SceneObject& b) {
  return a.name == b.name && a.kind == b.kind && a.body == b.body && a.rope == b.rope && a.cloth == b.cloth &&
         a.solid == b.solid && a.particles == b.particles && a.field == b.field && a.hook == b.hook;
}

RunWarning gap_at_start(double gap) {
  return {.what = text_of("began with its ends %.3g m apart: it draws them together", gap),
          .worst = gap,
          .limit = kOpen,
          .unit = "m",
          .cure = "place what it holds where the hook is"};
}

}  // namespace

std::string RunWarning::line() const {
  std::string text = object.empty() ? what : "'" + object + "' " + what;
  if (time > 0) text += text_of(", at %.3g s", time);
  return text + ": " + cure;
}

std::span<const RefusedCount> refused_counts() {
  return kRefusedCounts;
}

RunWatch::RunWatch(const Simulation& simulation) {
  take_new_objects(simulation);
}

void RunWatch::note(std::uint64_t order, int kind, double ratio, RunWarning warning) {
  const auto same = std::find_if(worst_.begin(), worst_.end(),
                                 [&](const Worst& one) { return one.order == order && one.kind == kind; });
  if (same == worst_.end()) {
    worst_.push_back({order, kind, ratio, std::move(warning)});
  } else if (ratio > same->ratio) {
    same->ratio = ratio;
    same->warning = std::move(warning);
  }
}

bool RunWatch::knows_all(std::span<const SceneObject> objects) {
  if (objects.size() != watched_.size()) return false;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!are_same(watched_[i].object, objects[i])) return false;
    watched_[i].object.broken = objects[i].broken;
  }
  return true;
}

void RunWatch::take_new_objects(const Simulation& simulation) {
  const std::span<const SceneObject> objects = simulation.objects();
  if (knows_all(objects)) return;
  // Both lists are in order of creation: an object that is not found further on is new, one that is passed
  // over is gone.
  std::vector<Watched> now;
  std::size_t next = 0;
  for (const SceneObject& object : objects) {
    std::size_t at = next;
    while (at < watched_.size() && !are_same(watched_[at].object, object)) ++at;
    if (at < watched_.size()) {
      now.push_back(std::move(watched_[at]));
      next = at + 1;
      continue;
    }
    now.push_back({.object = object, .order = created_++});
    look_at_start(simulation, now.back());
  }
  watched_ = std::move(now);
  look_at_crossings(simulation.world());
}

/// Tells whether two names are of copies of one object of a scene: "flag[0]" and "flag[63]".
static bool are_copies(const std::string& a, const std::string& b) {
  const std::size_t end = a.rfind('[');
  return end != std::string::npos && b.rfind('[') == end && a.compare(0, end, b, 0, end) == 0;
}

void RunWatch::look_at_crossings(const World& world) {
  const auto watched_of = [&](const auto& is) -> const Watched* {
    const auto found = std::find_if(watched_.begin(), watched_.end(), is);
    return found == watched_.end() ? nullptr : &*found;
  };
  for (const Crossing& crossing : world.crossings()) {
    const Watched* a = watched_of([&](const Watched& one) { return has_point(one.object, crossing.a); });
    const Watched* b = watched_of([&](const Watched& one) {
      if (!crossing.body) return has_point(one.object, crossing.b);
      return one.object.kind == SceneObject::Kind::kBody && one.object.body == crossing.body;
    });
    if (a == nullptr || b == nullptr) continue;
    const std::string other = a == b ? std::string("itself") : "'" + b->object.name + "'";
    const std::string place =
        text_of("about (%.3g, %.3g, %.3g)", crossing.place.x, crossing.place.y, crossing.place.z);
    // One warning for each other object, but one for all copies of the object itself.
    const bool is_copy = a != b && are_copies(a->object.name, b->object.name);
    const int kind =
        is_copy || a == b ? static_cast<int>(kCrossed) : kCrossedFirst + static_cast<int>(b->order);
    note(a->order, kind, crossing.pairs,
         {.object = a->object.name,
          .what = crossing.inside
                      ? "begins with " + other + " inside, " + place
                      : "begins crossed with " + other + text_of(" in %u places, ", crossing.pairs) + place,
          .worst = static_cast<double>(crossing.pairs),
          .limit = 0,
          .time = world.time(),
          .cure = "places at which they do not cross"});
  }
}

/// Returns the springs along the edges of a cloth, which have its limit; of a grid, those of its cells.
template <class Edge>
static std::vector<Edge> edges_of(const World& world, const SceneObject& object, const SceneCloth& cloth) {
  std::vector<Edge> edges;
  const PointView points = world.positions(object.cloth);
  const std::uint32_t columns = object.columns;
  if (columns > 0) {
    const double across = in_double(cloth.desc.width) / (columns - 1);
    const double down = in_double(cloth.desc.height) / (object.rows - 1);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if ((i + 1) % columns != 0) edges.push_back({i, i + 1, across});
      if (i + columns < points.size()) edges.push_back({i, i + columns, down});
    }
    return edges;
  }
  for (const auto& t : world.triangles(object.cloth)) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a < b) edges.push_back({a, b, length(points[b] - points[a])});
    }
  }
  return edges;
}

void RunWatch::look_at_start(const Simulation& simulation, Watched& watched) {
  const Scene& scene = simulation.scene();
  const World& world = simulation.world();
  const SceneObject& object = watched.object;
  const auto add = [&](int kind, std::optional<RunWarning> warning, double ratio = 0) {
    if (!warning) return;
    warning->object = object.name;
    note(watched.order, kind, ratio, *std::move(warning));
  };
  switch (object.kind) {
    case SceneObject::Kind::kRope:
      take_rope(world, declared(scene, object, &SceneObjects::ropes), watched);
      break;
    case SceneObject::Kind::kCloth: {
      const SceneCloth& cloth = declared(scene, object, &SceneObjects::cloths);
      add(kTooStiff, softness(scene, cloth));
      add(kCells, thickness(cell_of(cloth), cloth.desc.thickness));
      take_cloth(scene, world, cloth, watched);
      break;
    }
    case SceneObject::Kind::kSolid: {
      const SceneSolid& solid = declared(scene, object, &SceneObjects::solids);
      add(kCells, thickness(cell_of(solid), solid.desc.thickness));
      add(kLostParts, lost_parts(world, object, solid));
      break;
    }
    case SceneObject::Kind::kHook: {
      const double gap = in_double(world.hook_gap(object.hook));
      watched.was_closed = gap <= kOpen;
      if (!watched.was_closed) add(kGapAtStart, gap_at_start(gap), gap / kOpen);
      break;
    }
    default:
      break;
  }
}

void RunWatch::take_cloth(const Scene& scene, const World& world, const SceneCloth& cloth, Watched& watched) {
  const ClothDesc& desc = cloth.desc;
  const PointView points = world.positions(watched.object.cloth);
  double area = in_double(desc.width) * in_double(desc.height);
  if (!cloth.mesh.empty()) {
    area = 0;
    for (const auto& t : world.triangles(watched.object.cloth))
      area += length(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]])) / 2;
  }
  const double carried = carried_stiffness(scene, cloth, points.size(), area);
  watched.stiffness = in_double(desc.stretch_stiffness);
  // The yarns of a grid carry all of it.
  if (!cloth.mesh.empty() && watched.stiffness > kSlackFrom * carried) watched.carried = carried;
  if (desc.extension_max != kRigid) watched.extension_max = in_double(desc.extension_max);
  if (watched.carried > 0 || watched.extension_max > 0)
    watched.edges = edges_of<Edge>(world, watched.object, cloth);
}

void RunWatch::take_rope(const World& world, const SceneRope& rope, Watched& watched) {
  const RopeDesc& desc = rope.desc;
  const PointView points = world.positions(watched.object.rope);
  watched.is_rigid = desc.stiffness == kRigid && !desc.axial_stiffness && !desc.young_modulus;
  if (desc.extension_max < kRigid) watched.extension_max = in_double(desc.extension_max);
  for (std::uint32_t i = 0; i + 1 < points.size(); ++i) {
    const double even = watched.object.rest_length / static_cast<double>(points.size() - 1);
    const double rest = desc.points.empty() ? even : length(desc.points[i + 1] - desc.points[i]);
    watched.edges.push_back({i, i + 1, rest});
  }
}

/// Returns the largest relative elongation of its edges.
double RunWatch::stretch_of(const World& world, const Watched& watched) {
  const PointView points = positions_of(world, watched.object);
  double most = 0;
  for (const Edge& edge : watched.edges) {
    if (edge.b >= points.size() || !(edge.length > 0)) continue;
    most = std::max(most, length(points[edge.b] - points[edge.a]) / edge.length - 1);
  }
  return most;
}

void RunWatch::look_at_softness(const Simulation& simulation, const Watched& watched) {
  if (!(watched.carried > 0)) return;
  const World& world = simulation.world();
  const double most = stretch_of(world, watched);
  if (!(most > kFarStretched)) return;
  const Scene& scene = simulation.scene();
  note(
      watched.order, kSlack, most,
      {.object = watched.object.name,
       .what = text_of("stretched by %.3g %%: a substep of %.3g s carries no more than about %.3g N/m of its "
                       "stretch_stiffness",
                       percent(most), substep_of(scene), watched.carried),
       .worst = most,
       .limit = kFarStretched,
       .time = world.time(),
       .cure = more_substeps(scene, std::sqrt(watched.stiffness / watched.carried),
                             "larger cells, or heavier cloth")});
}

void RunWatch::look_at_stretch(const World& world, const Watched& watched) {
  if (!(watched.extension_max > 0)) return;
  const double most = stretch_of(world, watched);
  if (!(most > kBeyondLimit * watched.extension_max)) return;
  note(watched.order, kStretch, most / watched.extension_max,
       {.object = watched.object.name,
        .what = text_of("stretched by %.3g %%, its extension_max is %.3g %%", percent(most),
                        percent(watched.extension_max)),
        .worst = most,
        .limit = watched.extension_max,
        .time = world.time(),
        .cure = "more particle_substeps, a lighter load, or a slower one"});
}

void RunWatch::look_at_gap(const World& world, Watched& watched) {
  if (watched.object.kind != SceneObject::Kind::kHook || watched.object.broken) return;
  const double gap = in_double(world.hook_gap(watched.object.hook));
  if (!(gap > kOpen)) {
    watched.was_closed = true;
    return;
  }
  if (!watched.was_closed) return;
  note(watched.order, kGap, gap / kOpen,
       {.object = watched.object.name,
        .what = text_of("was open by %.3g m", gap),
        .worst = gap,
        .limit = kOpen,
        .unit = "m",
        .time = world.time(),
        .cure = "more substeps, or masses that differ less"});
}

void RunWatch::look_at_overlaps(const World& world) {
  const auto watched_of = [&](BodyId id) -> const Watched* {
    const auto found = std::find_if(watched_.begin(), watched_.end(), [&](const Watched& one) {
      return one.object.kind == SceneObject::Kind::kBody && one.object.body == id;
    });
    return found == watched_.end() ? nullptr : &*found;
  };
  for (const BodyContact& contact : world.body_contacts()) {
    const double depth = -in_double(contact.separation);
    if (!(depth > kOpen * kPressed)) continue;  // Most contacts end here, before bodies are searched.
    const Watched* a = watched_of(contact.a);
    const Watched* b = watched_of(contact.b);
    if (a == nullptr || b == nullptr) continue;
    const double sizes[] = {half_size(a->object.shape), half_size(b->object.shape)};
    const double size =
        sizes[0] > 0 && sizes[1] > 0 ? std::min(sizes[0], sizes[1]) : std::max(sizes[0], sizes[1]);
    if (!(size > 0) || !(depth > kPressed * size)) continue;
    const Watched* pressed = sizes[0] > 0 && (sizes[0] <= sizes[1] || !(sizes[1] > 0)) ? a : b;
    const Watched* other = pressed == a ? b : a;
    note(pressed->order, kOverlap, depth / size,
         {.object = pressed->object.name,
          .what = text_of("was pressed %.3g m into '", depth) + other->object.name +
                  text_of("', its half size is %.3g m", size),
          .worst = depth,
          .limit = kPressed * size,
          .unit = "m",
          .time = world.time(),
          .cure = world.step_count() <= 1 ? "places at which they do not overlap at the start"
                                          : "more substeps, or masses that differ less"});
  }
}

const RunWatch::Watched* RunWatch::least_rigid_rope(const World& world) const {
  const Watched* worst = nullptr;
  double most = 0;
  for (const Watched& watched : watched_) {
    if (!watched.is_rigid) continue;
    const PointView points = world.positions(watched.object.rope);
    for (const Edge& edge : watched.edges) {
      const double off = std::abs(length(points[edge.b] - points[edge.a]) / edge.length - 1);
      if (!(off > most)) continue;
      most = off;
      worst = &watched;
    }
  }
  return worst;
}

void RunWatch::look_at_report(const World& world, const StepReport& report) {
  for (std::size_t i = 0; i < kRefusedCounts.size(); ++i) {
    const RefusedCount& count = kRefusedCounts[i];
    const std::uint32_t number = report.*count.number;
    const double error = count.error != nullptr ? report.*count.error : 0;
    if (number == 0 || (count.error != nullptr && error < kFarOff)) continue;
    const Watched* rope = count.of_rope ? least_rigid_rope(world) : nullptr;
    std::string what =
        count.what + (count.error != nullptr
                          ? text_of(" (%u rows in one step, off by up to %.3g m)", number, error)
                          : text_of(" (%u in one step)", number));
    if (rope != nullptr) what += ", '" + rope->object.name + "' the most";
    note(kNobody, kFirstCount + static_cast<int>(i), count.error != nullptr ? error : number,
         {.what = std::move(what),
          .worst = count.error != nullptr ? error : static_cast<double>(number),
          .limit = count.error != nullptr ? kFarOff : 0,
          .unit = count.error != nullptr ? "m" : "",
          .time = world.time(),
          .cure = count.cure});
  }
}

void RunWatch::look(const Simulation& simulation, const StepReport& report) {
  const World& world = simulation.world();
  take_new_objects(simulation);
  for (Watched& watched : watched_) {
    look_at_stretch(world, watched);
    look_at_gap(world, watched);
  }
  look_at_report(world, report);
  const bool went_back = world.time() < next_overlaps_ - 2 * kOverlapInterval;
  if (world.time() < next_overlaps_ && !went_back) return;
  next_overlaps_ = world.time() + kOverlapInterval;
  look_at_overlaps(world);
  for (const Watched& watched : watched_) look_at_softness(simulation, watched);
}

std::vector<RunWarning> RunWatch::warnings() const {
  std::vector<Worst> sorted = worst_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Worst& a, const Worst& b) {
    return std::pair(a.order, a.kind) < std::pair(b.order, b.kind);
  });
  const auto are_many = [&](int kind) {
    return std::count_if(worst_.begin(), worst_.end(), [kind](const Worst& one) {
             return one.kind == kind && !one.warning.object.empty();
           }) > kMostAlike;
  };
  // Copies that have the same trouble give one warning, by the worst of them, and so do many objects.
  std::vector<Worst> told;
  std::vector<int> copies;
  for (Worst& one : sorted) {
    const bool is_one_of_many = !one.warning.object.empty() && are_many(one.kind);
    const auto same = std::find_if(told.begin(), told.end(), [&](const Worst& other) {
      if (other.kind != one.kind || other.warning.object.empty() != one.warning.object.empty()) return false;
      return is_one_of_many || are_copies(other.warning.object, one.warning.object);
    });
    if (same == told.end()) {
      told.push_back(std::move(one));
      copies.push_back(1);
      continue;
    }
    ++copies[static_cast<std::size_t>(same - told.begin())];
    if (one.ratio > same->ratio) *same = std::move(one);
  }
  std::vector<RunWarning> warnings;
  for (std::size_t i = 0; i < told.size(); ++i) {
    warnings.push_back(std::move(told[i].warning));
    const char* const one = told[i].ratio > 0 ? "the worst" : "one";
    if (copies[i] > 1) warnings.back().what += text_of(" (%s of %d)", one, copies[i]);
  }
  return warnings;
}

}  // namespace hooke::app
