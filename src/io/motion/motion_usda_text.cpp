#include "io/motion/motion_usda_text.h"

#include <array>
#include <charconv>

namespace hooke::io {

void UsdaText::indent() {
  for (std::size_t i = 0; i < depth_; ++i) sink_.put("    ");
}

void UsdaText::line(std::string_view text) {
  indent();
  sink_.put(text);
  sink_.put("\n");
}

void UsdaText::begin(std::string_view head, std::span<const std::string> metadata) {
  indent();
  sink_.put(head);
  if (!metadata.empty()) {
    sink_.put(" (\n");
    ++depth_;
    for (const std::string& text : metadata) line(text);
    --depth_;
    indent();
    sink_.put(")");
  }
  sink_.put("\n");
  line("{");
  ++depth_;
}

void UsdaText::end() {
  --depth_;
  line("}");
}

void UsdaText::begin_samples(std::string_view attribute) {
  indent();
  sink_.put(attribute);
  sink_.put(".timeSamples = {\n");
  ++depth_;
}

void UsdaText::begin_sample(std::size_t frame) {
  indent();
  sink_.put(std::to_string(frame) + ": ");
}

void UsdaText::end_samples() {
  end();
}

void UsdaText::begin_value(std::string_view attribute) {
  indent();
  sink_.put(attribute);
  sink_.put(" = ");
}

void UsdaText::put_vector(DVec3 v, int digits) {
  sink_.put("(");
  sink_.put_number(v.x, digits);
  sink_.put(", ");
  sink_.put_number(v.y, digits);
  sink_.put(", ");
  sink_.put_number(v.z, digits);
  sink_.put(")");
}

void UsdaText::put_rotation(Quat rotation) {
  const Quat q = normalize(rotation);
  sink_.put("(");
  sink_.put_number(static_cast<double>(q.w));
  for (const Real x : {q.x, q.y, q.z}) {
    sink_.put(", ");
    sink_.put_number(static_cast<double>(x));
  }
  sink_.put(")");
}

void UsdaText::put_vectors(std::span<const Vec3> vectors, int digits) {
  sink_.put("[");
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (i > 0) sink_.put(", ");
    put_vector(vector_cast<double>(vectors[i]), digits);
  }
  sink_.put("]");
}

void UsdaText::put_indices(std::span<const std::uint32_t> indices) {
  sink_.put("[");
  for (std::size_t i = 0; i < indices.size(); ++i)
    sink_.put((i > 0 ? ", " : "") + std::to_string(indices[i]));
  sink_.put("]");
}

std::string usda_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else {
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result + "\"";
}

std::string usda_number(double value) {
  std::array<char, 40> text = {};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value == 0 ? 0.0 : value,
                                 std::chars_format::general, 7);
  return {text.data(), end.ptr};
}

std::string usda_vector(DVec3 v) {
  return "(" + usda_number(v.x) + ", " + usda_number(v.y) + ", " + usda_number(v.z) + ")";
}

}  // namespace hooke::io
