#include "hooke/command_line.h"
#include "hooke/geometry.h"
#include "hooke/model_io.h"
#include "hooke/model_options.h"
#include "hooke/output_file.h"
#include "hooke/settle/drops.h"
#include "hooke/settle/scene_rest.h"
#include "hooke/settle/statics_report.h"
#include "hooke/statics.h"
#include "hooke/text_of.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>
#include <utility>

namespace hooke::app {

namespace {

using Json = nlohmann::ordered_json;

struct SettleOptions {
  std::string input;
  ModelOptions model;
  std::vector<double> center;
  DropOptions drops;
  std::optional<double> friction, restitution, height, disturbance, mass, slope, friction_torque;
  std::vector<std::string> cables;
  std::vector<double> axis, through;
  std::string json, csv, out;
  int pose = 1;
};

/// A model with its poses.
struct Settled {
  Model model;
  MeshDesc solid;  ///< What drops: closed, or without triangles if the model could not be mended.
  StablePoses poses;
  std::optional<DropCounts> drops;
  std::optional<std::vector<int>> stays;  ///< For each pose, the disturbances that it outlived.
};

/// Adds the options of rests that are not on a horizontal plane.
void add_rests(CLI::App& app, SettleOptions& options) {
  auto* const cables =
      app.add_option("--cable", options.cables,
                     "Hang it by this cable, from a place on the model to an anchor; again for each cable")
          ->option_text("X,Y,Z,ANCHOR_X,ANCHOR_Y,ANCHOR_Z,LENGTH");
  auto* const axis = app.add_option("--axis", options.axis, "Direction of an axis that it may turn about")
                         ->delimiter(',')
                         ->expected(3)
                         ->option_text("X,Y,Z");
  app.add_option("--through", options.through, "A point of the axis [m]; the origin by default")
      ->delimiter(',')
      ->expected(3)
      ->needs(axis)
      ->option_text("X,Y,Z");
  add_number(app, "--friction-torque", options.friction_torque, 0, 1e12, "Friction of the axle [N m]");
  app.get_option("--friction-torque")->needs(axis);
  add_number(app, "--slope", options.slope, 0, 89.9, "Lay it on a slope that falls along +x [degrees]");
  add_number(app, "--mass", options.mass, 1e-9, 1e12, "Mass, for tensions and torques [kg]; 1 by default");
  auto* const slope = app.get_option("--slope");
  axis->excludes(cables)->excludes(slope);
  cables->excludes(slope);
  for (const char* name : {"--drops", "--disturb"}) {
    for (auto* const other : {axis, cables, slope}) other->excludes(app.get_option(name));
  }
}

/// Adds the options of trials in a world.
void add_trials(CLI::App& app, SettleOptions& options) {
  auto* const drops =
      app.add_option("--drops", options.drops.count, "Also drop it so often in a world, turned at random")
          ->check(CLI::Range(1, 1000000));
  drops->excludes("--center");
  app.add_option("--seed", options.drops.seed, "Seed of the random orientations")->needs("--drops");
  add_number(app, "--height", options.height, 0, 1e6,
             "Height of the lowest point before a drop [m]; the radius about the center by default");
  add_number(app, "--disturb", options.disturbance, 1e-6, 1e6,
             "Also lift it so far out of each pose, and tilt it so far to eight sides, and tell whether it "
             "stays [m]");
  app.get_option("--disturb")->excludes("--center");
  add_number(app, "--friction", options.friction, 0, 100,
             "Friction of model and plane, for --drops, --disturb and --slope; 0.5 by default");
  add_number(app, "--restitution", options.restitution, 0, 1, "Restitution of both; 0 by default");
  app.get_option("--height")->needs(drops);
  app.add_option("--workers", options.drops.workers,
                 "Threads for --drops and --disturb; the result does not depend on it")
      ->check(CLI::Range(1, 64));
}

void add_options(CLI::App& app, SettleOptions& options) {
  app.add_option("MODEL", options.input,
                 "Model to read, or a scene, which is brought to rest: hooke settle SCENE.json --help")
      ->required();
  add_model_options(app, options.model);
  app.add_option("--center", options.center, "Center of mass [m], after scale; that of the volume by default")
      ->delimiter(',')
      ->expected(3)
      ->option_text("X,Y,Z");
  add_trials(app, options);
  add_rests(app, options);
  app.add_option("--csv", options.csv, "Write the poses as a table; - prints it");
  app.add_option("--json", options.json, "Write all as JSON; - prints it");
  app.add_option("--out", options.out, "Write the model as it lies in a pose: .obj .glb .stl .3ds");
  app.add_option("--pose", options.pose, "Number of that pose, 1 for the most probable")
      ->needs("--out")
      ->check(one_or_more());
  app.footer(
      "The probability is that of slow rolling from a random orientation; --drops counts what a drop "
      "does.\n\n"
      "Examples:\n"
      "  hooke settle scenes/models/crate.3ds\n"
      "  hooke settle scenes/models/crate.3ds --fit 1 --drops 20 --csv poses.csv\n"
      "  hooke settle scenes/models/crate.3ds --fit 1 --disturb 0.001\n"
      "  hooke settle scenes/models/lantern.3ds --fit 0.4 --out lying.glb\n"
      "  hooke settle scenes/models/crate.3ds --fit 1 --mass 50 --cable 0.5,0.5,0,0,3,0,2\n"
      "  hooke settle scenes/models/crate.3ds --fit 1 --axis 0,0,1 --through 0.5,0,0\n"
      "  hooke settle scenes/models/crate.3ds --fit 1 --slope 20 --friction 0.4");
}

/// Finds the poses. A mesh that is no solid is mended; one that cannot be mended is closed by voxels, but
/// only to find its center of mass, because voxels have other facets.
Result<Settled> settle(Model model, const SettleOptions& options) {
  Settled settled;
  settled.model = std::move(model);
  const MeshDesc& mesh = settled.model.mesh;
  std::optional<DVec3> center;
  if (options.center.size() == 3) center = DVec3{options.center[0], options.center[1], options.center[2]};
  if (auto repaired = repair_solid(mesh)) {
    settled.solid = std::move(repaired).value().mesh;
  } else if (!center) {
    const auto remesh = remesh_solid(mesh, default_voxel(mesh));
    if (!remesh) return remesh.error();
    const auto closed = find_stable_poses(remesh.value().mesh);
    if (!closed) return closed.error();
    center = closed.value().center;
    warn({ErrorCode::kOutOfRange, options.input,
          repaired.error().message + "; its center of mass is that of the model closed by voxels of " +
              text_of("%.3g m; --center gives another", static_cast<double>(remesh.value().voxel))});
  }
  auto poses = find_stable_poses(settled.solid.triangles.empty() ? mesh : settled.solid, center);
  if (!poses) return poses.error();
  settled.poses = std::move(poses).value();
  return settled;
}

/// Makes the trials in a world that were asked for.
Result<void> try_out(Settled& settled, const SettleOptions& options) {
  if (options.drops.count == 0 && !options.disturbance) return {};
  if (settled.solid.triangles.empty()) {
    return Error{ErrorCode::kOutOfRange, options.drops.count > 0 ? "--drops" : "--disturb",
                 "only a closed model can be dropped; close it first"};
  }
  DropOptions drops = options.drops;
  drops.height = options.height.value_or(radius_of(settled.solid, settled.poses.center));
  drops.friction = options.friction.value_or(drops.friction);
  drops.restitution = options.restitution.value_or(drops.restitution);
  if (options.drops.count > 0) {
    auto counts = drop(settled.solid, settled.poses, drops);
    if (!counts) return counts.error();
    settled.drops = std::move(counts).value();
  }
  if (options.disturbance) {
    auto stays = disturb(settled.solid, settled.poses, *options.disturbance, drops);
    if (!stays) return stays.error();
    settled.stays = std::move(stays).value();
  }
  return {};
}

std::string csv_of(const Settled& settled) {
  std::string text = "pose,probability,normal_x,normal_y,normal_z,height,margin,tip_angle,tip_height";
  text += std::string(settled.drops ? ",drops" : "") + (settled.stays ? ",stays\n" : "\n");
  for (std::size_t i = 0; i < settled.poses.poses.size(); ++i) {
    const StablePose& p = settled.poses.poses[i];
    text += text_of("%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", i + 1, p.probability, p.normal.x,
                    p.normal.y, p.normal.z, p.height, p.margin, p.tip_angle, p.tip_height);
    if (settled.drops) text += text_of(",%d", settled.drops->poses[i]);
    text += settled.stays ? text_of(",%d\n", (*settled.stays)[i]) : "\n";
  }
  return text;
}

Json json_of_vector(DVec3 v) {
  return {v.x, v.y, v.z};
}

std::string json_text_of(const Settled& settled, const SettleOptions& options) {
  Json report = {{"model", options.input},
                 {"center", json_of_vector(settled.poses.center)},
                 {"hull_error", settled.poses.hull_error}};
  Json& poses = report["poses"] = Json::array();
  for (std::size_t i = 0; i < settled.poses.poses.size(); ++i) {
    const StablePose& p = settled.poses.poses[i];
    Json pose = {{"probability", p.probability}, {"normal", json_of_vector(p.normal)}};
    if (settled.drops) pose["frequency"] = double(settled.drops->poses[i]) / options.drops.count;
    if (settled.stays) pose["stays"] = (*settled.stays)[i];
    pose["height"] = p.height;
    pose["margin"] = p.margin;
    pose["tip_angle"] = p.tip_angle;
    pose["tip_height"] = p.tip_height;
    pose["position"] = json_of_vector(p.position);
    pose["rotation"] = {p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w};
    Json& support = pose["support"] = Json::array();
    for (const DVec3& corner : p.support) support.push_back(json_of_vector(corner));
    poses.push_back(std::move(pose));
  }
  if (settled.drops) {
    report["drops"] = options.drops.count;
    report["seed"] = options.drops.seed;
    report["elsewhere"] = double(settled.drops->elsewhere) / options.drops.count;
    report["moving"] = double(settled.drops->moving) / options.drops.count;
    Json& others = report["other_poses"] = Json::array();
    for (const OtherPose& other : settled.drops->others) {
      others.push_back({{"normal", json_of_vector(other.normal)},
                        {"frequency", double(other.count) / options.drops.count}});
    }
  }
  if (settled.stays) {
    report["disturbance"] = *options.disturbance;
    report["disturbances"] = kDisturbances;
  }
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print_table(const Settled& settled, const SettleOptions& options) {
  const StablePoses& all = settled.poses;
  std::printf("%s: %zu stable poses, center of mass at (%.6g, %.6g, %.6g) m\n", options.input.c_str(),
              all.poses.size(), all.center.x, all.center.y, all.center.z);
  std::printf("%4s %11s%s%s %26s %10s %9s %10s\n", "pose", "probability", settled.drops ? "   dropped" : "",
              settled.stays ? "  stays" : "", "facet's normal", "height/m", "tips/deg", "rising/m");
  for (std::size_t i = 0; i < all.poses.size(); ++i) {
    const StablePose& p = all.poses[i];
    std::string dropped;
    if (settled.drops) dropped = text_of(" %9.4f", double(settled.drops->poses[i]) / options.drops.count);
    if (settled.stays) dropped += text_of("    %d/%d", (*settled.stays)[i], kDisturbances);
    std::printf("%4zu %11.4f%s   (%7.4f,%7.4f,%7.4f) %10.4g %9.2f %10.3g\n", i + 1, p.probability,
                dropped.c_str(), p.normal.x, p.normal.y, p.normal.z, p.height,
                p.tip_angle * 180 / std::numbers::pi, p.tip_height);
  }
  if (settled.drops && settled.drops->elsewhere + settled.drops->moving > 0) {
    std::printf("of %d drops %d came to rest in no pose of these, and %d were still moving after a minute\n",
                options.drops.count, settled.drops->elsewhere, settled.drops->moving);
    for (const OtherPose& other : settled.drops->others) {
      std::printf("%4s %11s %9.4f   (%7.4f,%7.4f,%7.4f) points down, no stable pose\n", "-", "",
                  double(other.count) / options.drops.count, other.normal.x, other.normal.y, other.normal.z);
    }
  }
}

/// Returns the drawn half of the model, moved to where it rests.
Model placed(Model model, const RestPlace& place) {
  for (ModelVertex& vertex : model.vertices) {
    const auto [x, y, z] = vertex.position;
    const DVec3 p = rotate(place.rotation, DVec3{x, y, z}) + place.position;
    const auto [nx, ny, nz] = vertex.normal;
    const DVec3 n = rotate(place.rotation, DVec3{nx, ny, nz});
    vertex.position = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    vertex.normal = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
  }
  return model;
}

DVec3 vector_of_words(const std::vector<double>& words) {
  return words.size() == 3 ? DVec3{words[0], words[1], words[2]} : DVec3{};
}

/// Reads the seven numbers of a cable.
Result<Cable> cable_of(const std::string& word) {
  double numbers[7] = {};
  const char* text = word.c_str();
  for (int i = 0; i < 7; ++i) {
    char* end = nullptr;
    numbers[i] = std::strtod(text, &end);
    if (end == text || *end != (i < 6 ? ',' : '\0')) {
      return Error{ErrorCode::kOutOfRange, "--cable",
                   "'" + word + "' is not seven numbers with commas: place, anchor, length"};
    }
    text = end + 1;
  }
  return Cable{.attachment = {numbers[0], numbers[1], numbers[2]},
               .anchor = {numbers[3], numbers[4], numbers[5]},
               .length = numbers[6]};
}

bool is_on_plane(const SettleOptions& options) {
  return options.cables.empty() && options.axis.empty() && !options.slope;
}

/// Tells how the model hangs, turns about an axis or lies on a slope, whichever is asked for.
Result<StaticsReport> report_rest(const Settled& settled, const SettleOptions& options) {
  const double mass = options.mass.value_or(1);
  const DVec3 center = settled.poses.center;
  if (options.slope) {
    const MeshDesc& mesh = settled.solid.triangles.empty() ? settled.model.mesh : settled.solid;
    return report_slope(options.input, mesh, center, {*options.slope, options.friction.value_or(0.5)});
  }
  if (!options.axis.empty()) {
    return report_axle(options.input, {.center = center,
                                       .point = vector_of_words(options.through),
                                       .axis = vector_of_words(options.axis),
                                       .mass = mass,
                                       .friction_torque = options.friction_torque.value_or(0)});
  }
  HangingSolid solid = {.center = center, .mass = mass};
  for (const std::string& word : options.cables) {
    const auto cable = cable_of(word);
    if (!cable) return cable.error();
    solid.cables.push_back(cable.value());
  }
  return report_hanging(options.input, solid);
}

/// Writes or prints what statics says of the model, and the model in its pose.
ExitCode finish_rest(Settled settled, const SettleOptions& options) {
  const auto made = report_rest(settled, options);
  if (!made) return report(made.error());
  const StaticsReport& rest = made.value();
  if (!options.out.empty() && static_cast<std::size_t>(options.pose) > rest.places.size()) {
    return report({ErrorCode::kOutOfRange, "--pose",
                   text_of("%d: the model has %zu such poses", options.pose, rest.places.size())});
  }
  if (!is_standard_output(options.json) && !is_standard_output(options.csv)) {
    std::fputs(rest.table.c_str(), stdout);
  }
  if (!options.csv.empty()) {
    if (auto written = write_file(options.csv, rest.csv); !written) return report(written.error());
  }
  if (!options.json.empty()) {
    if (auto written = write_file(options.json, rest.json); !written) return report(written.error());
  }
  if (options.out.empty()) return kGood;
  const RestPlace& place = rest.places[static_cast<std::size_t>(options.pose) - 1];
  const auto written = export_model(placed(std::move(settled.model), place), options.out);
  return written ? kGood : report(written.error());
}

/// Writes what was asked for.
Result<void> write_all(Settled settled, const SettleOptions& options) {
  if (!options.csv.empty()) {
    if (auto written = write_file(options.csv, csv_of(settled)); !written) return written;
  }
  if (!options.json.empty()) {
    if (auto written = write_file(options.json, json_text_of(settled, options)); !written) return written;
  }
  if (options.out.empty()) return {};
  const StablePose& pose = settled.poses.poses[static_cast<std::size_t>(options.pose) - 1];
  return export_model(placed(std::move(settled.model), {pose.position, pose.rotation}), options.out);
}

}  // namespace

int command_settle(Arguments arguments) {
  if (!arguments.empty() && std::string_view(arguments[0]).ends_with(".json")) return settle_scene(arguments);
  CLI::App app("Finds where a model rests: lying on a plane or slope, hung from cables, about an axis.",
               "hooke settle");
  SettleOptions options;
  add_options(app, options);
  if (const auto code = parse(app, arguments)) return *code;
  const bool tries = options.drops.count > 0 || options.disturbance;
  if (options.friction && !tries && !options.slope) {
    return report({ErrorCode::kOutOfRange, "--friction", "needs --drops, --disturb or --slope"});
  }
  if (options.restitution && !tries) {
    return report({ErrorCode::kOutOfRange, "--restitution", "needs --drops or --disturb"});
  }

  auto model = import_model(options.input, options.model.options());
  if (!model) return report(model.error());
  auto settled = settle(std::move(model).value(), options);
  if (!settled) return report(settled.error());
  if (!is_on_plane(options)) return finish_rest(std::move(settled).value(), options);
  const std::size_t count = settled.value().poses.poses.size();
  if (static_cast<std::size_t>(options.pose) > count) {
    return report({ErrorCode::kOutOfRange, "--pose",
                   text_of("%d: the model has %zu stable poses", options.pose, count)});
  }
  if (settled.value().poses.hull_error > 0.01 * settled.value().poses.poses[0].height) {
    warn({ErrorCode::kLimitExceeded, options.input,
          text_of("its hull has more than 256 corners; those used leave points %.3g m outside",
                  settled.value().poses.hull_error)});
  }
  if (const auto tried = try_out(settled.value(), options); !tried) return report(tried.error());
  if (!is_standard_output(options.json) && !is_standard_output(options.csv)) {
    print_table(settled.value(), options);
  }
  const auto written = write_all(std::move(settled).value(), options);
  return written ? kGood : report(written.error());
}

}  // namespace hooke::app
