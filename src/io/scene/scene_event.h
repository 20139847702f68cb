#pragma once

#include "hooke/scene_io.h"

#include <string>

/// \file
/// Tells what an event of the timeline can act on.

namespace hooke::io {

/// Returns the key in the file that says what an event does, such as ".impulse"; empty where there is none.
[[nodiscard]] const char* key_of(SceneEvent::Kind kind);

[[nodiscard]] bool acts_on_hook(SceneEvent::Kind kind);

/// Tells whether a hook of this kind has what an event changes.
[[nodiscard]] bool has_part(HookKind hook, SceneEvent::Kind event);

/// Returns why an event cannot act on a body, to stand after the body's name; empty if it can.
[[nodiscard]] std::string refusal_of(const SceneEvent& event, const BodyDesc& body);

}  // namespace hooke::io
