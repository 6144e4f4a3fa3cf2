// SPDX-License-Identifier: Apache-2.0
// Words and their variants.
#include "app/player/screen/stereo_word.h"

#include <charconv>
#include <string>

#include "platform/print.h"

namespace relievo {
namespace {

constexpr int kMostTiles = 100;  // across or down

// "8x6".
bool parseTiles(const std::string& word, int& cols, int& rows) {
  const char* const end = word.data() + word.size();
  const auto [sign, no_cols] = std::from_chars(word.data(), end, cols);
  if (no_cols != std::errc() || sign == end || *sign != 'x') return false;
  const auto [rest, no_rows] = std::from_chars(sign + 1, end, rows);
  return no_rows == std::errc() && rest == end && cols > 0 && rows > 0 && cols <= kMostTiles && rows <= kMostTiles;
}

bool parseVariant(std::string_view variant, StereoSettings& settings) {
  switch (settings.layout) {
    case StereoLayout::SideBySide:
    case StereoLayout::TopBottom:
      settings.full = variant == "full";
      return settings.full;
    case StereoLayout::Anaglyph:
      settings.anaglyph = variant == "gray" ? AnaglyphColors::Gray : AnaglyphColors::Color;
      return variant == "gray" || variant == "color";
    case StereoLayout::Quilt:
      return parseTiles(std::string(variant), settings.quilt_cols, settings.quilt_rows);
    default:
      return false;
  }
}

}  // namespace

bool parseStereo(std::string_view word, StereoSettings& settings) {
  const std::size_t colon = word.find(':');
  for (int i = 0; i < kStereoLayouts; ++i) {
    const auto layout = static_cast<StereoLayout>(i);
    if (word.substr(0, colon) != name(layout)) continue;
    StereoSettings result = settings;
    result.layout = layout;
    result.full = false;
    if (colon != std::string_view::npos && !parseVariant(word.substr(colon + 1), result)) return false;
    settings = result;
    return true;
  }
  return false;
}

std::string stereoWord(const StereoSettings& settings) {
  std::string word = name(settings.layout);
  switch (settings.layout) {
    case StereoLayout::SideBySide:
    case StereoLayout::TopBottom:
      return settings.full ? word + ":full" : word;
    case StereoLayout::Anaglyph:
      if (settings.anaglyph == AnaglyphColors::Dubois) return word;
      return word + (settings.anaglyph == AnaglyphColors::Gray ? ":gray" : ":color");
    case StereoLayout::Quilt:
      return word + ":" + std::to_string(settings.quilt_cols) + "x" + std::to_string(settings.quilt_rows);
    default:
      return word;
  }
}

std::string stereoTitle(const StereoSettings& settings) {
  switch (settings.layout) {
    case StereoLayout::Mono:
      return "off";
    case StereoLayout::SideBySide:
      return settings.full ? "side by side, full width" : "side by side";
    case StereoLayout::TopBottom:
      return settings.full ? "top and bottom, full height" : "top and bottom";
    case StereoLayout::Rows:
      return "row by row";
    case StereoLayout::Columns:
      return "column by column";
    case StereoLayout::Anaglyph:
      return "red-cyan glasses";
    case StereoLayout::FramePacking:
      return "frame packing";
    case StereoLayout::Quilt:
      return print("quilt of %dx%d views", settings.quilt_cols, settings.quilt_rows);
  }
  return "";
}

std::optional<double> parseAspect(std::string_view word) {
  if (word == "film") return 0;
  double width = 0, height = 0;
  const char* const begin = word.data();
  const char* const end = begin + word.size();
  const auto [colon, no_width] = std::from_chars(begin, end, width);
  if (no_width != std::errc() || colon == end || *colon != ':') return std::nullopt;
  const auto [rest, no_height] = std::from_chars(colon + 1, end, height);
  if (no_height != std::errc() || rest != end || !(height > 0)) return std::nullopt;
  const double aspect = width / height;
  return aspect >= 0.1 && aspect <= 10 ? std::optional(aspect) : std::nullopt;
}

}  // namespace relievo
