/// Compares contacts of cloths with each other in Hooke and in its peers: square sheets, one above the other,
/// that fall on a ball. This program makes the scene, runs it in Hooke, and judges what every engine
/// recorded.
///
///     sheets_peers scene COLUMNS LAYERS FRAMES FILE
///     sheets_peers hooke SUBSTEPS SCENE RECORD
///     sheets_peers judge RECORD...
///
/// `scene` writes JSON, which the peers' scripts read. A record is text, one item a line: `engine NAME`,
/// `frames N` that were asked for, `triangle A B C`, `step MS` for the processor time of a frame and `points
/// X Y Z ...` for where all points are. The first `points` are those of the start, where every edge has its
/// length. `judge` prints a row of a table for each record. One checker counts the crossings of all.

#include "hooke/hooke.h"

#include "validation/crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace hooke;

constexpr double kFrame = 1.0 / 60.0;  // [s]
constexpr double kEdge = 0.02;         // [m]
constexpr double kDensity = 0.2;       // [kg/m^2]
constexpr int kCheckEvery = 5;         // Frames between two states that are recorded.

/// What every engine runs. Lengths in m; the ground is the plane y = 0, the ball rests.
struct Scene {
  int columns = 0;  ///< Points along each side of a sheet.
  int layers = 0;
  int frames = 0;
  double thickness = 0.25 * kEdge;
  double friction = 0.3;
  double stiffness = 1e4;  ///< Of a spring along an edge [N/m].
  double bending = 1e-5;   ///< Flexural rigidity [N m].

  [[nodiscard]] double width() const { return kEdge * (columns - 1); }
  [[nodiscard]] double ball_radius() const { return 0.2 * width(); }
  [[nodiscard]] double ball_height() const { return 0.5 * width(); }
  /// Returns the corner of a sheet, whose columns go along x and whose rows along z.
  [[nodiscard]] DVec3 corner(int layer) const {
    const double above = ball_height() + ball_radius() + 0.03 + 1.5 * thickness * layer;
    return {-0.5 * width() + 0.003 * layer, above, -0.5 * width()};
  }
};

int usage() {
  std::fputs(
      "sheets_peers scene COLUMNS LAYERS FRAMES FILE | hooke SUBSTEPS SCENE RECORD | judge RECORD...\n",
      stderr);
  return 2;
}

bool write(const Scene& scene, const char* path) {
  std::ofstream file(path);
  file.precision(17);
  file << "{\"columns\": " << scene.columns << ", \"layers\": " << scene.layers
       << ", \"frames\": " << scene.frames << ", \"frame\": " << kFrame << ", \"edge\": " << kEdge
       << ", \"thickness\": " << scene.thickness << ", \"friction\": " << scene.friction
       << ", \"stiffness\": " << scene.stiffness << ", \"bending\": " << scene.bending
       << ", \"sheet_mass\": " << kDensity * scene.width() * scene.width()
       << ", \"check_every\": " << kCheckEvery << ",\n \"ball\": {\"center\": [0, " << scene.ball_height()
       << ", 0], \"radius\": " << scene.ball_radius() << "},\n \"corners\": [";
  for (int layer = 0; layer < scene.layers; ++layer) {
    const DVec3 corner = scene.corner(layer);
    file << (layer > 0 ? ", [" : "[") << corner.x << ", " << corner.y << ", " << corner.z << ']';
  }
  file << "]}\n";
  return static_cast<bool>(file.flush());
}

/// Reads the number after `"key": ` in a scene that `write` wrote; 0 if there is none.
int number_of(const std::string& text, const std::string& key) {
  const std::size_t at = text.find('"' + key + "\": ");
  return at == std::string::npos ? 0 : std::atoi(text.c_str() + at + key.size() + 4);
}

bool read(const char* path, Scene& scene) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  scene.columns = number_of(text.str(), "columns");
  scene.layers = number_of(text.str(), "layers");
  scene.frames = number_of(text.str(), "frames");
  return scene.columns >= 2 && scene.layers >= 1 && scene.frames >= 1;
}

World make_world(const Scene& scene, int substeps, std::vector<ClothId>& sheets) {
  World world = World::create({.substeps = substeps, .workers = 1}).value();
  const ContactDesc contact = {.friction = static_cast<Real>(scene.friction)};
  (void)world
      .add_body({.kind = BodyKind::kStatic, .shape = {.kind = ShapeKind::kHalfSpace}, .contact = contact})
      .value();
  (void)world
      .add_body({.kind = BodyKind::kStatic,
                 .shape = {.kind = ShapeKind::kSphere, .radius = static_cast<Real>(scene.ball_radius())},
                 .position = {0, scene.ball_height(), 0},
                 .contact = contact})
      .value();
  ClothDesc desc;
  desc.columns = desc.rows = static_cast<std::uint32_t>(scene.columns);
  desc.width = desc.height = static_cast<Real>(scene.width());
  desc.row_direction = {Real(0), Real(0), Real(1)};
  desc.total_mass = static_cast<Real>(kDensity * scene.width() * scene.width());
  desc.thickness = static_cast<Real>(scene.thickness);
  desc.stretch_stiffness = static_cast<Real>(scene.stiffness);
  desc.bend_stiffness = static_cast<Real>(scene.bending);
  desc.drag_coefficient = desc.lift_coefficient = Real(0);
  desc.contact = contact;
  desc.self_contact = true;
  for (int layer = 0; layer < scene.layers; ++layer) {
    desc.corner = scene.corner(layer);
    sheets.push_back(world.add_cloth(desc).value());
  }
  return world;
}

void write_points(const World& world, const std::vector<ClothId>& sheets, std::ofstream& record) {
  record << "points";
  for (const ClothId sheet : sheets) {
    const PointView points = world.positions(sheet);
    for (std::size_t i = 0; i < points.size(); ++i) {
      record << ' ' << points[i].x << ' ' << points[i].y << ' ' << points[i].z;
    }
  }
  record << '\n';
}

bool run_hooke(const Scene& scene, int substeps, const char* path) {
  std::vector<ClothId> sheets;
  World world = make_world(scene, substeps, sheets);
  std::ofstream record(path);
  record.precision(17);
  record << "engine Hooke, " << substeps << " substeps\nframes " << scene.frames << '\n';
  std::uint32_t first = 0;
  for (const ClothId sheet : sheets) {
    for (const auto& [a, b, c] : world.triangles(sheet)) {
      record << "triangle " << first + a << ' ' << first + b << ' ' << first + c << '\n';
    }
    first += static_cast<std::uint32_t>(world.positions(sheet).size());
  }
  write_points(world, sheets, record);
  for (int i = 1; i <= scene.frames; ++i) {
    const std::clock_t start = std::clock();
    (void)world.step(static_cast<Real>(kFrame));
    record << "step " << 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC << '\n';
    if (i % kCheckEvery == 0 || i == scene.frames) write_points(world, sheets, record);
  }
  return static_cast<bool>(record.flush());
}

/// What an engine recorded, as far as it has come.
struct Record {
  std::string engine;
  int frames = 0;  ///< That were asked for.
  std::vector<double> times;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::vector<DVec3>> states;
};

void take_line(const std::string& line, Record& record) {
  std::istringstream rest(line);
  std::string word;
  rest >> word;
  if (word == "engine") std::getline(rest >> std::ws, record.engine);
  if (word == "frames") rest >> record.frames;
  double ms = 0;
  if (word == "step" && rest >> ms) record.times.push_back(ms);
  std::array<std::uint32_t, 3> corners = {};
  if (word == "triangle" && rest >> corners[0] >> corners[1] >> corners[2]) {
    record.triangles.push_back(corners);
  }
  if (word != "points") return;
  std::vector<DVec3> points;
  std::string x, y, z;  // A stream does not read "nan".
  while (rest >> x >> y >> z)
    points.push_back({std::atof(x.c_str()), std::atof(y.c_str()), std::atof(z.c_str())});
  record.states.push_back(points);
}

/// Reads a record. A state that was cut off when its engine was ended is left out.
Record read_record(const char* path) {
  Record record;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) take_line(line, record);
  while (record.states.size() > 1 && record.states.back().size() != record.states.front().size()) {
    record.states.pop_back();
  }
  return record;
}

/// Whether a record has what a row needs: triangles of its points, two states that are finite, and a time.
bool is_whole(const Record& record) {
  if (record.times.size() < 2 || record.states.size() < 2 || record.triangles.empty()) return false;
  for (const std::vector<DVec3>& state : record.states) {
    for (const DVec3& p : state) {
      if (!std::isfinite(p.x + p.y + p.z)) return false;
    }
  }
  for (const auto& triangle : record.triangles) {
    if (std::max({triangle[0], triangle[1], triangle[2]}) >= record.states.front().size()) return false;
  }
  return true;
}

/// Returns the largest |l / l0 - 1| of an edge along the grid, l0 being its length at the start. Diagonals,
/// which engines lay in different ways, do not count.
double largest_stretch(const Record& record, const std::vector<DVec3>& state) {
  const std::vector<DVec3>& start = record.states.front();
  double largest = 0;
  for (const auto& triangle : record.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
      const double rest = length(start[a] - start[b]);
      if (rest > 1.2 * kEdge) continue;
      largest = std::max(largest, std::abs(length(state[a] - state[b]) / rest - 1));
    }
  }
  return largest;
}

void judge(const char* path) {
  Record record = read_record(path);
  if (!is_whole(record)) {
    std::printf("| %s | %zu | no two whole states, or one that is not finite: %s |\n", record.engine.c_str(),
                record.states.empty() ? 0 : record.states.front().size(), path);
    return;
  }
  std::size_t crossed_states = 0, most = 0, last = 0;
  double stretch = 0;
  for (std::size_t i = 1; i < record.states.size(); ++i) {
    last = count_crossings({record.states[i], record.triangles, {}, {}}).crossing;
    most = std::max(most, last);
    if (last > 0) ++crossed_states;
    stretch = std::max(stretch, largest_stretch(record, record.states[i]));
  }
  std::vector<double> times(record.times.begin() + 1, record.times.end());  // The first makes what is kept.
  std::sort(times.begin(), times.end());
  std::printf("| %s | %zu | %zu of %d | %.2f | %.2f | %zu of %zu | %zu | %zu | %.0f %% |\n",
              record.engine.c_str(), record.states.front().size(), record.times.size(), record.frames,
              times[times.size() / 2], times.back(), crossed_states, record.states.size() - 1, most, last,
              100 * stretch);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  Scene scene;
  if (command == "scene" && argc == 6) {
    scene.columns = std::clamp(std::atoi(argv[2]), 2, 200);
    scene.layers = std::clamp(std::atoi(argv[3]), 1, 16);
    scene.frames = std::clamp(std::atoi(argv[4]), 2, 100000);
    return write(scene, argv[5]) ? 0 : 1;
  }
  if (command == "hooke" && argc == 5) {
    if (!read(argv[3], scene)) return usage();
    return run_hooke(scene, std::clamp(std::atoi(argv[2]), 1, 64), argv[4]) ? 0 : 1;
  }
  if (command != "judge" || argc < 3) return usage();
  std::puts(
      "| engine | points | frames | ms a frame, median | worst | states that cross | most crossings | at the "
      "end | largest stretch |");
  std::puts("|---|---|---|---|---|---|---|---|---|");
  for (int i = 2; i < argc; ++i) judge(argv[i]);
}
