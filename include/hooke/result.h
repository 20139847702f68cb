#pragma once

#include <string>
#include <utility>
#include <variant>

/// \file
/// Errors: bad files, bad descriptions, stale handles, full disks. They are values, in every build.
/// The engine's own invariants are asserts (src/base/assert.h); numerical trouble is counted in StepReport.

namespace hooke {

enum class ErrorCode {
  kFileNotReadable,  ///< Missing, a folder, no permission.
  kFileNotWritable,  ///< No permission, no such folder, disk full.
  kBadSyntax,        ///< Not JSON, not a mesh.
  kUnknownKey,       ///< A key that the format does not have.
  kWrongType,        ///< A word where a number belongs.
  kOutOfRange,       ///< Understood, and not acceptable.
  kStaleId,          ///< A handle whose object is gone, or that never had one.
  kLimitExceeded,    ///< Too large, too many, too slow.
  kUnsupported,      ///< Valid, and not built in here.
};

struct Error {
  ErrorCode code = ErrorCode::kOutOfRange;
  std::string where =
      {};  ///< What the user can find: "rope.points[3]", in a file "demo.json:12:7: ropes[0].masses".
  std::string message = {};  ///< One sentence, with the offending value and the accepted range.
};

/// Either a value or an Error. The names follow std::expected, so a later switch is a rename.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}      // NOLINT(google-explicit-constructor): by design
  Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor): by design

  [[nodiscard]] bool has_value() const { return content_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  /// Precondition: has_value().
  [[nodiscard]] T& value() & { return *std::get_if<0>(&content_); }
  [[nodiscard]] const T& value() const& { return *std::get_if<0>(&content_); }
  [[nodiscard]] T&& value() && { return std::move(*std::get_if<0>(&content_)); }

  /// Precondition: !has_value().
  [[nodiscard]] const Error& error() const { return *std::get_if<1>(&content_); }

 private:
  std::variant<T, Error> content_;
};

/// Done, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): by design
  Result(Error error) : error_(std::move(error)), failed_(true) {}

  [[nodiscard]] bool has_value() const { return !failed_; }
  explicit operator bool() const { return has_value(); }
  [[nodiscard]] const Error& error() const { return error_; }

 private:
  Error error_;
  bool failed_ = false;
};

}  // namespace hooke
