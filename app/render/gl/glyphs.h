// SPDX-License-Identifier: Apache-2.0
// Renders lines of text as a picture with FreeType, in the system's sans-serif font.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/error.h"

namespace relievo {

// Coverage of each pixel by ink, 0 to 255; row 0 is at the top.
struct InkPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> ink;
};

// Left to right, one glyph per character: enough for alphabets without ligatures or reordering.
class Glyphs {
 public:
  // Uses the font that fontconfig returns for "sans". NotFound if there is none.
  [[nodiscard]] static Result<Glyphs> create(int line_pixels);
  Glyphs(Glyphs&&) noexcept;
  Glyphs& operator=(Glyphs&&) noexcept;
  ~Glyphs();

  // UTF-8 text; an invalid byte, or a character that the font lacks, becomes a box. As wide as the longest line.
  [[nodiscard]] InkPicture draw(const std::vector<std::string>& lines) const;

 private:
  struct Face;
  explicit Glyphs(std::unique_ptr<Face> face);
  std::unique_ptr<Face> face_;
};

}  // namespace relievo
