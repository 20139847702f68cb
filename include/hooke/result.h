#pragma once

#include <string>
#include <utility>
#include <variant>

/// \file
/// Errors, and results that may be one: bad files, bad descriptions, stale handles, full disks. They are
/// values, in every build. The engine's own invariants are asserts (src/base/assert.h); numerical trouble is
/// counted in StepReport.

namespace hooke {

/// What went wrong, for programs that decide by it. People read Error::message.
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

/// What went wrong, and where.
struct Error {
  ErrorCode code = ErrorCode::kOutOfRange;  ///< The kind of error.
  /// A place that the user can find: "rope.points[3]", or in a file "demo.json:12:7: ropes[0].masses".
  std::string where = {};
  std::string message = {};  ///< One sentence, with the offending value and the accepted range.
};

/// Prints the error in one line to stderr and aborts. A Result calls it when it is asked for what it lacks.
[[noreturn]] void abort_with(const Error& error);

/// Either a value or an Error. The names follow std::expected, so a later switch is a rename; unlike there,
/// `*` and `->` are checked as value() is.
template <class T>
class [[nodiscard]] Result {
 public:
  /// Holds a value. The conversion is implicit, so that a function may return the value itself.
  Result(T value) : content_(std::move(value)) {}  // NOLINT(google-explicit-constructor): by design
  /// Holds an error. The conversion is implicit, so that a function may return the error itself.
  Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor): by design

  ///@{
  /// Whether there is a value, and not an error.
  [[nodiscard]] bool has_value() const { return content_.index() == 0; }
  explicit operator bool() const { return has_value(); }
  ///@}

  ///@{
  /// The value, which lives as long as the Result. On an error prints it and aborts: for programs that cannot
  /// go on without.
  [[nodiscard]] T& value() & { return *checked(this); }
  [[nodiscard]] const T& value() const& { return *checked(this); }
  [[nodiscard]] T&& value() && { return std::move(*checked(this)); }
  ///@}

  ///@{
  /// The same as value().
  [[nodiscard]] T& operator*() & { return value(); }
  [[nodiscard]] const T& operator*() const& { return value(); }
  [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
  ///@}
  ///@{
  /// A member of the value. On an error prints it and aborts, as value() does.
  T* operator->() { return checked(this); }
  const T* operator->() const { return checked(this); }
  ///@}

  ///@{
  /// The value, or `other` on an error.
  template <class U>
  [[nodiscard]] T value_or(U&& other) const& {
    return has_value() ? *std::get_if<0>(&content_) : static_cast<T>(std::forward<U>(other));
  }
  template <class U>
  [[nodiscard]] T value_or(U&& other) && {
    return has_value() ? std::move(*std::get_if<0>(&content_)) : static_cast<T>(std::forward<U>(other));
  }
  ///@}

  /// Why there is no value. Aborts if there is one.
  [[nodiscard]] const Error& error() const {
    if (has_value()) abort_with({ErrorCode::kOutOfRange, "Result::error", "asked of a result without one"});
    return *std::get_if<1>(&content_);
  }

 private:
  template <class Self>
  static auto checked(Self* self) {
    if (!self->has_value()) abort_with(*std::get_if<1>(&self->content_));
    return std::get_if<0>(&self->content_);
  }

  std::variant<T, Error> content_;
};

/// Either "done" or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  /// Says that it was done.
  Result() = default;
  /// Holds an error. The conversion is implicit, so that a function may return the error itself.
  // NOLINTNEXTLINE(google-explicit-constructor): by design
  Result(Error error) : error_(std::move(error)), failed_(true) {}

  ///@{
  /// Whether it was done.
  [[nodiscard]] bool has_value() const { return !failed_; }
  explicit operator bool() const { return has_value(); }
  ///@}
  /// Does nothing if done; on an error prints it and aborts.
  void value() const {
    if (failed_) abort_with(error_);
  }
  /// Why it was not done. Aborts if it was.
  [[nodiscard]] const Error& error() const {
    if (!failed_) abort_with({ErrorCode::kOutOfRange, "Result::error", "asked of a result without one"});
    return error_;
  }

 private:
  Error error_;
  bool failed_ = false;
};

}  // namespace hooke
