// SPDX-License-Identifier: Apache-2.0
// Reads the override tags of Advanced SubStation that change the size of letters, as libass does.
#include "app/render/text/letter_area.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace relievo {
namespace {

// In the script's pixels.
struct Letters {
  double size = 0, across = 1, down = 1, spacing = 0, border = 0, shear = 0;
  double drawing = 0;  // 0: these are letters; n: drawings, in 1/2^(n-1) pixels
};

struct Tag {
  std::string_view name;
  double Letters::* value;
  double unit = 1;
};
// A tag stands before those that its name begins with.
constexpr Tag kTags[] = {{"fscx", &Letters::across, 0.01}, {"fscy", &Letters::down, 0.01}, {"fsp", &Letters::spacing},
                         {"fs", &Letters::size},           {"xbord", &Letters::border},    {"ybord", &Letters::border},
                         {"bord", &Letters::border},       {"fax", &Letters::shear},       {"fay", &Letters::shear},
                         {"p", &Letters::drawing}};

// libass passes over spaces, and over the bracket of an argument.
std::string_view argumentOf(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t("), text.size()));
  return text;
}

std::optional<double> numberAt(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec == std::errc::result_out_of_range) return std::numeric_limits<float>::max();
  if (read.ec != std::errc{} || !std::isfinite(number)) return std::nullopt;
  return number;
}

Letters lettersOf(const ASS_Style& style) {
  return {.size = style.FontSize,
          .across = style.ScaleX,
          .down = style.ScaleY,
          .spacing = style.Spacing,
          .border = style.Outline};
}

// As libass takes it where a script does not say it.
double heightOf(const ASS_Track& script) noexcept {
  if (script.PlayResY > 0) return script.PlayResY;
  return script.PlayResX > 0 ? 0.75 * script.PlayResX : 288;
}

class Line {
 public:
  Line(const ASS_Event& line, const ASS_Track& script)
      : styles_(script.styles, static_cast<std::size_t>(script.n_styles)),
        border_unit_(script.ScaledBorderAndShadow != 0 ? 1 : heightOf(script) / kSmallScreen) {
    if (line.Style >= 0 && line.Style < script.n_styles) style_ = lettersOf(styles_[line.Style]);
    letters_ = style_;
    std::string_view text = line.Text == nullptr ? "" : line.Text;
    while (!text.empty()) {
      const std::size_t block = std::min(text.find('{'), text.size());
      count(text.substr(0, block));
      text.remove_prefix(block);
      const std::size_t end = std::min(text.find('}'), text.size());
      read(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  [[nodiscard]] double area() const noexcept { return area_; }

 private:
  void count(std::string_view words) {
    const double width = letters_.drawing > 0 ? drawn(words) * letters_.across
                                              : std::max(letters_.size * letters_.across, std::abs(letters_.spacing));
    const double height = letters_.down * (letters_.drawing > 0 ? drawn(words) : letters_.size);
    // Bytes that go on with a letter of UTF-8 do not count.
    const auto letters = static_cast<double>(std::ranges::count_if(words, [](char c) { return (c & 0xC0) != 0x80; }));
    const double number = letters_.drawing > 0 ? std::min(1.0, letters) : letters;
    const double around = 2 * std::abs(letters_.border) * border_unit_;
    area_ += number * (std::abs(width) + std::abs(height * letters_.shear) + around) * (std::abs(height) + around);
  }

  // The farthest point of a drawing.
  [[nodiscard]] double drawn(std::string_view words) const {
    constexpr std::string_view kNumber = "+-.0123456789eE";
    double farthest = 0;
    for (std::size_t at = 0; at < words.size();) {
      at = words.find_first_of(kNumber, at);
      if (at == words.npos) break;
      const std::size_t end = std::min(words.find_first_not_of(kNumber, at), words.size());
      farthest = std::max(farthest, std::abs(numberAt(words.substr(at, end - at)).value_or(0)));
      at = end;
    }
    return farthest / std::exp2(letters_.drawing - 1);
  }

  void read(std::string_view block) {
    bool changes = false;  // in time: what was before counts, too
    for (std::size_t at = block.find('\\'); at != block.npos; at = block.find('\\')) {
      block = argumentOf(block.substr(at + 1));
      if (block.starts_with("t(")) changes = true;
      if (block.starts_with('r')) reset(block.substr(1, block.find_first_of("\\)", 1) - 1));
      const auto tag = std::ranges::find_if(kTags, [&](const Tag& each) { return block.starts_with(each.name); });
      if (tag != std::end(kTags)) apply(*tag, argumentOf(block.substr(tag->name.size())), changes);
    }
  }

  void apply(const Tag& tag, std::string_view argument, bool changes) {
    const bool another = !argument.empty() && argument[0] >= 'a' && argument[0] <= 'z';  // \pos begins as \p
    if (tag.value == &Letters::drawing && another) return;
    double& value = letters_.*tag.value;
    const double before = value;
    const auto number = numberAt(argument);
    const bool relative = argument.starts_with('+') || argument.starts_with('-');
    value = number ? *number * tag.unit : style_.*tag.value;
    if (number && tag.value == &Letters::size && relative) value = before * (1 + *number / 10);
    if (changes && std::abs(before) > std::abs(value)) value = before;
  }

  void reset(std::string_view name) {
    const auto named = std::ranges::find_if(styles_, [&](const ASS_Style& style) { return style.Name == name; });
    const double drawing = letters_.drawing;
    letters_ = named != styles_.end() ? lettersOf(*named) : style_;
    letters_.drawing = drawing;
  }

  static constexpr double kSmallScreen = 480;  // lines; outlines that are not scaled are as many pixels on each screen

  std::span<const ASS_Style> styles_;
  double border_unit_;
  Letters style_, letters_;
  double area_ = 0;  // in square pixels of the script
};

}  // namespace

double letterArea(const ASS_Event& line, const ASS_Track& script) {
  const double height = heightOf(script);
  return Line(line, script).area() / (height * height);
}

}  // namespace relievo
