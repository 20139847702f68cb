#include "hooke/command_line.h"
#include "hooke/geometry.h"
#include "hooke/model_io.h"
#include "hooke/model_options.h"
#include "hooke/output_file.h"
#include "hooke/settle/drops.h"
#include "hooke/statics.h"
#include "hooke/text_of.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

namespace hooke::app {

namespace {

using Json = nlohmann::ordered_json;

struct SettleOptions {
  std::string input;
  ModelOptions model;
  std::vector<double> center;
  DropOptions drops;
  std::optional<double> friction, restitution, height;
  std::string json, csv, out;
  int pose = 1;
};

/// A model with its poses.
struct Settled {
  Model model;
  MeshDesc solid;  ///< What drops: closed, or without triangles if the model could not be mended.
  StablePoses poses;
  std::optional<DropCounts> drops;
};

void add_options(CLI::App& app, SettleOptions& options) {
  app.add_option("MODEL", options.input, "Model to read")->required();
  add_model_options(app, options.model);
  app.add_option("--center", options.center, "Center of mass [m], after scale; that of the volume by default")
      ->delimiter(',')
      ->expected(3)
      ->option_text("X,Y,Z");
  auto* const drops =
      app.add_option("--drops", options.drops.count, "Also drop it so often in a world, turned at random")
          ->check(CLI::Range(1, 1000000));
  drops->excludes("--center");
  app.add_option("--seed", options.drops.seed, "Seed of the random orientations")->needs("--drops");
  add_number(app, "--height", options.height, 0, 1e6,
             "Height of the lowest point before a drop [m]; the radius about the center by default");
  add_number(app, "--friction", options.friction, 0, 100, "Friction of model and plane; 0.5 by default");
  add_number(app, "--restitution", options.restitution, 0, 1, "Restitution of both; 0 by default");
  for (const char* name : {"--height", "--friction", "--restitution"}) app.get_option(name)->needs(drops);
  app.add_option("--csv", options.csv, "Write the poses as a table; - prints it");
  app.add_option("--json", options.json, "Write all as JSON; - prints it");
  app.add_option("--out", options.out, "Write the model as it lies in a pose: .obj .glb .stl .3ds");
  app.add_option("--pose", options.pose, "Number of that pose, 1 for the most probable")
      ->needs("--out")
      ->check(CLI::PositiveNumber);
  app.footer(
      "The probability is that of slow rolling from a random orientation; --drops counts what a drop "
      "does.\n\n"
      "Examples:\n"
      "  hooke settle scenes/models/crate.3ds\n"
      "  hooke settle scenes/models/crate.3ds --fit 1 --drops 20 --csv poses.csv\n"
      "  hooke settle scenes/models/lantern.3ds --fit 0.4 --out lying.glb");
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

Result<void> drop(Settled& settled, const SettleOptions& options) {
  if (options.drops.count == 0) return {};
  if (settled.solid.triangles.empty()) {
    return Error{ErrorCode::kOutOfRange, "--drops", "only a closed model can be dropped; close it first"};
  }
  DropOptions drops = options.drops;
  double radius = 0;
  for (const Vec3& p : settled.solid.positions) {
    radius = std::max(radius, length(vector_cast<double>(p) - settled.poses.center));
  }
  drops.height = options.height.value_or(radius);
  drops.friction = options.friction.value_or(drops.friction);
  drops.restitution = options.restitution.value_or(drops.restitution);
  auto counts = drop(settled.solid, settled.poses, drops);
  if (!counts) return counts.error();
  settled.drops = std::move(counts).value();
  return {};
}

std::string csv_of(const Settled& settled) {
  std::string text = "pose,probability,normal_x,normal_y,normal_z,height,margin,tip_angle,tip_height";
  text += settled.drops ? ",drops\n" : "\n";
  for (std::size_t i = 0; i < settled.poses.poses.size(); ++i) {
    const StablePose& p = settled.poses.poses[i];
    text += text_of("%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", i + 1, p.probability, p.normal.x,
                    p.normal.y, p.normal.z, p.height, p.margin, p.tip_angle, p.tip_height);
    text += settled.drops ? text_of(",%d\n", settled.drops->poses[i]) : "\n";
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
  }
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print_table(const Settled& settled, const SettleOptions& options) {
  const StablePoses& all = settled.poses;
  std::printf("%s: %zu stable poses, center of mass at (%.6g, %.6g, %.6g) m\n", options.input.c_str(),
              all.poses.size(), all.center.x, all.center.y, all.center.z);
  std::printf("%4s %11s%s %26s %10s %9s %10s\n", "pose", "probability", settled.drops ? "   dropped" : "",
              "facet's normal", "height/m", "tips/deg", "rising/m");
  for (std::size_t i = 0; i < all.poses.size(); ++i) {
    const StablePose& p = all.poses[i];
    std::string dropped;
    if (settled.drops) dropped = text_of(" %9.4f", double(settled.drops->poses[i]) / options.drops.count);
    std::printf("%4zu %11.4f%s   (%7.4f,%7.4f,%7.4f) %10.4g %9.2f %10.3g\n", i + 1, p.probability,
                dropped.c_str(), p.normal.x, p.normal.y, p.normal.z, p.height,
                p.tip_angle * 180 / std::numbers::pi, p.tip_height);
  }
  if (settled.drops && settled.drops->elsewhere + settled.drops->moving > 0) {
    std::printf("of %d drops %d came to rest in no pose of these, and %d were still moving after a minute\n",
                options.drops.count, settled.drops->elsewhere, settled.drops->moving);
  }
}

/// Returns the drawn half of the model, moved into the pose.
Model placed(Model model, const StablePose& pose) {
  for (ModelVertex& vertex : model.vertices) {
    const auto [x, y, z] = vertex.position;
    const DVec3 p = rotate(pose.rotation, DVec3{x, y, z}) + pose.position;
    const auto [nx, ny, nz] = vertex.normal;
    const DVec3 n = rotate(pose.rotation, DVec3{nx, ny, nz});
    vertex.position = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    vertex.normal = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
  }
  return model;
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
  return export_model(placed(std::move(settled.model), pose), options.out);
}

}  // namespace

int command_settle(Arguments arguments) {
  CLI::App app("Finds the poses in which a model lies still on a plane, and how probable each is.",
               "hooke settle");
  SettleOptions options;
  add_options(app, options);
  if (const auto code = parse(app, arguments)) return *code;

  auto model = import_model(options.input, options.model.options());
  if (!model) return report(model.error());
  auto settled = settle(std::move(model).value(), options);
  if (!settled) return report(settled.error());
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
  if (const auto dropped = drop(settled.value(), options); !dropped) return report(dropped.error());
  if (!is_standard_output(options.json) && !is_standard_output(options.csv)) {
    print_table(settled.value(), options);
  }
  const auto written = write_all(std::move(settled).value(), options);
  return written ? kGood : report(written.error());
}

}  // namespace hooke::app
