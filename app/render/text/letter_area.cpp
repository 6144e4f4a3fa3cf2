// SPDX-License-Identifier: Apache-2.0
// Reads the override tags of Advanced SubStation that change the size of letters, as libass does.
#include "app/render/text/letter_area.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
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

// Units of drawings are whole numbers.
std::optional<double> wholeNumberAt(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  std::int32_t number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec == std::errc::result_out_of_range) return text.starts_with('-') ? 0 : std::numeric_limits<int>::max();
  if (read.ec != std::errc{}) return std::nullopt;
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
      const std::size_t block = std::min(blockIn(text), text.size());
      count(text.substr(0, block));
      text.remove_prefix(block);
      const std::size_t end = std::min(text.find('}'), text.size());
      read(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  [[nodiscard]] double area() const noexcept { return area_; }

 private:
  // Where the next block of tags begins. A bracket that none closes is a letter, and so is one behind a backslash.
  [[nodiscard]] std::size_t blockIn(std::string_view text) const {
    std::size_t at = text.find('{');
    while (at != text.npos && at > 0 && text[at - 1] == '\\' && letters_.drawing <= 0) at = text.find('{', at + 1);
    return text.find('}', at) == text.npos ? text.npos : at;
  }

  void count(std::string_view words) {
    const double width = letters_.drawing > 0 ? drawn(words, letters_.drawing) * letters_.across
                                              : std::max(letters_.size * letters_.across, std::abs(letters_.spacing));
    const double height = letters_.down * (letters_.drawing > 0 ? drawn(words, letters_.drawing) : letters_.size);
    // Bytes that go on with a letter of UTF-8 do not count.
    const auto letters = static_cast<double>(std::ranges::count_if(words, [](char c) { return (c & 0xC0) != 0x80; }));
    const double number = letters_.drawing > 0 ? std::min(1.0, letters) : letters;
    const double around = 2 * std::abs(letters_.border) * border_unit_;
    area_ += number * (std::abs(width) + std::abs(height * letters_.shear) + around) * (std::abs(height) + around);
  }

  // The farthest point of a drawing in 1/2^(unit-1) pixels. libass shifts by the last five bits.
  static double drawn(std::string_view words, double unit) {
    constexpr std::string_view kNumber = "+-.0123456789eE";
    double farthest = 0;
    for (std::size_t at = 0; at < words.size();) {
      at = words.find_first_of(kNumber, at);
      if (at == words.npos) break;
      const std::size_t end = std::min(words.find_first_not_of(kNumber, at), words.size());
      farthest = std::max(farthest, std::abs(numberAt(words.substr(at, end - at)).value_or(0)));
      at = end;
    }
    return farthest / std::exp2(std::fmod(unit - 1, 32));
  }

  void read(std::string_view block) {
    bool changes = false;  // in time: what was before counts, too
    for (std::size_t at = block.find('\\'); at != block.npos; at = block.find('\\')) {
      block.remove_prefix(std::min(block.find_first_not_of(" \t", at + 1), block.size()));
      if (block.starts_with('t')) changes = true;
      if (block.starts_with('r')) reset(block.substr(1, block.find_first_of("\\)", 1) - 1));
      const auto tag = std::ranges::find_if(kTags, [&](const Tag& each) { return block.starts_with(each.name); });
      if (tag != std::end(kTags)) apply(*tag, argumentOf(block.substr(tag->name.size())), changes);
      const std::size_t bracket = block.find_first_of("(\\");
      if (block.starts_with('t') || bracket == block.npos || block[bracket] == '\\') continue;
      const std::size_t end = std::min(block.find(')', bracket), block.size());
      if (block.starts_with("clip") || block.starts_with("iclip")) clip(block.substr(bracket + 1, end - bracket - 1));
      block.remove_prefix(end);  // only the tags of a transform stand in brackets
    }
  }

  // By a drawing, before which its unit may stand. Four numbers are a rectangle, which needs no picture.
  void clip(std::string_view text) {
    const std::size_t lasts = std::min(text.find('\\'), text.size());  // no argument ends behind it
    std::string_view first, last;
    int arguments = 0;  // those that are not empty
    for (std::size_t at = 0; at < text.size();) {
      std::size_t end = text.find(',', at);
      if (end > lasts) end = text.size();
      const std::string_view argument = text.substr(at, end - at);
      at = end + 1;
      if (argumentOf(argument).empty()) continue;
      if (arguments++ == 0) first = argument;
      last = argument;
    }
    if (arguments == 0 || arguments > 2) return;
    const double unit = arguments == 1 ? 1 : std::max(1.0, wholeNumberAt(argumentOf(first)).value_or(1));
    const double side = drawn(last, unit);
    area_ += side * side;
  }

  void apply(const Tag& tag, std::string_view argument, bool changes) {
    const bool another = !argument.empty() && argument[0] >= 'a' && argument[0] <= 'z';  // \pos begins as \p
    if (tag.value == &Letters::drawing && another) return;
    double& value = letters_.*tag.value;
    const double before = value;
    const auto number = tag.value == &Letters::drawing ? wholeNumberAt(argument) : numberAt(argument);
    const bool relative = argument.starts_with('+') || argument.starts_with('-');
    value = number ? *number * tag.unit : style_.*tag.value;
    if (number && tag.value == &Letters::size && relative) value = before * (1 + *number / 10);
    if (tag.value == &Letters::size && value <= 0) value = style_.size;
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
