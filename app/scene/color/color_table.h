// SPDX-License-Identifier: Apache-2.0
// The piece of a ColorCurve that the codes of a picture's samples lie on, looked up, and the place on it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/scene/color/color_curve.h"
#include "platform/realtime.h"

namespace relievo {

// For one format of pictures. 512 KiB: twice 64 x 64 x 64 places, each four codes of 8 bits wide.
class ColorTable {
 public:
  static constexpr int kBits = 6;                 // of a component's code, the upper ones
  static constexpr std::size_t kMostPieces = 52;  // and corners
  // Pieces are counted from 1. This is of a place whose colours are off the curve or at its seam: such a sample is to
  // be compared with its neighbours.
  static constexpr std::uint8_t kUnsure = 0;
  // A sample that is farther from the curve, in ColorCurve's coordinates, may be mixed: two hues that are close mix to
  // a colour near the curve. Measured on H.264 4:2:0 at crf 18 to 23: nine of ten samples are nearer than 0.01.
  static constexpr float kUnmixed = 0.02F;
  // A mean colour of samples that is no farther is the colour of their mean position, or nearly so: at a corner of the
  // curve unmixed ones are .03 off.
  static constexpr float kMean = 0.045F;
  // Half the width of the circle's seam: coding moves a hue by 0.0044 in one sample of twenty.
  static constexpr float kSeam = 0.006F;
  // To luma and chroma (YuvColor): factors of the three codes as codes of 8 bits, and what is added.
  using Colors = std::array<std::array<float, 4>, 3>;

  ColorTable(const ColorCurve& curve, const Colors& colors);
  // `bits`: of the codes.
  [[nodiscard]] static std::uint32_t placeOf(std::uint32_t first, std::uint32_t second, std::uint32_t third,
                                             int bits) RELIEVO_RT {
    const int rest = bits - kBits;
    return ((first >> rest) << kBits | second >> rest) << kBits | third >> rest;
  }
  // With the corners.
  [[nodiscard]] std::size_t pieceCount() const RELIEVO_RT { return count_; }
  // The numbers of the pieces by place: of single samples, and of means of several.
  [[nodiscard]] const std::uint8_t* piecesOfSamples() const RELIEVO_RT { return of_samples_.data(); }
  [[nodiscard]] const std::uint8_t* piecesOfMeans() const RELIEVO_RT { return of_means_.data(); }
  // The position on the curve, 0 to 1, of codes on a piece that is not kUnsure; `scale` times them are codes of 8 bits.
  // Slightly beyond its ends for codes beside them.
  [[nodiscard]] float shareOf(std::uint8_t piece, const std::array<float, 3>& codes, float scale) const RELIEVO_RT {
    const Line& line = lines_[piece];
    return scale * (line[0] * codes[0] + line[1] * codes[1] + line[2] * codes[2]) + line[3];
  }

 private:
  using Line = std::array<float, 4>;  // factors of the three codes, and what is added
  std::array<Line, kMostPieces + 1> lines_{};
  std::size_t count_ = 0;
  std::vector<std::uint8_t> of_samples_, of_means_;
};

// The table of a code other than luma in one of kColorFormats formats, of which `colors` tells how its codes are read.
// The first call creates it, which a real-time thread must not do; later calls return the same one. Any thread.
inline constexpr std::size_t kColorFormats = 9;
[[nodiscard]] const ColorTable& tableOf(DepthCode code, std::size_t format, const ColorTable::Colors& colors);

}  // namespace relievo
