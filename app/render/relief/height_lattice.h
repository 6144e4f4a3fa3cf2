// SPDX-License-Identifier: Apache-2.0
// The depth picture as heights on a lattice of square tiles with power-of-two sides, ready for subdivision.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/scene/height_field.h"

namespace relievo {

// Every vertex lies on a sample. If a side of the picture is not a multiple of the tile, some columns and rows appear
// twice; if there are more samples than needed, some are left out; both evenly spread. A hole takes the height of the
// farther of its neighbours in the row: its colour is known, and what was not measured is mostly hidden background.
// Parts of a picture that are bit-identical to the previous one are not read again.
class HeightLattice {
 public:
  static constexpr int kLargestTile = 32;

  // A larger step between two neighbouring samples separates two objects: a slope above 4, and more than the noise of
  // coded depth.
  [[nodiscard]] float jumpMm() const noexcept { return jump_mm_; }

  // At most about `most_across` cells in a row, and a number of rows that keeps the picture's aspect ratio. Returns
  // false if all heights are certainly those of the last picture.
  bool read(const HeightField& field, int most_across);

  [[nodiscard]] int tile() const noexcept { return tile_; }
  [[nodiscard]] int cols() const noexcept { return static_cast<int>(columns_.size()); }  // vertices
  [[nodiscard]] int rows() const noexcept { return static_cast<int>(rows_.size()); }
  [[nodiscard]] std::size_t size() const noexcept { return heights_.size(); }
  // The row of a vertex index; vertices are counted row by row.
  [[nodiscard]] int rowOf(std::uint32_t vertex) const noexcept {
    return static_cast<int>(vertex / static_cast<std::uint32_t>(columns_.size()));
  }
  [[nodiscard]] const float* heights() const noexcept { return heights_.data(); }  // mm, row by row
  [[nodiscard]] float* heights() noexcept { return heights_.data(); }
  // The sample of a vertex, its position in mm and in the picture (0 to 1).
  [[nodiscard]] int column(int i) const noexcept { return columns_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int row(int j) const noexcept { return rows_[static_cast<std::size_t>(j)]; }
  [[nodiscard]] float x(int i) const noexcept { return xs_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] float y(int j) const noexcept { return ys_[static_cast<std::size_t>(j)]; }
  [[nodiscard]] float u(int i) const noexcept { return us_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] float v(int j) const noexcept { return vs_[static_cast<std::size_t>(j)]; }

 private:
  void lay(const HeightField& field, int most_across);
  struct RowRead {
    bool changed, has_holes;
  };
  RowRead readChanged(const HeightField& field, int j, bool follows);
  void fillHoles(int j);

  int tile_ = 1;
  float jump_mm_ = 0;
  int most_across_ = 0;
  HeightField last_;  // its samples may be freed
  std::vector<int> columns_, rows_;
  std::vector<float> xs_, ys_, us_, vs_;
  std::vector<float> heights_;
  // State of the last picture: its bytes, its heights including holes, and the runs of vertices that contain a hole.
  std::vector<std::uint8_t> seen_;
  std::vector<float> read_;
  enum class Holes : std::uint8_t { None, Some, All };
  std::vector<Holes> holes_;
  std::vector<std::uint8_t> filled_;  // 1 if the row above has a hole here
};

}  // namespace relievo
