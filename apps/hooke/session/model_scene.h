#pragma once

#include "hooke/model_io.h"
#include "hooke/session/scene_document.h"

#include <cstdint>
#include <optional>
#include <string>

/// \file
/// A model that is shown by itself: a scene of it on a ground, in one of several forms.

namespace hooke::app {

/// What a shown model is made of.
enum class ModelForm : std::uint8_t {
  kStill,  ///< A body that stands on the ground and never moves.
  kRigid,  ///< A rigid body that falls.
  kJelly,  ///< A soft solid that falls.
  kCloth,  ///< Its surface as a cloth that falls.
};

/// Whether a file is a model, by its ending.
bool is_model_file(const std::string& file);

/// Makes a scene with the model standing still on a ground. Errors: those of import_model.
Result<SceneDocument> document_of_model(const std::string& file, const ImportOptions& options);

/// The form of the model of such a scene; nothing for a scene that came from no model, or lost it.
std::optional<ModelForm> form_of_model(const SceneDocument& document);

/// Returns the scene with the model in another form, a fifth of its longest side above the ground unless it
/// is still. Jelly has twelve cells along that side, and a stiffness by which it sinks by 3 % under its own
/// weight. What else the scene says stays. Errors: those of import_model; kUnsupported if the scene came from
/// no model; kLimitExceeded for a cloth of more points than run in real time.
Result<SceneDocument> turn_model(const SceneDocument& document, ModelForm form);

}  // namespace hooke::app
