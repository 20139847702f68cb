#include "hooke/session/session.h"

#include "simulation_of.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace hooke::app {

namespace {

/// A ball, a flag, a rope and a jelly in a row, 2 m apart, on a ground.
const char* const kScene = R"({
  "version": 1, "seconds": 60,
  "world": {"wind": {"velocity": [1, 0, 0], "gust": 0.5}},
  "bodies": [
    {"name": "ground", "shape": {"half_space": {}}},
    {"name": "ball", "kind": "dynamic", "shape": {"sphere": {"radius": 0.3}}, "position": [0, 0.3, 0], "mass": 2}],
  "cloths": [{"name": "flag", "corner": [2, 2, 0], "width": 1, "height": 1, "columns": 11, "rows": 11,
              "pins": [{"column": 0}]}],
  "ropes": [{"name": "rope", "hook_point": [5, 2, 0], "direction": [0, -1, 0], "length_at_rest": 1}],
  "solids": [{"name": "jelly", "cells": [3, 3, 3], "size": [0.5, 0.5, 0.5], "position": [7, 0.25, 0]}]
})";

Simulation make_simulation() {
  return simulation_of(kScene);
}

constexpr std::size_t kBudget = std::size_t{64} << 20;

/// Looks along -z at a place.
Ray ray_at(double x, double y) {
  return {{x, y, 5}, {0, 0, -20}};
}

void make_steps(LiveScene& live, int count) {
  for (int i = 0; i < count; ++i) REQUIRE(live.step().has_value());
}

std::uint64_t hash_of(const LiveScene& live) {
  return live.simulation().world().state_hash();
}

DVec3 place_of(const LiveScene& live, const std::string& name) {
  const SceneObject* object = live.simulation().find(name);
  REQUIRE(object != nullptr);
  return live.simulation().world().pose(object->body).position;
}

/// Grabs the ball, pulls it up and to the right for `steps`, and lets go.
void throw_ball(LiveScene& live, int steps) {
  const DVec3 place = place_of(live, "ball");
  REQUIRE(live.act(Grab{ray_at(place.x, place.y)}).done);
  for (int i = 0; i < steps; ++i) {
    REQUIRE(live.act(MoveHand{place + DVec3{-0.02 * i, 0.03 * i, 0}}).done);
    make_steps(live, 1);
  }
  REQUIRE(live.act(Release{}).done);
}

}  // namespace

TEST_SUITE("session/live_scene") {
  TEST_CASE("each kind of object is grabbed, named, pulled and let go") {
    LiveScene live(make_simulation(), kBudget);
    make_steps(live, 5);
    const std::vector<std::pair<std::string, Ray>> targets = {{"ball", ray_at(0, 0.3)},
                                                              {"flag", ray_at(2.3, 1.8)},
                                                              {"rope", ray_at(5, 1.2)},
                                                              {"jelly", ray_at(7, 0.25)}};
    for (const auto& [name, ray] : targets) {
      CAPTURE(name);
      const Outcome grabbed = live.act(Grab{ray});
      CHECK(grabbed.text == "grabbed '" + name + "'");
      CHECK(live.held() == name);
      const DVec3 start = live.hand().place(live.simulation().world());
      REQUIRE(live.act(MoveHand{start + DVec3{0, 0.3, 0.2}}).done);
      make_steps(live, 60);
      // The flag is held 0.3 m from its pole, and does not stretch.
      CHECK(length(live.hand().place(live.simulation().world()) - start) > (name == "flag" ? 0.15 : 0.2));
      CHECK(live.act(Release{}).text == "let go of '" + name + "'");
      CHECK(live.held().empty());
    }
    CHECK_FALSE(live.act(Grab{ray_at(0, 50)}).done);
    CHECK(live.act(Grab{{{-3, 3, 0}, {0, -10, 0}}}).text == "'ground' cannot be moved");
    CHECK_FALSE(live.act(Release{}).done);
    CHECK(live.undo_count() == 4);
  }

  TEST_CASE("undo gives back the state before, to the bit, one action after the other") {
    LiveScene live(make_simulation(), kBudget);
    make_steps(live, 20);
    const std::uint64_t first = hash_of(live);
    throw_ball(live, 10);
    make_steps(live, 13);
    const std::uint64_t second = hash_of(live);
    REQUIRE(live.act(Shoot{ray_at(7, 0.3)}).done);
    make_steps(live, 30);
    CHECK(live.undo_count() == 2);
    CHECK(live.undo().text == "undone: shot");
    CHECK(hash_of(live) == second);
    CHECK(live.step_count() == 43);
    CHECK(live.last_step() == 43);
    CHECK(live.undo().text == "undone: grab");
    CHECK(hash_of(live) == first);
    CHECK(live.step_count() == 20);
    CHECK_FALSE(live.undo().done);
  }

  TEST_CASE("a rewind finds every step again, to the bit, with all that was done") {
    LiveScene live(make_simulation(), kBudget);
    std::vector<std::uint64_t> hashes = {hash_of(live)};
    const auto go_on = [&](int count) {
      for (int i = 0; i < count; ++i) {
        make_steps(live, 1);
        hashes.push_back(hash_of(live));
      }
    };
    go_on(17);
    REQUIRE(live.act(Grab{ray_at(0, 0.3)}).done);
    hashes.back() = hash_of(live);
    for (int i = 0; i < 20; ++i) {
      live.act(MoveHand{{0.02 * i, 0.3 + 0.05 * i, 0}});
      go_on(1);
    }
    live.act(Release{});
    hashes.back() = hash_of(live);
    go_on(10);
    REQUIRE(live.act(Drop{.object = "jelly", .ray = ray_at(0, 3), .distance = 5}).done);
    hashes.back() = hash_of(live);
    go_on(30);
    const std::uint64_t last = live.step_count();
    for (const std::uint64_t step : {60, 3, 17, 18, 36, 37, 47, 48, 0, 77}) {
      CAPTURE(step);
      REQUIRE(live.seek(step));
      CHECK(live.step_count() == step);
      CHECK(hash_of(live) == hashes[step]);
      CHECK(live.last_step() == last);
    }
    // Played on, it repeats what happened.
    REQUIRE(live.seek(10));
    make_steps(live, 50);
    REQUIRE(live.seek(60));
    CHECK(hash_of(live) == hashes[60]);
    // A new action forgets what came after it.
    REQUIRE(live.seek(30));
    CHECK(live.held() == "ball");
    REQUIRE(live.act(Release{}).done);
    CHECK(live.last_step() == 30);
    make_steps(live, 30);
    CHECK(hash_of(live) != hashes[60]);
    live.restart();
    CHECK(hash_of(live) == hashes[0]);
    CHECK(live.undo_count() == 0);
    make_steps(live, 17);
    CHECK(live.timeline().actions().empty());
  }

  TEST_CASE("the timeline keeps to its budget, and still finds every step") {
    std::size_t one = 0;
    {
      LiveScene live(make_simulation(), kBudget);
      one = live.timeline().bytes();
    }
    CHECK(one > 10'000);
    LiveScene live(make_simulation(), 8 * one);
    std::vector<std::uint64_t> hashes = {hash_of(live)};
    for (int i = 0; i < 300; ++i) {
      if (i == 100) REQUIRE(live.act(Grab{ray_at(7, 0.25)}).done);
      if (i == 130) REQUIRE(live.act(Release{}).done);
      make_steps(live, 1);
      hashes.push_back(hash_of(live));
      CHECK(live.timeline().bytes() <= 8 * one);
    }
    CHECK(live.timeline().interval() > 40);
    CHECK(live.timeline().moments() >= 3);
    CHECK(live.undo_count() == 1);
    for (const std::uint64_t step : {299, 1, 150, 77, 300}) {
      REQUIRE(live.seek(step));
      CHECK(hash_of(live) == hashes[step]);
    }
    // Many actions: those that lie farthest back cannot be undone any more.
    for (int i = 0; i < 40; ++i) REQUIRE(live.act(Shoot{ray_at(-3, 3)}).done);
    CHECK(live.undo_count() < 40);
    CHECK(live.undo_count() > 1);
    CHECK(live.timeline().moments() >= 2);
  }

  TEST_CASE("the smallest budget holds what is done before the first step, and what is undone") {
    LiveScene live(make_simulation(), 1);
    REQUIRE(live.act(Shoot{ray_at(-3, 3)}).done);
    REQUIRE(live.undo().done);
    for (int i = 0; i < 10; ++i) {
      REQUIRE(live.act(Grab{ray_at(0, 0.3)}).done);
      REQUIRE(live.act(Release{}).done);
    }
    CHECK(live.timeline().moments() == 2);
    CHECK(live.timeline().interval() < 1000);
    make_steps(live, 3);
    REQUIRE(live.seek(0));
    CHECK(live.step_count() == 0);
  }

  TEST_CASE("what is refused changes nothing, so that a repeat gives the same names and bits") {
    LiveScene live(make_simulation(), kBudget);
    const std::uint64_t start = hash_of(live);
    CHECK_FALSE(live.act(Shoot{.ray = ray_at(-2, 5), .radius = -1}).done);
    CHECK(hash_of(live) == start);
    CHECK(live.act(Shoot{ray_at(-2, 5)}).text == "shot 'ball_1'");
    make_steps(live, 3);
    const std::uint64_t last = hash_of(live);
    REQUIRE(live.seek(0));
    REQUIRE(live.seek(3));
    CHECK(live.simulation().find("ball_1") != nullptr);
    CHECK(hash_of(live) == last);

    // An edit of which a part cannot be.
    auto document = std::make_shared<SceneDocument>();
    document->scene = live.simulation().scene();
    document->scene.world.gravity = {0, 1, 0};
    document->scene.world.wind.velocity = {5, 0, 0};
    document->scene.world.workers = -1;
    CHECK_FALSE(live.act(Edit{document, "gravity"}).done);
    CHECK(live.simulation().world().desc().gravity.y == doctest::Approx(-9.81));
    CHECK(live.simulation().world().desc().wind.velocity.x == doctest::Approx(1));
    CHECK(hash_of(live) == last);
  }

  TEST_CASE("an edit of gravity keeps workers that the command line set") {
    auto said = std::make_shared<SceneDocument>();
    said->scene = make_simulation().scene();
    Simulation simulation = make_simulation();
    REQUIRE(simulation.world().set_workers(2));
    LiveScene live(std::move(simulation), kBudget, said);
    auto edited = std::make_shared<SceneDocument>(*said);
    edited->scene.world.gravity = {0, -5, 0};
    REQUIRE(live.act(Edit{edited, "gravity"}).done);
    CHECK(live.simulation().world().desc().workers == 2);
    edited = std::make_shared<SceneDocument>(*edited);
    edited->scene.world.workers = 3;
    REQUIRE(live.act(Edit{edited, "workers"}).done);
    CHECK(live.simulation().world().desc().workers == 3);
  }

  TEST_CASE("a body that yields is grabbed and let go, rigid and soft") {
    LiveScene live(simulation_of(R"({"version": 1, "world": {"gravity": [0, 0, 0]}, "bodies": [
      {"name": "tin", "kind": "dynamic", "shape": {"box": {"half_extents": [0.3, 0.3, 0.03]}}, "mass": 12,
       "yields": {"impulse": 20, "cell": 0.1, "young_modulus": 3e6, "damping": 0.02, "yield_stress": 3e4}},
      {"name": "ball", "kind": "dynamic", "shape": {"sphere": {"radius": 0.08}}, "mass": 6,
       "position": [0.12, 0.05, -0.5], "velocity": [0, 0, 12]}]})"),
                   kBudget);
    const Ray ray = ray_at(-0.2, 0.1);
    const BodyId tin = live.simulation().find("tin")->body;
    CHECK(live.act(Grab{ray}).text == "grabbed 'tin'");
    CHECK(live.act(Release{}).done);
    for (int i = 0; i < 60 && !live.simulation().world().soft_form(tin); ++i) make_steps(live, 1);
    REQUIRE(live.simulation().world().soft_form(tin));
    CHECK(live.name_at(ray) == "tin");
    CHECK(live.act(Grab{ray}).text == "grabbed 'tin'");
    CHECK(live.held() == "tin");
    CHECK(live.act(Release{}).text == "let go of 'tin'");
    CHECK(live.act(Pin{ray}).text == "'tin' is soft now: pin it once it is rigid again");
  }

  TEST_CASE("a hand that must let go says why") {
    LiveScene live(make_simulation(), kBudget);
    REQUIRE(live.act(Grab{ray_at(0, 0.3)}).done);
    make_steps(live, 1);
    CHECK_FALSE(live.take_lost());
    REQUIRE(live.act(MoveHand{{0, 1e30, 0}}).done);
    make_steps(live, 1);
    const std::optional<std::string> lost = live.take_lost();
    REQUIRE(lost);
    CHECK(lost->starts_with("the hand lost 'ball': "));
    CHECK(lost->find("target") != std::string::npos);
    CHECK_FALSE(live.hand().holds());
    make_steps(live, 1);
    CHECK_FALSE(live.take_lost());
  }

  TEST_CASE("a way to a step ends when it is told to") {
    LiveScene live(make_simulation(), kBudget);
    make_steps(live, 20);
    int asked = 0;
    REQUIRE(live.seek(0));
    CHECK(live.seek(19, [&] { return ++asked > 2; }));
    CHECK(live.step_count() == 17);  // There is a state at 15.
    CHECK(live.last_step() == 20);
  }

  TEST_CASE("balls fly, copies fall, pins hold, strings tie, and removed objects are gone") {
    LiveScene live(make_simulation(), kBudget);
    CHECK(live.act(Shoot{.ray = ray_at(-2, 5), .speed = 10}).text == "shot 'ball_1'");
    make_steps(live, 30);
    const DVec3 ball = place_of(live, "ball_1");
    CHECK(5 - ball.z == doctest::Approx(0.4 + 5).epsilon(0.02));
    CHECK(5 - ball.y == doctest::Approx(0.5 * 9.81 * 0.25).epsilon(0.05));

    CHECK(live.act(Drop{.object = "ball", .ray = {{-4, 5, 0}, {0, -20, 0}}}).text == "dropped 'ball_2'");
    CHECK(place_of(live, "ball_2").y == doctest::Approx(0.6));
    CHECK(live.act(Drop{.object = "flag", .ray = {{-6, 5, 0}, {0, -20, 0}}}).done);
    CHECK_FALSE(live.act(Drop{.object = "ground", .ray = ray_at(0, 3)}).done);
    make_steps(live, 60);
    CHECK(place_of(live, "ball_2").y == doctest::Approx(0.3).epsilon(0.02));

    // A body that is pinned in the air stays there; a second pin lets it fall.
    REQUIRE(live.act(Grab{ray_at(0, 0.3)}).done);
    live.act(MoveHand{{0, 2, 0}});
    make_steps(live, 60);
    CHECK(live.act(Pin{ray_at(0, place_of(live, "ball").y)}).text == "pinned 'ball'");
    live.act(Release{});
    make_steps(live, 60);
    const double height = place_of(live, "ball").y;
    CHECK(height > 1.8);
    // The upper end of the rope is tied to it: unpinned, the ball swings toward the rope as it falls.
    CHECK(live.act(Tie{ray_at(0, height), ray_at(5, 1.97)}).done);
    CHECK(live.act(Pin{ray_at(0, height)}).text == "unpinned 'ball'");
    make_steps(live, 60);
    const DVec3 swung = place_of(live, "ball");
    CHECK(swung.x > 0.15);

    const Outcome pinned = live.act(Pin{ray_at(2.95, 1.5)});
    if (pinned.done) CHECK(pinned.text.starts_with("pinned point"));
    CHECK(live.act(Remove{ray_at(7, 0.25)}).text == "removed 'jelly'");
    CHECK(live.simulation().find("jelly") == nullptr);
    REQUIRE(live.undo().done);
    CHECK(live.simulation().find("jelly") != nullptr);
  }

  TEST_CASE("the figure of contacts says that it is the force of bodies alone") {
    LiveScene live(simulation_of(R"({"version": 1,
      "bodies": [{"name": "ground", "shape": {"half_space": {}}},
                 {"name": "low", "kind": "dynamic", "shape": {"box": {"half_extents": [0.1, 0.1, 0.1]}},
                  "mass": 1, "position": [0, 0.1, 0]}]})"),
                   kBudget);
    make_steps(live, 60);
    double force = 0;
    for (const MeasuredValue& value : measure(live.simulation(), "low"))
      if (value.name == "force of bodies") force = value.value;
    CHECK(force == doctest::Approx(9.81).epsilon(0.01));
  }
}

TEST_SUITE("session/session") {
  Loaded<Simulation> build(const Scene& scene, const std::function<void(const std::string&)>& progress) {
    progress("building");
    return Simulation::create(scene);
  }

  /// Reads a text in place of a file.
  Loader loader_of(const char* text, double seconds = 0) {
    const auto read = [text, seconds](const std::string& file) -> Loaded<SceneDocument> {
      std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
      Loaded<Scene> scene = parse_scene(text, "scene.json");
      if (!scene) return {.errors = std::move(scene.errors)};
      return {.value = SceneDocument{file, text, *std::move(scene.value)}};
    };
    return {read, build};
  }

  constexpr double kLong = 120;  // Nothing waits for so long but on a machine that is stuck [s].

  TEST_CASE("a body's figures tell what a jelly that lies on it weighs") {
    Session session("", loader_of(R"({"version": 1,
      "bodies": [{"name": "ground", "shape": {"half_space": {}}},
                 {"name": "table", "shape": {"box": {"half_extents": [1, 0.5, 1]}}, "position": [0, 0.5, 0]}],
      "timeline": [{"at_step": 0, "add": {
        "bodies": [{"name": "stool", "shape": {"box": {"half_extents": [1, 0.5, 1]}}, "position": [5, 0.5, 0]}],
        "solids": [{"name": "other", "cells": [3, 3, 3], "size": [0.5, 0.5, 0.5], "position": [5, 1.25, 0],
                    "total_mass": 4}]}}],
      "solids": [{"name": "jelly", "cells": [3, 3, 3], "size": [0.5, 0.5, 0.5], "position": [0, 1.25, 0],
                  "total_mass": 4}]})"),
                    {.playing = false});
    session.post(MakeSteps{180});
    for (const char* const name : {"table", "stool"}) {
      CAPTURE(name);
      const std::uint64_t number = session.post(Select{name});
      const auto view = session.wait_for(
          [&](const SessionView& v) { return v.commands >= number && v.step == 180; }, kLong);
      double force = -1;
      for (const MeasuredValue& value : view->measured)
        if (value.name == "force of ropes, cloths and solids") force = value.value;
      CHECK(force == doctest::Approx(4 * 9.81).epsilon(0.03));
    }
  }

  TEST_CASE("while it loads, calls return at once, and commands wait") {
    const auto start = std::chrono::steady_clock::now();
    Session session("", loader_of(kScene, 1), {.playing = false});
    const std::uint64_t number = session.post(MakeSteps{3});
    CHECK(session.view()->stage == SessionView::Stage::kLoading);
    CHECK(session.view()->step == 0);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    CHECK(passed.count() < 0.9);
    const auto view = session.wait_for([&](const SessionView& v) { return v.commands >= number; }, kLong);
    REQUIRE(view->stage == SessionView::Stage::kReady);
    CHECK(view->step == 3);
    CHECK(view->time == doctest::Approx(0.05));
    CHECK(view->places.size() == 5);
    CHECK(view->picture->objects.size() == 5);
    CHECK(view->droppable == std::vector<std::string>{"ball", "rope", "flag", "jelly"});
  }

  TEST_CASE("while a change is built, the view is the one before, whole") {
    std::atomic<const Session*> shown = nullptr;
    std::vector<std::shared_ptr<const SessionView>> views;
    Loader loader = loader_of(kScene);
    loader.build = [&](const Scene& scene, const std::function<void(const std::string&)>& progress) {
      progress("building");
      if (const Session* session = shown) views.push_back(session->view());
      return Simulation::create(scene);
    };
    Session session("", loader, {.playing = false});
    session.wait_for([](const SessionView& v) { return v.stage == SessionView::Stage::kReady; }, kLong);
    shown = &session;
    session.post(Select{"ball"});
    const std::uint64_t number = session.post(Change{"bodies[1].mass", "3"});
    const auto view = session.wait_for([&](const SessionView& v) { return v.commands >= number; }, kLong);
    CHECK(view->said->text.find("starts anew") != std::string::npos);
    CHECK(view->progress.empty());
    CHECK(view->listed->size() == 5);
    REQUIRE(views.size() == 1);
    CHECK(views[0]->progress == "building");
    CHECK(views[0]->commands < number);
    CHECK(views[0]->built < view->built);
    REQUIRE(views[0]->listed != nullptr);
    CHECK(views[0]->listed->size() == 5);
  }

  TEST_CASE("it ends between two steps, whatever was asked for") {
    const auto start = std::chrono::steady_clock::now();
    {
      Session session("", loader_of(kScene), {.playing = false});
      const std::uint64_t number = session.post(MakeSteps{1});
      session.wait_for([&](const SessionView& v) { return v.commands >= number; }, kLong);
      session.post(MakeSteps{100'000'000});
      session.post(MakeSteps{100'000'000});
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    CHECK(passed.count() < kLong);
  }

  TEST_CASE("a scene that cannot be built says why") {
    Session session("", loader_of(R"({"version": 1, "bodies": [{"shape": {"sphere": {"radius": -1}}}]})"),
                    {});
    const auto view =
        session.wait_for([](const SessionView& v) { return v.stage == SessionView::Stage::kFailed; }, kLong);
    REQUIRE(view->errors.size() == 1);
    CHECK(to_line(view->errors[0]).find("radius") != std::string::npos);
    session.post(Undo{});
  }

  TEST_CASE("it plays in time and not faster, pauses, steps, rewinds and undoes") {
    Session session("", loader_of(kScene), {});
    const auto start = std::chrono::steady_clock::now();
    auto view = session.wait_for([](const SessionView& v) { return v.step >= 20; }, kLong);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    CHECK(passed.count() > 19.0 / 60);
    const auto done = [&](Command command) {
      const std::uint64_t number = session.post(std::move(command));
      return session.wait_for([&](const SessionView& v) { return v.commands >= number; }, kLong);
    };
    view = done(Play{false});
    CHECK_FALSE(view->playing);
    const std::uint64_t step = view->step;
    view = done(MakeSteps{5});
    CHECK(view->step == step + 5);
    view = done(Action(Grab{ray_at(0, 0.3)}));
    CHECK(view->said->done);
    CHECK(view->held == "ball");
    CHECK(view->undo_count == 1);
    done(Action(MoveHand{{0, 2, 0}}));
    view = done(MakeSteps{30});
    CHECK(view->hand_place.y > 1);
    view = done(Seek{step});
    CHECK(view->step == step);
    CHECK(view->last_step == step + 35);
    CHECK_FALSE(view->holding);
    view = done(Seek{step + 35});
    CHECK(view->held == "ball");
    view = done(Undo{});
    CHECK(view->step == step + 5);
    CHECK_FALSE(view->holding);
    CHECK(view->timeline_bytes > 0);
    CHECK(view->timeline_bytes <= view->timeline_budget);
    CHECK(done(SetSpeed{std::nan("")})->speed == kLeastSpeed);
    CHECK(done(SetSpeed{1e300})->speed == kMostSpeed);
    view = done(SetSpeed{0.25});
    const auto slow = std::chrono::steady_clock::now();
    view = done(Play{true});
    session.wait_for([&](const SessionView& v) { return v.step >= view->step + 6; }, kLong);
    const std::chrono::duration<double> slowly = std::chrono::steady_clock::now() - slow;
    CHECK(slowly.count() > 5 * 4.0 / 60);
    view = done(Restart{});
    CHECK(view->step <= 1);
  }

  TEST_CASE("a change of the scene forgets what was undone before it, and is itself done again") {
    Session session("", loader_of(kScene), {.playing = false});
    const auto done = [&](Command command) {
      const std::uint64_t number = session.post(std::move(command));
      return session.wait_for([&](const SessionView& v) { return v.commands >= number; }, kLong);
    };
    REQUIRE(done(Action(Shoot{ray_at(-3, 3)}))->said->done);
    CHECK(done(Undo{})->redo_count == 1);
    REQUIRE(done(Change{"bodies[1].mass", "3"})->said->done);
    CHECK(done(Undo{})->redo_count == 1);
    CHECK(done(Redo{})->said->text == "done again: change of the scene");
  }

  TEST_CASE("it stops for good at its time") {
    Session session("", loader_of(kScene), {.stop_time = 0.2});
    const auto view = session.wait_for([](const SessionView& v) { return v.time > 0 && !v.playing; }, kLong);
    CHECK(view->time == doctest::Approx(0.2).epsilon(0.01));
  }
}

}  // namespace hooke::app
