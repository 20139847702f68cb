#include "hooke/view/view_log.h"

#include <nlohmann/json.hpp>

namespace hooke::app {

namespace {

using Json = nlohmann::ordered_json;

Json json_of_place(DVec3 place) {
  return Json::array({place.x, place.y, place.z});
}

Json objects_seen(const SessionView& view, const Eye& eye) {
  Json objects = Json::object();
  for (const auto& [name, place] : view.places) {
    const auto pixel = pixel_of(eye, place);
    objects[name] = {{"place", json_of_place(place)}};
    if (pixel) objects[name]["pixel"] = *pixel;
  }
  return objects;
}

Json mistakes_of(const SessionView& view) {
  Json lines = Json::array();
  for (const Error& error : view.file_errors) lines.push_back(to_line(error));
  return lines;
}

Json measured_of(const SessionView& view) {
  Json values = Json::object();
  for (const MeasuredValue& value : view.measured) values[value.name] = value.value;
  return values;
}

/// How much a debug picture has, and its legend.
Json insight_of(const SessionView& view) {
  if (!view.insight) return Json::object();
  const Insight& insight = *view.insight;
  return {{"lines", insight.lines.size()},        {"triangles", insight.triangles.size()},
          {"texts", insight.texts.size()},        {"contacts", insight.legend.contacts},
          {"force", insight.legend.force},        {"tension", insight.legend.full_tension},
          {"strain", insight.legend.full_strain}, {"asleep", insight.legend.asleep}};
}

}  // namespace

Result<void> ViewLog::open(const std::string& path) {
  if (path.empty()) return {};
  file_.open(path);
  if (file_) return {};
  return Error{ErrorCode::kFileNotWritable, path, "cannot be written"};
}

void ViewLog::write(const SessionView& view, const Eye& eye, const PictureFacts& facts) {
  if (!file_.is_open()) return;
  static constexpr const char* kStages[] = {"loading", "ready", "failed"};
  Json line = {{"picture", facts.picture},
               {"stage", kStages[static_cast<int>(view.stage)]},
               {"posted", facts.posted},
               {"commands", view.commands},
               {"step", view.step},
               {"last_step", view.last_step},
               {"time", view.time},
               {"playing", view.playing},
               {"speed", view.speed},
               {"held", view.held},
               {"undo", view.undo_count},
               {"said", view.said ? view.said->text : ""},
               {"redo", view.redo_count},
               {"built", view.built},
               {"opened", view.opened},
               {"selected", view.selected},
               {"edited", view.edited},
               {"mistakes", mistakes_of(view)},
               {"measured", measured_of(view)},
               {"insight", insight_of(view)},
               {"warnings", view.warnings},
               {"plot", facts.plot},
               {"rows", view.history ? view.history->size() : 0},
               {"boxes", facts.boxes},
               {"scale", facts.scale},
               {"font", facts.font_px},
               {"hint", facts.hint},
               {"help", facts.help},
               {"gl_error", facts.gl_error},
               {"size", eye.size},
               {"objects", objects_seen(view, eye)}};
  if (view.document) line["file"] = view.document->file;
  if (view.holding) line["hand"] = json_of_place(view.hand_place);
  file_ << line.dump() << '\n' << std::flush;
}

}  // namespace hooke::app
