// SPDX-License-Identifier: Apache-2.0
// Reads depth that is coded in colours: the position of each sample on the code's curve.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

#include "app/scene/codes/code_set.h"
#include "app/scene/codes/sampled_block.h"
#include "app/scene/color/color_curve.h"
#include "app/scene/color/color_samples.h"
#include "app/scene/color/color_table.h"
#include "app/scene/color/color_tile.h"
#include "hal/media/frame.h"
#include "platform/realtime.h"

namespace relievo {

// Trivially copyable. Does not own the samples. A position is 0 to 1 along the ColorCurve, or NaN at a hole.
//
// It is the point of the curve that is nearest to the sample's colour. Subsampled chroma mixes the two sides of a depth
// edge to a colour off the curve. Such a sample belongs to one of the surfaces nearby: a small change of that surface's
// height explains its brightness, which is not subsampled; a mixture with the other side explains its chroma; and
// chroma interpolated to its place holds the larger part of it. Where the edge is soft, and a point of the curve
// between the two sides explains the colour better, that point is used. If the nearby sample that is most like it
// in brightness is black or red, it is a hole. If no nearby sample is on the curve, the sample's own reading is used if
// its colour is not far off. Red, where both ends of the depth meet on the circle of hues, is a hole in YUV unless a
// surface beside it ends there.
class ColorReading {
 public:
  ColorReading() = default;  // reads nothing
  // `frame` is YUV or RGB, and `code` is not luma. Makes the code's curve and table if it is the first: not for a
  // real-time thread.
  ColorReading(const Frame& frame, DepthCode code);

  [[nodiscard]] double shareAt(int c, int r) const RELIEVO_RT { return shareAt(c, r, samples_.lineAt(r)); }
  [[nodiscard]] ColorSamples::Line lineAt(int r) const RELIEVO_RT { return samples_.lineAt(r); }
  [[nodiscard]] double shareAt(int c, int r, const ColorSamples::Line& line) const RELIEVO_RT {
    const auto [place, codes] = samples_.codesAt(c, line);
    const std::uint8_t piece = table_->piecesOfSamples()[place];
    if (piece == ColorTable::kUnsure) return unsureShareAt(c, r);
    return std::clamp(static_cast<double>(table_->shareOf(piece, codes, samples_.scale())), 0.0, 1.0);
  }
  // The codes in `invalid`, of 0 to `steps` on the curve, stand for holes: samples near them are read one by one.
  void keepApart(const CodeSet& invalid, double steps) noexcept;
  // The positions of a block's samples: calls add(position, samples) for parts of them, with the mean position of each
  // part. All columns between the first and the last are read. A cell of 2 x 2 samples that is off the curve, or near
  // holes, is read by two of them.
  template <class Add>
  void readBlock(int c0, int r0, const SampledBlock& block, const Add& add) const RELIEVO_RT;

  // What one code of the samples changes in the position, on average over the curve.
  [[nodiscard]] double step() const noexcept { return curve_->meanPerColor() * samples_.step(); }

  // Whether chroma is equal in every sample; brightness is not compared. The other picture has this one's format.
  [[nodiscard]] bool sameChroma(const ColorReading& other) const noexcept {
    return samples_.sameChroma(other.samples_, cols_, rows_);
  }
  // Whether the other picture has the same format and code, wherever it lies.
  [[nodiscard]] bool readsLike(const ColorReading& other) const noexcept {
    return curve_ == other.curve_ && cols_ == other.cols_ && rows_ == other.rows_ && samples_.readsLike(other.samples_);
  }
  bool operator==(const ColorReading&) const = default;

 private:
  static constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] bool isSure(const ColorCurve::Point& point) const RELIEVO_RT {
    return point.distance <= kOnCurve && !curve_->isAtSeam(point.s, ColorTable::kSeam);
  }
  [[nodiscard]] double unsureShareAt(int c, int r) const RELIEVO_RT;
  [[nodiscard]] double shareBeside(int c, int r, const YuvColor& own,
                                   const ColorCurve::Point& reading) const RELIEVO_RT;
  // `sides`: the readings nearby, from `low` to `high`.
  [[nodiscard]] float shareAtEdge(int c, int r, const YuvColor& own, std::span<const float> sides, float low,
                                  float high) const RELIEVO_RT;

  template <class Add>
  void addCell(int c, int r, const Add& add) const RELIEVO_RT;
  template <class Add>
  void addTile(const ColorTile& tile, const Add& add) const RELIEVO_RT;
  template <class Add>
  void addOneByOne(std::uint8_t piece, const ColorTile& tile, const Add& add) const RELIEVO_RT;
  // Whether what lies on a piece cannot be averaged.
  [[nodiscard]] bool isApart(std::uint8_t piece) const RELIEVO_RT { return (apart_ >> piece & 1) != 0; }

  // Distance of a colour from the curve, in ColorCurve's coordinates. Measured on H.264 4:2:0 at crf 18 to 23: nine of
  // ten samples are nearer than 0.01, mixed ones farther than 0.05.
  static constexpr float kOnCurve = 0.06F;

  ColorSamples samples_;
  const ColorCurve* curve_ = nullptr;
  const ColorTable* table_ = nullptr;
  std::uint64_t apart_ = 1;  // a bit for each piece, and for kUnsure
  int cols_ = 0, rows_ = 0;
};

template <class Add>
void ColorReading::readBlock(int c0, int r0, const SampledBlock& block, const Add& add) const RELIEVO_RT {
  const auto &across = block.across, &down = block.down;
  const int left = c0 + across.first, right = left + (across.count - 1) * across.step + 1;
  const auto isPair = [](const SampledBlock::Places& places, int begin) {
    return places.count == 2 && places.step == 1 && begin % 2 == 0;
  };
  if (isPair(across, left) && isPair(down, r0 + down.first)) return addCell(left, r0 + down.first, add);
  ColorTile tile;
  tile.step = down.step;
  for (tile.begin = left & ~1; tile.begin < right; tile.begin += ColorTile::kMostColumns) {
    tile.left = std::max(left, tile.begin);
    tile.right = std::min(right, tile.begin + ColorTile::kMostColumns);
    for (int row = 0; row < down.count; row += ColorTile::kMostRows) {
      tile.top = r0 + down.first + row * down.step;
      tile.rows = std::min(down.count - row, ColorTile::kMostRows);
      samples_.readTile(*table_, cols_, tile);
      addTile(tile, add);
    }
  }
}

// The narrow level's blocks are mostly one cell.
template <class Add>
void ColorReading::addCell(int c, int r, const Add& add) const RELIEVO_RT {
  const auto [place, codes] = samples_.codesOfCell(c, r);
  const std::uint8_t piece = table_->piecesOfMeans()[place];
  if (!isApart(piece)) {
    return add(static_cast<double>(table_->shareOf(piece, codes, samples_.scale() / 4)), 4);
  }
  add(shareAt(c, r), 2);
  add(shareAt(c + 1, r + 1), 2);
}

template <class Add>
void ColorReading::addTile(const ColorTile& tile, const Add& add) const RELIEVO_RT {
  for (std::uint64_t used = tile.used; used != 0; used &= used - 1) {
    const auto piece = static_cast<std::uint8_t>(__builtin_ctzll(used));
    if (isApart(piece)) {
      addOneByOne(piece, tile, add);
      continue;
    }
    const auto [first, second, third, samples] = std::bit_cast<ColorTile::Sums>(tile.sums[piece]);
    const std::array sums{static_cast<float>(first), static_cast<float>(second), static_cast<float>(third)};
    add(static_cast<double>(table_->shareOf(piece, sums, 1 / static_cast<float>(samples))), samples);
  }
}

template <class Add>
void ColorReading::addOneByOne(std::uint8_t piece, const ColorTile& tile, const Add& add) const RELIEVO_RT {
  for (int row = 0, rows = 0; row < tile.rows; row += rows) {
    rows = tile.rowsFrom(row);
    for (int k = 0; k < tile.cells(); ++k) {
      const std::uint32_t place = tile.places[static_cast<std::size_t>(row)][static_cast<std::size_t>(k)];
      if (table_->piecesOfMeans()[place] != piece) continue;
      const int c = tile.leftOf(k), r = tile.rowAt(row);
      add(shareAt(c, r), rows);
      if (tile.rightOf(k) - c == 2) add(shareAt(c + 1, r + rows - 1), rows);
    }
  }
}

}  // namespace relievo
