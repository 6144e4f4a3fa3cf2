// SPDX-License-Identifier: Apache-2.0
// Setting up the view of a depth plane, and reading depth that is coded as a hue.
#include "app/scene/height_field.h"

#include <cmath>
#include <optional>

namespace relievo {
namespace {

// Below this sum of the three bytes a pixel has no reading: 0.3 of one channel's full scale. A hue of a dark pixel is
// noise; footage in this coding marks what the sensor did not see by black.
constexpr int kDarkestReadable = 76;

// Hue over 360 degrees by the textbook hexagon (red 0, yellow 1/6, green 1/3, ..), or a hole at a pixel without a
// reading. Which channel leads is chosen without a branch: in noise nobody can foretell it.
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
    return fail(ErrorCode::InvalidArgument, "a depth picture without samples");
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
  if (calibration.code == DepthCode::Hue) {
    if (depth.model != ColorModel::Rgb || first.bits != 8 || first.step_bytes < 3) {
      return fail(ErrorCode::Unsupported, "hue depth needs packed 8-bit RGB; use --depth-code luma for this source");
    }
    field.layout_ = Layout::Hue;
    field.data_ = plane.data;
    field.red_ = first.offset_bytes;
    field.green_ = depth.components[1].offset_bytes;
    field.blue_ = depth.components[2].offset_bytes;
    field.s_scale_ = 1.0;
    field.s_offset_ = 0.0;
  } else {
    if (depth.model == ColorModel::Rgb) {
      return fail(ErrorCode::Unsupported, "luma depth needs a gray or YUV picture; use --depth-code hue for RGB");
    }
    field.layout_ = first.bits <= 8 ? Layout::Bytes : Layout::Words;
    field.mask_ = (1u << first.bits) - 1;
    field.invalid_ = calibration.invalid;
    const double low = calibration.lowCode();
    field.s_scale_ = 1.0 / (calibration.highCode() - low);
    field.s_offset_ = -low * field.s_scale_;
  }
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

SampledBlock::Places::Places(int length, int most) RELIEVO_RT : count(length) {
  if (length <= most) return;
  count = most + ((length ^ most) & 1);  // as even or odd as the length
  step = length / count;
  if (count % 2 == 0 && step % 2 == 0) step += (step + 1) * (count - 1) < length ? 1 : -1;
  first = (length - 1 - step * (count - 1)) / 2;
}

// kAcross 0: as many as the block says.
template <class Sample, int kAcross>
double HeightField::meanOfRows(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  const int across = kAcross > 0 ? kAcross : block.across.count, down = block.down.count;
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(block.across.step) * step_bytes_;
  const std::ptrdiff_t stride = block.down.step * stride_bytes_;
  const std::uint8_t* first = data_ + (r0 + block.down.first) * stride_bytes_ +
                              static_cast<std::ptrdiff_t>(c0 + block.across.first) * step_bytes_;
  std::uint32_t sum = 0;
  for (int r = 0; r < down; ++r) {
    for (int c = 0; c < across; ++c) sum += Sample::code(first + r * stride + c * step, mask_);
  }
  return depth_mm_ * (s_offset_ + s_scale_ * static_cast<double>(sum) / (across * down));
}

// Rows of a known length take half the instructions.
template <class Sample>
double HeightField::meanOfCodes(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  switch (block.across.count) {
    case 2:
      return meanOfRows<Sample, 2>(c0, r0, block);
    case 3:
      return meanOfRows<Sample, 3>(c0, r0, block);
    case 4:
      return meanOfRows<Sample, 4>(c0, r0, block);
    case 5:
      return meanOfRows<Sample, 5>(c0, r0, block);
    case 6:
      return meanOfRows<Sample, 6>(c0, r0, block);
    default:
      return meanOfRows<Sample, 0>(c0, r0, block);
  }
}

double HeightField::meanHeight(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  struct Byte {
    static std::uint32_t code(const std::uint8_t* s, std::uint32_t) noexcept { return s[0]; }
  };
  struct Word {
    static std::uint32_t code(const std::uint8_t* s, std::uint32_t mask) noexcept {
      return (static_cast<std::uint32_t>(s[0]) | static_cast<std::uint32_t>(s[1]) << 8) & mask;
    }
  };
  if (plain_) {
    return layout_ == Layout::Bytes ? meanOfCodes<Byte>(c0, r0, block) : meanOfCodes<Word>(c0, r0, block);
  }
  double sum = 0;
  int count = 0;
  for (int j = 0; j < block.down.count; ++j) {
    const int r = r0 + block.down.first + j * block.down.step;
    for (int i = 0; i < block.across.count; ++i) {
      const double z = heightMm(c0 + block.across.first + i * block.across.step, r);
      if (std::isnan(z)) continue;
      sum += z;
      ++count;
    }
  }
  return 2 * count < block.across.count * block.down.count ? kHole : sum / count;
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

double HeightField::fromHue(const std::uint8_t* pixel) const RELIEVO_RT {
  const double hue = hueOf(pixel[red_], pixel[green_], pixel[blue_]);
  return std::isnan(hue) ? kHole : fromNormalised(s_offset_ + s_scale_ * hue);
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
  if (layout_ == Layout::Hue) {
    const std::uint8_t* line = data_ + r * stride_bytes_;
    for (const int c : columns) {
      *heights_mm++ = static_cast<float>(fromHue(line + static_cast<std::ptrdiff_t>(c) * step_bytes_));
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
  return there == *this;
}

bool HeightField::sameSamples(const HeightField& other) const noexcept {
  if (cols_ != other.cols_ || rows_ != other.rows_ || layout_ != other.layout_ || step_bytes_ != other.step_bytes_) {
    return false;
  }
  for (int r = 0; r < rows_; ++r) {
    if (!std::ranges::equal(rowBytes(r), other.rowBytes(r))) return false;
  }
  return true;
}

std::uint32_t HeightField::code(int c, int r) const RELIEVO_RT {
  const std::uint8_t* sample = data_ + r * stride_bytes_ + static_cast<std::ptrdiff_t>(c) * step_bytes_;
  if (layout_ != Layout::Hue) return codeAt(sample);
  const double hue = hueOf(sample[red_], sample[green_], sample[blue_]);
  return std::isnan(hue) ? 0 : static_cast<std::uint32_t>(hue * kHueSteps);
}

}  // namespace relievo
