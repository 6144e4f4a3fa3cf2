// SPDX-License-Identifier: Apache-2.0
// The relief: a view of the decoder's depth plane that gives the height of any sample in mm, without copying.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "app/scene/codes/sampled_block.h"
#include "app/scene/color/color_reading.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/media/frame.h"
#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo {

// Trivially copyable. Does not own the samples: the holder of the Frame does. The height of a hole (an invalid code, a
// colour that stands for no depth) is NaN: every comparison with it is false, so that a hole cannot be touched by
// accident. Every other height is finite, in [0, volume depth].
//
// How depth in colours is read: see ColorReading. RGB that holds hues is read as it is, without its neighbours.
class HeightField {
 public:
  HeightField() = default;
  // Unsupported if the frame lacks the luma or packed 8-bit RGB that the calibration's code needs.
  [[nodiscard]] static Result<HeightField> make(const Frame& depth, const DepthCalibration& calibration,
                                                const DisplayVolume& volume) noexcept;

  [[nodiscard]] int cols() const noexcept { return cols_; }
  [[nodiscard]] int rows() const noexcept { return rows_; }
  [[nodiscard]] const GridMapping& grid() const noexcept { return grid_; }

  // Requires 0 <= c < cols, 0 <= r < rows; not checked.
  [[nodiscard]] double heightMm(int c, int r) const RELIEVO_RT {
    const std::uint8_t* sample = data_ + r * stride_bytes_ + static_cast<std::ptrdiff_t>(c) * step_bytes_;
    if (layout_ >= Layout::Hue) return heightOfColor(colorCodeAt(c, r));
    return heightOfCode(codeAt(sample));
  }

  // A whole row of raw luma codes, one for each column. False, and nothing is read, if the depth is in colours.
  bool readCodes(int r, std::span<std::uint16_t> codes) const noexcept;
  // The height that a luma code below `codeCount` stands for.
  [[nodiscard]] double heightOfCode(std::uint32_t code) const RELIEVO_RT {
    return invalid_.contains(code) ? kHole : fromNormalised(s_offset_ + s_scale_ * static_cast<double>(code));
  }
  [[nodiscard]] std::size_t codeCount() const noexcept { return std::size_t{mask_} + 1; }

  // Reads the heights of some samples of a row, in the given order. Returns whether there is a hole among them.
  bool readRow(int r, std::span<const int> columns, float* heights_mm) const RELIEVO_RT;

  // True if a sample depends on bytes outside `rowBytes`, so that comparing rows can miss a change.
  [[nodiscard]] bool readsBeside() const noexcept { return layout_ == Layout::Curve; }
  // The bytes of a row from the first sample to the last.
  [[nodiscard]] std::span<const std::uint8_t> rowBytes(int r) const noexcept {
    return {data_ + r * stride_bytes_, static_cast<std::size_t>(cols_ - 1) * step_bytes_ + sampleBytes()};
  }
  [[nodiscard]] int stepBytes() const noexcept { return step_bytes_; }
  // True if the other field has the same size and format, so that equal bytes mean equal heights.
  [[nodiscard]] bool readsLike(const HeightField& other) const noexcept;

  // A block of about `most` x `most` samples, read as this field reads them best.
  [[nodiscard]] SampledBlock blockOf(int width, int height, int most) const RELIEVO_RT {
    return layout_ == Layout::Curve || (plain_ && step_bytes_ == sampleBytes())
               ? SampledBlock::ofWholeRows(width, height, most)
               : SampledBlock(width, height, most);
  }
  // The mean height of the samples read from a block that begins at sample (c0, r0) and lies inside the picture. NaN if
  // fewer than half of them have a height.
  [[nodiscard]] double meanHeight(int c0, int r0, const SampledBlock& block) const RELIEVO_RT;
  // Prefetches the samples that `meanHeight` reads for `blocks` adjacent blocks, the first at (c0, r0).
  void prefetch(int c0, int r0, int blocks, const SampledBlock& block) const RELIEVO_RT;
  [[nodiscard]] double depthMm() const RELIEVO_RT { return depth_mm_; }
  // The height of one code step, averaged over the volume. Of colours that are not looked up by hue alone: of a step of
  // the samples' own codes.
  [[nodiscard]] double stepMm() const noexcept {
    return depth_mm_ * std::abs(s_scale_) * (layout_ == Layout::Curve ? steps_ * colors_.step() : 1);
  }
  // Whether heights are a mixture of several codes, whose differences show no steps.
  [[nodiscard]] bool mixesCodes() const noexcept { return layout_ == Layout::Curve; }
  // How high a code step is at a height, in parts of the average one; the inverse law has the highest steps far away.
  [[nodiscard]] double stretchAt(double height_mm) const RELIEVO_RT {
    if (!inverse_) return 1;
    const double away_mm = far_mm_ - height_mm / depth_per_mm_;
    return depth_per_mm_ / depth_mm_ * away_mm * away_mm * (near_inverse_ - far_inverse_);
  }

  // Whether every sample equals that of another field of the same film. Compares the bytes between the samples too, so
  // it may return false for equal samples. Reads the whole picture: not for the real-time thread.
  [[nodiscard]] bool sameSamples(const HeightField& other) const noexcept;

  // The raw luma code, a hue 0 .. 1535 (six steps of 256) or the entry 0 .. 255 of a colour map; 0 if unreadable.
  [[nodiscard]] std::uint32_t code(int c, int r) const RELIEVO_RT;

  static constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

 private:
  bool operator==(const HeightField&) const = default;
  enum class Layout : std::uint8_t { Bytes, Words, Hue, Curve };
  [[nodiscard]] std::uint32_t codeAt(const std::uint8_t* sample) const RELIEVO_RT {
    const std::uint32_t low = sample[0];
    if (layout_ == Layout::Bytes) return (low >> shift_) & mask_;
    return ((low | static_cast<std::uint32_t>(sample[1]) << 8) >> shift_) & mask_;
  }
  [[nodiscard]] double fromNormalised(double s) const RELIEVO_RT {
    s = std::min(std::max(s, 0.0), 1.0);
    if (!inverse_) return depth_mm_ * s;
    return (far_mm_ - 1.0 / (far_inverse_ + s * (near_inverse_ - far_inverse_))) * depth_per_mm_;
  }
  [[nodiscard]] int sampleBytes() const noexcept {
    if (layout_ == Layout::Bytes) return 1;
    return layout_ == Layout::Words || step_bytes_ == 2 ? 2
           : step_bytes_ == 1                           ? 1
                                                        : 1 + std::max({red_, green_, blue_});
  }
  void readColors(const Frame& depth, DepthCode code) noexcept;
  [[nodiscard]] double colorCodeAt(int c, int r) const RELIEVO_RT;
  // NaN, which is no code, stands for a hole.
  [[nodiscard]] double heightOfColor(double code) const RELIEVO_RT {
    if (std::isnan(code) || invalid_.contains(static_cast<std::uint32_t>(code))) return kHole;
    return fromNormalised(s_offset_ + s_scale_ * code);
  }
  // Only for a plain field.
  [[nodiscard]] double meanOfCodes(int c0, int r0, const SampledBlock& block) const RELIEVO_RT;

  const std::uint8_t* data_ = nullptr;
  std::ptrdiff_t stride_bytes_ = 0;
  int cols_ = 0;
  int rows_ = 0;
  std::uint8_t step_bytes_ = 1;
  std::uint8_t shift_ = 0;
  std::uint8_t red_ = 0, green_ = 1, blue_ = 2;  // byte offsets inside a pixel
  Layout layout_ = Layout::Bytes;
  bool inverse_ = false;
  bool plain_ = false;  // height = code x scale + offset for every code, so the mean of heights is that of codes
  std::uint32_t mask_ = 0xff;
  CodeSet invalid_;
  double s_scale_ = 1, s_offset_ = 0;  // s = clamp(s_offset + s_scale x code), polarity included
  double depth_mm_ = 0;
  double near_inverse_ = 0, far_inverse_ = 0;  // 1/near, 1/far
  double far_mm_ = 0, depth_per_mm_ = 0;       // depth_per_mm = D/(far - near)
  GridMapping grid_;
  ColorReading colors_;
  double steps_ = 0;  // codes from the curve's first colour to its last
};

}  // namespace relievo
