// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/block_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace relievo {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr int kSteps = 16;     // of the matcher's results, in a pixel
constexpr int kMultiple = 16;  // the matcher's counts of disparities
constexpr float kAgree = 1;    // pixels
constexpr int kSpeck = 60;     // pixels of a speck, in a picture of 450 x 375
constexpr double kSpeckOf = 450.0 * 375;
constexpr int kBlock = 3;
constexpr int kSlope = 5, kStep = 32;  // costs of a disparity's change by one and by more, for each byte of a block
constexpr int kCap = 63;               // levels: of the gradient

}  // namespace

cv::Mat asMat(const ViewPicture& view) {
  return {view.rows, view.cols, CV_8UC3, const_cast<std::uint8_t*>(view.bytes.data())};
}

cv::Mat lumaOf(const ViewPicture& view) {
  cv::Mat luma;
  cv::extractChannel(asMat(view), luma, 0);
  return luma;
}

namespace {

int countIn(DisparityRange range) {
  return (range.highest - range.lowest + kMultiple) / kMultiple * kMultiple;
}

// Adds margins on both sides, so that a match may lie outside the picture.
cv::Mat matched(cv::StereoSGBM& matcher, const cv::Mat& left, const cv::Mat& right, DisparityRange range) {
  const int margin = std::max({std::abs(range.lowest), std::abs(range.highest), 1}) + kMultiple;
  cv::Mat wide_left, wide_right, found;
  cv::copyMakeBorder(left, wide_left, 0, 0, margin, margin, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(right, wide_right, 0, 0, margin, margin, cv::BORDER_REPLICATE);
  matcher.compute(wide_left, wide_right, found);
  const cv::Mat inner = found.colRange(margin, margin + left.cols);
  cv::Mat pixels;
  inner.convertTo(pixels, CV_32F, 1.0 / kSteps);
  pixels.setTo(cv::Scalar(static_cast<double>(kNothing)), inner < range.lowest * kSteps);
  return pixels;
}

}  // namespace

cv::Mat matchAlone(const cv::Mat& left, const cv::Mat& right, DisparityRange range, int block) {
  const int smooth = left.channels() * block * block;
  const auto matcher = cv::StereoSGBM::create(range.lowest, countIn(range), block, kSlope * smooth, kStep * smooth, -1,
                                              kCap, 0, 0, 0, cv::StereoSGBM::MODE_HH);
  return matched(*matcher, left, right, range);
}

namespace {

// Without margins: pixels that the matcher itself rejects are holes.
cv::Mat asTheyAre(cv::StereoMatcher& matcher, const cv::Mat& left, const cv::Mat& right, DisparityRange range) {
  cv::Mat found, pixels;
  matcher.compute(left, right, found);
  found.convertTo(pixels, CV_32F, 1.0 / kSteps);
  pixels.setTo(cv::Scalar(static_cast<double>(kNothing)), found < range.lowest * kSteps);
  return pixels;
}

}  // namespace

cv::Mat matchPlainly(const cv::Mat& left, const cv::Mat& right, DisparityRange range) {
  constexpr int kPlain = 5, kArea = kPlain * kPlain;
  const auto matcher = cv::StereoSGBM::create(range.lowest, countIn(range), kPlain, 8 * kArea, 32 * kArea, 1, 63, 10,
                                              100, 32, cv::StereoSGBM::MODE_SGBM);
  return asTheyAre(*matcher, left, right, range);
}

cv::Mat matchBlocks(const cv::Mat& left, const cv::Mat& right, DisparityRange range) {
  constexpr int kWide = 21;  // pixels: the default of StereoBM
  const auto matcher = cv::StereoBM::create(countIn(range), kWide);
  matcher->setMinDisparity(range.lowest);
  matcher->setUniquenessRatio(10);
  matcher->setSpeckleWindowSize(100);
  matcher->setSpeckleRange(32);
  matcher->setDisp12MaxDiff(1);
  return asTheyAre(*matcher, left, right, range);
}

DisparityMap matchFromBoth(const ViewPicture& left, const ViewPicture& right, DisparityRange range) {
  const cv::Mat a = asMat(left), b = asMat(right);
  std::array<cv::Mat, 2> found;
  cv::parallel_for_(cv::Range(0, 2), [&](const cv::Range& part) {
    for (int i = part.start; i < part.end; ++i) {
      if (i == 0) {
        found[0] = matchAlone(a, b, range, kBlock);
        continue;
      }
      cv::Mat mirrored_left, mirrored_right;
      cv::flip(a, mirrored_left, 1);
      cv::flip(b, mirrored_right, 1);
      cv::flip(matchAlone(mirrored_right, mirrored_left, range, kBlock), found[1], 1);
    }
  });
  DisparityMap map(left.cols, left.rows);
  cv::Mat specks(map.rows, map.cols, CV_16S);
  for (int r = 0; r < map.rows; ++r) {
    const auto* of_left = found[0].ptr<float>(r);
    const auto* of_right = found[1].ptr<float>(r);
    for (int c = 0; c < map.cols; ++c) {
      const float d = of_left[c];
      map.pixels[map.at(c, r)] = d;
      map.from_right[map.at(c, r)] = of_right[c];
      const int there = d == kNothing ? -1 : static_cast<int>(std::lround(static_cast<float>(c) - d));
      const bool agrees = there >= 0 && there < map.cols && std::abs(of_right[there] - d) <= kAgree;
      specks.at<short>(r, c) = agrees ? cv::saturate_cast<short>(d * kSteps) : std::numeric_limits<short>::min();
    }
  }
  const auto speck = static_cast<int>(kSpeck * static_cast<double>(map.size()) / kSpeckOf);
  cv::filterSpeckles(specks, std::numeric_limits<short>::min(), speck, kSteps);
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) {
      map.seen[map.at(c, r)] = specks.at<short>(r, c) != std::numeric_limits<short>::min() ? 1 : 0;
    }
  }
  return map;
}

}  // namespace relievo
