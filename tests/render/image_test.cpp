#include "render/image.h"

#include "render/stage.h"

#include <doctest/doctest.h>
#include <fstream>

using hooke::ErrorCode;
using hooke::render::Image;
using hooke::render::load_image;
using hooke::render::write_png;
using hooke::render_test::TemporaryFolder;

namespace {

Image make_pattern(int width, int height, int channels) {
  Image image{width, height, channels, {}};
  for (int i = 0; i < width * height * channels; ++i) {
    image.pixels.push_back(static_cast<std::uint8_t>((i * 7919) % 256));
  }
  return image;
}

}  // namespace

TEST_SUITE("render/image") {
  TEST_CASE("a picture written as PNG reads back as it was") {
    const TemporaryFolder folder;
    for (const int channels : {3, 4}) {
      const Image image = make_pattern(37, 23, channels);
      REQUIRE(write_png(image, folder.file("a.png")));
      const auto read = load_image(folder.file("a.png"));
      REQUIRE(read);
      CHECK(read.value() == image);
    }
  }

  TEST_CASE("what cannot be written is an error and leaves no file") {
    const TemporaryFolder folder;
    const auto no_folder = write_png(make_pattern(2, 2, 3), folder.file("missing/a.png"));
    REQUIRE_FALSE(no_folder);
    CHECK(no_folder.error().code == ErrorCode::kFileNotWritable);
    Image broken = make_pattern(4, 4, 3);
    broken.pixels.pop_back();
    CHECK_FALSE(write_png(broken, folder.file("b.png")));
    CHECK(folder.is_empty());
  }

  TEST_CASE("a file that is missing, too large or no picture is an error") {
    const TemporaryFolder folder;
    const auto missing = load_image(folder.file("none.png"));
    REQUIRE_FALSE(missing);
    CHECK(missing.error().code == ErrorCode::kFileNotReadable);
    CHECK_FALSE(load_image(folder.file("")));

    REQUIRE(write_png(make_pattern(64, 8, 3), folder.file("wide.png")));
    const auto wide = load_image(folder.file("wide.png"), {1 << 20, 63});
    REQUIRE_FALSE(wide);
    CHECK(wide.error().code == ErrorCode::kLimitExceeded);
    const auto heavy = load_image(folder.file("wide.png"), {100, 64});
    REQUIRE_FALSE(heavy);
    CHECK(heavy.error().code == ErrorCode::kLimitExceeded);

    std::ofstream(folder.file("text.png")) << "this is not a picture";
    const auto text = load_image(folder.file("text.png"));
    REQUIRE_FALSE(text);
    CHECK(text.error().code == ErrorCode::kBadSyntax);
    std::ofstream(folder.file("empty.png")).flush();
    CHECK_FALSE(load_image(folder.file("empty.png")));

    // The header promises more than there is.
    std::ifstream whole(folder.file("wide.png"), std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(whole)), std::istreambuf_iterator<char>());
    bytes.resize(bytes.size() / 2);
    std::ofstream(folder.file("half.png"), std::ios::binary) << bytes;
    CHECK_FALSE(load_image(folder.file("half.png")));
  }
}
