#pragma once

#include "hooke/model_io.h"

#include <optional>

namespace CLI {
class App;
}

namespace hooke::app {

/// What the command line says of a model that is read.
struct ModelOptions {
  ImportOptions import;
  std::optional<double> scale;

  /// Returns the options for import_model. Call it after parsing.
  [[nodiscard]] ImportOptions options() const {
    ImportOptions all = import;
    all.scale = scale.value_or(all.scale);
    return all;
  }
};

/// Adds --up, --scale and --fit. `model` must outlive the parsing.
void add_model_options(CLI::App& app, ModelOptions& model);

}  // namespace hooke::app
