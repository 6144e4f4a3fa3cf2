// SPDX-License-Identifier: Apache-2.0
// Guesses what a film's floating-point numbers are: distances or disparities.
#pragma once

#include <optional>
#include <string_view>

#include "app/media/reading/depth_reading.h"

namespace relievo {

// True if the path's last three names say disparity ("disp", "parallax"), false if they say distance ("depth", "dist",
// "zbuf"), nullopt if they say neither.
[[nodiscard]] std::optional<bool> namesDisparity(std::string_view path);

// True if one of the path's last three names has the word disparity ("disp.png", "disparity/0001.png") and none behind
// it says depth.
[[nodiscard]] bool saysDisparity(std::string_view path);

// True if the numbers may be a room's distances in metres, and are hardly disparities in pixels: all from 0.1 to 16.
[[nodiscard]] bool mayBeMetres(const Frame& depth, const CodeCount& count);

// True if the smallest number may be a distance in metres: at least 0.1.
[[nodiscard]] bool areFromAfar(const Frame& depth, const CodeCount& count);

// True if disparities make the picture's lower part clearly nearer than its upper one.
[[nodiscard]] bool looksLikeDisparity(const Frame& depth, const CodeCount& count);

// True if distances do so.
[[nodiscard]] bool looksLikeDistance(const Frame& depth, const CodeCount& count);

// True if the largest number is so many times the smallest that their zero is arbitrary: neither a distance of 0 nor a
// disparity of infinitely far.
[[nodiscard]] bool areRelative(const CodeCount& count);

// The code of a sensor's 65535, which is no distance, where an array was divided by 1000 or not: 65.535 or 65535 as the
// highest number of all.
[[nodiscard]] std::optional<std::uint32_t> fullCode(const Frame& depth, const CodeCount& count);

// For codes that stand for floats (Frame::value_per_code), or are the numbers themselves. Distances are metres, or
// millimetres if half of them are beyond 200. Disparities follow the inverse law unless their range shows an arbitrary
// zero. Numbers on both sides of 0 are relative disparities or heights. What `said` states overrides the guess: unit=
// makes them distances, law= or polarity= disparities.
[[nodiscard]] DepthReading readFloats(const Frame& depth, const CodeCount& count, bool disparity,
                                      const CalibrationLayers& said);

// Converts `unit` and `codes`, which users state in the file's numbers, to the picture's codes.
void scaleToCodes(CalibrationLayers& said, const Frame& depth);

}  // namespace relievo
