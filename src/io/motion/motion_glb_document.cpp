#include "io/motion/motion_glb_document.h"

#include <algorithm>
#include <limits>
#include <string_view>

namespace hooke::io {

namespace {

constexpr int kFloat = 5126;  // These are constants of OpenGL that glTF uses.
constexpr int kUnsignedInt = 5125;
constexpr int kUnsignedShort = 5123;
constexpr std::size_t kMostShort = 65534;  ///< Largest index of 16 bits; 65535 restarts a primitive.

std::size_t width_of(std::string_view type) {
  return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
}

}  // namespace

GlbDocument::GlbDocument(const std::string& path)
    : json_({{"asset", {{"version", "2.0"}, {"generator", "Hooke"}}}}), numbers_(path) {}

std::size_t GlbDocument::append(const char* list, Json object) {
  json_[list].push_back(std::move(object));
  return json_[list].size() - 1;
}

std::size_t GlbDocument::begin_view(std::size_t bytes, GlbTarget target) {
  while (numbers_.size() % 4 != 0) numbers_.put_value(std::byte{});
  Json view = {{"buffer", 0}, {"byteOffset", numbers_.size()}, {"byteLength", bytes}};
  if (target != GlbTarget::kNone) view["target"] = static_cast<int>(target);
  return append("bufferViews", std::move(view));
}

std::size_t GlbDocument::add_floats(std::span<const float> numbers, const char* type, GlbTarget target,
                                    bool has_bounds) {
  const std::size_t width = width_of(type);
  Json accessor = {{"bufferView", begin_view(numbers.size_bytes(), target)},
                   {"componentType", kFloat},
                   {"count", numbers.size() / width},
                   {"type", type}};
  if (has_bounds) {
    std::vector<float> low(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(width));
    std::vector<float> high = low;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      low[i % width] = std::min(low[i % width], numbers[i]);
      high[i % width] = std::max(high[i % width], numbers[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
  }
  numbers_.put(std::as_bytes(numbers));
  return append("accessors", std::move(accessor));
}

std::size_t GlbDocument::add_indices(std::span<const std::uint32_t> indices) {
  const bool is_short = *std::max_element(indices.begin(), indices.end()) <= kMostShort;
  const std::size_t size = is_short ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
  Json accessor = {{"bufferView", begin_view(indices.size() * size, GlbTarget::kIndices)},
                   {"componentType", is_short ? kUnsignedShort : kUnsignedInt},
                   {"count", indices.size()},
                   {"type", "SCALAR"}};
  for (const std::uint32_t index : indices) {
    if (is_short) {
      numbers_.put_value(static_cast<std::uint16_t>(index));
    } else {
      numbers_.put_value(index);
    }
  }
  return append("accessors", std::move(accessor));
}

std::size_t GlbDocument::add_bytes(std::span<const std::byte> bytes) {
  const std::size_t view = begin_view(bytes.size(), GlbTarget::kNone);
  numbers_.put(bytes);
  return view;
}

Result<void> GlbDocument::write(const MotionJob& job, const std::string& path) {
  while (numbers_.size() % 4 != 0) numbers_.put_value(std::byte{});
  if (numbers_.size() > 0) json_["buffers"] = {{{"byteLength", numbers_.size()}}};
  // A name may come from a file in another encoding; what is no UTF-8 becomes a question mark in a box.
  std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const bool has_numbers = numbers_.size() > 0;
  const std::uint64_t length = 20 + text.size() + (has_numbers ? 8 + numbers_.size() : 0);
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    return Error{
        ErrorCode::kLimitExceeded, path,
        "would have " + std::to_string(length >> 20) +
            " MiB, and .glb holds 4095: use fewer frames a second, a shorter time, a larger tolerance "
            "or a folder of point caches"};
  }
  OutputSink sink(path);
  sink.put("glTF");
  sink.put_value(std::uint32_t{2});
  sink.put_value(static_cast<std::uint32_t>(length));
  sink.put_value(static_cast<std::uint32_t>(text.size()));
  sink.put("JSON");
  sink.put(text);
  if (has_numbers) {
    sink.put_value(static_cast<std::uint32_t>(numbers_.size()));
    sink.put(std::string_view("BIN\0", 4));
    sink.append(numbers_);
  }
  return sink.finish(job.summary);
}

}  // namespace hooke::io
