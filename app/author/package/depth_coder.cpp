// SPDX-License-Identifier: Apache-2.0
// Maps depth codes to depth codes: by a table for luma, by the player's own reading for hue.
#include "app/author/package/depth_coder.h"

#include <algorithm>
#include <cmath>

#include "app/scene/height_field.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::uint16_t kHole = 0;
constexpr std::uint32_t kBands = 32;  // a band: 8 of 256 codes; at crf 8 nearly all codes move by less, at crf 23 most

// The normalised code, near high, that gives the same height under the other law.
double inLaw(double s, const DepthCalibration& from, const DepthCalibration& to) {
  if (from.law == to.law) return s;
  DepthCalibration near_high = from;
  near_high.polarity = DepthPolarity::NearIsHigh;
  const double height = heightMm(near_high, s, 1);
  if (to.law == DepthLaw::Linear) return height;
  const double distance = to.far_mm - height * (to.far_mm - to.near_mm);
  return (1 / distance - 1 / to.far_mm) / (1 / to.near_mm - 1 / to.far_mm);
}

const char* nameOf(DepthLaw law) {
  return law == DepthLaw::Linear ? "linear" : "inverse";
}

}  // namespace

DepthCoder::DepthCoder(const DepthCalibration& source, const DepthCoding& coding)
    : source_(source), outcome_(recoded(source, coding.bits, coding.law)) {
  if (!outcome_.invalid.empty() && !coding.isLossless()) {
    const std::uint32_t all = 1U << coding.bits, band = all / kBands;
    outcome_.invalid = CodeSet(CodeSet::Range{kHole, band - 1});
    outcome_.codes = {2 * band, all - 1};
  }
  counts_.bits = coding.bits;
  counts_.of_code.assign(std::size_t{1} << coding.bits, 0);
  if (source.code != DepthCode::Luma) return;
  const double low = source.lowCode(), high = source.highCode();
  from_luma_.resize(std::size_t{1} << source.bits);
  is_clipped_.resize(from_luma_.size());
  // Into the codes between a band of holes and the range, coding has moved some of either.
  const bool band = source.invalid.contains(0) && source.invalid.contains(1) && source.invalid.highest() < low;
  const double lowest_told = band ? 0 : low;
  for (std::size_t i = 0; i < from_luma_.size(); ++i) {
    const double above = std::clamp(static_cast<double>(i), low, high) - low;
    const double near_high = source.polarity == DepthPolarity::NearIsHigh ? above : (high - low) - above;
    const bool hole = source.invalid.contains(static_cast<std::uint32_t>(i));
    const auto code = static_cast<double>(i);
    is_clipped_[i] = !hole && (code < lowest_told || code > high) ? 1 : 0;
    from_luma_[i] = hole ? kHole : codeOf(inLaw(near_high / (high - low), source, outcome_));
  }
}

// Rounds halves up, also quotients that should be halves but come out slightly below.
std::uint16_t DepthCoder::codeOf(double s) const noexcept {
  constexpr double kRounding = 1e-9;
  const double low = outcome_.lowCode(), high = outcome_.highCode();
  const long code = std::lround((low + s * (high - low)) * (1 + kRounding));
  const long lowest = std::max(std::lround(low), outcome_.invalid.empty() ? 0L : kHole + 1L);
  return static_cast<std::uint16_t>(std::clamp(code, lowest, static_cast<long>(outcome_.highCode())));
}

Result<void> DepthCoder::encode(const Frame& depth, DepthPicture& picture) {
  // In a linear field 1 mm deep, heights are the normalised codes.
  DepthCalibration linear = source_;
  linear.law = DepthLaw::Linear;
  const auto field = HeightField::make(depth, linear, {.width_mm = 1, .height_mm = 1, .depth_mm = 1});
  if (!field) return std::unexpected(field.error());

  picture.width = depth.width;
  picture.height = depth.height;
  picture.codes.resize(static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height));
  const bool has_holes = !outcome_.invalid.empty();
  auto out = picture.codes.begin();
  std::vector<std::uint16_t> row(static_cast<std::size_t>(depth.width));
  for (int r = 0; r < depth.height; ++r) {
    if (field->readCodes(r, row)) {
      out = std::transform(row.begin(), row.end(), out, [this](std::uint16_t read) {
        const std::size_t code = read & (from_luma_.size() - 1);
        counts_.clipped += is_clipped_[code];
        return from_luma_[code];
      });
    } else {
      for (int c = 0; c < depth.width; ++c) {
        const double s = field->heightMm(c, r);
        *out++ = std::isnan(s) ? kHole : codeOf(inLaw(s, source_, outcome_));
      }
    }
  }
  for (const std::uint16_t code : picture.codes) ++counts_.of_code[code];
  counts_.samples += picture.codes.size();
  if (has_holes) {
    counts_.holes += counts_.of_code[kHole];
    counts_.of_code[kHole] = 0;
  }
  return {};
}

std::vector<std::string> DepthCoder::explain() const {
  std::vector<std::string> lines;
  const double low = outcome_.lowCode(), high = outcome_.highCode();
  if (source_.code != DepthCode::Luma) {
    lines.push_back(print("%s decoded to %d-bit luma, %d %s to %.0f codes", name(source_.code), outcome_.bits,
                          source_.code == DepthCode::Hue ? DepthCalibration::kHueSteps : 256,
                          source_.code == DepthCode::Hue ? "hues" : "colours", high - low));
  } else if (source_.bits != outcome_.bits) {
    lines.push_back(print("%d bits rescaled to %d bits: codes %.0f .. %.0f to %.0f .. %.0f, rounded", source_.bits,
                          outcome_.bits, source_.lowCode(), source_.highCode(), low, high));
  } else if (source_.codes || source_.unit_mm) {
    lines.push_back(print("codes %.0f .. %.0f rescaled to %.0f .. %.0f, rounded", source_.lowCode(), source_.highCode(),
                          low, high));
  } else if (source_.range == ColorRange::Limited) {
    lines.push_back(print("limited range expanded to full: codes %.0f .. %.0f to %.0f .. %.0f, rounded",
                          source_.lowCode(), source_.highCode(), low, high));
  }
  if (source_.law != outcome_.law) {
    lines.push_back(
        print("%s steps converted to %s ones; heights are unchanged", nameOf(source_.law), nameOf(outcome_.law)));
  }
  if (source_.polarity == DepthPolarity::NearIsLow) lines.emplace_back("polarity inverted: near was low, is now high");
  if (outcome_.codes) {
    lines.push_back(print("codes 0 .. %u are holes; valid codes begin at %.0f, because coding moves codes",
                          outcome_.invalid.highest(), outcome_.lowCode()));
  } else if (!outcome_.invalid.empty()) {
    lines.emplace_back("code 0 is reserved for holes; valid codes begin at 1");
  }
  return lines;
}

}  // namespace relievo
