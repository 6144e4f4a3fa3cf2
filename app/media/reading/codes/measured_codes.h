// SPDX-License-Identifier: Apache-2.0
// What tells measured distances from brightness in 16-bit codes.
#pragma once

#include <cstdint>
#include <optional>

#include "app/media/reading/code_count.h"

namespace relievo {

// A rendering that reaches only the upper half is distinguished by the gap that a sensor leaves between its hole code
// (0) and its nearest reading.
inline constexpr std::uint32_t kMaybeStretched = 0x8000;

// Most sensors see less far than 12 m, and half of a scene within 5 m.
inline constexpr std::uint32_t kFarthestMm = 12000, kMiddleMm = 5000;

// A sensor's picture holds many different codes.
[[nodiscard]] bool isMeasured(const CodeCount& count);

// True for codes that leave out a large part of their range, or are a stereo camera's.
[[nodiscard]] bool isDistances(const CodeCount& count);

// True if, at 5000 codes a metre, more of the view would be nearer than Kinect and Xtion see, .35 m, than a hand in
// front of it or one picture of many. Those are the sensors whose recordings have as many.
[[nodiscard]] bool beginsNearerThanKinectSees(const CodeCount& count);

// True for distances in mm of a room which, at 5000 codes a metre, would begin nearer than a Kinect sees.
[[nodiscard]] bool isTooNearForKinect(const CodeCount& count);

// A stereo camera (RealSense) measures in even steps of disparity, so that twice as far away its distances are four
// times as far apart, and half as many of them lie in twice the range. Of a picture whose codes reach the highest ones
// this tells distances from brightness, which has no fewer shades at its bright end.
[[nodiscard]] bool hasStereoSteps(const CodeCount& count);

// A stereo camera's focal length times its baseline times its steps a pixel, in codes: the product of two neighbouring
// distances over their difference. Nullopt unless that is the same all over the picture. Cameras that write mm have at
// most 1.7 million (RealSense, Kinect), TUM's Kinects 1.86 million, those of 10000 codes a metre over 2.2 million
// (RealSense D405, Xtion).
[[nodiscard]] std::optional<double> stereoConstant(const CodeCount& count);
// The kind that the constant of a picture of so many columns shows; null if it shows none. Kinect and Xtion have 640
// columns; in pictures of 1280 a RealSense D455 in mm has the constant of TUM's Kinects.
[[nodiscard]] const KnownKind* kindBySteps(const CodeCount& count, int cols);

}  // namespace relievo
