// SPDX-License-Identifier: Apache-2.0
// Semi-global matching by OpenCV, seen from both eyes: for a shot's range, and as what the author's depth is held
// against. The depth itself comes from QuickMatching, which keeps more steps where the outlines are.
#pragma once

#include <opencv2/core.hpp>

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// The picture's bytes as OpenCV takes them, not copied.
[[nodiscard]] cv::Mat asMat(const ViewPicture& view);
[[nodiscard]] cv::Mat lumaOf(const ViewPicture& view);

// OpenCV's matcher alone (CV_32F): pixels without a match are -infinity.
[[nodiscard]] cv::Mat matchAlone(const cv::Mat& left, const cv::Mat& right, DisparityRange range, int block);

// The same as OpenCV's documentation uses it, with its own left-right check, uniqueness check and speckle filter.
[[nodiscard]] cv::Mat matchPlainly(const cv::Mat& left, const cv::Mat& right, DisparityRange range);
// OpenCV's block matching, likewise.
[[nodiscard]] cv::Mat matchBlocks(const cv::Mat& left, const cv::Mat& right, DisparityRange range);

// From both eyes: a point is `seen` if the right view finds it where the left view did, to within a pixel, and if it is
// no speck. Other pixels keep what the left view found, or -infinity.
[[nodiscard]] DisparityMap matchFromBoth(const ViewPicture& left, const ViewPicture& right, DisparityRange range);

}  // namespace relievo
