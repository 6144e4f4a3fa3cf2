// SPDX-License-Identifier: Apache-2.0
// Collects the boxes and words of the on-screen display as lines for AssText.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "app/player/screen/screen_script.h"
#include "app/render/text/ass_text.h"
#include "platform/print.h"

namespace relievo {

// In the script's units; see screen_script.h.
inline constexpr double kMargin = 40;
inline constexpr double kHeadingTop = 24, kHeadingSize = 38;  // of a page that covers the film

inline constexpr const char* kWhite = "FFFFFF";  // blue, green, red
inline constexpr const char* kBlack = "000000";
inline constexpr const char* kGray = "A0A0A0";
inline constexpr const char* kAccent = "47C7FF";                               // the colour of the finger's glow
inline constexpr std::array<const char*, 2> kFingerColors{kAccent, "FFC75A"};  // as their glows
inline constexpr const char* kWarn = "60B0FF";

struct Area {
  double x, y, width, height;
};

// Collects lines, each over those before it.
class Script {
 public:
  // The view is `width` by `rows` of the units in which things are placed.
  explicit Script(double width, double rows = kScreenRows) : width_(width), rows_(rows) {}

  void box(const Area& at, const char* color, double opacity) {
    shape({{{0, 0}, {at.width, 0}, {at.width, at.height}, {0, at.height}}}, at.x, at.y, color, opacity);
  }
  using Corners = std::vector<std::array<double, 2>>;
  void shape(const Corners& corners, double x, double y, const char* color, double opacity) {
    std::string path = "m";
    for (const auto& [across, down] : corners) {
      path += print(" %.1f %.1f", across * unit(), down * unit());
      if (path.find('l') == std::string::npos) path += " l";
    }
    add(print("{\\an7\\pos(%.1f,%.1f)\\bord0\\shad0\\1c&H%s&\\1a&H%02X&\\p1}", x * unit(), (top_ + y) * unit(), color,
              static_cast<unsigned>(std::lround(255 * (1 - opacity)))) +
        path + "{\\p0}");
  }
  // `corner`: the text's corner at (x, y), as on a keypad; 7 is its top left.
  void text(const std::string& words, int corner, double x, double y, double size, const char* color = kWhite) {
    if (words.empty()) return;
    add(print("{\\an%d\\pos(%.1f,%.1f)\\fs%.1f\\1c&H%s&}", corner, x * unit(), (top_ + y) * unit(), size * unit(),
              color) +
        AssText::escaped(words));
  }
  // From now on y is counted from here.
  void beginAt(double top) noexcept { top_ = top; }
  [[nodiscard]] double width() const noexcept { return width_; }
  [[nodiscard]] double rows() const noexcept { return rows_; }
  [[nodiscard]] std::vector<std::string> take() { return std::move(lines_); }

 private:
  [[nodiscard]] double unit() const noexcept { return kScreenRows / rows_; }
  void add(const std::string& text) { lines_.push_back(print("%zu,0,Default,,0,0,0,,", lines_.size()) + text); }
  double width_, rows_, top_ = 0;
  std::vector<std::string> lines_;
};

inline constexpr double kLetterOfSize = 0.52;  // the mean width of a letter

// About how many letters of a font size fit into a width.
inline int cellsIn(double width, double size) noexcept {
  return std::max(8, static_cast<int>(width / (kLetterOfSize * size)));
}

}  // namespace relievo
