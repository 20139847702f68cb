#pragma once

#include "hooke/limits.h"
#include "hooke/math.h"
#include "hooke/result.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hooke::build {

/// Collects the first error of a description. Every check names its field; checks after an error do nothing.
class Checks {
 public:
  explicit Checks(std::string object) : object_(std::move(object)) {}

  /// Requires `good`; the message gives `value` and says what it must be.
  Checks& require(bool good, const std::string& field, double value, const char* must);
  Checks& require(bool good, const std::string& field, const char* must);

  Checks& positive(const std::string& field, double value) {
    return require(value > 0 && std::isfinite(value), field, value, "must be positive and finite");
  }
  Checks& not_negative(const std::string& field, double value) {
    return require(value >= 0 && std::isfinite(value), field, value, "must be zero or positive and finite");
  }
  /// Requires a positive stiffness of at most 1e30, or kRigid.
  Checks& stiffness(const std::string& field, double value) {
    return require(value > 0 && (value <= as_real(limits::kStiffness) || std::isinf(value)), field, value,
                   value > 0 ? "must be at most 1e30, or rigid" : "must be positive, or rigid");
  }
  /// Does the same, but a stiffness of zero passes, too.
  Checks& stiffness_or_none(const std::string& field, double value) {
    return value == 0 ? *this : stiffness(field, value);
  }
  Checks& in_range(const std::string& field, double value, double least, double most);
  Checks& finite(const std::string& field, double value) {
    return require(std::isfinite(value), field, value, "must be finite");
  }
  template <class T>
  Checks& finite(const std::string& field, Vector3<T> value) {
    return require(is_finite(value), field, "must be finite");
  }
  /// Requires each component to be from -most to most.
  Checks& within(const std::string& field, DVec3 value, double most, const char* unit = "");
  Checks& within(const std::string& field, Vector3<float> value, double most, const char* unit = "") {
    return within(field, vector_cast<double>(value), most, unit);
  }
  Checks& place(const std::string& field, DVec3 value) {
    return within(field, value, limits::kPlace, " m of the origin");
  }
  template <class T>
  Checks& velocity(const std::string& field, Vector3<T> value) {
    return within(field, vector_cast<double>(value), limits::kSpeed, " m/s");
  }
  Checks& size(const std::string& field, double value) {
    return in_range(field, value, limits::kLeastSize, limits::kSize);
  }
  Checks& mass(const std::string& field, double value) {
    return in_range(field, value, limits::kLeastMass, limits::kMass);
  }
  /// Requires a value from zero to `most`.
  Checks& up_to(const std::string& field, double value, double most) {
    return in_range(field, value, 0, most);
  }

  [[nodiscard]] bool good() const { return !error_.has_value(); }
  [[nodiscard]] Result<void> result() const { return error_ ? Result<void>(*error_) : Result<void>(); }

 private:
  /// The nearest number of type Real also fulfills a bound, whether it is above the bound or not.
  static double as_real(double bound) {
    return std::max(bound, static_cast<double>(static_cast<Real>(bound)));
  }
  [[nodiscard]] std::string place_of(const std::string& field) const {
    return object_.empty() ? field : object_ + "." + field;
  }

  std::string object_;  ///< Empty if fields are named without an object.
  std::optional<Error> error_;
};

/// Whether a quaternion can be normalized.
[[nodiscard]] inline bool is_rotation(Quat q) {
  const auto square = [](Real part) { return static_cast<double>(part) * static_cast<double>(part); };
  const double squared = square(q.x) + square(q.y) + square(q.z) + square(q.w);
  // `normalize` takes the squares in float, where they must neither vanish nor overflow.
  return squared >= 1e-30 && squared <= 1e30;
}

/// Makes an Error such as "has no edge 'to', there are left, right".
[[nodiscard]] Error no_such_name(const char* what, const std::string& name,
                                 const std::vector<std::string>& names, const char* where);

/// Makes "name[i]".
[[nodiscard]] std::string indexed(const std::string& name, std::size_t i);

}  // namespace hooke::build
