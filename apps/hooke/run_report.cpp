#include "hooke/run_report.h"

#include "hooke/json_of.h"
#include "hooke/text_of.h"
#include "hooke/version.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hooke::app {

using Json = nlohmann::ordered_json;

namespace {

struct RouteName {
  const char* name;
  std::uint32_t RouteCounts::*number;
};

constexpr RouteName kRouteNames[] = {
    {"contacts_soft", &RouteCounts::contacts_soft},
    {"contacts_direct", &RouteCounts::contacts_direct},
    {"contacts_coupled", &RouteCounts::contacts_coupled},
    {"contacts_bouncing", &RouteCounts::contacts_bouncing},
    {"pairs_at_start", &RouteCounts::pairs_at_start},
    {"pairs_in_the_middle", &RouteCounts::pairs_in_the_middle},
    {"pairs_at_impact", &RouteCounts::pairs_at_impact},
    {"pairs_each_substep", &RouteCounts::pairs_each_substep},
    {"hooks_tree", &RouteCounts::hooks_tree},
    {"hooks_approximate_tree", &RouteCounts::hooks_approximate_tree},
    {"hooks_loop", &RouteCounts::hooks_loop},
    {"hooks_block", &RouteCounts::hooks_block},
    {"hooks_iterative", &RouteCounts::hooks_iterative},
    {"hooks_coupled", &RouteCounts::hooks_coupled},
    {"ropes_alone", &RouteCounts::ropes_alone},
    {"ropes_coupled", &RouteCounts::ropes_coupled},
    {"points_swept", &RouteCounts::points_swept},
    {"points_in_ropes", &RouteCounts::points_in_ropes},
    {"points_coupled", &RouteCounts::points_coupled},
    {"articulations", &RouteCounts::articulations},
    {"direct_islands", &RouteCounts::direct_islands},
    {"coupled_groups", &RouteCounts::coupled_groups},
};

/// Name of the object that has this point; empty for none.
std::string name_of(const Simulation& simulation, PointRef point) {
  for (const SceneObject& object : simulation.objects()) {
    if (has_point(object, point)) return object.name;
  }
  return {};
}

}  // namespace

StepTimes step_times(const std::vector<double>& step_ms) {
  if (step_ms.empty()) return {};
  std::vector<double> sorted = step_ms;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double part) {
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  };
  return {.min = sorted.front(), .median = at(0.5), .p99 = at(0.99)};
}

std::string hash_text(std::uint64_t hash) {
  return text_of("%016llx", static_cast<unsigned long long>(hash));
}

bool passed(const Simulation& simulation) {
  const auto verdicts = simulation.verdicts();
  return simulation.errors().empty() &&
         std::all_of(verdicts.begin(), verdicts.end(), [](const SceneVerdict& v) { return v.passed; });
}

std::vector<const SceneObject*> broken_objects(const Simulation& simulation) {
  std::vector<const SceneObject*> broken;
  for (const SceneObject& object : simulation.objects()) {
    if (object.broken) broken.push_back(&object);
  }
  std::stable_sort(broken.begin(), broken.end(),
                   [](const SceneObject* a, const SceneObject* b) { return a->broke.time < b->broke.time; });
  return broken;
}

/// Returns when and how a cloth or a solid tore or was cut first, and how many points it got since.
static Json json_of_tear(const World& world, const SceneObject& object) {
  const bool is_cloth = object.kind == SceneObject::Kind::kCloth;
  Json json = {{is_cloth ? "cloth" : "solid", object.name}, {"time", object.broke.time}};
  if (object.cut_by.empty()) {
    json[is_cloth ? "strain" : "stress"] = object.tore_at;
  } else {
    json["cut_by"] = object.cut_by;
  }
  json["points"] = is_cloth ? world.splits(object.cloth).size() : world.splits(object.solid).size();
  return json;
}

static Json json_of_breaks(const Simulation& simulation) {
  Json list = Json::array();
  const World& world = simulation.world();
  for (const SceneObject* object : broken_objects(simulation)) {
    if (object->kind == SceneObject::Kind::kCloth || object->kind == SceneObject::Kind::kSolid) {
      list.push_back(json_of_tear(world, *object));
      continue;
    }
    const bool is_rope = object->kind == SceneObject::Kind::kRope;
    list.push_back({{is_rope ? "rope" : "hook", object->name},
                    {"time", object->broke.time},
                    {"force", object->broke.force},
                    {"torque", object->broke.torque}});
    if (is_rope) list.back()["segments"] = world.broken_segments(object->rope);
    if (!object->cut_by.empty()) list.back()["cut_by"] = object->cut_by;
  }
  return list;
}

/// Returns text such as "; 4 hooks and 1 rope in all"; nothing for one object.
static std::string count_of_breaks(const std::vector<const SceneObject*>& broken) {
  if (broken.size() < 2) return {};
  std::string text;
  const auto add = [&](SceneObject::Kind kind, const char* one) {
    const auto count = std::count_if(broken.begin(), broken.end(),
                                     [kind](const SceneObject* object) { return object->kind == kind; });
    if (count == 0) return;
    text += text_of("%s%d %s%s", text.empty() ? "; " : " and ", static_cast<int>(count), one,
                    count > 1 ? "s" : "");
  };
  add(SceneObject::Kind::kHook, "hook");
  add(SceneObject::Kind::kRope, "rope");
  add(SceneObject::Kind::kCloth, "cloth");
  add(SceneObject::Kind::kSolid, "solid");
  return text + " in all";
}

/// Returns text such as "'glue' first, at 0.853 s, as it needed 312 N and 4.1 N m; 4 hooks in all".
static std::string text_of_breaks(const Simulation& simulation) {
  const std::vector<const SceneObject*> broken = broken_objects(simulation);
  if (broken.empty()) return {};
  const SceneObject& object = *broken.front();
  const BreakEvent& first = object.broke;
  std::string text = "broke     '" + object.name + "' first" + text_of(", at %.6g s, as it ", first.time);
  if (!object.cut_by.empty()) {
    text += "was cut by '" + object.cut_by + "'";
  } else if (object.kind == SceneObject::Kind::kSolid) {
    text += text_of("was stressed by %.4g Pa", static_cast<double>(object.tore_at));
  } else if (object.kind == SceneObject::Kind::kCloth) {
    text += text_of("was strained by %.3g %%", 100 * static_cast<double>(object.tore_at));
  } else {
    text += text_of("needed %.4g N", static_cast<double>(first.force));
  }
  if (first.torque > Real(0)) text += text_of(" and %.4g N m", static_cast<double>(first.torque));
  return text + count_of_breaks(broken) + "\n";
}

/// Returns the bodies that became soft, in the order of time.
static std::vector<const SceneObject*> yielded_objects(const Simulation& simulation) {
  std::vector<const SceneObject*> yielded;
  for (const SceneObject& object : simulation.objects()) {
    if (object.blow) yielded.push_back(&object);
  }
  std::stable_sort(yielded.begin(), yielded.end(),
                   [](const SceneObject* a, const SceneObject* b) { return a->blow->time < b->blow->time; });
  return yielded;
}

static Json json_of_yields(const Simulation& simulation) {
  Json list = Json::array();
  for (const SceneObject* object : yielded_objects(simulation)) {
    const YieldEvent& blow = *object->blow;
    list.push_back({{"body", object->name},
                    {"time", blow.time},
                    {"impulse", blow.impulse},
                    {"place", {blow.place.x, blow.place.y, blow.place.z}},
                    {"times", object->yielded}});
    if (object->froze) list.back()["froze"] = object->froze->time;
  }
  return list;
}

/// Returns a line such as "yielded   'door' at 0.45 s, for 86.5 N s; rigid again at 1.77 s" for each body
/// that became soft.
static std::string text_of_yields(const Simulation& simulation) {
  std::string text;
  for (const SceneObject* object : yielded_objects(simulation)) {
    text +=
        "yielded   '" + object->name + "'" +
        text_of(" at %.6g s, for %.4g N s", object->blow->time, static_cast<double>(object->blow->impulse));
    if (object->yielded > 1) text += text_of(", first of %d times", object->yielded);
    const bool is_soft = simulation.world().soft_form(object->body) != SolidId{};
    text += is_soft || !object->froze ? "; soft at the end"
                                      : text_of("; rigid again at %.6g s", object->froze->time);
    text += "\n";
  }
  return text;
}

static Json json_of_problems(const std::vector<RunWarning>& problems) {
  Json list = Json::array();
  for (const RunWarning& one : problems) {
    list.push_back({{"object", one.object},
                    {"what", one.what},
                    {"worst", one.worst},
                    {"limit", one.limit},
                    {"unit", one.unit},
                    {"time", one.time},
                    {"cure", one.cure}});
  }
  return list;
}

void note_refused(const StepReport& step, StepReport& worst) {
  for (const RefusedCount& count : refused_counts()) {
    worst.*count.number = std::max(worst.*count.number, step.*count.number);
    if (count.error != nullptr) worst.*count.error = std::max(worst.*count.error, step.*count.error);
  }
}

/// Returns how many contacts, hooks and ropes took each route in the last step.
static Json json_of_routes(const RouteCounts& routes) {
  Json json = Json::object();
  for (const RouteName& route : kRouteNames) json[route.name] = routes.*route.number;
  return json;
}

/// Returns the largest number of each kind in any step.
static Json json_of_refused(const StepReport& worst) {
  Json json = Json::object();
  for (const RefusedCount& count : refused_counts()) {
    json[count.name] = worst.*count.number;
    if (count.error != nullptr) json[count.error_name] = worst.*count.error;
  }
  return json;
}

std::string run_json(const Simulation& simulation, const RunRecord& record) {
  const World& world = simulation.world();
  const Measurement end = world.measure();
  const StepTimes times = step_times(record.step_ms);
  Json errors = Json::array();
  for (const Error& error : simulation.errors()) errors.push_back(to_line(error));
  const Json report = {
      {"version", kVersion},
      {"scene", record.scene},
      {"steps", world.step_count()},
      {"seconds", world.time()},
      {"ms_per_step", {{"min", times.min}, {"median", times.median}, {"p99", times.p99}}},
      {"energy", {{"start", json_of(record.start)}, {"end", json_of(end.energy)}}},
      {"momentum", {end.momentum.x, end.momentum.y, end.momentum.z}},
      {"largest_stretch", end.largest_stretch},
      {"most_stretched", name_of(simulation, end.most_stretched)},
      {"mean_stretch", end.mean_stretch},
      {"largest_penetration", end.largest_penetration},
      {"largest_gap", end.largest_gap},
      {"contacts", record.last.contacts},
      {"clusters", record.last.clusters},
      {"rows_direct", record.last.rows_direct},
      {"routes", json_of_routes(record.last.routes)},
      {"refused", json_of_refused(record.worst)},
      {"broke", json_of_breaks(simulation)},
      {"yielded", json_of_yields(simulation)},
      {"state_hash", hash_text(world.state_hash())},
      {"expect", json_of(simulation, simulation.verdicts())},
      {"passed", passed(simulation)},
      {"errors", errors},
      {"notes", record.notes},
      {"warnings", record.warnings},
      {"problems", json_of_problems(record.problems)},
  };
  // The name of a file may have any bytes, but a report is UTF-8.
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string run_summary(const Simulation& simulation, const RunRecord& record) {
  const World& world = simulation.world();
  const Measurement end = world.measure();
  const StepTimes times = step_times(record.step_ms);
  const double wall = std::accumulate(record.step_ms.begin(), record.step_ms.end(), 0.0) / 1000;
  std::string text = record.scene + ": " + simulation.scene().title + "\n";
  text += text_of("time      %.6g s in %llu steps, computed in %.3g s", world.time(),
                  static_cast<unsigned long long>(world.step_count()), wall);
  if (wall > 0) text += text_of(" (%.3g x real time)", world.time() / wall);
  text += text_of("\nstep      %.4g ms median, %.4g fastest, %.4g at 99 %%\n", times.median, times.min,
                  times.p99);
  text += text_of("energy    %.6g J kinetic, %.6g potential, %.6g elastic; at the start %.6g, %.6g, %.6g\n",
                  end.energy.kinetic, end.energy.potential, end.energy.elastic, record.start.kinetic,
                  record.start.potential, record.start.elastic);
  text += text_of("stretch   %.3g %% at most", 100 * end.largest_stretch);
  if (const std::string name = name_of(simulation, end.most_stretched); !name.empty())
    text += " ('" + name + "')";
  text += text_of(", %.3g %% on average\n", 100 * end.mean_stretch);
  text += text_of("contacts  %u, deepest overlap %.3g mm\n", record.last.contacts,
                  1000 * end.largest_penetration);
  text += text_of_breaks(simulation);
  text += text_of_yields(simulation);
  text += "hash      " + hash_text(world.state_hash()) + "\n";
  text += simulation.report();
  const std::size_t due = simulation.verdicts().size();
  const std::size_t promised = simulation.scene().expect.size();
  if (due < promised) {
    text += text_of("%zu of %zu expectations are due later than this run\n", promised - due, promised);
  }
  return text;
}

std::string csv_header() {
  return "step,time,kinetic,potential,elastic,momentum_x,momentum_y,momentum_z,largest_stretch,"
         "largest_penetration,largest_gap,contacts,state_hash\n";
}

std::string csv_line(const World& world, std::uint32_t contacts) {
  const Measurement m = world.measure();
  return text_of("%llu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%u,",
                 static_cast<unsigned long long>(world.step_count()), world.time(), m.energy.kinetic,
                 m.energy.potential, m.energy.elastic, m.momentum.x, m.momentum.y, m.momentum.z,
                 m.largest_stretch, m.largest_penetration, m.largest_gap, contacts) +
         hash_text(world.state_hash()) + "\n";
}

}  // namespace hooke::app
