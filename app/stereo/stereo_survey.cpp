// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/stereo_survey.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "app/stereo/block_matching.h"
#include "app/stereo/quick/disparity_count.h"
#include "hal/media/samples.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kLookEvery = std::chrono::milliseconds(500);
constexpr std::size_t kMostLooks = 24;  // kept of a shot; whenever there are more, every second one is dropped
constexpr int kKeptCols = 640;          // of what is kept: in which the eyes are told apart
constexpr int kReducedCols = 320;       // in which the range is measured
constexpr std::size_t kMostAsked = 8;   // pictures of a shot that are examined for the eyes' order
constexpr int kWidest = 6;              // the largest disparity is the width divided by this
constexpr double kSame = 0.75;          // levels between two views, on average
constexpr double kSamePlace = 0.5;      // pixels of what is kept reduced
constexpr double kLeastShift = 0.5;     // pixels that are worth correcting
constexpr double kBadRest = 1.5;        // pixels
constexpr const char* kSamePicture = "both views are the same picture: there is no depth to be had from it";

ViewPicture reduced(const ViewPicture& view, int most_cols) {
  const int cols = std::min(view.cols, most_cols);
  ViewPicture small(cols, std::max(1, view.rows * cols / view.cols));
  cv::Mat result = asMat(small);
  cv::resize(asMat(view), result, result.size(), 0, 0, cv::INTER_AREA);
  return small;
}

double difference(const ViewPicture& a, const ViewPicture& b) {
  return cv::norm(asMat(a), asMat(b), cv::NORM_L1) / static_cast<double>(a.size());
}

// The alignment of the reduced views.
Alignment scaledBy(Alignment alignment, double scale) {
  alignment.shift *= scale;
  return alignment;
}

}  // namespace

const ShotPlan& StereoPlan::at(MediaTime time) const {
  const auto after = std::ranges::upper_bound(shots, time, {}, &ShotPlan::begin);
  return after == shots.begin() ? shots.front() : *std::prev(after);
}

bool StereoSurvey::beginsShot(const Frame& left) {
  const Component& k = brightnessOf(left);
  const float scale = 255.0F / static_cast<float>((1U << k.bits) - 1);
  return cuts_.begins(left.width, left.height,
                      [&](int x, int y) { return static_cast<float>(codeAt(left, k, x, y)) * scale; });
}

Result<void> StereoSurvey::add(const Frame& left, const Frame& right) {
  if (plan_.cols == 0) {
    plan_.cols = left.width;
    plan_.rows = left.height;
  }
  for (const Frame* view : {&left, &right}) {
    if (view->width == plan_.cols && view->height == plan_.rows) continue;
    return fail(ErrorCode::Unsupported, "the picture size changes; split the film there");
  }
  const bool begins = beginsShot(left);
  if (begins) beginShot(left.pts);
  if (begins || left.pts >= looked_at_ + kLookEvery) look(left, right);
  return {};
}

void StereoSurvey::beginShot(MediaTime begin) {
  endShot();
  plan_.shots.push_back({.begin = begin});
  pairs_.clear();
  left_tone_ = right_tone_ = {};
  looked_.clear();
  stride_ = 1;
  until_next_ = 0;
}

void StereoSurvey::look(const Frame& left, const Frame& right) {
  looked_at_ = left.pts;
  if (until_next_-- > 0) return;
  until_next_ = stride_ - 1;
  const ViewPicture a = readView(left), b = readView(right);
  ++pictures_;
  const bool left_black = isBlank(a), right_black = isBlank(b);
  if (left_black != right_black) ++one_black_;
  if (left_black || right_black) return;
  if (difference(a, b) < kSame) ++alike_;
  left_tone_.add(a);
  right_tone_.add(b);
  const auto found = findPairs(a, b);
  pairs_.insert(pairs_.end(), found.begin(), found.end());
  looked_.push_back({reduced(a, kKeptCols), reduced(b, kKeptCols)});
  if (looked_.size() < kMostLooks) return;
  std::size_t kept = 1;  // the first stays: a picture that is moved to itself loses its bytes
  for (std::size_t i = 2; i < looked_.size(); i += 2) looked_[kept++] = std::move(looked_[i]);
  looked_.resize(kept);
  stride_ *= 2;
}

void StereoSurvey::endShot() {
  if (plan_.shots.empty() || looked_.empty()) return;
  ShotPlan& shot = plan_.shots.back();
  const AlignmentFit fit = fitAlignment(pairs_);
  if (fit.points > 0 && fit.rest > kBadRest) ++unfitting_;
  shot.is_aligned = fit.points > 0 && fit.rest <= kBadRest && fit.alignment.reach(plan_.cols, plan_.rows) > kLeastShift;
  if (shot.is_aligned) shot.alignment = fit.alignment;
  shot.exposure = exposureBetween(left_tone_, right_tone_);
  shot.is_balanced = shot.exposure.isNeeded();
  measureRange(shot);
  askEyes(shot);
}

// By matching small pictures over the widest range.
void StereoSurvey::measureRange(ShotPlan& shot) {
  constexpr double kLeastFound = 0.1, kOutliers = 0.005, kSpare = 0.05;
  const int cols = std::min(looked_.front().left.cols, kReducedCols), widest = std::max(cols / kWidest, 1);
  const double scale = static_cast<double>(plan_.cols) / cols;
  const double kept = static_cast<double>(plan_.cols) / looked_.front().left.cols;
  DisparityCount count(widest + 1);
  for (Looked& looked : looked_) {
    if (shot.is_balanced) balance(looked.right, shot.exposure);
    if (shot.is_aligned) looked.right = aligned(looked.right, scaledBy(shot.alignment, 1 / kept));
    const ViewPicture left = reduced(looked.left, cols);
    count.add(quick_.match(left, reduced(looked.right, cols), {-widest, widest}), left);
  }
  shot.has_depth = count.found() > kLeastFound;
  if (shot.has_depth && count.isNone(kSamePlace)) {
    shot.has_depth = false;
    ++same_;
  }
  const DisparityCount::Reach reach = count.reach(kOutliers);
  const double low = scale * reach.low, high = scale * reach.high;
  const double spare = scale + kSpare * (high - low);
  shot.range = {static_cast<int>(std::floor(low - spare)), static_cast<int>(std::ceil(high + spare))};
}

// An area that only one eye sees is a few pixels wide, so larger pictures are used than for the range.
void StereoSurvey::askEyes(const ShotPlan& shot) {
  if (!shot.has_depth) return;
  const int cols = looked_.front().left.cols;
  const auto inKept = [&](int disparity) { return static_cast<double>(disparity) * cols / plan_.cols; };
  const DisparityRange range{static_cast<int>(std::floor(inKept(shot.range.lowest))),
                             static_cast<int>(std::ceil(inKept(shot.range.highest)))};
  const std::size_t step = (looked_.size() + kMostAsked - 1) / kMostAsked;
  for (std::size_t i = 0; i < looked_.size(); i += step)
    eyes_ += voteOnEyes(quick_.match(looked_[i].left, looked_[i].right, range), looked_[i].left, looked_[i].right);
}

void StereoSurvey::explain() {
  std::size_t moved = 0, toned = 0, flat = 0;
  const ShotPlan *most = nullptr, *brightest = nullptr;
  const auto reach = [&](const ShotPlan& shot) { return shot.alignment.reach(plan_.cols, plan_.rows); };
  const auto contrast = [](const ShotPlan& shot) { return std::abs(std::log(shot.exposure.gain[0])); };
  for (const ShotPlan& shot : plan_.shots) {
    flat += shot.has_depth ? 0 : 1;
    moved += shot.is_aligned ? 1 : 0;
    toned += shot.is_balanced ? 1 : 0;
    if (shot.is_aligned && (most == nullptr || reach(shot) > reach(*most))) most = &shot;
    if (shot.is_balanced && (brightest == nullptr || contrast(shot) > contrast(*brightest))) brightest = &shot;
  }
  const auto of = print("of %zu %s", plan_.shots.size(), plan_.shots.size() == 1 ? "shot" : "shots");
  if (most != nullptr) {
    constexpr double kDegrees = 57.29577951;
    plan_.notes.push_back(print(
        "the right view was straightened in %zu %s: by up to %.1f pixels in height, %.2f degrees, %.1f %% in size",
        moved, of.c_str(), std::abs(most->alignment.shift), kDegrees * std::abs(most->alignment.turn),
        100 * std::abs(most->alignment.zoom - 1)));
  }
  if (brightest != nullptr) {
    plan_.notes.push_back(print("the right view's exposure was balanced in %zu %s: contrast by up to %.2f times", toned,
                                of.c_str(), brightest->exposure.gain[0]));
  }
  if (unfitting_ > 0) {
    plan_.notes.push_back(
        print("in %d %s the rows of the two views do not match and could not be aligned", unfitting_, of.c_str()));
  }
  if (same_ > 0)
    plan_.notes.push_back(print("%zu %s are flat: both views are the same picture there", same_, of.c_str()));
  if (flat > same_)
    plan_.notes.push_back(
        print("%zu %s are flat: the two views show nothing in common there", flat - same_, of.c_str()));
}

Result<StereoPlan> StereoSurvey::finish() {
  endShot();
  if (plan_.shots.empty()) return fail(ErrorCode::NotFound, "there are no pictures in it");
  if (2 * one_black_ > pictures_) {
    return fail(ErrorCode::Unsupported, "one of its two views is black: there is no depth to be had from it");
  }
  if (2 * alike_ > pictures_) {
    return fail(ErrorCode::Unsupported, kSamePicture);
  }
  const bool is_flat = std::ranges::none_of(plan_.shots, &ShotPlan::has_depth);
  if (is_flat && same_ > 0) return fail(ErrorCode::Unsupported, kSamePicture);
  if (is_flat) {
    return fail(
        ErrorCode::Unsupported,
        "its views have nothing in common; it is no film of two views, or they have another layout: see --packing");
  }
  plan_.views_swapped = eyes_.areSwapped();
  plan_.order_known = plan_.views_swapped || eyes_.areInOrder();
  explain();
  return std::move(plan_);
}

}  // namespace relievo
