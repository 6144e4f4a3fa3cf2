// SPDX-License-Identifier: Apache-2.0
// OpenCV's matchers, which the depth of QuickMatching is compared with.
#pragma once

#include <opencv2/core.hpp>

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// The picture's bytes as OpenCV takes them, not copied.
[[nodiscard]] cv::Mat asMat(const ViewPicture& view);
[[nodiscard]] cv::Mat lumaOf(const ViewPicture& view);

// OpenCV's semi-global matching as its documentation uses it, with its own left-right check, uniqueness check and
// speckle filter (CV_32F): pixels without a match are -infinity.
[[nodiscard]] cv::Mat matchPlainly(const cv::Mat& left, const cv::Mat& right, DisparityRange range);
// OpenCV's block matching, likewise.
[[nodiscard]] cv::Mat matchBlocks(const cv::Mat& left, const cv::Mat& right, DisparityRange range);

}  // namespace relievo
