// SPDX-License-Identifier: Apache-2.0
// Several lines side by side, so that vector instructions fit them together. Where no run ends within reach, the fit is
// the mean of a window that slides along the line; near the run's ends it is computed in full.
#include "app/enhance/edge_keeping_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "app/enhance/in_bands.h"

namespace relievo {
namespace {

constexpr int kLines = 16;  // a cache line of samples

// The place of a sample in the picture's memory, from its line and its number in it. Lines are rows or columns.
struct Layout {
  int lines = 0, length = 0, cols = 0;
  bool columns = false;

  [[nodiscard]] std::ptrdiff_t at(int line, int i) const {
    return columns ? static_cast<std::ptrdiff_t>(i) * cols + line : static_cast<std::ptrdiff_t>(line) * cols + i;
  }
};

class LineFits {
 public:
  LineFits(const Layout& layout, int reach)
      : layout_(layout),
        reach_(reach),
        codes_(static_cast<std::size_t>(layout.length)),
        fitted_(codes_.size()),
        of_count_(2 * static_cast<std::size_t>(reach) + 2) {
    for (std::size_t n = 2; n < of_count_.size(); ++n) {
      const auto count = static_cast<double>(n);
      of_count_[n] = {1 / count, 12 / (count * (count * count - 1))};
    }
  }

  // Fits `count` lines from `first` on. A run ends after each sample marked 1 in `ends`; the last one always does.
  void fit(const std::uint8_t* ends, float* codes, int first, int count) {
    exchange(first, count, [codes](std::ptrdiff_t at, float& code) { code = codes[at]; }, codes_);
    inside();
    findStops(ends, first, count);
    for (int k = 0; k < count; ++k) {
      int begin = 0;
      for (const int stop : stops_[k]) atEnds(k, std::exchange(begin, stop), stop);
      atEnds(k, begin, layout_.length);
    }
    exchange(first, count, [codes](std::ptrdiff_t at, float& code) { codes[at] = code; }, fitted_);
  }

 private:
  using Rows = std::vector<std::array<float, kLines>>;
  struct OfCount {
    double mean = 0, slope = 0;
  };

  // As if no run ended: the line's value in the middle of its window is the mean.
  void inside() {
    std::array<double, kLines> sums{};
    const int length = layout_.length;
    if (length <= 2 * reach_) return;
    for (int i = 0; i < 2 * reach_; ++i) {
      for (int k = 0; k < kLines; ++k) sums[k] += static_cast<double>(codes_[i][k]);
    }
    for (int i = reach_; i < length - reach_; ++i) {
      const auto &ahead = codes_[i + reach_], &behind = codes_[i - reach_];
      for (int k = 0; k < kLines; ++k) sums[k] += static_cast<double>(ahead[k]);
      for (int k = 0; k < kLines; ++k) fitted_[i][k] = static_cast<float>(sums[k] * of_count_.back().mean);
      for (int k = 0; k < kLines; ++k) sums[k] -= static_cast<double>(behind[k]);
    }
  }

  // Copies between the picture and the lines side by side, with distances known at compile time where possible.
  template <class Move>
  void exchange(int first, int count, Move&& move, Rows& rows) {
    const std::ptrdiff_t begin = layout_.at(first, 0), cols = layout_.cols;
    if (layout_.columns && count == kLines) {
      for (int i = 0; i < layout_.length; ++i) {
        for (int k = 0; k < kLines; ++k) move(begin + i * cols + k, rows[i][k]);
      }
    } else if (layout_.columns) {
      for (int i = 0; i < layout_.length; ++i) {
        for (int k = 0; k < count; ++k) move(begin + i * cols + k, rows[i][k]);
      }
    } else {
      for (int i = 0; i < layout_.length; ++i) {
        for (int k = 0; k < count; ++k) move(begin + i + k * cols, rows[i][k]);
      }
    }
  }

  // The samples at which the lines' later runs begin.
  void findStops(const std::uint8_t* ends, int first, int count) {
    for (auto& stops : stops_) stops.clear();
    if (layout_.columns) {
      for (int i = 0; i + 1 < layout_.length; ++i) {
        const std::uint8_t* const here = ends + layout_.at(first, i);
        unsigned any = 0;
        for (int k = 0; k < count; ++k) any |= here[k];
        if (any == 0) continue;
        for (int k = 0; k < count; ++k) {
          if (here[k] != 0) stops_[k].push_back(i + 1);
        }
      }
      return;
    }
    for (int k = 0; k < count; ++k) {
      const std::uint8_t *const begin = ends + layout_.at(first + k, 0), *const last = begin + layout_.length - 1;
      for (const std::uint8_t* at = begin; (at = std::find(at, last, 1)) != last;) {
        stops_[k].push_back(static_cast<int>(++at - begin));
      }
    }
  }

  // The samples within reach of a run's ends, by the line of least squares through what the run has of their window.
  void atEnds(int line, int begin, int end) {
    double sum = 0, moment = 0;  // about `begin`, of codes less `base`
    int a = begin, b = begin;    // the window is [a, b)
    const double base = static_cast<double>(codes_[begin][line]);
    const auto add = [&](int i, double sign) {
      const double code = sign * (static_cast<double>(codes_[i][line]) - base);
      sum += code;
      moment += code * (i - begin);
    };
    for (int i = begin; i < end; ++i) {
      if (i - begin == reach_ && i < end - reach_) {
        i = end - reach_;
        a = b = i - reach_;
        sum = moment = 0;
      }
      while (b < std::min(i + reach_ + 1, end)) add(b++, 1);
      while (a < i - reach_) add(a++, -1);
      const int n = b - a;
      if (n < 3) {  // the line through two samples
        fitted_[i][line] = codes_[i][line];
        continue;
      }
      const double middle = 0.5 * (a + b - 1);
      const double slope = (moment - sum * (middle - begin)) * of_count_[n].slope;
      fitted_[i][line] = static_cast<float>(base + sum * of_count_[n].mean + slope * (i - middle));
    }
  }

  Layout layout_;
  int reach_;
  Rows codes_, fitted_;  // by sample along the lines
  std::array<std::vector<int>, kLines> stops_;
  std::vector<OfCount> of_count_;
};

// 1 at the last sample before a step or a hole, along rows and along columns.
struct Ends {
  std::vector<std::uint8_t> across, down;
};

Ends endsOfRuns(const DepthMap& map) {
  Ends ends{std::vector<std::uint8_t>(map.size()), std::vector<std::uint8_t>(map.size())};
  inBands(map.rows, [&](int first, int last) {
    const auto compare = [&](std::vector<std::uint8_t>& marks, int row, std::ptrdiff_t away, int count) {
      const float *const z = &map.codes[map.at(0, row)], *const other = z + away;
      const std::uint8_t *const hole = &map.holes[map.at(0, row)], *const other_hole = hole + away;
      std::uint8_t* const end = &marks[map.at(0, row)];
      for (int c = 0; c < count; ++c) {
        end[c] = static_cast<std::uint8_t>(static_cast<int>(std::abs(other[c] - z[c]) > DepthMap::kStep) |
                                           (hole[c] ^ other_hole[c]));
      }
    };
    for (int r = first; r < last; ++r) {
      compare(ends.across, r, 1, map.cols - 1);
      if (r + 1 < map.rows) compare(ends.down, r, map.cols, map.cols);
    }
  });
  return ends;
}

void fitAlong(const std::vector<std::uint8_t>& ends, DepthMap& map, bool columns, int reach) {
  const Layout layout{.lines = columns ? map.cols : map.rows,
                      .length = columns ? map.rows : map.cols,
                      .cols = map.cols,
                      .columns = columns};
  inBands(layout.lines, [&](int first, int last) {
    LineFits fits(layout, reach);
    for (int line = first; line < last; line += kLines) {
      fits.fit(ends.data(), map.codes.data(), line, std::min(kLines, last - line));
    }
  });
}

}  // namespace

void fitLines(DepthMap& map, int reach) {
  if (reach < 1 || map.size() == 0) return;
  const Ends ends = endsOfRuns(map);
  for (int round = 0; round < 2; ++round) {
    fitAlong(ends.across, map, false, reach);
    fitAlong(ends.down, map, true, reach);
  }
}

}  // namespace relievo
