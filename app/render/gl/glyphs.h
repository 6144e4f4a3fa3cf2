// SPDX-License-Identifier: Apache-2.0
// Lines of text as a picture, by FreeType, in whatever font the system has for plain text.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/error.h"

namespace relievo {

// How much of each pixel is ink, 0 to 255; row 0 is the top one.
struct InkPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> ink;
};

// Left to right, a glyph a character: right for the alphabets that need no more.
class Glyphs {
 public:
  // The font that fontconfig names for "sans". NotFound where there is none.
  [[nodiscard]] static Result<Glyphs> create(int line_pixels);
  Glyphs(Glyphs&&) noexcept;
  Glyphs& operator=(Glyphs&&) noexcept;
  ~Glyphs();

  // UTF-8; a byte that is none, and a character that the font lacks, is a box. As wide as the longest line.
  [[nodiscard]] InkPicture draw(const std::vector<std::string>& lines) const;

 private:
  struct Face;
  explicit Glyphs(std::unique_ptr<Face> face);
  std::unique_ptr<Face> face_;
};

}  // namespace relievo
