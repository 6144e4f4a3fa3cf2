// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/block_matching.h"

#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace relievo {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr int kSteps = 16;     // of the matcher's results, in a pixel
constexpr int kMultiple = 16;  // the matcher's counts of disparities

int countIn(DisparityRange range) {
  return (range.highest - range.lowest + kMultiple) / kMultiple * kMultiple;
}

cv::Mat pixelsOf(cv::StereoMatcher& matcher, const cv::Mat& left, const cv::Mat& right, DisparityRange range) {
  cv::Mat found, pixels;
  matcher.compute(left, right, found);
  found.convertTo(pixels, CV_32F, 1.0 / kSteps);
  pixels.setTo(cv::Scalar(static_cast<double>(kNothing)), found < range.lowest * kSteps);
  return pixels;
}

}  // namespace

cv::Mat asMat(const ViewPicture& view) {
  return {view.rows, view.cols, CV_8UC3, const_cast<std::uint8_t*>(view.bytes.data())};
}

cv::Mat lumaOf(const ViewPicture& view) {
  cv::Mat luma;
  cv::extractChannel(asMat(view), luma, 0);
  return luma;
}

cv::Mat matchPlainly(const cv::Mat& left, const cv::Mat& right, DisparityRange range) {
  constexpr int kPlain = 5, kArea = kPlain * kPlain;
  const auto matcher = cv::StereoSGBM::create(range.lowest, countIn(range), kPlain, 8 * kArea, 32 * kArea, 1, 63, 10,
                                              100, 32, cv::StereoSGBM::MODE_SGBM);
  return pixelsOf(*matcher, left, right, range);
}

cv::Mat matchBlocks(const cv::Mat& left, const cv::Mat& right, DisparityRange range) {
  constexpr int kWide = 21;  // pixels: the default of StereoBM
  const auto matcher = cv::StereoBM::create(countIn(range), kWide);
  matcher->setMinDisparity(range.lowest);
  matcher->setUniquenessRatio(10);
  matcher->setSpeckleWindowSize(100);
  matcher->setSpeckleRange(32);
  matcher->setDisp12MaxDiff(1);
  return pixelsOf(*matcher, left, right, range);
}

}  // namespace relievo
