#include "hooke/session/scene_keys.h"
#include "hooke/session/session.h"

#include "../temporary_folder.h"

#include <algorithm>
#include <chrono>
#include <doctest/doctest.h>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

namespace hooke::app {

namespace {

/// A ball that falls and a rope that hangs, with a comment that edits must keep.
const char* const kText = R"({
  "version": 1, "seconds": 60, // as long as one likes
  "bodies": [{"name": "ball", "kind": "dynamic", "shape": {"sphere": {"radius": 0.3}}, "position": [0, 50, 0]}],
  "ropes": [{"name": "rope", "hook_point": [5, 2, 0], "direction": [0, -1, 0], "total_mass": 2, "loads": [
    {"point": "last", "mass": 3}]}]
})";

constexpr double kLong = 120;  // Nothing waits for so long but on a machine that is stuck [s].

std::string read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Writes a file at once, as editors do, and at a time that no earlier file has.
void write(const std::string& path, const std::string& text) {
  static int clock = 0;
  std::ofstream(path + ".new", std::ios::binary) << text;
  const auto later = std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++clock);
  std::filesystem::last_write_time(path + ".new", later);
  std::filesystem::rename(path + ".new", path);
}

std::string with(std::string text, const std::string& part, const std::string& by) {
  REQUIRE(text.find(part) != std::string::npos);
  return text.replace(text.find(part), part.size(), by);
}

/// A session of a file in a folder of its own.
struct Desk {
  explicit Desk(const std::string& text = kText) : file(folder / "scene.json") {
    write(file, text);
    Loader loader;
    loader.read = read_document;
    loader.build = [](const Scene& scene, const std::function<void(const std::string&)>&) {
      return Simulation::create(scene);
    };
    session.emplace(file, loader, SessionOptions{.playing = false});
  }

  std::shared_ptr<const SessionView> done(Command command) {
    const std::uint64_t number = session->post(std::move(command));
    return session->wait_for([&](const SessionView& v) { return v.commands >= number; }, kLong);
  }
  /// Saves the file, and waits until a world or another mistake comes of it.
  std::shared_ptr<const SessionView> saved(const std::string& text) {
    const auto before = session->view();
    const auto mistake_of = [](const SessionView& v) {
      return v.file_errors.empty() ? std::string() : to_line(v.file_errors.front());
    };
    write(file, text);
    return session->wait_for(
        [&](const SessionView& v) { return v.built > before->built || mistake_of(v) != mistake_of(*before); },
        kLong);
  }

  test::TemporaryFolder folder;
  std::string file;
  std::optional<Session> session;
};

double figure(const SessionView& view, const std::string& name) {
  for (const MeasuredValue& value : view.measured) {
    if (value.name == name) return value.value;
  }
  FAIL("no figure is called " << name);
  return 0;
}

/// Memory of this process that is in use [bytes].
double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages >> pages;
  return 4096 * pages;
}

}  // namespace

TEST_SUITE("session/edit") {
  TEST_CASE("gravity changes at once, goes back with undo, comes again with redo, and is part of a rewind") {
    Desk desk;
    desk.done(Select{"ball"});
    auto view = desk.done(MakeSteps{60});
    const double fallen = 50 - figure(*view, "center y");
    CHECK(fallen == doctest::Approx(0.5 * 9.81).epsilon(0.02));
    view = desk.done(Change{"world.gravity", "[0, 0, 0]"});
    CHECK(view->said->text == "world.gravity is [0, 0, 0] now");
    CHECK(view->step == 60);
    CHECK(view->built == 1);
    CHECK(view->edited);
    view = desk.done(MakeSteps{60});
    // Without gravity it keeps the 9.81 m/s that it has.
    const double later = 50 - figure(*view, "center y");
    CHECK(later - fallen == doctest::Approx(9.81).epsilon(1e-4));
    desk.done(Seek{10});
    view = desk.done(Seek{120});
    CHECK(50 - figure(*view, "center y") == later);
    view = desk.done(Undo{});
    CHECK(view->said->text == "undone: edit");
    CHECK(view->step == 60);
    CHECK_FALSE(view->edited);
    CHECK(view->document->text == kText);
    view = desk.done(Redo{});
    CHECK(view->step == 120);
    CHECK(50 - figure(*view, "center y") == later);
    CHECK(view->document->scene.world.gravity == Vec3{0, 0, 0});
    // The start stays edited.
    desk.done(Restart{});
    view = desk.done(MakeSteps{60});
    CHECK(figure(*view, "center y") == 50);
  }

  TEST_CASE("what no world can change starts the scene anew, and undo brings the world before back") {
    Desk desk;
    desk.done(Select{"rope"});
    auto view = desk.done(MakeSteps{40});
    // The upper end carries 2 kg and 3 kg, the first segment all but half a segment's share of the rope.
    CHECK(figure(*view, "largest tension") == doctest::Approx((5 - 2 / 30.0) * 9.81).epsilon(0.02));
    view = desk.done(Change{"ropes[0].total_mass", "4"});
    CHECK(view->said->text == "ropes[0].total_mass is 4 now; the scene starts anew with it");
    CHECK(view->step == 0);
    CHECK(view->built == 2);
    CHECK(view->selected == "rope");
    view = desk.done(MakeSteps{40});
    CHECK(figure(*view, "mass") == doctest::Approx(7));
    CHECK(figure(*view, "largest tension") == doctest::Approx((7 - 4 / 30.0) * 9.81).epsilon(0.02));
    view = desk.done(Undo{});
    CHECK(view->step == 40);
    CHECK(figure(*view, "mass") == doctest::Approx(5));
    view = desk.done(Redo{});
    CHECK(view->step == 40);
    CHECK(figure(*view, "mass") == doctest::Approx(7));
    CHECK(view->undo_count == 1);
    CHECK(view->redo_count == 0);
  }

  TEST_CASE("keys come with units, values of the file, and defaults") {
    const Desk desk;
    const auto view =
        desk.session->wait_for([](const SessionView& v) { return v.document != nullptr; }, kLong);
    const auto find = [&](const std::string& of, const std::string& key) -> SceneKey {
      for (const SceneKey& one : keys_of(*view->document, of)) {
        if (one.key == key) return one;
      }
      FAIL("no key is called " << key);
      return {};
    };
    const SceneKey mass = find("ropes[0]", "total_mass");
    CHECK(mass.path == "ropes[0].total_mass");
    CHECK(mass.value == "2");
    CHECK(mass.said);
    CHECK(mass.unit == "kg");
    const SceneKey stiffness = find("ropes[0]", "stiffness");
    CHECK(stiffness.type == SceneKey::Type::kNumber);
    CHECK(stiffness.value == "\"rigid\"");
    CHECK_FALSE(stiffness.said);
    CHECK(stiffness.unit == "N/m");
    CHECK(find("bodies[0]", "kind").words.size() == 3);
    CHECK(find("bodies[0]", "position").value == "[0,50,0]");
    const SceneKey wind = find("world", "wind");
    CHECK(wind.type == SceneKey::Type::kGroup);
    CHECK(wind.keys.front().path == "world.wind.velocity");
    CHECK(wind.keys.front().unit == "m/s");
    CHECK(keys_of(*view->document, "added[0].ropes[0]").empty());
  }

  TEST_CASE("insight shows what is wished, with colors whose scale fades and arrows of one length") {
    Desk desk;
    desk.done(MakeSteps{240});
    CHECK(desk.session->view()->insight == nullptr);
    InsightWish wish = {.arrow = 0.5};
    wish.desc.loads = true;
    wish.desc.texts = true;
    auto view = desk.done(ShowInsight{wish});
    REQUIRE(view->insight != nullptr);
    CHECK(view->insight->lines.size() == 15);
    CHECK(view->insight->legend.full_tension == view->insight->legend.tension);
    // Of a rope of 2 kg with 3 kg at its end all but half a segment's share hangs below its first segment.
    CHECK(view->insight->legend.tension == doctest::Approx((5 - 2.0 / 30) * 9.81).epsilon(0.03));
    CHECK(view->insight->texts.size() == 1);
    view = desk.done(Change{"world.gravity", "[0, -981e-3, 0]"});
    // The scale falls to the half in two seconds.
    const double before = view->insight->legend.full_tension;
    view = desk.done(MakeSteps{120});
    CHECK(view->insight->legend.tension == doctest::Approx((5 - 2.0 / 30) * 0.981).epsilon(0.1));
    CHECK(view->insight->legend.full_tension == doctest::Approx(before / 2).epsilon(0.02));
    view = desk.done(ShowInsight{});
    CHECK(view->insight == nullptr);
  }

  TEST_CASE("figures over time are those of the motion, end with a rewind, and can be saved as a table") {
    Desk desk;
    desk.done(Select{"ball"});
    for (int i = 0; i < 60; ++i) desk.done(MakeSteps{1});
    const auto view = desk.session->view();
    const History& history = *view->history;
    CHECK(history.size() == 61);
    const History::Curve all = history.curve("ball: center y", 100);
    REQUIRE(all.size() == 61);
    for (const auto& [time, height] : all)
      CHECK(height == doctest::Approx(50 - 0.5 * 9.81 * time * time).epsilon(0.003));
    CHECK(history.curve("ball: center y", 0.51).size() == 31);
    CHECK(history.curve("substeps", 100).back()[1] > 0);
    CHECK(history.curve("ball: charm", 100).empty());
    desk.done(Seek{20});
    CHECK(history.curve("ball: center y", 100).back()[0] == doctest::Approx(20.0 / 60));
    // Another object has figures from now on; those of the world go on.
    desk.done(Select{"rope"});
    CHECK(history.curve("ball: center y", 100).empty());
    CHECK(history.curve("rope: length", 100).size() == 1);
    CHECK(history.curve("energy", 100).size() == 21);
    CHECK(desk.done(SaveFigures{})->said->text ==
          "saved '" + desk.folder / "scene-figures.csv" + "', 21 rows");
    const std::string table = read(desk.folder / "scene-figures.csv");
    CHECK(table.starts_with("step,time [s],kinetic energy [J],"));
    CHECK(std::count(table.begin(), table.end(), '\n') == 22);
    const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    std::istringstream lines(table);
    std::string head;
    std::getline(lines, head);
    for (std::string line; std::getline(lines, line);) CHECK(commas(line) == commas(head));
  }

  TEST_CASE("a line cuts what it crosses, and undo joins it again") {
    Desk desk;
    desk.done(Select{"rope"});
    const auto ray = [](DVec3 to) {
      const DVec3 eye = {5, 1.5, 5};
      return Ray{eye, 100.0 * (to - eye)};
    };
    desk.done(MakeSteps{30});
    auto view = desk.done(Action(Cut{ray({4, 1.3, 0}), ray({4.5, 1.3, 0})}));
    CHECK_FALSE(view->said->done);
    CHECK(view->said->text == "the line crosses nothing that can be cut");
    view = desk.done(Action(Cut{ray({4, 1.3, 0}), ray({6, 1.3, 0})}));
    CHECK(view->said->text == "cut 'rope'");
    const double before = figure(*view, "end y");
    view = desk.done(MakeSteps{30});
    CHECK(before - figure(*view, "end y") == doctest::Approx(0.5 * 9.81 * 0.25).epsilon(0.05));
    view = desk.done(Undo{});
    CHECK(view->said->text == "undone: cut");
    view = desk.done(MakeSteps{30});
    CHECK(figure(*view, "end y") == doctest::Approx(before).epsilon(1e-3));
  }

  TEST_CASE("what the engine gives up is told with what helps") {
    Desk desk(
        R"({"version": 1, "cloths": [{"name": "strip", "columns": 12, "rows": 3, "width": 0.55, "height": 0.1,
      "areal_density": 0.2, "row_direction": [0, 0, 1], "bend": "angle", "bend_stiffness": 0.3,
      "pins": [{"column": 0}, {"column": 1}]}]})");
    auto view = desk.done(MakeSteps{2});
    REQUIRE(view->warnings.size() == 1);
    CHECK(view->warnings[0].starts_with("'strip' has hardly any of its bend_stiffness of 0.3 N m"));
    view = desk.done(Change{"cloths[0].bend", "\"yarn\""});
    CHECK(desk.done(MakeSteps{2})->warnings.empty());
  }

  TEST_CASE("an edit that is no scene is refused with the reason, and nothing changes") {
    Desk desk;
    desk.done(MakeSteps{3});
    auto view = desk.done(Change{"ropes[0].total_mass", "-4"});
    CHECK_FALSE(view->said->done);
    CHECK(view->said->text.find("ropes[0].total_mass: -4 is out of range") != std::string::npos);
    CHECK(view->document->text == kText);
    CHECK(view->step == 3);
    view = desk.done(Change{"ropes[0].total_mass", "two"});
    CHECK_FALSE(view->said->done);
    view = desk.done(Change{"ropes[0].total_mas", "2"});
    CHECK(view->said->text.find("total_mas") != std::string::npos);
    CHECK(view->undo_count == 0);
  }

  TEST_CASE("a saved scene has the edits, and all else as it was") {
    Desk desk;
    desk.done(Change{"ropes[0].total_mass", "4"});
    desk.done(Change{"world.wind.velocity", "[3, 0, 0]"});
    auto view = desk.done(Save{"edited.json"});
    CHECK(view->said->done);
    CHECK_FALSE(view->edited);
    const std::string expected = with(with(kText, "\"total_mass\": 2", "\"total_mass\": 4"), "}]}]\n",
                                      "}]}],\n  \"world\": {\"wind\": {\"velocity\": [3, 0, 0]}}\n");
    CHECK(read(desk.folder / "edited.json") == expected);
    CHECK(read(desk.file) == kText);
    CHECK_FALSE(desk.done(Save{"../edited.json"})->said->done);
    CHECK_FALSE(desk.done(Save{"edited.png"})->said->done);
    // Saved over its own file, it is not read again.
    view = desk.done(Save{"scene.json"});
    CHECK(view->said->done);
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    CHECK(desk.session->view()->built == view->built);
  }

  TEST_CASE("a file that is saved is read again; a mistake tells its line and column, and the scene stays") {
    Desk desk;
    auto view = desk.done(MakeSteps{5});
    view = desk.saved(with(kText, "\"total_mass\": 2", "\"total_mass\": 6"));
    CHECK(view->built == 2);
    CHECK(view->opened == 1);
    CHECK(view->step == 0);
    CHECK(view->document->scene.objects.ropes[0].desc.total_mass == 6);
    CHECK_FALSE(view->edited);
    desk.done(MakeSteps{7});
    view = desk.saved(with(kText, "\"total_mass\": 2,", "\"total_mass\": 2"));
    REQUIRE(view->file_errors.size() >= 1);
    // Line 4 of the text; the column where another word begins.
    CHECK(to_line(view->file_errors[0]).find("scene.json:4:") != std::string::npos);
    CHECK(view->step == 7);
    CHECK(view->document->scene.objects.ropes[0].desc.total_mass == 6);
    view = desk.saved(with(kText, "\"total_mass\": 2", "\"total_mass\": 0"));
    REQUIRE(view->file_errors.size() == 1);
    CHECK(to_line(view->file_errors[0]).find("scene.json:4:94: ropes[0].total_mass") != std::string::npos);
    view = desk.saved(with(kText, "\"total_mass\": 2", "\"total_mass\": 8"));
    CHECK(view->file_errors.empty());
    CHECK(view->document->scene.objects.ropes[0].desc.total_mass == 8);
    view = desk.done(Undo{});
    CHECK(view->step == 7);
    CHECK(view->document->scene.objects.ropes[0].desc.total_mass == 6);
  }

  TEST_CASE("another scene opens in its place; one that is missing or wrong leaves all as it is") {
    Desk desk;
    desk.done(MakeSteps{5});
    const std::string other = desk.folder / "other.json";
    auto view = desk.done(Open{other});
    CHECK_FALSE(view->said->done);
    CHECK(view->file_errors.size() == 1);
    CHECK(view->step == 5);
    write(other, R"({"version": 1, "bodies": [{"name": "ground", "shape": {"half_space": {}}}]})");
    view = desk.done(Open{other});
    CHECK(view->said->done);
    CHECK(view->opened == 2);
    CHECK(view->file_errors.empty());
    REQUIRE(view->listed->size() == 1);
    CHECK(view->listed->front().name == "ground");
    CHECK(view->listed->front().path == "bodies[0]");
    CHECK(view->undo_count == 0);
  }

  TEST_CASE("a hundred scenes that are opened one after the other leave no memory behind") {
    Desk desk;
    const std::string flag = desk.folder / "flag.json";
    write(flag, R"({"version": 1, "cloths": [{"name": "flag", "columns": 60, "rows": 60}]})");
    const auto open = [&](int times) {
      for (int i = 0; i < times; ++i) {
        desk.done(Open{i % 2 == 0 ? flag : desk.file});
        desk.done(MakeSteps{6});
      }
    };
    open(20);
    const double before = resident_bytes();
    open(100);
    const double grown = resident_bytes() - before;
    MESSAGE("grown by " << grown / 1024 << " KiB");
    // One world and its timeline take 2 MB; 100 of them would be 200 MB.
    CHECK(grown < 8e6);
  }
}

}  // namespace hooke::app
