#include "render/text.h"

#include "render/batches.h"

#include <algorithm>
#include <cstring>
#include <stb/stb_easy_font.h>

namespace hooke::render {

namespace {

constexpr std::size_t kMaxCharacters = 2000;
// The font's own documentation says about 270 bytes for each character.
constexpr std::size_t kBytesPerCharacter = 320;
constexpr float kFontLineHeight = 12;

/// The font writes quads of such corners.
struct FontCorner {
  float x = 0;
  float y = 0;
  float z = 0;
  std::uint32_t color = 0;
};

}  // namespace

void add_text(const DrawText& text, std::vector<TextVertex>& triangles) {
  std::string printable;
  for (const char c : text.text) {
    if ((c >= ' ' && c <= '~') || c == '\n') printable += c;
  }
  printable.resize(std::min(printable.size(), kMaxCharacters));
  std::vector<FontCorner> corners((printable.size() + 1) * kBytesPerCharacter / sizeof(FontCorner));
  const int quads = stb_easy_font_print(0, 0, printable.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(FontCorner)));
  const float scale = text.size_px / kFontLineHeight;
  const auto color = linear_of(text.color);
  for (std::size_t quad = 0; quad < static_cast<std::size_t>(quads); ++quad) {
    for (const std::size_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) {
      const FontCorner& c = corners[4 * quad + corner];
      triangles.push_back({text.x_px + scale * c.x, text.y_px + scale * c.y, color});
    }
  }
}

}  // namespace hooke::render
