#pragma once

#include "io/motion/motion_write.h"

#include <span>
#include <string>
#include <string_view>

/// \file
/// Writes the text form of USD: prims, and attributes with one value or with a value for each of some frames.

namespace hooke::io {

/// A UsdaText writes prims with their indentation.
class UsdaText {
 public:
  explicit UsdaText(OutputSink& sink) : sink_(sink) {}

  /// Begins a prim, such as `def Xform "ball"`, and its block. `metadata` are lines for the round brackets;
  /// empty for none.
  void begin(std::string_view head, std::span<const std::string> metadata = {});
  void end();
  /// Writes one line at the indentation of now.
  void line(std::string_view text);

  /// Begins an attribute with samples, such as `point3f[] points`.
  void begin_samples(std::string_view attribute);
  /// Begins one sample; the value and end_sample() follow.
  void begin_sample(std::size_t frame);
  void end_sample() { sink_.put(",\n"); }
  void end_samples();

  /// Begins a line that is an attribute with a value, which follows; end_value() ends it.
  void begin_value(std::string_view attribute);
  void end_value() { sink_.put("\n"); }

  void put_vector(DVec3 v, int digits = 7);
  void put_rotation(Quat rotation);
  void put_vectors(std::span<const Vec3> vectors, int digits);
  void put_indices(std::span<const std::uint32_t> indices);
  void put(std::string_view text) { sink_.put(text); }
  void put_number(double value, int digits = 7) { sink_.put_number(value, digits); }

 private:
  void indent();

  OutputSink& sink_;
  std::size_t depth_ = 0;
};

/// Returns a text between quotation marks, for any characters.
[[nodiscard]] std::string usda_string(std::string_view text);

/// Returns a number as text.
[[nodiscard]] std::string usda_number(double value);

/// Returns a vector as text: (1, 2, 3).
[[nodiscard]] std::string usda_vector(DVec3 v);

}  // namespace hooke::io
