#pragma once

#include "hooke/math.h"
#include "hooke/result.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hooke::build {

/// Collects the first thing wrong with a description. Every check names the field; later checks do nothing.
class Checks {
 public:
  explicit Checks(std::string object) : object_(std::move(object)) {}

  /// `value` must satisfy `good`; the message says what it is and what it must be.
  Checks& require(bool good, const std::string& field, double value, const char* must);
  Checks& require(bool good, const std::string& field, const char* must);

  Checks& positive(const std::string& field, double value) {
    return require(value > 0 && std::isfinite(value), field, value, "must be positive and finite");
  }
  Checks& not_negative(const std::string& field, double value) {
    return require(value >= 0 && std::isfinite(value), field, value, "must be zero or positive and finite");
  }
  /// A stiffness: positive, or kRigid.
  Checks& stiffness(const std::string& field, double value) {
    return require(value > 0, field, value, "must be positive, or rigid");
  }
  Checks& in_range(const std::string& field, double value, double least, double most);
  Checks& finite(const std::string& field, double value) {
    return require(std::isfinite(value), field, value, "must be finite");
  }
  template <class T>
  Checks& finite(const std::string& field, Vector3<T> value) {
    return require(is_finite(value), field, "must be finite");
  }
  /// World coordinates beyond this lose more than the engine's accuracy [m].
  Checks& place(const std::string& field, DVec3 value) {
    const double most = 1e9;
    const bool good = std::abs(value.x) <= most && std::abs(value.y) <= most && std::abs(value.z) <= most;
    return require(good, field, "must be finite and within 1e9 m of the origin");
  }

  [[nodiscard]] bool good() const { return !error_.has_value(); }
  [[nodiscard]] Result<void> result() const { return error_ ? Result<void>(*error_) : Result<void>(); }

 private:
  std::string object_;
  std::optional<Error> error_;
};

/// "has no edge 'to', there are left, right".
[[nodiscard]] Error no_such_name(const char* what, const std::string& name,
                                 const std::vector<std::string>& names, const char* where);

/// "name[i]"
[[nodiscard]] std::string indexed(const std::string& name, std::size_t i);

}  // namespace hooke::build
