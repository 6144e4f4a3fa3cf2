// SPDX-License-Identifier: Apache-2.0
// The colours of a picture in the decoder's memory, in the coordinates of a ColorCurve.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "app/scene/color/color_curve.h"
#include "app/scene/color/color_table.h"
#include "hal/media/frame.h"
#include "platform/realtime.h"

namespace relievo {

struct ColorTile;

// Trivially copyable. Does not own the samples.
class ColorSamples {
 public:
  ColorSamples() = default;
  // `frame` is YUV or RGB.
  explicit ColorSamples(const Frame& frame) noexcept;

  [[nodiscard]] YuvColor at(int c, int r) const RELIEVO_RT {
    const auto [place, codes] = codesAt(c, lineAt(r));
    return colorOf(codes[0], codes[1], codes[2]);
  }
  // A row of samples: where each component begins, and the way from one sample to the next.
  struct Line {
    std::array<const std::uint8_t*, 3> begin;
    std::array<std::ptrdiff_t, 3> step_bytes;
  };
  [[nodiscard]] Line lineAt(int r) const RELIEVO_RT {
    const auto begin = [this](std::size_t i, int row)
                           RELIEVO_RT { return parts_[i].data + row * parts_[i].stride_bytes; };
    return {{begin(0, r), begin(1, r >> shift_y_), begin(2, r >> shift_y_)},
            {parts_[0].step_bytes, parts_[1].step_bytes, parts_[2].step_bytes}};
  }
  // The place of a sample in a ColorTable, and its codes.
  struct Codes {
    std::uint32_t place = 0;
    std::array<float, 3> codes{};
  };
  [[nodiscard]] Codes codesAt(int c, const Line& line) const RELIEVO_RT {
    const std::uint32_t first = codeAt(0, c, line), second = codeAt(1, c >> shift_x_, line),
                        third = codeAt(2, c >> shift_x_, line);
    return codesOf(first, second, third, bits_);
  }
  // The place of the mean of 2 x 2 samples, the first of which is at an even column and row, and the sums of their
  // codes.
  [[nodiscard]] Codes codesOfCell(int c, int r) const RELIEVO_RT {
    const Line line = lineAt(r), below = lineAt(r + 1);
    const auto sumOf = [&](std::size_t i) RELIEVO_RT {
      return codeAt(i, c, line) + codeAt(i, c + 1, line) + codeAt(i, c, below) + codeAt(i, c + 1, below);
    };
    const auto chromaOf = [&](std::size_t i) RELIEVO_RT {
      if (shift_x_ == 0) return sumOf(i);
      return 2 * (codeAt(i, c >> shift_x_, line) + codeAt(i, c >> shift_x_, below));
    };
    return codesOf(sumOf(0), chromaOf(1), chromaOf(2), bits_ + 2);
  }
  // `scale` times a code is a code of 8 bits.
  [[nodiscard]] float scale() const RELIEVO_RT { return of_eight_bits_; }
  // Reads the cells of a tile. `cols`: of the picture.
  void readTile(const ColorTable& table, int cols, ColorTile& tile) const RELIEVO_RT;
  // The colour of (c, r) with chroma interpolated to its place, from the four chroma samples around it. `cols` and
  // `rows`: of the picture.
  [[nodiscard]] YuvColor interpolatedAt(int c, int r, int cols, int rows) const RELIEVO_RT;
  // The table of a code in this format. Makes it if it is the first: not for a real-time thread.
  [[nodiscard]] const ColorTable& tableOf(DepthCode code) const;
  // What one code changes in the colour.
  [[nodiscard]] double step() const noexcept;
  // Whether the second and third components of two pictures of the same format and size are equal.
  [[nodiscard]] bool sameChroma(const ColorSamples& other, int cols, int rows) const noexcept;
  // Whether the other picture has the same format, wherever it lies.
  [[nodiscard]] bool readsLike(const ColorSamples& other) const noexcept;
  bool operator==(const ColorSamples&) const = default;

 private:
  struct Part {
    const std::uint8_t* data = nullptr;
    std::ptrdiff_t stride_bytes = 0;
    std::uint8_t step_bytes = 1, shift = 0;
    bool operator==(const Part&) const = default;
  };
  [[nodiscard]] YuvColor colorOf(float first, float second, float third) const RELIEVO_RT {
    const auto part = [&](const std::array<float, 4>& row) {
      return row[0] * first + row[1] * second + row[2] * third + row[3];
    };
    return {part(rows_[0]), part(rows_[1]), part(rows_[2])};
  }
  [[nodiscard]] static Codes codesOf(std::uint32_t first, std::uint32_t second, std::uint32_t third,
                                     int bits) RELIEVO_RT {
    const auto asFloat = [](std::uint32_t code) { return static_cast<float>(static_cast<int>(code)); };
    return {ColorTable::placeOf(first, second, third, bits), {asFloat(first), asFloat(second), asFloat(third)}};
  }
  template <bool kWords, bool kHalved>
  void readSideBySide(const ColorTable& table, ColorTile& tile) const RELIEVO_RT;
  void readOneByOne(const ColorTable& table, ColorTile& tile) const RELIEVO_RT;
  [[nodiscard]] std::uint32_t codeAt(std::size_t part, int c, const Line& line) const RELIEVO_RT {
    const std::uint8_t* at = line.begin[part] + c * line.step_bytes[part];
    if (!words_) return at[0];
    return (at[0] | static_cast<std::uint32_t>(at[1]) << 8) >> parts_[part].shift & mask_;
  }

  std::array<Part, 3> parts_{};
  std::array<std::array<float, 4>, 3> rows_{};  // to y, u, v: factors of the three codes, and what is added
  std::uint32_t mask_ = 0xff;
  float of_eight_bits_ = 1;  // a code as a code of 8 bits
  std::uint8_t bits_ = 8, shift_x_ = 0, shift_y_ = 0, format_ = 0;
  bool words_ = false, side_by_side_ = false;
};

}  // namespace relievo
