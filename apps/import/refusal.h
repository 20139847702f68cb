#pragma once

#include "io/model/model_flat.h"

#include <stdexcept>
#include <string>

namespace hooke::importer {

/// A Refusal tells why a file is not imported. It ends the program with `exit` and the reason on standard
/// error.
class Refusal : public std::runtime_error {
 public:
  Refusal(io::ImporterExit exit, const std::string& reason) : std::runtime_error(reason), exit_(exit) {}

  [[nodiscard]] io::ImporterExit exit() const { return exit_; }

 private:
  io::ImporterExit exit_;
};

}  // namespace hooke::importer
