#include "hooke/settle/statics_report.h"

#include "hooke/text_of.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

namespace hooke::app {

namespace {

using RestJson = nlohmann::ordered_json;

constexpr double kDegrees = 180 / std::numbers::pi;

RestJson json_of_place(DVec3 v) {
  return {v.x, v.y, v.z};
}

RestJson json_of_turn(const Quaternion<double>& q) {
  return {q.x, q.y, q.z, q.w};
}

std::string text_of_json(const RestJson& json) {
  return json.dump(2, ' ', false, RestJson::error_handler_t::replace) + "\n";
}

std::string text_of_pose(DVec3 position, const Quaternion<double>& q) {
  return text_of("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", position.x, position.y, position.z, q.x, q.y,
                 q.z, q.w);
}

constexpr const char* kPoseColumns =
    "position_x,position_y,position_z,rotation_x,rotation_y,rotation_z,rotation_w";

void add_hanging_texts(StaticsReport& report, const HangingSolid& solid, const HangingPose& pose) {
  const double weight = solid.mass * solid.gravity;
  const std::size_t number = report.places.size() + 1;
  report.table += text_of("pose %zu: center of mass at (%.6g, %.6g, %.6g) m", number, pose.center.x,
                          pose.center.y, pose.center.z);
  if (pose.neutral > 1) {
    report.table += ", indifferent: every attitude rests";
  } else {
    report.table += text_of(", stiffness %.4g N/m%s", pose.stiffness,
                            pose.neutral == 1 ? ", free to turn about the vertical" : "");
  }
  report.table += "\n";
  for (std::size_t i = 0; i < pose.tensions.size(); ++i) {
    report.table += text_of("  cable %zu  %12.6g N  %7.4f of the weight%s\n", i + 1, pose.tensions[i],
                            pose.tensions[i] / weight, pose.tensions[i] > 0 ? "" : "  slack");
  }
  if (pose.is_indeterminate) {
    report.table += "  other tensions would balance it, too: these are of cables of equal stiffness\n";
  }
  report.csv += text_of("%zu,%.17g,%d,", number, pose.stiffness, pose.neutral) +
                text_of_pose(pose.position, pose.rotation);
  for (const double tension : pose.tensions) report.csv += text_of(",%.17g", tension);
  report.csv += "\n";
  report.places.push_back({pose.position, pose.rotation});
}

/// What becomes of a solid on a facet of the slope.
const char* fate_of(const SlopePose& pose, bool slides) {
  if (pose.upright_share < 1) return slides ? "slides, tips in some headings" : "tips in some headings";
  return slides ? "slides" : "stays";
}

}  // namespace

Result<StaticsReport> report_hanging(const std::string& model, const HangingSolid& solid) {
  const auto poses = find_hanging_poses(solid);
  if (!poses) return poses.error();
  StaticsReport report;
  report.table =
      text_of("%s: %.6g kg on %zu cables, %zu stable %s, the lowest first\n", model.c_str(), solid.mass,
              solid.cables.size(), poses.value().size(), poses.value().size() == 1 ? "pose" : "poses");
  report.csv = std::string("pose,stiffness,neutral,") + kPoseColumns;
  for (std::size_t i = 0; i < solid.cables.size(); ++i) report.csv += text_of(",tension_%zu", i + 1);
  report.csv += "\n";
  RestJson json = {{"model", model}, {"mass", solid.mass}, {"center", json_of_place(solid.center)}};
  RestJson& list = json["poses"] = RestJson::array();
  for (const HangingPose& pose : poses.value()) {
    add_hanging_texts(report, solid, pose);
    list.push_back({{"position", json_of_place(pose.position)},
                    {"rotation", json_of_turn(pose.rotation)},
                    {"center", json_of_place(pose.center)},
                    {"tensions", pose.tensions},
                    {"stiffness", pose.stiffness},
                    {"neutral", pose.neutral},
                    {"indeterminate", pose.is_indeterminate},
                    {"residual", pose.residual}});
  }
  report.json = text_of_json(json);
  return report;
}

Result<StaticsReport> report_axle(const std::string& model, const AxleSolid& solid) {
  const auto found = find_axle_rest(solid);
  if (!found) return found.error();
  const AxleRest& rest = found.value();
  StaticsReport report;
  if (rest.is_indifferent) {
    report.table = model + ": rests at every angle: gravity has no torque about the axis\n";
  } else {
    report.table = text_of(
        "%s: center of mass %.6g m from the axis\n"
        "stable at    %10.4f deg from how it is given\n"
        "unstable at  %10.4f deg\n"
        "torque of gravity about the axis %.6g N m as given, %.6g N m at most\n",
        model.c_str(), rest.arm, rest.stable_angle * kDegrees, rest.unstable_angle * kDegrees, rest.torque,
        rest.largest_torque);
    if (solid.friction_torque > 0) {
      report.table += text_of("friction of %.6g N m holds it up to %.4f deg from either\n",
                              solid.friction_torque, rest.held_within * kDegrees);
    }
    report.table += rest.stays ? "it stays as it is given\n" : "it does not stay as it is given\n";
  }
  report.csv = std::string("stable_angle,unstable_angle,arm,largest_torque,torque,held_within,stays,") +
               kPoseColumns + "\n" +
               text_of("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d,", rest.stable_angle, rest.unstable_angle,
                       rest.arm, rest.largest_torque, rest.torque, rest.held_within, rest.stays ? 1 : 0) +
               text_of_pose(rest.position, rest.rotation) + "\n";
  report.json = text_of_json({{"model", model},
                              {"mass", solid.mass},
                              {"center", json_of_place(solid.center)},
                              {"indifferent", rest.is_indifferent},
                              {"stable_angle", rest.stable_angle},
                              {"unstable_angle", rest.unstable_angle},
                              {"arm", rest.arm},
                              {"largest_torque", rest.largest_torque},
                              {"torque", rest.torque},
                              {"held_within", rest.held_within},
                              {"stays", rest.stays},
                              {"position", json_of_place(rest.position)},
                              {"rotation", json_of_turn(rest.rotation)}});
  report.places.push_back({rest.position, rest.rotation});
  return report;
}

Result<StaticsReport> report_slope(const std::string& model, const MeshDesc& mesh, DVec3 center,
                                   const SlopeWords& slope) {
  const auto found = find_slope_poses(mesh, slope.degrees / kDegrees, slope.friction, center);
  if (!found) return found.error();
  const SlopePoses& all = found.value();
  StaticsReport report;
  report.table = text_of("%s: on a slope of %.6g deg with friction %.6g it %s", model.c_str(), slope.degrees,
                         slope.friction, all.slides ? "slides" : "does not slide");
  report.table += all.slides ? text_of(", at %.4f of gravity\n", all.acceleration_share)
                             : text_of(" before %.4f deg\n", all.slide_angle * kDegrees);
  report.table += text_of("%4s %26s %10s %9s %9s %9s\n", "pose", "facet's normal", "height/m", "tips/deg",
                          "best/deg", "headings");
  report.csv =
      std::string("pose,normal_x,normal_y,normal_z,height,tip_angle,tip_angle_best,upright_share,slides,") +
      kPoseColumns + "\n";
  RestJson json = {{"model", model},
                   {"center", json_of_place(all.center)},
                   {"hull_error", all.hull_error},
                   {"slides", all.slides},
                   {"slide_angle", all.slide_angle},
                   {"acceleration_share", all.acceleration_share}};
  RestJson& list = json["poses"] = RestJson::array();
  for (const SlopePose& p : all.poses) {
    const std::size_t number = report.places.size() + 1;
    const DVec3 n = p.normal;
    report.table += text_of("%4zu   (%7.4f,%7.4f,%7.4f) %10.4g %9.2f %9.2f %8.2f%%  %s\n", number, n.x, n.y,
                            n.z, p.height, p.tip_angle * kDegrees, p.tip_angle_best * kDegrees,
                            100 * p.upright_share, fate_of(p, all.slides));
    report.csv += text_of("%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d,", number, n.x, n.y, n.z,
                          p.height, p.tip_angle, p.tip_angle_best, p.upright_share, all.slides ? 1 : 0) +
                  text_of_pose(p.position, p.rotation) + "\n";
    list.push_back({{"normal", json_of_place(n)},
                    {"height", p.height},
                    {"tip_angle", p.tip_angle},
                    {"tip_angle_best", p.tip_angle_best},
                    {"upright_share", p.upright_share},
                    {"heading", json_of_place(p.heading)},
                    {"position", json_of_place(p.position)},
                    {"rotation", json_of_turn(p.rotation)}});
    report.places.push_back({p.position, p.rotation});
  }
  if (all.poses.empty()) report.table += "it tips over every facet, whatever its heading\n";
  report.json = text_of_json(json);
  return report;
}

}  // namespace hooke::app
