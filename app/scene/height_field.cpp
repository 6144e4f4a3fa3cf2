// SPDX-License-Identifier: Apache-2.0
// Creates the view of a depth plane and decodes depth that is coded as a hue.
#include "app/scene/height_field.h"

#include <cmath>
#include <cstring>
#include <optional>

namespace relievo {
namespace {

// Chroma is subsampled: at a depth edge it is the mean of two hues, which is neither of them and is less saturated than
// both.
constexpr int kPurest = 256, kLeastPurity = 160;  // least saturation of a readable colour
constexpr int kDarkestLit = 64;                   // brightness below which saturation is not judged

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
  if (calibration.code == DepthCode::Hue) {
    const bool packed_rgb = depth.model == ColorModel::Rgb && first.bits == 8 && first.step_bytes >= 3;
    if (!packed_rgb && depth.model != ColorModel::Yuv) {
      return fail(ErrorCode::Unsupported,
                  "hue depth needs YUV or packed 8-bit RGB; use --depth-code luma for this source");
    }
    if (packed_rgb) {
      field.layout_ = Layout::Hue;
      field.data_ = plane.data;
      field.red_ = first.offset_bytes;
      field.green_ = depth.components[1].offset_bytes;
      field.blue_ = depth.components[2].offset_bytes;
    } else {
      field.layout_ = Layout::HueYuv;
      field.chroma_ = chromaOf(depth);
    }
  } else {
    // RGB with three equal components holds gray depth.
    if (depth.model == ColorModel::Rgb) field.data_ = plane.data + depth.components[1].offset_bytes;
    field.layout_ = first.bits <= 8 ? Layout::Bytes : Layout::Words;
    field.mask_ = (1u << first.bits) - 1;
  }
  field.invalid_ = calibration.invalid;
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

SampledBlock::Places::Places(int length, int most) RELIEVO_RT : count(length) {
  if (length <= most) return;
  count = most + ((length ^ most) & 1);  // same parity as the length
  step = length / count;
  if (count % 2 == 0 && step % 2 == 0) step += (step + 1) * (count - 1) < length ? 1 : -1;
  first = (length - 1 - step * (count - 1)) / 2;
}

// kAcross 0: the width is known only at run time.
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

// With the row length known at compile time this takes half the instructions.
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

HeightField::Chroma HeightField::chromaOf(const Frame& depth) noexcept {
  const Component &y = depth.components[0], &u = depth.components[1], &v = depth.components[2];
  Chroma chroma;
  chroma.u = depth.planes[u.plane].data + u.offset_bytes;
  chroma.v = depth.planes[v.plane].data + v.offset_bytes;
  chroma.u_stride_bytes = depth.planes[u.plane].stride_bytes;
  chroma.v_stride_bytes = depth.planes[v.plane].stride_bytes;
  chroma.shift_x = depth.chroma_shift_x;
  chroma.shift_y = depth.chroma_shift_y;
  chroma.step_bytes = u.step_bytes;
  chroma.bits = y.bits;
  chroma.sample_shift = y.shift;
  const bool full = depth.range == ColorRange::Full;
  const auto [kr, kb] = lumaWeights(depth);
  const double kg = 1 - kr - kb, one = 65536, luma = full ? 1 : 255.0 / 219, color = full ? 1 : 255.0 / 224;
  const auto whole = [](double x) { return static_cast<int>(std::lround(x)); };
  chroma.luma_offset = full ? 0 : 16;
  chroma.luma = whole(one * luma);
  chroma.red_v = whole(one * color * 2 * (1 - kr));
  chroma.blue_u = whole(one * color * 2 * (1 - kb));
  chroma.green_u = whole(-one * color * 2 * (1 - kb) * kb / kg);
  chroma.green_v = whole(-one * color * 2 * (1 - kr) * kr / kg);
  return chroma;
}

// The hue, 0 to kHueSteps, or a hole.
double HeightField::hueAt(int c, int r) const RELIEVO_RT {
  const std::uint8_t* sample = data_ + r * stride_bytes_ + static_cast<std::ptrdiff_t>(c) * step_bytes_;
  if (layout_ == Layout::Hue) return kHueSteps * hueOf(sample[red_], sample[green_], sample[blue_]);
  const Chroma& k = chroma_;
  // In quarters of an 8-bit code, so that 10 bits keep their precision.
  const auto quarters = [&](const std::uint8_t* at) {
    const int code = k.bits > 8 ? (at[0] | at[1] << 8) >> k.sample_shift : at[0];
    return k.bits >= 10 ? code >> (k.bits - 10) : code << (10 - k.bits);
  };
  const std::ptrdiff_t across = static_cast<std::ptrdiff_t>(c >> k.shift_x) * k.step_bytes;
  const std::ptrdiff_t down = r >> k.shift_y;
  const std::int64_t y = std::int64_t{k.luma} * (quarters(sample) - 4 * k.luma_offset);
  const std::int64_t u = quarters(k.u + down * k.u_stride_bytes + across) - 512;
  const std::int64_t v = quarters(k.v + down * k.v_stride_bytes + across) - 512;
  const auto component = [](std::int64_t x) { return static_cast<int>(std::clamp<std::int64_t>(x >> 16, 0, 1020)); };
  const int red = component(y + k.red_v * v), green = component(y + k.green_u * u + k.green_v * v);
  const int blue = component(y + k.blue_u * u);
  const int high = std::max({red, green, blue}), spread = high - std::min({red, green, blue});
  if (high <= 4 * kDarkestLit || kPurest * spread < kLeastPurity * high) return kHole;
  return kHueSteps * hueOf(red, green, blue);
}

double HeightField::fromHue(int c, int r) const RELIEVO_RT {
  const double hue = hueAt(c, r);
  if (std::isnan(hue) || invalid_.contains(static_cast<std::uint32_t>(hue))) return kHole;
  return fromNormalised(s_offset_ + s_scale_ * hue);
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
  for (const int c : columns) *heights_mm++ = static_cast<float>(heightMm(c, r));
  return std::any_of(first, const_cast<const float*>(heights_mm), [](float z) { return std::isnan(z); });
}

bool HeightField::readsLike(const HeightField& other) const noexcept {
  HeightField there = other;
  there.data_ = data_;
  there.stride_bytes_ = stride_bytes_;
  there.chroma_ = chroma_;
  return there == *this;
}

bool HeightField::sameSamples(const HeightField& other) const noexcept {
  if (cols_ != other.cols_ || rows_ != other.rows_ || layout_ != other.layout_ || step_bytes_ != other.step_bytes_) {
    return false;
  }
  for (int r = 0; r < rows_; ++r) {
    if (!std::ranges::equal(rowBytes(r), other.rowBytes(r))) return false;
  }
  return !readsChroma() || sameChroma(other);
}

bool HeightField::sameChroma(const HeightField& other) const noexcept {
  const int cols = (cols_ + (1 << chroma_.shift_x) - 1) >> chroma_.shift_x;
  const int rows = (rows_ + (1 << chroma_.shift_y) - 1) >> chroma_.shift_y;
  const auto bytes = static_cast<std::size_t>(cols - 1) * chroma_.step_bytes + (chroma_.bits > 8 ? 2 : 1);
  for (int r = 0; r < rows; ++r) {
    const auto same = [&](const std::uint8_t* a, std::ptrdiff_t a_stride, const std::uint8_t* b,
                          std::ptrdiff_t b_stride) {
      return std::memcmp(a + r * a_stride, b + r * b_stride, bytes) == 0;
    };
    if (!same(chroma_.u, chroma_.u_stride_bytes, other.chroma_.u, other.chroma_.u_stride_bytes)) return false;
    if (!same(chroma_.v, chroma_.v_stride_bytes, other.chroma_.v, other.chroma_.v_stride_bytes)) return false;
  }
  return true;
}

std::uint32_t HeightField::code(int c, int r) const RELIEVO_RT {
  if (layout_ < Layout::Hue) return codeAt(data_ + r * stride_bytes_ + static_cast<std::ptrdiff_t>(c) * step_bytes_);
  const double hue = hueAt(c, r);
  return std::isnan(hue) ? 0 : static_cast<std::uint32_t>(hue);
}

}  // namespace relievo
