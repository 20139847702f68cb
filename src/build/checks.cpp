#include "build/checks.h"

#include <algorithm>
#include <cstdio>

namespace hooke::build {

namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

}  // namespace

Error no_such_name(const char* what, const std::string& name, const std::vector<std::string>& names,
                   const char* where) {
  std::string list;
  for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
  list = list.empty() ? "there are none" : "there are " + list;
  return {ErrorCode::kOutOfRange, where, "has no " + std::string(what) + " '" + name + "', " + list};
}

std::string indexed(const std::string& name, std::size_t i) {
  return name + std::string("[") + std::to_string(i) + std::string("]");
}

Checks& Checks::require(bool good, const std::string& field, double value, const char* must) {
  if (good || error_) return *this;
  error_ = Error{ErrorCode::kOutOfRange, place_of(field), number(value) + " is out of range, " + must};
  return *this;
}

Checks& Checks::require(bool good, const std::string& field, const char* must) {
  if (good || error_) return *this;
  error_ = Error{ErrorCode::kOutOfRange, place_of(field), must};
  return *this;
}

Checks& Checks::in_range(const std::string& field, double value, double least, double most) {
  // The nearest number of type Real also fulfills a bound like 0.499, whether it is above the bound or not.
  const auto real = [](double bound) { return static_cast<double>(static_cast<Real>(bound)); };
  if ((value >= std::min(least, real(least)) && value <= std::max(most, real(most))) || error_) return *this;
  const std::string must = "must be " + number(least) + " to " + number(most);
  return require(false, field, value, must.c_str());
}

Checks& Checks::within(const std::string& field, DVec3 value, double most, const char* unit) {
  const double bound = as_real(most);
  const bool good = std::abs(value.x) <= bound && std::abs(value.y) <= bound && std::abs(value.z) <= bound;
  if (good || error_) return *this;
  const std::string given = "[" + number(value.x) + ", " + number(value.y) + ", " + number(value.z) + "]";
  error_ = Error{ErrorCode::kOutOfRange, place_of(field),
                 given + " is out of range, must be finite and within " + number(most) + unit};
  return *this;
}

}  // namespace hooke::build
