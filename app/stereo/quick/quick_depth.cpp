// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/quick_depth.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/stereo/hole_filling.h"
#include "app/stereo/quick/disparity_count.h"
#include "app/stereo/quick/outline_snapping.h"
#include "app/stereo/quick/row_shift.h"

namespace relievo {
namespace {

constexpr int kSurveyCols = 160;     // in which the range is measured
constexpr int kWidest = 6;           // the largest disparity is the width divided by this
constexpr double kLeastFound = 0.4;  // share of the textured pixels that both views show; of two other pictures a tenth
constexpr double kOutliers = 0.005;
constexpr double kSamePlace = 0.25;  // pixels of the survey
constexpr int kVoteCols =
    320;  // the width at which the eyes' order is first examined, since a shot has to begin quickly
constexpr int kClearVoteCols = 640;  // the width if that is not conclusive
constexpr double kSpare = 0.2;       // of the range, on each side
constexpr double kLeastSpare = 1.5;  // pixels of the survey
constexpr float kHighest = 65535;
constexpr int kLookEvery = 4;  // pictures: something may have come nearer than all before
constexpr int kVotes = 6;      // pictures of a shot that are examined for the eyes' order

}  // namespace

Frame QuickDepth::depthOf(const Frame& left, const Frame& right) {
  const ViewSize size = reducedSize(left, kCols);
  readSmall(left, size, left_);
  if (cutsTo(left_)) {
    range_.reset();
    exposure_.reset();
    one_picture_ = false;
    steady_.begin();
    matched_cols_ = wished_cols_;
  }
  if (!range_) level(right, size);
  readStraight(right, size);
  if (swapped_) mirrorBoth();
  const bool fades = range_ && isBlank(left_);  // in the black, the last relief of the shot stays
  if (!range_) {                                // also where a shot comes out of the dark
    measureShot();
  } else if (!fades && ++since_look_ == kLookEvery) {
    lookAgain();
  }
  if (large_.cols != size.cols || large_.rows != size.rows) large_ = DisparityMap(size.cols, size.rows);
  if (range_ && !fades) match(large_);
  Frame depth = codesOf(large_);
  depth.pts = left.pts;
  depth.duration = left.duration;
  depth.sample_aspect = left.width * left.sample_aspect / left.height * size.rows / size.cols;
  return depth;
}

bool QuickDepth::cutsTo(const ViewPicture& left) {
  return cuts_.begins(left.cols, left.rows, [&](int x, int y) { return static_cast<float>(*left.pixel(x, y)); });
}

// Measured on the shot's first picture. The turn comes first: rows of a turned view have no common vertical shift.
void QuickDepth::level(const Frame& right, ViewSize size) {
  lower_ = 0;
  turned_ = 0;
  readStraight(right, size);
  turned_ = turnBetween(left_, right_);
  if (turned_ != 0) turnBack(right_, turned_);
  lower_ = static_cast<int>(std::lround(rowShift(left_, right_) * right.height / size.rows));
}

void QuickDepth::readStraight(const Frame& right, ViewSize size) {
  readSmall(right, size, right_, lower_);
  if (turned_ != 0) turnBack(right_, turned_);
}

// A mirror shows swapped views as views in order.
void QuickDepth::mirrorBoth() {
  mirror(left_);
  mirror(right_);
}

// Finds the range of the picture's disparities by matching a small one over the widest range.
std::optional<QuickDepth::Range> QuickDepth::reach() {
  const int cols = std::min(kSurveyCols, left_.cols), widest = std::max(1, cols / kWidest);
  const ViewSize size{cols, std::max(1, left_.rows * cols / left_.cols)};
  reduce(left_, size, small_left_);
  reduce(right_, size, small_right_);
  DisparityCount count(widest + 1);
  count.add(matching_.match(small_left_, small_right_, {-widest, widest}), small_left_);
  if (count.found() < kLeastFound) return std::nullopt;
  one_picture_ = count.isNone(kSamePlace);
  if (one_picture_) return std::nullopt;
  const DisparityCount::Reach reach = count.reach(kOutliers);
  const double spare = std::max(kLeastSpare, kSpare * (reach.high - reach.low));
  return Range{static_cast<float>((reach.low - spare) / cols), static_cast<float>((reach.high + spare) / cols)};
}

void QuickDepth::measureShot() {
  if (isBlank(left_) || isBlank(right_)) return;
  ViewTone left_tone, right_tone;
  left_tone.add(left_);
  right_tone.add(right_);
  const Exposure exposure = exposureBetween(left_tone, right_tone);
  if (exposure.isNeeded()) exposure_ = exposure;
  range_ = reach();
  since_look_ = 0;
  if (!range_) return;
  matched_ = *range_;
  eyes_.in_order /= 2;
  eyes_.swapped /= 2;
  votes_left_ = kVotes;
  orderEyes(kVoteCols);
}

// The strips that one eye alone sees lie on the other side of things if the views are swapped. One picture may show
// too few of them.
void QuickDepth::orderEyes(int most_cols) {
  const int cols = std::min(most_cols, left_.cols);
  const ViewSize size{cols, std::max(1, left_.rows * cols / left_.cols)};
  reduce(left_, size, small_left_);
  reduce(right_, size, small_right_);
  EyeVotes now = voteOnEyes(matching_.match(small_left_, small_right_, rangeAt(cols)), small_left_, small_right_);
  if (swapped_) std::swap(now.in_order, now.swapped);
  --votes_left_;
  eyes_ += now;
  if (swapped_ ? !eyes_.areInOrder() : !eyes_.areSwapped()) return;
  swapped_ = !swapped_;
  mirrorBoth();
  range_ = Range{-matched_.high, -matched_.low};
  matched_ = *range_;
  steady_.begin();
}

void QuickDepth::lookAgain() {
  since_look_ = 0;
  const auto now = reach();
  one_picture_ = false;  // of the shot: something else in it has depth
  if (now) matched_ = {std::min(range_->low, now->low), std::max(range_->high, now->high)};
  if (now && votes_left_ > 0) orderEyes(isOrderTold() ? kVoteCols : kClearVoteCols);
}

DisparityRange QuickDepth::rangeAt(int cols) const noexcept {
  const auto width = static_cast<float>(cols);
  return {static_cast<int>(std::floor(matched_.low * width)), static_cast<int>(std::ceil(matched_.high * width))};
}

void QuickDepth::match(DisparityMap& large) {
  if (exposure_) balance(right_, *exposure_);
  const int cols = std::min(matched_cols_, left_.cols);
  const ViewSize size{cols, std::max(1, left_.rows * cols / left_.cols)};
  reduce(left_, size, small_left_);
  reduce(right_, size, small_right_);
  filled_ = matching_.match(small_left_, small_right_, rangeAt(cols));
  fillHoles(filled_, small_left_);
  enlarge(filled_, small_left_, left_, large);
  sub_pixel_.refine(large, left_, right_);
  steady_.steady(large, left_, right_);
}

Frame QuickDepth::codesOf(const DisparityMap& map) const {
  auto codes = std::make_shared<std::vector<std::uint16_t>>(map.size(), static_cast<std::uint16_t>(kHighest / 2));
  if (range_) {
    const auto width = static_cast<float>(map.cols);
    const float low = range_->low * width, scale = 1 / ((range_->high - range_->low) * width);
    std::ranges::transform(map.pixels, codes->begin(), [&](float d) {
      return static_cast<std::uint16_t>(nearest(std::clamp((d - low) * scale, 0.0F, 1.0F) * kHighest));
    });
    if (swapped_) {
      for (auto row = codes->begin(); row != codes->end(); row += map.cols) std::reverse(row, row + map.cols);
    }
  }
  return grayFrame(std::move(codes), map.cols, map.rows);
}

}  // namespace relievo
