#include "io/model/model_flat.h"

#include "io/model_support.h"

#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using hooke::Model;
using hooke::model_of;
using hooke::io::check_model;
using hooke::io::read_flat_model;
using hooke::io::write_flat_model;
using hooke::io_test::box;

namespace {

constexpr std::size_t kHeaderSize = 32;
constexpr std::size_t kVertexSize = 32;

Model two_part_model() {
  Model model = model_of(box({1, 2, 3}));
  model.parts = {{0, 12, 1}, {12, 24, 0}};
  model.materials = {
      {.name = "paper", .color = {1, 0.5f, 0.25f}, .opacity = 0.5f, .texture = "lantern.png"},
      {.name = "wood \xC3\xA9",
       .shininess = 64,
       .metalness = 0.25f,
       .roughness = 0.75f,
       .normal_map = {.file = "n.png",
                      .bytes = std::make_shared<const std::vector<std::byte>>(3, std::byte{7})},
       .normal_scale = 2,
       .roughness_map = {.file = "r.png"}}};
  return model;
}

template <class T>
std::vector<std::byte> patched(std::vector<std::byte> bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
  return bytes;
}

}  // namespace

TEST_SUITE("io/model_flat") {
  TEST_CASE("a model comes back the same") {
    const Model model = two_part_model();
    const auto back = read_flat_model(write_flat_model(model));
    REQUIRE(back.has_value());
    CHECK(back.value().indices == model.indices);
    REQUIRE(back.value().vertices.size() == model.vertices.size());
    CHECK(std::memcmp(back.value().vertices.data(), model.vertices.data(),
                      model.vertices.size() * kVertexSize) == 0);
    REQUIRE(back.value().parts.size() == 2);
    CHECK(back.value().parts[1].first == 12);
    REQUIRE(back.value().materials.size() == 2);
    CHECK(back.value().materials[0].texture == "lantern.png");
    CHECK(back.value().materials[0].opacity == 0.5f);
    const hooke::ModelMaterial& wood = back.value().materials[1];
    CHECK(wood.name == "wood \xC3\xA9");
    CHECK(wood.metalness == 0.25f);
    CHECK(wood.roughness == 0.75f);
    CHECK(wood.normal_map.file == "n.png");
    REQUIRE(wood.normal_map.bytes != nullptr);
    CHECK(wood.normal_map.bytes->size() == 3);
    CHECK(wood.normal_scale == 2);
    CHECK(wood.roughness_map.file == "r.png");
    CHECK(wood.roughness_map.bytes == nullptr);
    CHECK_FALSE(back.value().materials[0].roughness.has_value());
    CHECK(back.value().materials[0].normal_map.file.empty());
  }

  TEST_CASE("each header field is checked before anything is allocated for it") {
    const auto bytes = write_flat_model(two_part_model());
    for (const std::size_t field : {0u, 8u, 12u, 16u, 20u, 24u}) {
      CAPTURE(field);
      for (const std::uint32_t value : {0u, 5u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFFu}) {
        CHECK_FALSE(read_flat_model(patched(bytes, field, value)).has_value());
      }
    }
  }

  TEST_CASE("coordinates, normals, indices, parts and names out of range are refused") {
    const Model model = two_part_model();
    const auto bytes = write_flat_model(model);
    const std::size_t indices = kHeaderSize + model.vertices.size() * kVertexSize;
    const std::size_t parts = indices + 4 * model.indices.size();
    const float infinity = std::numeric_limits<float>::infinity();
    CHECK_FALSE(read_flat_model(patched(bytes, kHeaderSize + 4, infinity)).has_value());
    CHECK_FALSE(read_flat_model(patched(bytes, kHeaderSize, infinity - infinity)).has_value());
    CHECK_FALSE(read_flat_model(patched(bytes, kHeaderSize + 12, 0.5f)).has_value());      // normal
    CHECK_FALSE(read_flat_model(patched(bytes, kHeaderSize + 24, infinity)).has_value());  // uv
    CHECK_FALSE(read_flat_model(patched(bytes, indices, 24u)).has_value());
    CHECK_FALSE(read_flat_model(patched(bytes, parts, 3u)).has_value());
    CHECK_FALSE(read_flat_model(patched(bytes, parts + 4, 0xFFFFFFFCu)).has_value());
    CHECK_FALSE(read_flat_model(patched(bytes, parts + 8, 2u)).has_value());
    const std::size_t name = bytes.size() - 6;
    CHECK_FALSE(read_flat_model(patched(bytes, name, '\n')).has_value());
    CHECK_FALSE(read_flat_model(patched(bytes, name, '\xFF')).has_value());
    auto longer = bytes;
    longer.push_back(std::byte{0});
    CHECK_FALSE(read_flat_model(longer).has_value());
  }

  TEST_CASE("a texture that leaves the model's folder is refused") {
    for (const char* name : {"../secret.png", "/etc/passwd", "a\\b.png", "..", "."}) {
      Model model = two_part_model();
      model.materials[0].texture = name;
      CHECK_FALSE(read_flat_model(write_flat_model(model)).has_value());
    }
  }

  TEST_CASE("every cut is refused") {
    const auto bytes = write_flat_model(two_part_model());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      CHECK_FALSE(read_flat_model(std::span(bytes).first(size)).has_value());
    }
  }

  TEST_CASE("random changes are refused or give a sound model") {
    const auto bytes = write_flat_model(two_part_model());
    std::mt19937 random(7);
    int accepted = 0;
    for (int run = 0; run < 20000; ++run) {
      auto changed = bytes;
      for (unsigned i = 0; i <= random() % 4; ++i) {
        const std::size_t reach = random() % 2 == 0 ? changed.size() : kHeaderSize;
        changed[random() % reach] = static_cast<std::byte>(random());
      }
      if (random() % 8 == 0) changed.resize(random() % changed.size());
      const auto model = read_flat_model(changed);
      if (!model) continue;
      ++accepted;
      REQUIRE(check_model(model.value()).has_value());
    }
    CHECK(accepted > 0);
    CHECK(accepted < 20000);
  }

  TEST_CASE("text is made printable and bounded") {
    using hooke::io::cleaned_text;
    using hooke::io::is_clean_text;
    CHECK(cleaned_text("a\x1B[31m\nb") == "a_[31m_b");
    CHECK(cleaned_text("\xC3\xA9\xC3") == "\xC3\xA9_");
    CHECK(cleaned_text(std::string(1000, 'x')).size() == hooke::io::kMaxModelText);
    CHECK_FALSE(is_clean_text("\xC2\x9B"));      // a control character of two bytes
    CHECK_FALSE(is_clean_text("\xE2\x80\xAE"));  // turns the direction of writing
    CHECK_FALSE(is_clean_text("\xC0\xAF"));      // an overlong slash
    CHECK_FALSE(is_clean_text("\xED\xA0\x80"));  // half of a pair
    CHECK(is_clean_text("\xF0\x9F\x8F\xAE paper"));
  }
}
