#include "hooke/view/view_input.h"

#include <doctest/doctest.h>
#include <memory>

namespace hooke::app {

namespace {

constexpr double kLong = 120;  // Nothing waits for so long but on a machine that is stuck [s].

Loaded<SceneDocument> read(const std::string& file) {
  const char* const text = R"({"version": 1, "bodies": [
      {"name": "ball", "kind": "dynamic", "shape": {"sphere": {"radius": 0.3}}}]})";
  Loaded<Scene> scene = parse_scene(text, "scene.json");
  if (!scene) return {.errors = std::move(scene.errors)};
  return {.value = SceneDocument{file, text, *std::move(scene.value)}};
}

Loaded<Simulation> build(const Scene& scene, const std::function<void(const std::string&)>& /*progress*/) {
  return Simulation::create(scene);
}

}  // namespace

TEST_SUITE("session/view_input") {
  using Key = ViewInput::Key;

  TEST_CASE("keys that are pressed before the next view count one after the other") {
    Session session("", {read, build}, {.playing = false});
    render::OrbitCamera camera;
    ViewInput input(session, camera);
    const Eye eye = {};
    const auto shown = [&] {
      return session.wait_for(
          [&](const SessionView& v) {
            return v.stage == SessionView::Stage::kReady && v.commands >= input.posted();
          },
          kLong);
    };
    const auto press = [&](Key key, const SessionView& view) {
      input.look(eye, view, {});
      input.key(key);
    };
    const auto start = shown();
    // The window still shows this view when each key comes.
    press(Key::kSlower, *start);
    press(Key::kSlower, *start);
    press(Key::kSlower, *start);
    press(Key::kFaster, *start);
    CHECK(shown()->speed == 0.25);
    press(Key::kPlay, *start);
    press(Key::kPlay, *start);
    CHECK_FALSE(shown()->playing);
    const auto before = shown();
    for (int i = 0; i < 10; ++i) press(Key::kStep, *before);
    press(Key::kStepBack, *before);
    press(Key::kStepBack, *before);
    press(Key::kStepBack, *before);
    CHECK(shown()->step == before->step + 7);
    CHECK(shown()->last_step == before->step + 10);
    // A later view is believed again.
    session.post(SetSpeed{2});
    session.wait_for([](const SessionView& v) { return v.speed == 2; }, kLong);
    press(Key::kFaster, *session.view());
    CHECK(shown()->speed == 4);
  }

  TEST_CASE("speeds end where the session's do") {
    Session session("", {read, build}, {.playing = false});
    render::OrbitCamera camera;
    ViewInput input(session, camera);
    const auto done = [&] {
      return session.wait_for([&](const SessionView& v) { return v.commands >= input.posted(); }, kLong);
    };
    for (int i = 0; i < 10; ++i) input.key(Key::kFaster);
    input.key(Key::kSlower);
    CHECK(done()->speed == kMostSpeed / 2);
    for (int i = 0; i < 40; ++i) input.key(Key::kSlower);
    CHECK(done()->speed == kLeastSpeed);
  }

  TEST_CASE("edits that are not saved are not lost by one key") {
    Session session("", {read, build}, {.playing = false});
    render::OrbitCamera camera;
    ViewInput input(session, camera);
    const auto look = [&](bool edited) {
      SessionView view = *session.view();
      view.edited = edited;
      input.look({}, view, {});
    };
    look(true);
    input.key(Key::kClose);
    CHECK_FALSE(input.wants_to_close());
    CHECK(input.hint().find("not saved") != std::string_view::npos);
    // Anything else takes it back.
    look(true);
    input.key(Key::kSlower);
    CHECK(input.hint().empty());
    input.key(Key::kQuit);
    CHECK_FALSE(input.wants_to_close());
    look(true);
    input.key(Key::kQuit);
    CHECK(input.wants_to_close());
  }

  TEST_CASE("without edits one key hides the page of keys, or closes the window") {
    Session session("", {read, build}, {.playing = false});
    render::OrbitCamera camera;
    ViewInput input(session, camera);
    input.look({}, *session.view(), {});
    input.key(Key::kHelp);
    input.key(Key::kClose);
    CHECK_FALSE(input.shows_help());
    CHECK_FALSE(input.wants_to_close());
    input.key(Key::kClose);
    CHECK(input.wants_to_close());
  }
}

}  // namespace hooke::app
