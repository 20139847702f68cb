#include "hooke/load/load_report.h"

#include "hooke/compare/plots.h"
#include "hooke/text_of.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace hooke::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRows = 40;   ///< Members in the table for people; files have all.
constexpr std::size_t kMostMovers = 5;  ///< Moves in the text for people.
constexpr std::size_t kMostCurves = 8;  ///< Members in the plot.

Json json_of_vector(DVec3 v) {
  return {v.x, v.y, v.z};
}

/// Interval from `held` to `load` as text.
std::string interval_text(double held, double load) {
  return text_of("at %.6g N (held %.6g, not %.6g)", 0.5 * (held + load), held, load);
}

std::string moves_text(const std::vector<Move>& moves) {
  std::string text;
  for (std::size_t i = 0; i < std::min(moves.size(), kMostMovers); ++i) {
    const Move& move = moves[i];
    const double way = length(move.way);
    if (!(way > 1e-2 * length(moves[0].way)) || !(way > 0)) break;
    const DVec3 along = normalize(move.way);
    text += text_of("  '%s' by %.3g m along (%.2f, %.2f, %.2f)\n", move.name.c_str(), way, along.x, along.y,
                    along.z);
  }
  return text;
}

std::string member_table(const Raised& raised) {
  const Equilibrium& own = raised.equilibria.front();
  const Equilibrium& most = last_whole(raised);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < raised.members.size(); ++i) {
    if (!raised.members[i].is_end) rows.push_back(i);
  }
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    return most.forces[a].utilization > most.forces[b].utilization;
  });
  std::string text = text_of("%-24s %-5s %13s %13s %11s %11s %6s\n", "member", "", "N without load", "N",
                             "shear/N", "moment/Nm", "used") +
                     text_of("%30s %13s   at %8.5g N\n", "", "", most.load);
  for (std::size_t i = 0; i < std::min(rows.size(), kMostRows); ++i) {
    const Member& member = raised.members[rows[i]];
    const MemberForce& force = most.forces[rows[i]];
    text += text_of("%-24s %-5s %13.6g %13.6g %11.4g %11.4g", member.name.c_str(), word_of(member.kind),
                    own.forces[rows[i]].force, force.force, force.shear, force.moment);
    text += has_limit(member) ? text_of(" %5.1f%%\n", 100 * force.utilization) : "      -\n";
  }
  if (rows.size() > kMostRows)
    text += text_of("... and %zu more; --csv and --json list all\n", rows.size() - kMostRows);
  return text;
}

std::string breaks_text(const Raised& raised) {
  std::string text;
  for (std::size_t i = 0; i < std::min(raised.breaks.size(), kMostRows); ++i) {
    const LoadBreak& one = raised.breaks[i];
    const bool tore = one.what.starts_with("cloth");
    if (!(one.load > 0)) {
      text += "broke        ";
    } else {
      text += &one == first_break(raised) ? "first break  " : "then         ";
    }
    text += "'" + one.object + "' (" + one.what + ") " +
            (one.load > 0 ? interval_text(one.held, one.load)
                          : text_of("without load, under %.4g of its weight", one.share));
    text += tore ? text_of(", strained by %.3g %%\n", 100 * one.force)
                 : text_of(", where it needed %.6g N\n", one.force);
  }
  for (const std::string& name : raised.fell_off) text += "fell off     '" + name + "'\n";
  return text;
}

std::string limit_text(const char* words, const std::optional<LoadLimit>& limit) {
  if (!limit) return {};
  if (!(limit->load > 0)) return text_of("%s'%s' without load\n", words, limit->member.c_str());
  return text_of("%s'%s' at %.6g N (between the equilibria at %.6g and %.6g)\n", words, limit->member.c_str(),
                 limit->at, limit->held, limit->load);
}

Json json_of_limit(const std::optional<LoadLimit>& limit) {
  if (!limit) return nullptr;
  return {{"member", limit->member}, {"at", limit->at}, {"held", limit->held}, {"load", limit->load}};
}

Json json_of_forces(const Raised& raised, const Equilibrium& equilibrium) {
  Json list = Json::array();
  for (std::size_t i = 0; i < raised.members.size(); ++i) {
    const Member& member = raised.members[i];
    const MemberForce& force = equilibrium.forces[i];
    Json one = {{"name", member.name},
                {"kind", word_of(member.kind)},
                {"force", force.force},
                {"shear", force.shear},
                {"moment", force.moment}};
    if (member.strength > 0) one["strength"] = member.strength;
    if (member.torque_strength > 0) one["torque_strength"] = member.torque_strength;
    if (member.yield_force > 0) one["yield_force"] = member.yield_force;
    if (member.buckling_force > 0) one["buckling_force"] = member.buckling_force;
    if (has_limit(member)) one["utilization"] = force.utilization;
    if (force.broken) one["broken"] = true;
    list.push_back(std::move(one));
  }
  return list;
}

Json json_of_moves(const std::vector<Move>& moves) {
  Json list = Json::array();
  for (const Move& move : moves) list.push_back({{"object", move.name}, {"way", json_of_vector(move.way)}});
  return list;
}

double most_used(const Equilibrium& equilibrium) {
  double most = 0;
  for (const MemberForce& force : equilibrium.forces) most = std::max(most, force.utilization);
  return most;
}

}  // namespace

std::optional<double> reserve_of(const Raised& raised, const LoadTitle& title) {
  if (!title.nominal) return {};
  double held = raised.equilibria.empty() ? 0 : raised.equilibria.back().load;
  if (raised.collapse) held = raised.collapse->held;
  for (const auto ratio : {&MemberForce::yielding, &MemberForce::buckling}) {
    if (const auto limit = first_limit(raised, ratio)) held = std::min(held, limit->at);
  }
  return held / *title.nominal;
}

std::string load_summary(const Raised& raised, const LoadTitle& title) {
  std::string text = text_of("%s: load on %s along (%.3g, %.3g, %.3g)\n", title.scene.c_str(),
                             title.on.c_str(), title.direction.x, title.direction.y, title.direction.z);
  if (raised.equilibria.empty()) {
    text += breaks_text(raised) + "mechanism    no equilibrium without load: " + raised.collapse->why +
            "; what moved:\n" + moves_text(raised.collapse->moves);
    return text + (raised.breaks.empty()
                       ? "  hold it by hooks to the world or to static bodies, or put ground under it\n"
                       : "  it does not carry its own weight: it needs more strength, or less mass\n");
  }
  const Equilibrium& own = raised.equilibria.front();
  text += text_of("without load at rest after %llu steps, %.2g N unbalanced of %.6g N weight\n",
                  static_cast<unsigned long long>(own.steps), own.residual, raised.weight);
  if (raised.is_mechanism) {
    text +=
        "mechanism    it moved far until it found rest under its own weight:\n" + moves_text(raised.settling);
  }
  text += member_table(raised);
  text += limit_text("first yield  ", first_limit(raised, &MemberForce::yielding));
  text += limit_text("buckles      ", first_limit(raised, &MemberForce::buckling));
  text += breaks_text(raised);
  if (raised.collapse) {
    text += raised.collapse->ran ? "collapse     " : "restless     ";
    text += interval_text(raised.collapse->held, raised.collapse->load) + ": " + raised.collapse->why + "\n" +
            moves_text(raised.collapse->moves);
    if (!raised.collapse->ran)
      text += "  whether it holds is not known: more --patience or --substeps may tell\n";
  } else if (raised.equilibria.back().load >= title.most) {
    text +=
        text_of("holds        %.6g N, the largest load that was asked for\n", raised.equilibria.back().load);
  }
  if (const auto reserve = reserve_of(raised, title)) {
    text += text_of("reserve      %.4g times the nominal %.6g N\n", *reserve, *title.nominal);
  }
  text += text_of(
      "found by     %zu equilibria in %llu steps; at most %.2g N were not balanced; loads to %.2g %%\n",
      raised.equilibria.size(), static_cast<unsigned long long>(raised.steps), raised.largest_residual,
      100 * title.tolerance);
  return text;
}

std::string load_csv(const Raised& raised) {
  std::string text = "load,way_x,way_y,way_z,residual,steps,utilization";
  for (const Member& member : raised.members) {
    std::string name;
    for (const char c : member.name) name += c == '"' ? std::string("\"\"") : std::string(1, c);
    text += ",\"" + name + "\"";
  }
  text += "\n";
  for (const Equilibrium& one : raised.equilibria) {
    text += text_of("%.17g,%.17g,%.17g,%.17g,%.17g,%llu,%.17g", one.load, one.way.x, one.way.y, one.way.z,
                    one.residual, static_cast<unsigned long long>(one.steps), most_used(one));
    for (const MemberForce& force : one.forces) text += text_of(",%.17g", force.force);
    text += "\n";
  }
  return text;
}

std::string load_json(const Raised& raised, const LoadTitle& title) {
  Json report = {{"scene", title.scene},
                 {"on", title.on},
                 {"direction", json_of_vector(title.direction)},
                 {"weight", raised.weight},
                 {"steps", raised.steps},
                 {"tolerance", title.tolerance},
                 {"largest_residual", raised.largest_residual},
                 {"mechanism", raised.is_mechanism},
                 {"settling", json_of_moves(raised.settling)}};
  Json& equilibria = report["equilibria"] = Json::array();
  for (const Equilibrium& one : raised.equilibria) {
    equilibria.push_back({{"load", one.load},
                          {"way", json_of_vector(one.way)},
                          {"residual", one.residual},
                          {"steps", one.steps},
                          {"members", json_of_forces(raised, one)}});
  }
  report["first_yield"] = json_of_limit(first_limit(raised, &MemberForce::yielding));
  report["first_buckling"] = json_of_limit(first_limit(raised, &MemberForce::buckling));
  Json& breaks = report["breaks"] = Json::array();
  for (const LoadBreak& one : raised.breaks) {
    breaks.push_back({{"object", one.object},
                      {"what", one.what},
                      {one.what.starts_with("cloth") ? "strain" : "force", one.force},
                      {"held", one.held},
                      {"load", one.load},
                      {"weight", one.share}});
  }
  report["fell_off"] = raised.fell_off;
  report["collapse"] = nullptr;
  if (raised.collapse) {
    report["collapse"] = {{"kind", raised.collapse->ran ? "collapse" : "restless"},
                          {"held", raised.collapse->held},
                          {"load", raised.collapse->load},
                          {"why", raised.collapse->why},
                          {"moves", json_of_moves(raised.collapse->moves)}};
  }
  report["reserve"] = nullptr;
  if (const auto reserve = reserve_of(raised, title)) {
    report["nominal"] = *title.nominal;
    report["reserve"] = *reserve;
  }
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<std::string> load_plot(const Raised& raised, const LoadTitle& title, const std::string& path) {
  static constexpr std::array kColors = {"#D55E00", "#0072B2", "#009E73", "#CC79A7",
                                         "#E69F00", "#56B4E9", "#8A6D00", "#7F3FBF"};
  Plot plot = {.name = "load",
               .title = "Forces in " + title.scene + " over the load",
               .caption = "",
               .x = {.label = "load [N]"},
               .y = {.label = "force, tension positive [N]"},
               .curves = {}};
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < raised.members.size(); ++i) {
    if (!raised.members[i].is_end) rows.push_back(i);
  }
  const Equilibrium& most = last_whole(raised);
  const auto weight = [&](std::size_t i) {
    return std::pair(most.forces[i].utilization, std::abs(most.forces[i].force));
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](std::size_t a, std::size_t b) { return weight(a) > weight(b); });
  rows.resize(std::min(rows.size(), kMostCurves));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    PlotCurve curve = {.title = raised.members[rows[i]].name, .color = kColors[i], .marked = true};
    for (const Equilibrium& one : raised.equilibria)
      curve.points.push_back({one.load, one.forces[rows[i]].force});
    plot.curves.push_back(std::move(curve));
  }
  return draw_plot(plot, path.ends_with(".png") ? PlotFormat::kPng : PlotFormat::kSvg);
}

}  // namespace hooke::app
