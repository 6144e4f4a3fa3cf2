// SPDX-License-Identifier: Apache-2.0
#include "app/estimate/steady_relief.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace relievo {
namespace {

constexpr int kMotionCols = 320;             // wider pictures are scaled down to look for motion
constexpr double kLow = 0.15, kHigh = 0.85;  // of the relief: the farthest and nearest twentieth
constexpr std::size_t kTwentieth = 20;
constexpr double kStaying = 0.15;   // share of the points: if fewer stay, the picture does not continue the last one
constexpr int kMemory = 48;         // pictures over which a point's height is averaged
constexpr int kStrays = 5;          // pictures
constexpr double kStray = 6;        // standard deviations
constexpr float kNewShare = 0.25F;  // of a picture in the mean along the motion
constexpr float kSameHeight = 0.06F, kSameColor = 16;  // shares of the relief, codes
constexpr float kHighest = 65535;

GrayPicture grayOf(const RawPicture& picture) {
  std::vector<std::uint8_t> luma(picture.size());
  for (std::size_t i = 0; i < luma.size(); ++i) {
    const std::uint8_t* const rgb = picture.pixel(i);
    luma[i] = static_cast<std::uint8_t>((77 * rgb[0] + 150 * rgb[1] + 29 * rgb[2]) >> 8);
  }
  const int cols = std::min(picture.cols, kMotionCols);
  const int rows = std::max(static_cast<int>(std::lround(static_cast<double>(cols) * picture.rows / picture.cols)), 1);
  return scaledTo(cols, rows, luma.data(), picture.cols, picture.rows);
}

// Interpolates a map that shows the same view as a picture of `cols` x `rows`, at a position of the picture.
double valueAt(const std::vector<float>& map, int map_cols, int map_rows, const TrackedPoint& place,
               const GrayPicture& gray) {
  const double x = std::clamp((place.x + 0.5) * map_cols / gray.cols - 0.5, 0.0, map_cols - 1.0);
  const double y = std::clamp((place.y + 0.5) * map_rows / gray.rows - 0.5, 0.0, map_rows - 1.0);
  const int c = std::min(static_cast<int>(x), map_cols - 2), r = std::min(static_cast<int>(y), map_rows - 2);
  const auto at = [&](int i, int j) {
    return static_cast<double>(
        map[static_cast<std::size_t>(r + j) * static_cast<std::size_t>(map_cols) + static_cast<std::size_t>(c + i)]);
  };
  const double s = x - c, t = y - r;
  return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

// Heights 0 and 1 are the first picture's farthest and nearest twentieth. Beyond them the steps become ever smaller.
std::uint16_t codeOf(float height) {
  constexpr auto kRest = static_cast<float>(1 - kHigh), kSpan = static_cast<float>(kHigh - kLow);
  const float share = static_cast<float>(kLow) + kSpan * height;
  const float beyond = std::max(std::abs(share - 0.5F) - 0.5F * kSpan, 0.0F);
  const float inside = std::min(std::abs(share - 0.5F), 0.5F * kSpan);
  const float away = inside + kRest * (1 - std::exp(-beyond / kRest));
  return static_cast<std::uint16_t>(std::lround((0.5F + std::copysign(away, share - 0.5F)) * kHighest));
}

}  // namespace

DepthCalibration SteadyRelief::calibration() {
  return {.law = DepthLaw::Linear, .range = ColorRange::Full, .bits = 16};
}

Frame SteadyRelief::add(const RawPicture& picture, const DepthEstimate& estimate) {
  GrayPicture gray = grayOf(picture);
  const bool cut = cuts_.begins(gray.cols, gray.rows, [&](int c, int r) { return static_cast<float>(gray.at(c, r)); });
  cols_ = estimate.cols;
  rows_ = estimate.rows;
  const bool goes_on = !cut && anchored_ && follow(gray, estimate);
  if (!goes_on) {
    if (cut || anchored_) ++shots_;
    begin(estimate);
  }
  Heights heights(estimate.values.size());
  std::ranges::transform(estimate.values, heights.begin(),
                         [this](float value) { return static_cast<float>(fit_.at(static_cast<double>(value))); });
  if (goes_on) smooth(heights, gray);
  heights_ = std::move(heights);
  plant(gray);
  before_ = std::move(gray);

  auto codes = std::make_shared<std::vector<std::uint16_t>>(heights_.size());
  std::ranges::transform(heights_, codes->begin(), codeOf);
  return grayFrame(std::move(codes), cols_, rows_);
}

// The first picture sets the shot's scale and offset.
void SteadyRelief::begin(const DepthEstimate& estimate) {
  std::vector<float> values = estimate.values;
  const std::size_t far = values.size() / kTwentieth, near = values.size() - 1 - far;
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(far));
  const double low = static_cast<double>(values[far]);
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(near));
  const double span = static_cast<double>(values[near]) - low;
  const bool flat = !(span > 1e-6 * std::abs(low));
  fit_ = flat ? ReliefFit{.scale = 0, .offset = 0.5} : ReliefFit{.scale = 1 / span, .offset = -low / span};
  least_scale_ = most_scale_ = fit_.scale;
  anchored_ = false;
  tracks_.clear();
}

// Finds the estimate's scale and offset from the points; false if the picture does not continue the last one.
bool SteadyRelief::follow(const GrayPicture& gray, const DepthEstimate& estimate) {
  motion_ = before_->bytes == gray.bytes ? std::vector<Motion>(gray.size()) : motionBetween(*before_, gray);
  const std::size_t had = tracks_.points().size();
  tracks_.follow(*before_, gray, motion_);
  const std::vector<TrackedPoint>& points = tracks_.points();
  if (static_cast<double>(points.size()) < kStaying * static_cast<double>(had)) return false;
  std::vector<FitSample> samples;
  samples.reserve(points.size());
  for (const TrackedPoint& point : points) {
    constexpr int kTrusted = 8;
    constexpr double kUntextured = 0.3;
    samples.push_back({.estimate = valueAt(estimate.values, cols_, rows_, point, gray),
                       .height = point.height,
                       .of = std::min(point.age, kMemory),
                       .weight = (point.textured ? 1 : kUntextured) * std::min(point.age, kTrusted)});
  }
  const auto fit = fitRelief(samples, fit_);
  if (!fit) return false;
  fit_ = *fit;
  least_scale_ = std::min(least_scale_, fit_.scale);
  most_scale_ = std::max(most_scale_, fit_.scale);
  if (least_scale_ > 0) wandered_ = std::max(wandered_, most_scale_ / least_scale_ - 1);
  std::size_t i = 0;
  for (TrackedPoint& point : tracks_.points()) {
    const double now = fit_.at(samples[i++].estimate);
    point.strays = std::abs(now - point.height) > std::max(kStray * fit_.rest, 0.01) ? point.strays + 1 : 0;
    point.age = std::min(point.age + 1, kMemory);
    point.height += (now - point.height) / point.age;
  }
  return true;
}

// Replaces points of objects that have come nearer or gone away, and adds points where there are none.
void SteadyRelief::plant(const GrayPicture& gray) {
  std::erase_if(tracks_.points(), [](const TrackedPoint& point) { return point.strays >= kStrays; });
  tracks_.seed(gray);
  std::size_t textured = 0;
  for (TrackedPoint& point : tracks_.points()) {
    textured += point.textured ? 1 : 0;
    if (point.age > 0) continue;
    point.height = valueAt(heights_, cols_, rows_, point, gray);
    point.age = 1;
  }
  anchored_ = fit_.scale > 0 && textured >= kLeastSamples;
}

// Averages with the previous steady picture where that shows the same.
void SteadyRelief::smooth(Heights& heights, const GrayPicture& gray) const {
  const float to_x = static_cast<float>(cols_) / static_cast<float>(gray.cols);
  const float to_y = static_cast<float>(rows_) / static_cast<float>(gray.rows);
  cv::Mat from_x(rows_, cols_, CV_32F), from_y(rows_, cols_, CV_32F), moved;
  std::vector<std::uint8_t> same(heights.size());
  for (int r = 0; r < rows_; ++r) {
    const int y = std::clamp(static_cast<int>((static_cast<float>(r) + 0.5F) / to_y), 0, gray.rows - 1);
    for (int c = 0; c < cols_; ++c) {
      const int x = std::clamp(static_cast<int>((static_cast<float>(c) + 0.5F) / to_x), 0, gray.cols - 1);
      const Motion& v =
          motion_[static_cast<std::size_t>(y) * static_cast<std::size_t>(gray.cols) + static_cast<std::size_t>(x)];
      const float at_x = static_cast<float>(c) + v.x * to_x, at_y = static_cast<float>(r) + v.y * to_y;
      from_x.at<float>(r, c) = at_x;
      from_y.at<float>(r, c) = at_y;
      const int was_x = x + static_cast<int>(std::lround(v.x)), was_y = y + static_cast<int>(std::lround(v.y));
      if (was_x < 0 || was_y < 0 || was_x >= gray.cols || was_y >= gray.rows) continue;
      const bool inside =
          at_x >= 0 && at_y >= 0 && at_x <= static_cast<float>(cols_ - 1) && at_y <= static_cast<float>(rows_ - 1);
      const int change = std::abs(gray.at(x, y) - before_->at(was_x, was_y));
      same[static_cast<std::size_t>(r) * static_cast<std::size_t>(cols_) + static_cast<std::size_t>(c)] =
          inside && static_cast<float>(change) < kSameColor ? 1 : 0;
    }
  }
  const cv::Mat before(rows_, cols_, CV_32F, const_cast<float*>(heights_.data()));
  cv::remap(before, moved, from_x, from_y, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  const auto* const was = moved.ptr<float>();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const float away = std::min(std::abs(heights[i] - was[i]) / kSameHeight, 1.0F);
    const float share = same[i] != 0 ? kNewShare + (1 - kNewShare) * away * away : 1;
    heights[i] = was[i] + share * (heights[i] - was[i]);
  }
}

}  // namespace relievo
