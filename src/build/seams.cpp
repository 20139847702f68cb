/// This file makes seams: it finds two edges as lines of points, and the stitches that hold them together.

#include "base/assert.h"
#include "build/build.h"
#include "build/checks.h"
#include "build/common.h"
#include "build/hook_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hooke::build {

namespace {

using state::Deformable;
using state::HookPlace;
using state::Tables;

using Line = std::vector<std::uint32_t>;

struct NamedLine {
  std::string name;
  Line points;
};

/// An edge as rows of particles, with the share of its length at each point.
struct Thread {
  std::uint32_t object = 0;
  std::vector<std::uint32_t> rows = {};
  std::vector<DVec3> places = {};  ///< Position of each point [m].
  std::vector<double> share = {};  ///< Share of the length: 0 at the first point, 1 at the last.
  double length = 0;               ///< Length of the edge [m].

  [[nodiscard]] std::size_t segments() const { return rows.size() - 1; }
  [[nodiscard]] bool is_closed() const { return rows.front() == rows.back(); }
};

/// A place at which the edges are held together.
struct Stitch {
  double share = 0;
  HookPlace a, b;
};

// -- Edges of cloths. --------------------------------------------------------------------------------------

/// A directed edge of a triangle, with points in the order of the maker.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Returns the directed edges that no triangle has in the other direction, in ascending order.
std::vector<Edge> open_edges_of(const Deformable& object, const Tables& t) {
  std::vector<std::uint32_t> point_of(object.particles.count);
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    point_of[t.particles.row_of[object.particles.first + i]] = i;
  }
  std::vector<Edge> edges;
  for (std::uint32_t i = object.triangles.first; i < object.triangles.end(); ++i) {
    const auto [a, b, c] = t.triangles.corners[i];
    const std::array corners = {a, b, c};
    for (std::size_t k = 0; k < 3; ++k) {
      HOOKE_ASSERT(corners[k] - object.particles.first < object.particles.count);
      edges.emplace_back(point_of[corners[k] - object.particles.first],
                         point_of[corners[(k + 1) % 3] - object.particles.first]);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> open;
  for (const Edge& edge : edges) {
    if (!std::binary_search(edges.begin(), edges.end(), Edge{edge.second, edge.first})) open.push_back(edge);
  }
  return open;
}

/// Follows the open edges from one of them, and marks as used those that it takes.
Line follow_border(const std::vector<Edge>& open, std::size_t first, std::vector<std::uint8_t>& used) {
  Line line = {open[first].first};
  for (std::size_t at = first; at < open.size() && used[at] == 0;) {
    used[at] = 1;
    line.push_back(open[at].second);
    if (line.back() == line.front()) break;
    at = static_cast<std::size_t>(std::lower_bound(open.begin(), open.end(), Edge{line.back(), 0}) -
                                  open.begin());
    while (at < open.size() && used[at] != 0 && open[at].first == line.back()) ++at;
    if (at < open.size() && open[at].first != line.back()) break;
  }
  return line;
}

/// Returns the borders of a cloth. Each begins at its first point in the order of the maker and runs in the
/// direction of its triangles. A border is closed unless triangles are wound against each other.
std::vector<Line> borders_of(const Deformable& object, const Tables& t) {
  const std::vector<Edge> open = open_edges_of(object, t);
  std::vector<std::uint8_t> used(open.size(), 0);
  std::vector<Line> borders;
  for (std::size_t first = 0; first < open.size(); ++first) {
    Line line = follow_border(open, first, used);
    if (line.size() > 2) borders.push_back(std::move(line));
  }
  return borders;
}

/// Returns the points first, first + stride, ... of a grid.
Line grid_line(std::uint32_t first, std::uint32_t stride, std::uint32_t count) {
  Line line(count);
  for (std::uint32_t i = 0; i < count; ++i) line[i] = first + i * stride;
  return line;
}

std::vector<NamedLine> edges_of(const Deformable& object, const Tables& t) {
  std::vector<NamedLine> edges;
  if (object.columns > 0) {
    const std::uint32_t columns = object.columns;
    const auto points = object.particles.count - static_cast<std::uint32_t>(object.split_from.size());
    const std::uint32_t rows = points / columns;
    HOOKE_ASSERT(rows * columns == points);
    edges.push_back({"left", grid_line(0, columns, rows)});
    edges.push_back({"right", grid_line(columns - 1, columns, rows)});
    edges.push_back({"top", grid_line(0, 1, columns)});
    edges.push_back({"bottom", grid_line((rows - 1) * columns, 1, columns)});
  }
  std::vector<Line> borders = borders_of(object, t);
  for (std::size_t i = 0; i < borders.size(); ++i) {
    const std::string name = borders.size() == 1 ? "border" : "border_" + std::to_string(i);
    edges.push_back({name, std::move(borders[i])});
  }
  return edges;
}

// -- Lines as they are now. --------------------------------------------------------------------------------

Result<Line> find_line(const SeamEdge& edge, const Deformable& object, const char* where, const Tables& t) {
  if (edge.edge.empty() == edge.points.empty())
    return Error{ErrorCode::kOutOfRange, where, "needs either the name of an edge or points"};
  if (edge.edge.empty()) return edge.points;
  std::vector<std::string> names;
  for (NamedLine& line : edges_of(object, t)) {
    if (line.name == edge.edge) return std::move(line.points);
    names.push_back(line.name);
  }
  return no_such_name("edge", edge.edge, names, where);
}

Result<Thread> find_thread(const SeamEdge& edge, const char* where, const Tables& t) {
  const std::uint32_t row = state::object_row(t, edge.object);
  if (row == Tables::kNoRow)
    return Error{ErrorCode::kStaleId, where, "refers to nothing that is in the world"};
  const Deformable& object = t.objects[row];
  if (object.kind != PointRef::Kind::kCloth && object.kind != PointRef::Kind::kSolid)
    return Error{ErrorCode::kOutOfRange, where, "must be of a cloth or a solid"};
  const Result<Line> line = find_line(edge, object, where, t);
  if (!line) return line.error();
  const auto wrong = [&](const std::string& what) {
    return Error{ErrorCode::kOutOfRange, std::string(where) + ".points", what};
  };
  if (line.value().size() < 2) return wrong("needs at least 2 points");
  Thread thread = {.object = row};
  for (const std::uint32_t point : line.value()) {
    if (point >= object.particles.count) {
      return wrong("names point " + std::to_string(point) + " of " + std::to_string(object.particles.count) +
                   "; the first is 0");
    }
    thread.rows.push_back(row_of(t, object, point));
    thread.places.push_back(object.origin + vector_cast<double>(t.particles.position[thread.rows.back()].x));
    if (thread.rows.size() > 1)
      thread.length += length(thread.places.back() - thread.places[thread.places.size() - 2]);
    thread.share.push_back(thread.length);
  }
  if (!(thread.length > 0)) return wrong("are all at the same place");
  for (double& share : thread.share) share /= thread.length;
  return thread;
}

// -- Which place of one thread belongs to which of the other. -----------------------------------------------

/// Returns the place at a share of a thread's length: a point, or a place on a segment.
HookPlace place_at(const Thread& thread, double share) {
  constexpr double kAtPoint = 1e-4;  // Rounding moves no place farther from its point, as share of a segment.
  HOOKE_ASSERT(thread.rows.size() >= 2 && thread.share.size() == thread.rows.size());
  const auto after = std::upper_bound(thread.share.begin() + 1, thread.share.end() - 1, share);
  const auto last = static_cast<std::size_t>(after - thread.share.begin());
  const double span = thread.share[last] - thread.share[last - 1];
  const double along = span > 0 ? std::clamp((share - thread.share[last - 1]) / span, 0.0, 1.0) : 0.0;
  HookPlace place = {.object = thread.object, .particle_count = 1};
  if (along < kAtPoint || along > 1 - kAtPoint) {
    place.particle[0] = thread.rows[along < 0.5 ? last - 1 : last];
    place.weight[0] = Real(1);
    return place;
  }
  place.particle_count = 2;
  place.particle = {thread.rows[last - 1], thread.rows[last]};
  place.weight = {static_cast<Real>(1 - along), static_cast<Real>(along)};
  return place;
}

DVec3 position_at(const Thread& thread, double share) {
  const auto after = std::upper_bound(thread.share.begin() + 1, thread.share.end() - 1, share);
  const auto last = static_cast<std::size_t>(after - thread.share.begin());
  const double span = thread.share[last] - thread.share[last - 1];
  const double along = span > 0 ? (share - thread.share[last - 1]) / span : 0.0;
  return thread.places[last - 1] + along * (thread.places[last] - thread.places[last - 1]);
}

/// Reverses the direction of a thread.
Thread reversed(Thread thread) {
  std::reverse(thread.rows.begin(), thread.rows.end());
  std::reverse(thread.places.begin(), thread.places.end());
  std::reverse(thread.share.begin(), thread.share.end());
  for (double& share : thread.share) share = 1 - share;
  return thread;
}

/// Returns a closed thread that begins at another of its points.
Thread begun_at(const Thread& thread, std::size_t first) {
  Thread backward = {.object = thread.object, .length = thread.length};
  const std::size_t count = thread.segments();
  HOOKE_ASSERT(thread.is_closed() && first < count);
  for (std::size_t i = 0; i <= count; ++i) {
    const std::size_t from = (first + i) % count;
    const double share = thread.share[from] - thread.share[first] + (first + i >= count ? 1 : 0);
    backward.rows.push_back(thread.rows[from]);
    backward.places.push_back(thread.places[from]);
    backward.share.push_back(i == count ? 1.0 : share);
  }
  return backward;
}

/// Sum of the squared distances of two threads [m^2]: at their ends, or at quarters of the length of closed
/// ones.
double distance_squared(const Thread& a, const Thread& b) {
  double sum = 0;
  for (const double share : a.is_closed() ? std::array{0.25, 0.75} : std::array{0.0, 1.0})
    sum += length_squared(position_at(a, share) - position_at(b, share));
  return sum;
}

/// Returns b in the direction that fits a best. If it is closed, it begins at its point nearest to that of a.
Thread aligned(const Thread& a, Thread b) {
  if (a.is_closed()) {
    const auto nearer = [&](const DVec3& p, const DVec3& q) {
      return length_squared(p - a.places[0]) < length_squared(q - a.places[0]);
    };
    const auto nearest = std::min_element(b.places.begin(), b.places.end() - 1, nearer);
    b = begun_at(b, static_cast<std::size_t>(nearest - b.places.begin()));
  }
  Thread back = reversed(b);
  return distance_squared(a, back) < distance_squared(a, b) ? back : b;
}

bool holds(const HookPlace& place, std::uint32_t particle) {
  for (std::uint32_t i = 0; i < place.particle_count; ++i) {
    if (place.particle[i] == particle) return true;
  }
  return false;
}

/// Stitches each point of the finer thread to its place on the other thread. Points of the other thread that
/// would not be held otherwise get stitches, too. Places that share a point already need no stitch.
std::vector<Stitch> find_stitches(const Thread& a, const Thread& b) {
  const bool a_is_finer = a.rows.size() >= b.rows.size();
  const Thread& fine = a_is_finer ? a : b;
  const Thread& coarse = a_is_finer ? b : a;
  std::vector<double> shares(fine.share.begin(), fine.share.end() - (a.is_closed() ? 1 : 0));
  std::vector<HookPlace> held;
  held.reserve(shares.size());
  for (const double share : shares) held.push_back(place_at(coarse, share));
  for (std::size_t i = 0; i < coarse.segments() + (a.is_closed() ? 0 : 1); ++i) {
    const auto holds_it = [&](const HookPlace& place) { return holds(place, coarse.rows[i]); };
    if (std::none_of(held.begin(), held.end(), holds_it)) shares.push_back(coarse.share[i]);
  }
  std::sort(shares.begin(), shares.end());
  std::vector<Stitch> stitches;
  for (const double share : shares) {
    const Stitch stitch = {share, place_at(a, share), place_at(b, share)};
    const auto shared = [&](std::uint32_t particle) { return holds(stitch.b, particle); };
    const auto* const first = stitch.a.particle.data();
    if (std::any_of(first, first + stitch.a.particle_count, shared)) continue;
    stitches.push_back(stitch);
  }
  return stitches;
}

/// Share of the seam's length that a stitch holds: half of the distances to its neighbors.
double share_of(const std::vector<Stitch>& stitches, std::size_t i, bool closed) {
  const std::size_t count = stitches.size();
  double before = i > 0 ? stitches[i - 1].share : 0.0;
  double after = i + 1 < count ? stitches[i + 1].share : 1.0;
  if (closed && i == 0) before = stitches[count - 1].share - 1;
  if (closed && i + 1 == count) after = stitches[0].share + 1;
  const double reach_before = (closed || i > 0) ? 0.5 * (stitches[i].share - before) : stitches[i].share;
  const double reach_after =
      (closed || i + 1 < count) ? 0.5 * (after - stitches[i].share) : 1 - stitches[i].share;
  return reach_before + reach_after;
}

FoundEnd end_at(const HookPlace& place, const Tables& t) {
  FoundEnd end = {.place = place, .is_given = true, .position = t.objects[place.object].origin};
  for (std::uint32_t i = 0; i < place.particle_count; ++i) {
    const Vec3 x = t.particles.position[place.particle[i]].x;
    end.position += static_cast<double>(place.weight[i]) * vector_cast<double>(x);
  }
  return end;
}

}  // namespace

Result<std::uint32_t> sew(const SeamDesc& desc, Tables& t) {
  Checks checks("seam");
  checks.stiffness("strength", static_cast<double>(desc.strength));
  if (!checks.good()) return checks.result().error();
  const Result<Thread> a = find_thread(desc.a, "seam.a", t);
  if (!a) return a.error();
  const Result<Thread> found_b = find_thread(desc.b, "seam.b", t);
  if (!found_b) return found_b.error();
  const bool closed = a.value().is_closed();
  if (closed != found_b.value().is_closed()) {
    return Error{ErrorCode::kOutOfRange, "seam.b",
                 closed ? "must be closed, as a is" : "must be open, as a is"};
  }
  const Thread b = aligned(a.value(), found_b.value());
  const std::vector<Stitch> stitches = find_stitches(a.value(), b);
  if (stitches.empty()) return Error{ErrorCode::kOutOfRange, "seam.b", "must be another line than a"};
  const double length = 0.5 * (a.value().length + b.length);
  for (std::size_t i = 0; i < stitches.size(); ++i) {
    HookDesc hook;
    hook.break_force = desc.strength * static_cast<Real>(length * share_of(stitches, i, closed));
    append_hook(hook, end_at(stitches[i].a, t), end_at(stitches[i].b, t), t);
  }
  return static_cast<std::uint32_t>(stitches.size());
}

}  // namespace hooke::build
