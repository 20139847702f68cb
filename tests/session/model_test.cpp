#include "hooke/session/model_scene.h"
#include "hooke/session/session.h"

#include "../temporary_folder.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace hooke::app {

namespace {

constexpr double kLong = 120;  // Nothing waits for so long but on a machine that is stuck [s].
const std::string kModels = HOOKE_OWN_MODELS;

/// A session of a model that is 1 m long.
struct Show {
  explicit Show(const std::string& file) {
    Loader loader;
    loader.read = [](const std::string& name) -> Loaded<SceneDocument> {
      auto document = document_of_model(name, {.fit = 1});
      if (!document) return {.errors = {document.error()}};
      return {.value = std::move(document).value()};
    };
    loader.build = [](const Scene& scene, const std::function<void(const std::string&)>&) {
      return Simulation::create(scene);
    };
    session.emplace(file, loader, SessionOptions{.playing = false});
    const auto view = session->wait_for(
        [](const SessionView& v) { return v.stage != SessionView::Stage::kLoading; }, kLong);
    for (const Error& error : view->errors) FAIL(to_line(error));
  }

  std::shared_ptr<const SessionView> done(Command command) {
    const std::uint64_t number = session->post(std::move(command));
    return session->wait_for([&](const SessionView& v) { return v.commands >= number; }, kLong);
  }

  std::optional<Session> session;
};

const ListedObject* model_of(const SessionView& view) {
  for (const ListedObject& object : *view.listed) {
    if (object.name == "model") return &object;
  }
  return nullptr;
}

/// Height of the model's place [m].
double height_of(const SessionView& view) {
  for (const auto& [name, place] : view.places) {
    if (name == "model") return place.y;
  }
  FAIL("the model has no place");
  return 0;
}

/// A model of `count` squared separate points in a plane, too many for a cloth.
std::string write_wide_model(const test::TemporaryFolder& folder, int count) {
  std::string file = folder / "wide.obj";
  std::ofstream out(file);
  for (int y = 0; y < count; ++y) {
    for (int x = 0; x < count; ++x) out << "v " << x << ' ' << y << " 0\n";
  }
  const auto at = [&](int x, int y) { return 1 + x + count * y; };
  for (int y = 0; y + 1 < count; ++y) {
    for (int x = 0; x + 1 < count; ++x) {
      out << "f " << at(x, y) << ' ' << at(x + 1, y) << ' ' << at(x + 1, y + 1) << '\n';
      out << "f " << at(x, y) << ' ' << at(x + 1, y + 1) << ' ' << at(x, y + 1) << '\n';
    }
  }
  return file;
}

}  // namespace

TEST_SUITE("session/model") {
  TEST_CASE("a model becomes a rigid body, jelly and cloth, which fall, and stands still again") {
    for (const char* name : {"/crate.3ds", "/lantern.3ds"}) {
      CAPTURE(name);
      Show show(kModels + name);
      const double still = height_of(*show.done(MakeSteps{10}));
      CHECK(height_of(*show.session->view()) == doctest::Approx(still));
      const std::pair<ModelForm, std::pair<const char*, SceneObject::Kind>> forms[] = {
          {ModelForm::kRigid, {"the model is a rigid body now", SceneObject::Kind::kBody}},
          {ModelForm::kJelly, {"the model is jelly now", SceneObject::Kind::kSolid}},
          {ModelForm::kCloth, {"the model is cloth now", SceneObject::Kind::kCloth}}};
      for (const auto& [form, expected] : forms) {
        CAPTURE(expected.first);
        auto view = show.done(TurnModel{form});
        REQUIRE(view->said->text == expected.first);
        CHECK(view->step == 0);
        REQUIRE(model_of(*view) != nullptr);
        CHECK(model_of(*view)->kind == expected.second);
        // A fifth of a meter takes 0.202 s: after 0.1 s it has fallen g t^2 / 2.
        const double above = height_of(*view);
        view = show.done(MakeSteps{6});
        CHECK(above - height_of(*view) == doctest::Approx(0.5 * 9.81 * 0.01).epsilon(0.2).scale(0));
        CHECK(view->problem.empty());
      }
      const auto view = show.done(TurnModel{ModelForm::kCloth});
      CHECK(view->said->text == "the model is still now");
      CHECK(height_of(*view) == doctest::Approx(still));
    }
  }

  TEST_CASE("models of one folder have scenes of different names, so that nothing saved overwrites another") {
    const test::TemporaryFolder folder;
    const std::string wide = write_wide_model(folder, 3);
    const std::string other = folder / "wide.ply.obj";
    std::filesystem::copy_file(wide, other);
    const auto one = document_of_model(wide, {.fit = 1});
    const auto two = document_of_model(other, {.fit = 1});
    REQUIRE(one);
    REQUIRE(two);
    CHECK(one.value().scene.path == wide + ".json");
    CHECK(two.value().scene.path == other + ".json");
    Show show(wide);
    CHECK(show.done(SaveFigures{})->said->text.starts_with("saved '" + wide + "-figures.csv'"));
    CHECK(std::filesystem::exists(wide + "-figures.csv"));
  }

  TEST_CASE("undo puts back the form before, and what was edited stays in the next form") {
    Show show(kModels + "/crate.3ds");
    show.done(Change{"world.gravity", "[0, -1.62, 0]"});
    auto view = show.done(TurnModel{ModelForm::kJelly});
    CHECK(view->document->scene.world.gravity.y == doctest::Approx(-1.62));
    CHECK(form_of_model(*view->document) == ModelForm::kJelly);
    // The stiffness by which it sinks by 3 % follows gravity: 1000 1.62 1 / 0.06.
    CHECK(view->document->scene.objects.solids[0].desc.young_modulus == doctest::Approx(27000));
    view = show.done(Undo{});
    CHECK(form_of_model(*view->document) == ModelForm::kStill);
    view = show.done(Redo{});
    CHECK(form_of_model(*view->document) == ModelForm::kJelly);
  }

  TEST_CASE("a model that is too fine for a cloth stays as it is, and one line says why") {
    const test::TemporaryFolder folder;
    Show show(write_wide_model(folder, 142));
    const auto before = show.session->view();
    const auto view = show.done(TurnModel{ModelForm::kCloth});
    CHECK_FALSE(view->said->done);
    CHECK(
        view->said->text ==
        "nothing is turned: its surface has 20164 points, and a cloth that runs in real time at most 20000: "
        "open a coarser model");
    CHECK(view->built == before->built);
    CHECK(form_of_model(*view->document) == ModelForm::kStill);
  }

  TEST_CASE("a scene that came from no model is not turned") {
    const SceneDocument scene = {.file = "scene.json", .text = "{\"version\": 1}", .scene = {}};
    CHECK_FALSE(form_of_model(scene).has_value());
    const auto turned = turn_model(scene, ModelForm::kJelly);
    REQUIRE_FALSE(turned.has_value());
    CHECK(turned.error().code == ErrorCode::kUnsupported);
  }
}

}  // namespace hooke::app
