// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/stereo/stereo_pair.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "hal/media/samples.h"

namespace relievo {
namespace {

constexpr int kCols = 168, kRows = 96;  // of the reduced pictures
constexpr int kBlock = 12;              // both divide evenly
constexpr int kFarthest = kCols / 7;    // shift in the reduced picture
constexpr int kLowest = kRows / 12;     // rows by which one view may lie lower than the other
constexpr double kTexture = 0.02;       // least standard deviation in a block, of full scale
constexpr double kAlike = 0.85;         // correlation of a block that was found
constexpr double kFound = 0.6;          // share of the blocks in a stereo pair; of colour and depth 0.15
constexpr int kLeastBlocks = 12;        // a picture with less texture cannot be judged
constexpr double kBlack = 0.1;          // brightness of a bar; black of limited range is 0.06

using Reduced = std::vector<double>;

double brightnessAt(const Frame& f, int c, int r) noexcept {
  const Component& k = brightnessOf(f);
  return static_cast<double>(codeAt(f, k, c, r)) / ((1u << k.bits) - 1);
}

// Each value is the mean of up to 4 x 4 samples of its cell.
Reduced reduce(const Frame& f) {
  constexpr int kTaken = 4;
  Reduced reduced;
  reduced.reserve(std::size_t{kCols} * kRows);
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      double sum = 0;
      for (int i = 0; i < kTaken * kTaken; ++i) {
        const int x = (c * kTaken + i % kTaken) * f.width / (kCols * kTaken);
        const int y = (r * kTaken + i / kTaken) * f.height / (kRows * kTaken);
        sum += brightnessAt(f, x, y);
      }
      reduced.push_back(sum / (kTaken * kTaken));
    }
  }
  return reduced;
}

std::size_t at(int c, int r) {
  return static_cast<std::size_t>(r) * kCols + static_cast<std::size_t>(c);
}

struct Moments {
  double mean = 0, deviation = 0;
};
Moments momentsOf(const Reduced& a, int c0, int r0) {
  double sum = 0, squares = 0;
  for (int r = r0; r < r0 + kBlock; ++r) {
    for (int c = c0; c < c0 + kBlock; ++c) {
      const double x = a[at(c, r)];
      sum += x;
      squares += x * x;
    }
  }
  constexpr double kCount = kBlock * kBlock;
  const double mean = sum / kCount;
  return {mean, std::sqrt(std::max(0.0, squares / kCount - mean * mean))};
}

// The standard deviation from a fitted plane: a mere slope is no texture.
double textureOf(const Reduced& a, int c0, int r0, const Moments& moments) {
  constexpr double kMiddle = 0.5 * (kBlock - 1), kSpread = (kBlock * kBlock - 1) / 12.0, kCount = kBlock * kBlock;
  double across = 0, down = 0;
  for (int r = 0; r < kBlock; ++r) {
    for (int c = 0; c < kBlock; ++c) {
      const double x = a[at(c0 + c, r0 + r)];
      across += (c - kMiddle) * x / kCount;
      down += (r - kMiddle) * x / kCount;
    }
  }
  const double of_plane = (across * across + down * down) / kSpread;
  return std::sqrt(std::max(0.0, moments.deviation * moments.deviation - of_plane));
}

double correlation(const Reduced& a, int ca, int ra, const Moments& of_a, const Reduced& b, int cb, int rb) {
  const Moments of_b = momentsOf(b, cb, rb);
  if (of_b.deviation < kTexture / 2) return 0;
  double sum = 0;
  for (int r = 0; r < kBlock; ++r) {
    for (int c = 0; c < kBlock; ++c) {
      sum += (a[at(ca + c, ra + r)] - of_a.mean) * (b[at(cb + c, rb + r)] - of_b.mean);
    }
  }
  return sum / (kBlock * kBlock) / (of_a.deviation * of_b.deviation);
}

// `lower`: the rows that the other picture lies lower.
bool isFound(const Reduced& a, int c0, int r0, const Moments& moments, const Reduced& b, int lower) {
  for (int c = std::max(0, c0 - kFarthest); c <= std::min(kCols - kBlock, c0 + kFarthest); ++c) {
    for (int r = std::max(0, r0 + lower - 1); r <= std::min(kRows - kBlock, r0 + lower + 1); ++r) {
      if (correlation(a, c0, r0, moments, b, c, r) >= kAlike) return true;
    }
  }
  return false;
}

// The change of the rows' brightness from each row to the next: nearly the same in two views of one scene.
std::vector<double> changesOf(const Reduced& a) {
  std::vector<double> rows(kRows), changes;
  for (int r = 0; r < kRows; ++r) rows[static_cast<std::size_t>(r)] = std::reduce(&a[at(0, r)], &a[at(0, r)] + kCols);
  std::adjacent_difference(rows.begin(), rows.end(), std::back_inserter(changes));
  changes.front() = 0;
  return changes;
}

// The rows that the second picture lies lower, as far as whole pictures can tell.
int rowsLower(const Reduced& a, const Reduced& b) {
  const std::vector<double> first = changesOf(a), second = changesOf(b);
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int lower = -kLowest; lower <= kLowest; ++lower) {
    double sum = 0;
    for (int r = kLowest; r < kRows - kLowest; ++r) sum += std::abs(first.begin()[r] - second.begin()[r + lower]);
    if (sum < least) best = lower;
    least = std::min(least, sum);
  }
  return best;
}

struct Likeness {
  int textured = 0, found = 0;  // blocks of the first picture
};
Likeness likenessOf(const Reduced& a, const Reduced& b, int lower) {
  Likeness likeness;
  for (int r = 0; r < kRows; r += kBlock) {
    for (int c = 0; c < kCols; c += kBlock) {
      const Moments moments = momentsOf(a, c, r);
      if (textureOf(a, c, r, moments) < kTexture) continue;
      ++likeness.textured;
      likeness.found += isFound(a, c, r, moments, b, lower) ? 1 : 0;
    }
  }
  return likeness;
}

// A view of a camera that was built or held badly lies higher or lower than the other.
Likeness likenessOf(const Frame& first, const Frame& second) {
  const Reduced a = reduce(first), b = reduce(second);
  const Likeness level = likenessOf(a, b, 0);
  const int lower = rowsLower(a, b);
  if (lower == 0 || level.found >= kFound * level.textured) return level;
  const Likeness moved = likenessOf(a, b, lower);
  return moved.found > level.found ? moved : level;
}

bool areViews(const Likeness& likeness) {
  return likeness.textured >= kLeastBlocks && likeness.found >= kFound * likeness.textured;
}

// Rows or columns of the reduced picture that are black from its border on.
struct Bars {
  int before = 0, behind = 0;
};
Bars barsOf(const Reduced& a, bool columns) {
  const int lines = columns ? kCols : kRows, across = columns ? kRows : kCols;
  const auto isBlack = [&](int line) {
    for (int i = 0; i < across; ++i) {
      if (a[columns ? at(line, i) : at(i, line)] > kBlack) return false;
    }
    return true;
  };
  Bars bars;
  while (bars.before < lines && isBlack(bars.before)) ++bars.before;
  while (bars.before + bars.behind < lines && isBlack(lines - 1 - bars.behind)) ++bars.behind;
  return bars;
}

}  // namespace

bool areViews(const Frame& first, const Frame& second) {
  return areViews(likenessOf(first, second));
}

bool barsMeetInTheMiddle(const Frame& picture, Packing packing) {
  const bool beside = packing == Packing::StereoSideBySide;
  const auto halves = splitPacked(picture, beside ? Packing::SideBySide : Packing::TopBottom, DepthCode::Hue);
  if (!halves) return false;
  const Bars first = barsOf(reduce(halves->color), beside), second = barsOf(reduce(halves->depth), beside);
  return std::min({first.before, first.behind, second.before, second.behind}) > 0;
}

bool areOtherPictures(const Frame& first, const Frame& second) {
  constexpr double kHardly = 0.3;
  const Likeness likeness = likenessOf(first, second);
  return likeness.textured >= kLeastBlocks && likeness.found < kHardly * likeness.textured;
}

std::optional<Packing> findViews(const Frame& picture) {
  std::optional<Packing> found;
  double most = 0;
  for (const Packing packing : {Packing::SideBySide, Packing::TopBottom}) {
    const auto halves = splitPacked(picture, packing, DepthCode::Hue);
    if (!halves) continue;
    const Likeness likeness = likenessOf(halves->color, halves->depth);
    const double share = likeness.found / std::max(1.0, 1.0 * likeness.textured);
    if (!areViews(likeness) || share <= most) continue;
    most = share;
    found = packing == Packing::SideBySide ? Packing::StereoSideBySide : Packing::StereoTopBottom;
  }
  return found;
}

std::optional<Views> viewsOf(const Frame& picture, Packing packing, bool right_first, std::optional<bool> squeezed) {
  constexpr double kTwoBeside = 2.5, kTwoAbove = 1.1;  // films are 1.33 to 2.4 times as wide as high
  const bool beside = packing == Packing::StereoSideBySide;
  const auto halves = splitPacked(picture, beside ? Packing::SideBySide : Packing::TopBottom, DepthCode::Hue);
  if (!halves) return std::nullopt;
  Views views{halves->color, halves->depth};
  if (right_first) std::swap(views.left, views.right);
  const double shape = picture.width * picture.sample_aspect / picture.height;
  const bool half = squeezed.value_or(beside ? shape < kTwoBeside : shape > kTwoAbove);
  const double unsqueezed = !half ? 1.0 : beside ? 2.0 : 0.5;
  views.left.sample_aspect *= unsqueezed;
  views.right.sample_aspect *= unsqueezed;
  return views;
}

}  // namespace relievo
