// SPDX-License-Identifier: Apache-2.0
// Finds the font, decodes UTF-8 and places glyphs.
#include "app/render/gl/glyphs.h"

#include <fontconfig/fontconfig.h>
#include <ft2build.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include FT_FREETYPE_H

namespace relievo {
namespace {

// Removes the first character from `text`, which must not be empty, and returns it.
char32_t takeCharacter(std::string_view& text) noexcept {
  constexpr char32_t kBox = 0xFFFD;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80        ? 1
                             : first >> 5U == 6  ? 2
                             : first >> 4U == 14 ? 3
                             : first >> 3U == 30 ? 4
                                                 : 0;
  if (length == 0 || length > text.size()) {
    text.remove_prefix(1);
    return kBox;
  }
  char32_t character = length == 1 ? first : first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(i) >> 6U != 2) {
      text.remove_prefix(i);
      return kBox;
    }
    character = character << 6U | (byte(i) & 0x3FU);
  }
  text.remove_prefix(length);
  return character;
}

std::string fontFile() {
  FcInit();
  FcPattern* wanted = FcNameParse(reinterpret_cast<const FcChar8*>("sans"));
  FcConfigSubstitute(nullptr, wanted, FcMatchPattern);
  FcDefaultSubstitute(wanted);
  FcResult matched = FcResultNoMatch;
  FcPattern* found = FcFontMatch(nullptr, wanted, &matched);
  FcChar8* path = nullptr;
  std::string result;
  if (found != nullptr && FcPatternGetString(found, FC_FILE, 0, &path) == FcResultMatch) {
    result = reinterpret_cast<const char*>(path);
  }
  if (found != nullptr) FcPatternDestroy(found);
  FcPatternDestroy(wanted);
  FcFini();
  return result;
}

}  // namespace

struct Glyphs::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  int line_pixels = 0;

  Face() = default;
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  ~Face() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }

  [[nodiscard]] int widthOf(std::string_view line) const {
    int width = 0;
    while (!line.empty()) {
      if (FT_Load_Char(face, takeCharacter(line), FT_LOAD_DEFAULT) == 0) width += advance();
    }
    return width;
  }
  [[nodiscard]] int advance() const { return static_cast<int>(face->glyph->advance.x >> 6); }

  void drawLine(std::string_view line, int baseline, InkPicture& picture) const {
    int x = 0;
    while (!line.empty()) {
      if (FT_Load_Char(face, takeCharacter(line), FT_LOAD_RENDER) != 0) continue;
      blend(x + face->glyph->bitmap_left, baseline - face->glyph->bitmap_top, picture);
      x += advance();
    }
  }
  void blend(int left, int top, InkPicture& picture) const {
    const FT_Bitmap& bitmap = face->glyph->bitmap;
    for (int r = 0; r < static_cast<int>(bitmap.rows); ++r) {
      for (int c = 0; c < static_cast<int>(bitmap.width); ++c) {
        const int x = left + c, y = top + r;
        if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) continue;
        std::uint8_t& ink = picture.ink[static_cast<std::size_t>(y) * picture.width + x];
        ink = std::max(ink, bitmap.buffer[r * bitmap.pitch + c]);
      }
    }
  }
};

Glyphs::Glyphs(std::unique_ptr<Face> face) : face_(std::move(face)) {}
Glyphs::Glyphs(Glyphs&&) noexcept = default;
Glyphs& Glyphs::operator=(Glyphs&&) noexcept = default;
Glyphs::~Glyphs() = default;

Result<Glyphs> Glyphs::create(int line_pixels) {
  constexpr const char* kNoFont = "no font found; install one (Debian: fonts-dejavu-core)";
  auto face = std::make_unique<Face>();
  face->line_pixels = line_pixels;
  const std::string path = fontFile();
  if (path.empty() || FT_Init_FreeType(&face->library) != 0 ||
      FT_New_Face(face->library, path.c_str(), 0, &face->face) != 0) {
    return fail(ErrorCode::NotFound, kNoFont);
  }
  constexpr double kOfLine = 0.75;  // of a line's height; the rest is the gap between lines
  if (FT_Set_Pixel_Sizes(face->face, 0, static_cast<FT_UInt>(kOfLine * line_pixels)) != 0) {
    return fail(ErrorCode::NotFound, kNoFont);
  }
  return Glyphs(std::move(face));
}

InkPicture Glyphs::draw(const std::vector<std::string>& lines) const {
  InkPicture picture;
  for (const std::string& line : lines) picture.width = std::max(picture.width, face_->widthOf(line));
  picture.width += 2;  // room for glyphs wider than the last advance
  picture.height = face_->line_pixels * static_cast<int>(lines.size());
  picture.ink.assign(static_cast<std::size_t>(picture.width) * picture.height, 0);
  constexpr double kBaseline = 0.75;  // distance from the top of a line, in line heights
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int top = face_->line_pixels * static_cast<int>(i);
    face_->drawLine(lines[i], top + static_cast<int>(kBaseline * face_->line_pixels), picture);
  }
  return picture;
}

}  // namespace relievo
