// SPDX-License-Identifier: Apache-2.0
// Drawn text: pictures of words and shapes, and the frame that they were drawn for.
#pragma once

#include <cstdint>
#include <vector>

namespace relievo {

// One eye's view, from its top left. The film's picture lies in it between the margins.
struct TextFrame {
  int width = 0, height = 0;       // pixels
  double aspect = 16.0 / 9;        // width over height as the viewer sees it: a half of sbs is stretched
  int margin_x = 0, margin_y = 0;  // pixels at each side, and above and below
  bool operator==(const TextFrame&) const = default;
};

// Red, green, blue, opacity; the colours are multiplied by the opacity. `cols` x `rows` of them, from the top left, are
// shown as large as `width` and `height` say.
struct TextPicture {
  int x = 0, y = 0, width = 0, height = 0;
  int cols = 0, rows = 0;
  std::vector<std::uint8_t> rgba;
};

}  // namespace relievo
