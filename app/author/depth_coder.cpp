// SPDX-License-Identifier: Apache-2.0
// Depth codes to depth codes: a table for luma, the player's own reading for hue.
#include "app/author/depth_coder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/scene/height_field.h"

namespace relievo {
namespace {

constexpr std::uint8_t kHole = 0;

DepthCalibration outcomeOf(DepthCalibration c) {
  const bool has_holes = c.invalid_code.has_value() || c.code == DepthCode::Hue;
  c.polarity = DepthPolarity::NearIsHigh;
  c.range = ColorRange::Full;
  c.code = DepthCode::Luma;
  c.bits = 8;
  c.unit_mm.reset();
  c.invalid_code = has_holes ? std::optional<std::uint32_t>(kHole) : std::nullopt;
  return c;
}

// round(255 (code - low)/(high - low)) in whole numbers, the polarity taken in first.
std::vector<std::uint8_t> tableOf(const DepthCalibration& c) {
  const auto low = static_cast<std::int64_t>(c.lowCode()), high = static_cast<std::int64_t>(c.highCode());
  std::vector<std::uint8_t> table(std::size_t{1} << c.bits);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::int64_t above = std::clamp(static_cast<std::int64_t>(i), low, high) - low;
    const std::int64_t s = c.polarity == DepthPolarity::NearIsHigh ? above : (high - low) - above;
    table[i] = static_cast<std::uint8_t>((510 * s + (high - low)) / (2 * (high - low)));
    if (c.invalid_code) table[i] = i == *c.invalid_code ? kHole : std::max<std::uint8_t>(table[i], kHole + 1);
  }
  return table;
}

}  // namespace

DepthCoder::DepthCoder(const DepthCalibration& source) : source_(source), outcome_(outcomeOf(source)) {
  if (source.code == DepthCode::Luma) from_luma_ = tableOf(source);
}

Result<void> DepthCoder::encode(const Frame& depth, DepthPicture& picture) {
  // A field 255 mm deep, of the linear law, has its codes for heights.
  DepthCalibration linear = source_;
  linear.law = DepthLaw::Linear;
  const auto field = HeightField::make(depth, linear, {.width_mm = 1, .height_mm = 1, .depth_mm = 255});
  if (!field) return std::unexpected(field.error());

  picture.width = depth.width;
  picture.height = depth.height;
  picture.codes.resize(static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height));
  const bool has_holes = outcome_.invalid_code.has_value();
  auto out = picture.codes.begin();
  for (int r = 0; r < depth.height; ++r) {
    for (int c = 0; c < depth.width; ++c, ++out) {
      if (source_.code == DepthCode::Luma) {
        *out = from_luma_[field->code(c, r) & (from_luma_.size() - 1)];
      } else {
        const double height = field->heightMm(c, r);
        *out = std::isnan(height) ? kHole : std::max(static_cast<std::uint8_t>(std::lround(height)), std::uint8_t{1});
      }
      ++counts_.of_code[*out];
    }
  }
  counts_.samples += picture.codes.size();
  if (has_holes) {
    counts_.holes += counts_.of_code[kHole];
    counts_.of_code[kHole] = 0;
  }
  return {};
}

std::vector<std::string> DepthCoder::explain() const {
  std::vector<std::string> lines;
  char line[160];
  if (source_.code == DepthCode::Hue) {
    lines.emplace_back("hue decoded to 8-bit luma, 1536 hues to 255 codes");
  } else if (source_.bits > 8) {
    std::snprintf(line, sizeof line, "%d bits rescaled to 8: codes %.0f .. %.0f to 0 .. 255, rounded", source_.bits,
                  source_.lowCode(), source_.highCode());
    lines.emplace_back(line);
  } else if (source_.range == ColorRange::Limited) {
    lines.emplace_back("limited range expanded to full: codes 16 .. 235 to 0 .. 255, rounded");
  }
  if (source_.polarity == DepthPolarity::NearIsLow) lines.emplace_back("turned round: near was low, near is high now");
  if (outcome_.invalid_code) lines.emplace_back("holes are code 0, which is theirs alone; valid codes begin at 1");
  return lines;
}

}  // namespace relievo
