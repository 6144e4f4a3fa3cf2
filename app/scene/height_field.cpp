// SPDX-License-Identifier: Apache-2.0
// Creates the view of a depth plane, and reads its samples, rows and blocks.
#include "app/scene/height_field.h"

#include <array>
#include <cmath>

#include "app/scene/code_sums.h"

namespace relievo {
namespace {

// A pixel whose three bytes sum to less than this has no reading: 0.3 of one channel's full scale. The hue of a dark
// pixel is noise, and footage in this coding paints black where the sensor saw nothing.
constexpr int kDarkestReadable = 76;

// Hue over 360 degrees by the standard hexagon (red 0, yellow 1/6, green 1/3, ..), or a hole at a pixel without a
// reading. The leading channel is selected without a branch, which noise would make unpredictable.
inline double hueOf(int red, int green, int blue) noexcept {
  const int high = std::max({red, green, blue});
  const int spread = high - std::min({red, green, blue});
  if (red + green + blue <= kDarkestReadable) return HeightField::kHole;
  const bool is_red = high == red, is_green = high == green;
  const int ahead = is_red ? green - blue : is_green ? blue - red : red - green;
  const int sixth = is_red ? (ahead < 0 ? 6 : 0) : is_green ? 2 : 4;
  return static_cast<double>(sixth * spread + ahead) / (6 * spread);  // gray is 0/0, not a number
}

}  // namespace

Result<HeightField> HeightField::make(const Frame& depth, const DepthCalibration& calibration,
                                      const DisplayVolume& volume) noexcept {
  if (depth.empty() || depth.width < 1 || depth.height < 1) {
    return fail(ErrorCode::InvalidArgument, "the depth picture is empty");
  }
  HeightField field;
  const Component& first = depth.components[0];
  const Plane& plane = depth.planes[first.plane];
  field.data_ = plane.data + first.offset_bytes;
  field.stride_bytes_ = plane.stride_bytes;
  field.step_bytes_ = first.step_bytes;
  field.shift_ = first.shift;
  field.cols_ = depth.width;
  field.rows_ = depth.height;
  field.grid_ = GridMapping(volume, depth.width, depth.height);
  field.depth_mm_ = volume.depth_mm;
  if (calibration.code != DepthCode::Luma) {
    const bool packed_rgb = depth.model == ColorModel::Rgb && first.bits == 8 && first.step_bytes >= 3;
    if (!packed_rgb && depth.model != ColorModel::Yuv) {
      return fail(ErrorCode::Unsupported,
                  "depth in colours needs YUV or packed 8-bit RGB; use --depth-code luma for this source");
    }
    field.readColors(depth, calibration.code);
  } else {
    // RGB with three equal components holds gray depth.
    if (depth.model == ColorModel::Rgb) field.data_ = plane.data + depth.components[1].offset_bytes;
    field.layout_ = first.bits <= 8 ? Layout::Bytes : Layout::Words;
    field.mask_ = (1u << first.bits) - 1;
  }
  field.invalid_ = calibration.invalid;
  if (field.layout_ == Layout::Curve) field.colors_.keepApart(field.invalid_, field.steps_);
  const double low = calibration.lowCode();
  field.s_scale_ = 1.0 / (calibration.highCode() - low);
  field.s_offset_ = -low * field.s_scale_;
  if (calibration.polarity == DepthPolarity::NearIsLow) {
    field.s_scale_ = -field.s_scale_;
    field.s_offset_ = 1.0 - field.s_offset_;
  }
  if (calibration.law == DepthLaw::Inverse) {
    field.inverse_ = true;
    field.near_inverse_ = 1.0 / calibration.near_mm;
    field.far_inverse_ = 1.0 / calibration.far_mm;
    field.far_mm_ = calibration.far_mm;
    field.depth_per_mm_ = volume.depth_mm / (calibration.far_mm - calibration.near_mm);
  }
  const double s_last = field.s_offset_ + field.s_scale_ * static_cast<double>(field.mask_);
  const auto clamped = [](double s) { return s < -1e-12 || s > 1 + 1e-12; };
  field.plain_ = calibration.code == DepthCode::Luma && !field.inverse_ && calibration.invalid.empty() &&
                 field.shift_ == 0 && field.mask_ >= 0xff && !clamped(field.s_offset_) && !clamped(s_last);
  return field;
}

double HeightField::meanOfCodes(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  const CodeBlock codes{.first = data_ + (r0 + block.down.first) * stride_bytes_ +
                                 static_cast<std::ptrdiff_t>(c0 + block.across.first) * step_bytes_,
                        .step_bytes = static_cast<std::ptrdiff_t>(block.across.step) * step_bytes_,
                        .stride_bytes = block.down.step * stride_bytes_,
                        .across = block.across.count,
                        .down = block.down.count};
  const std::uint32_t sum = layout_ == Layout::Bytes ? sumOfBytes(codes) : sumOfWords(codes, mask_);
  return depth_mm_ * (s_offset_ + s_scale_ * static_cast<double>(sum) / (codes.across * codes.down));
}

namespace {

// Adds heights, and counts those that are known.
struct Known {
  double sum = 0;
  int count = 0, looked = 0;

  void add(double z, int samples) RELIEVO_RT {
    looked += samples;
    if (std::isnan(z)) return;
    sum += samples * z;
    count += samples;
  }
  [[nodiscard]] double mean() const RELIEVO_RT { return 2 * count < looked ? HeightField::kHole : sum / count; }
};

}  // namespace

double HeightField::meanHeight(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  if (plain_) return meanOfCodes(c0, r0, block);
  // Not inline: a plain block needs less.
  const auto meanOfHeights = [&] [[gnu::noinline]] {
    Known known;
    if (layout_ == Layout::Curve) {
      colors_.readBlock(c0, r0, block, [&](double share, int samples) RELIEVO_RT {
        known.add(heightOfColor(steps_ * share), samples);
      });
      return known.mean();
    }
    for (int j = 0; j < block.down.count; ++j) {
      const int r = r0 + block.down.first + j * block.down.step;
      for (int i = 0; i < block.across.count; ++i) {
        known.add(heightMm(c0 + block.across.first + i * block.across.step, r), 1);
      }
    }
    return known.mean();
  };
  return meanOfHeights();
}

void HeightField::prefetch(int c0, int r0, int blocks, const SampledBlock& block) const RELIEVO_RT {
  constexpr std::ptrdiff_t kLine = 64;
  const std::ptrdiff_t margin = block.across.first;
  const std::ptrdiff_t bytes = (std::ptrdiff_t{blocks} * block.width - 2 * margin - 1) * step_bytes_;
  const std::ptrdiff_t stride = block.down.step * stride_bytes_;
  const std::uint8_t* first = data_ + (r0 + block.down.first) * stride_bytes_ + (c0 + margin) * step_bytes_;
  for (int j = 0; j < block.down.count; ++j) {
    const std::uint8_t* row = first + j * stride;
    for (std::ptrdiff_t at = 0; at < bytes; at += kLine) __builtin_prefetch(row + at);
    __builtin_prefetch(row + bytes);
  }
}

bool HeightField::readCodes(int r, std::span<std::uint16_t> codes) const noexcept {
  if (layout_ >= Layout::Hue) return false;
  const std::uint8_t* sample = data_ + r * stride_bytes_;
  if (layout_ == Layout::Bytes && step_bytes_ == 1) {  // the usual case, which the compiler vectorises
    for (int c = 0; c < cols_; ++c) codes[c] = static_cast<std::uint16_t>((sample[c] >> shift_) & mask_);
    return true;
  }
  for (int c = 0; c < cols_; ++c, sample += step_bytes_) codes[c] = static_cast<std::uint16_t>(codeAt(sample));
  return true;
}

void HeightField::readColors(const Frame& depth, DepthCode code) noexcept {
  const bool rgb = depth.model == ColorModel::Rgb;
  layout_ = rgb && code == DepthCode::Hue ? Layout::Hue : Layout::Curve;
  steps_ = code == DepthCode::Hue ? DepthCalibration::kHueSteps : DepthCalibration::kMapHighest;
  if (rgb) {
    data_ = depth.planes[depth.components[0].plane].data;
    red_ = depth.components[0].offset_bytes;
    green_ = depth.components[1].offset_bytes;
    blue_ = depth.components[2].offset_bytes;
  }
  if (layout_ == Layout::Hue) return;
  colors_ = ColorReading(depth, code);
}

// The code of a sample, or a hole.
double HeightField::colorCodeAt(int c, int r) const RELIEVO_RT {
  if (layout_ == Layout::Curve) return steps_ * colors_.shareAt(c, r);
  const std::uint8_t* sample = data_ + r * stride_bytes_ + static_cast<std::ptrdiff_t>(c) * step_bytes_;
  return steps_ * hueOf(sample[red_], sample[green_], sample[blue_]);
}

bool HeightField::readRow(int r, std::span<const int> columns, float* heights_mm) const RELIEVO_RT {
  if (plain_) {
    const std::uint8_t* line = data_ + r * stride_bytes_;
    const auto offset = static_cast<float>(depth_mm_ * s_offset_), scale = static_cast<float>(depth_mm_ * s_scale_);
    const int high_byte = layout_ == Layout::Words ? 256 : 0;
    for (const int c : columns) {
      const std::uint8_t* sample = line + static_cast<std::ptrdiff_t>(c) * step_bytes_;
      const int code = high_byte == 0 ? sample[0] : sample[0] + high_byte * sample[1];
      *heights_mm++ = offset + scale * static_cast<float>(code);
    }
    return false;
  }
  const float* const first = heights_mm;
  if (layout_ == Layout::Curve) {
    const ColorSamples::Line line = colors_.lineAt(r);
    for (const int c : columns) {
      *heights_mm++ = static_cast<float>(heightOfColor(steps_ * colors_.shareAt(c, r, line)));
    }
  } else {
    for (const int c : columns) *heights_mm++ = static_cast<float>(heightMm(c, r));
  }
  return std::any_of(first, const_cast<const float*>(heights_mm), [](float z) { return std::isnan(z); });
}

bool HeightField::readsLike(const HeightField& other) const noexcept {
  HeightField there = other;
  there.data_ = data_;
  there.stride_bytes_ = stride_bytes_;
  if (!there.colors_.readsLike(colors_)) return false;
  there.colors_ = colors_;
  return there == *this;
}

bool HeightField::sameSamples(const HeightField& other) const noexcept {
  if (cols_ != other.cols_ || rows_ != other.rows_ || layout_ != other.layout_ || step_bytes_ != other.step_bytes_) {
    return false;
  }
  for (int r = 0; r < rows_; ++r) {
    if (!std::ranges::equal(rowBytes(r), other.rowBytes(r))) return false;
  }
  return layout_ != Layout::Curve || colors_.sameChroma(other.colors_);
}

std::uint32_t HeightField::code(int c, int r) const RELIEVO_RT {
  if (layout_ < Layout::Hue) return codeAt(data_ + r * stride_bytes_ + static_cast<std::ptrdiff_t>(c) * step_bytes_);
  const double code = colorCodeAt(c, r);
  return std::isnan(code) ? 0 : static_cast<std::uint32_t>(code);
}

}  // namespace relievo
