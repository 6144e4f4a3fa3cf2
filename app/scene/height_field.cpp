// SPDX-License-Identifier: Apache-2.0
// Creates the view of a depth plane and decodes depth that is coded in colours.
#include "app/scene/height_field.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace relievo {
namespace {

// Distances of a colour from the curve, in ColorCurve's coordinates. Measured on H.264 4:2:0 at crf 18 to 23: nine of
// ten samples are nearer than 0.01, mixed ones farther than 0.05.
constexpr float kOnCurve = 0.06F;
constexpr float kFarOffHues = 0.2F, kFarOffMap = 0.12F;
constexpr float kNearBlack = 0.2F, kDarker = 0.04F;
bool isBlack(const YuvColor& color) noexcept {
  return color.y * color.y + color.u * color.u + color.v * color.v < kNearBlack * kNearBlack;
}

// Half the width of the circle's seam: coding moves a hue by 0.0044 in one sample of twenty.
constexpr float kSeam = 0.006F, kBesideSeam = 0.03F;

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

// The squared distance of a colour from what a sample at an edge between two colours holds: the luma of the side that
// it is off by `luma`, and chroma that is mixed of both.
float errorOfMixture(const YuvColor& color, float luma, const YuvColor& one, const YuvColor& other) noexcept {
  const float along_u = other.u - one.u, along_v = other.v - one.v, u = color.u - one.u, v = color.v - one.v;
  const float length = along_u * along_u + along_v * along_v;
  const float share = length > 0 ? std::clamp((u * along_u + v * along_v) / length, 0.0F, 1.0F) : 0;
  const float off_u = u - share * along_u, off_v = v - share * along_v;
  return luma * luma + ColorCurve::kChromaWeight * (off_u * off_u + off_v * off_v);
}

// How much better one side of an edge must fit than a place between the two. Measured on hard and soft edges, H.264
// 4:2:0 at crf 18 and 23.
constexpr float kSideFits = 2;

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

namespace {

std::uint64_t eightBytes(const std::uint8_t* p) RELIEVO_RT {
  std::uint64_t bytes;
  std::memcpy(&bytes, p, sizeof bytes);
  return bytes;
}

// The sum of `count` lanes of a row that starts at `p`, kLanes of them in eight bytes, by adding neighbouring lanes
// first: `add` takes eight bytes. The last eight overlap those before; what was added already is shifted out.
template <int kLanes, class Add>
void eachEightBytes(const std::uint8_t* p, int count, Add&& add) RELIEVO_RT {
  constexpr int kBits = 64 / kLanes;
  for (; count >= kLanes; count -= kLanes, p += 8) add(eightBytes(p));
  if (count > 0) add(eightBytes(p - (kLanes - count) * (kBits / 8)) >> (kBits * (kLanes - count)));
}

// Samples of plain codes, in memory one after the other. kInWords: how many of a row make it worth to add several at
// once; 0 where the machine's byte order does not allow it.
constexpr bool kLittle = std::endian::native == std::endian::little;
struct Byte {
  static constexpr int kBytes = 1, kInWords = kLittle ? 8 : 0;
  static std::uint32_t code(const std::uint8_t* s, std::uint32_t) RELIEVO_RT { return s[0]; }
  static std::uint32_t sumOfRow(const std::uint8_t* row, int count, std::uint32_t) RELIEVO_RT {
    constexpr std::uint64_t kEven = 0x00ff00ff00ff00ff, kOnes = 0x0001000100010001;
    constexpr int kMost = 256;  // of four sums of 16 bits each, together
    std::uint32_t sum = 0;
    for (; count > 0; count -= kMost, row += kMost) {
      std::uint64_t sums = 0;
      const auto add = [&](std::uint64_t x) RELIEVO_RT { sums += (x & kEven) + (x >> 8 & kEven); };
      if (count < 8) {
        for (int c = 0; c < count; ++c) sums += row[c];
      } else {
        eachEightBytes<8>(row, std::min(count, kMost), add);
      }
      sum += static_cast<std::uint32_t>(sums * kOnes >> 48);
    }
    return sum;
  }
};
struct Word {
  static constexpr int kBytes = 2, kInWords = kLittle ? 4 : 0;
  static std::uint32_t code(const std::uint8_t* s, std::uint32_t mask) RELIEVO_RT {
    return (static_cast<std::uint32_t>(s[0]) | static_cast<std::uint32_t>(s[1]) << 8) & mask;
  }
  static std::uint32_t sumOfRow(const std::uint8_t* row, int count, std::uint32_t mask) RELIEVO_RT {
    const std::uint64_t even = mask | std::uint64_t{mask} << 32;
    std::uint64_t sums = 0;
    eachEightBytes<4>(row, count, [&](std::uint64_t x) RELIEVO_RT { sums += (x & even) + (x >> 16 & even); });
    return static_cast<std::uint32_t>(sums) + static_cast<std::uint32_t>(sums >> 32);
  }
};

}  // namespace

// kAcross 0: the width is known only at run time.
template <class Sample, int kAcross>
std::uint32_t HeightField::sumOfRows(const std::uint8_t* first, const SampledBlock& block) const RELIEVO_RT {
  const int across = kAcross > 0 ? kAcross : block.across.count, down = block.down.count;
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(block.across.step) * step_bytes_;
  const std::ptrdiff_t stride = block.down.step * stride_bytes_;
  std::uint32_t sum = 0;
  if (Sample::kInWords && step == Sample::kBytes && across >= Sample::kInWords) {
    for (int r = 0; r < down; ++r) sum += Sample::sumOfRow(first + r * stride, across, mask_);
    return sum;
  }
  for (int r = 0; r < down; ++r) {
    for (int c = 0; c < across; ++c) sum += Sample::code(first + r * stride + c * step, mask_);
  }
  return sum;
}

// With the row length known at compile time this takes half the instructions.
template <class Sample>
double HeightField::meanOfCodes(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  const std::uint8_t* first = data_ + (r0 + block.down.first) * stride_bytes_ +
                              static_cast<std::ptrdiff_t>(c0 + block.across.first) * step_bytes_;
  const auto sum = [&]() RELIEVO_RT {
    switch (block.across.count) {
      case 2:
        return sumOfRows<Sample, 2>(first, block);
      case 3:
        return sumOfRows<Sample, 3>(first, block);
      case 4:
        return sumOfRows<Sample, 4>(first, block);
      case 5:
        return sumOfRows<Sample, 5>(first, block);
      case 6:
        return sumOfRows<Sample, 6>(first, block);
      default:
        return sumOfRows<Sample, 0>(first, block);
    }
  }();
  return depth_mm_ * (s_offset_ + s_scale_ * static_cast<double>(sum) / (block.across.count * block.down.count));
}

double HeightField::meanHeight(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  if (plain_) {
    return layout_ == Layout::Bytes ? meanOfCodes<Byte>(c0, r0, block) : meanOfCodes<Word>(c0, r0, block);
  }
  if (layout_ == Layout::Curve) {
    const double mean = meanOfColors(c0, r0, block);
    if (!std::isnan(mean)) return mean;
  }
  // Colours are costly: of a block with an edge every other one is read, as on a chessboard.
  const int stride = layout_ == Layout::Curve ? 2 : 1;
  double sum = 0;
  int count = 0, looked = 0;
  for (int j = 0; j < block.down.count; ++j) {
    const int r = r0 + block.down.first + j * block.down.step;
    for (int i = j % stride; i < block.across.count; i += stride, ++looked) {
      const double z = heightMm(c0 + block.across.first + i * block.across.step, r);
      if (std::isnan(z)) continue;
      sum += z;
      ++count;
    }
  }
  return 2 * count < looked ? kHole : sum / count;
}

// Colours that differ little lie on one straight piece of the curve, or nearly so: their mean is the colour of the mean
// height. A hole (NaN) if they differ more, or stand for no depth.
double HeightField::meanOfColors(int c0, int r0, const SampledBlock& block) const RELIEVO_RT {
  const auto mean = colors_.meanOfEvenBlock(c0, r0, block);
  if (!mean) return kHole;
  const ColorCurve::Point point = curve_->nearest(*mean);
  const double code = steps_ * static_cast<double>(point.s);
  if (!isSure(point) || invalid_.contains(static_cast<std::uint32_t>(code))) return kHole;
  return fromNormalised(s_offset_ + s_scale_ * code);
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
  if (layout_ == Layout::Bytes && step_bytes_ == 1) {  // nearly always: the compiler makes it several at a time
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
  colors_ = ColorSamples(depth);
  curve_ = &curveOf(code);
}

bool HeightField::isSure(const ColorCurve::Point& point) const RELIEVO_RT {
  if (point.distance > kOnCurve) return false;
  return !curve_->closed() || (point.s > kSeam && point.s < 1 - kSeam);
}

// Position on the curve, 0 to 1, or a hole.
double HeightField::shareAt(int c, int r) const RELIEVO_RT {
  const YuvColor own = colors_.at(c, r);
  const ColorCurve::Point reading = curve_->nearest(own);
  return isSure(reading) ? static_cast<double>(reading.s) : shareBeside(c, r, own, reading);
}

[[gnu::noinline]] double HeightField::shareBeside(int c, int r, const YuvColor& own,
                                                  const ColorCurve::Point& reading) const RELIEVO_RT {
  // Chroma is mixed over two samples, and by some encoders' filters over four.
  static constexpr int kBeside[][2] = {{-2, 0}, {2, 0}, {0, -2}, {0, 2}, {-4, 0}, {4, 0}, {0, -4}, {0, 4}};
  const float far_off = curve_->closed() ? kFarOffHues : kFarOffMap;
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const bool at_seam = reading.distance <= kOnCurve;
  float least = kNone, least_empty = kNone, share = 0, low = 1, high = 0;
  YuvColor low_color, high_color;
  for (const auto& [across, down] : kBeside) {
    const int col = c + across, row = r + down;
    if (col < 0 || col >= cols_ || row < 0 || row >= rows_) continue;
    const YuvColor color = colors_.at(col, row);
    const ColorCurve::Point point = curve_->nearest(color);
    const float difference = std::abs(color.y - own.y);
    if (isSure(point)) {
      if (at_seam && std::min(point.s, 1 - point.s) > kBesideSeam) continue;
      if (point.s < low) low = point.s, low_color = color;
      if (point.s > high) high = point.s, high_color = color;
      if (difference < least) least = difference, share = point.s;
    } else if (point.distance <= kOnCurve || (point.distance > far_off && isBlack(color))) {
      least_empty = std::min(least_empty, difference);
    }
  }
  // A dark colour whose chroma is mixed with its complement's looks black as well.
  if (!at_seam && least_empty + kDarker < least) return kHole;
  if (least < kNone && !at_seam) {
    const ColorCurve::Between between = curve_->between(own, low, high);
    if (between.error < kSideFits * errorOfMixture(own, least, low_color, high_color)) share = between.s;
  }
  if (least < kNone) return static_cast<double>(share);
  return at_seam || reading.distance > far_off ? kHole : static_cast<double>(reading.s);
}

// The code of a sample, or a hole.
double HeightField::colorCodeAt(int c, int r) const RELIEVO_RT {
  if (layout_ == Layout::Curve) return steps_ * shareAt(c, r);
  const std::uint8_t* sample = data_ + r * stride_bytes_ + static_cast<std::ptrdiff_t>(c) * step_bytes_;
  return steps_ * hueOf(sample[red_], sample[green_], sample[blue_]);
}

double HeightField::fromColor(int c, int r) const RELIEVO_RT {
  const double code = colorCodeAt(c, r);
  if (std::isnan(code) || invalid_.contains(static_cast<std::uint32_t>(code))) return kHole;
  return fromNormalised(s_offset_ + s_scale_ * code);
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
  return layout_ != Layout::Curve || colors_.sameChroma(other.colors_, cols_, rows_);
}

std::uint32_t HeightField::code(int c, int r) const RELIEVO_RT {
  if (layout_ < Layout::Hue) return codeAt(data_ + r * stride_bytes_ + static_cast<std::ptrdiff_t>(c) * step_bytes_);
  const double code = colorCodeAt(c, r);
  return std::isnan(code) ? 0 : static_cast<std::uint32_t>(code);
}

}  // namespace relievo
