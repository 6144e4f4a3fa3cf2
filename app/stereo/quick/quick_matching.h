// SPDX-License-Identifier: Apache-2.0
// Semi-global matching that is quick enough to run while a film plays; it needs no library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// What the player and the author ask of the matcher; the player's first.
struct MatchingRule {
  std::int16_t slope = 12;  // cost of a disparity's change by one, in census bits
  int step = 150;           // the same for a change by more than one, where the picture is even
  int least_step = 40;      // the same at an outline
  bool by_color = false;    // an outline is told by all parts of the pixels, not by the luma alone
  bool diagonals = false;   // paths in eight directions, not in four
};

// Census of 5 x 5 pixels (Zabih and Woodfill, ECCV 1994), whatever the exposure; paths in four or eight directions
// (Hirschmueller, PAMI 2008). Keeps its memory from picture to picture.
class QuickMatching {
 public:
  explicit QuickMatching(MatchingRule rule = {}) noexcept : rule_(rule) {}

  // The views have one size, row by row. `seen`: the right view has the same point there, and it is no speckle. Other
  // pixels keep the left view's match; `from_right` is -infinity where nothing was found.
  [[nodiscard]] const DisparityMap& match(const ViewPicture& left, const ViewPicture& right, DisparityRange range);

 private:
  using Census = std::vector<std::uint32_t>;
  using Cost = std::int16_t;

  void prepare(const ViewPicture& left, DisparityRange range);
  void takeCensus(const std::vector<std::uint8_t>& luma, Census& census) const;
  void takeSteps(const ViewPicture& left);
  [[nodiscard]] Cost stepCost(const std::uint8_t* a, const std::uint8_t* b) const noexcept;
  void costsOfRow(int r);
  void downward();
  void upward();
  void alongRow(int r, int step);
  void fromRow(int other, int r);
  void fromRow(int other, int r, int across, Cost* paths);
  void chooseInRow(int r);
  void checkRow(int r);
  void removeSpecks();
  [[nodiscard]] std::size_t wanted() const noexcept {
    const int count = range_.highest - range_.lowest + 1;
    return static_cast<std::size_t>(count);
  }
  [[nodiscard]] std::size_t pathsFromRow() const noexcept { return rule_.diagonals ? 3 : 1; }
  // Of a pixel's paths, with a high cost on both sides and the least cost at the end.
  [[nodiscard]] std::size_t stride() const noexcept;
  [[nodiscard]] std::size_t cell(int c, int r) const noexcept { return map_.at(c, r) * levels_; }

  MatchingRule rule_;
  DisparityMap map_;
  DisparityRange range_;
  std::size_t levels_ = 0;  // a multiple of a vector's length
  std::vector<std::uint8_t> left_luma_, right_luma_;
  Census left_census_, right_census_, reversed_;
  std::vector<std::uint8_t> costs_;         // of all pixels and disparities
  std::vector<Cost> sums_;                  // likewise, of the paths
  std::vector<Cost> beside_;                // of the path from the pixel before in the row
  std::array<std::vector<Cost>, 3> above_;  // of the paths from the three pixels above
  std::vector<Cost> before_, now_, none_;   // a row's and a pixel's paths, and one that begins
  std::vector<Cost> least_right_;
  std::vector<std::size_t> speck_;  // pixels
  std::vector<std::uint8_t> visited_;
};

}  // namespace relievo
