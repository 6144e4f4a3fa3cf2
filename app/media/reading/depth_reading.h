// SPDX-License-Identifier: Apache-2.0
// Determines from a depth track's first informative picture what its codes mean, unless that is stated.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "app/media/reading/code_count.h"
#include "app/media/reading/known_kind.h"
#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

// Where two readings are as likely, the safer one is taken and `offer` names the other's option.
struct DepthReading {
  CalibrationSettings settings;     // a calibration layer below everything that was stated
  const KnownKind* kind = nullptr;  // as the codes show
  std::string why;                  // one line; empty if the picture revealed nothing
  std::string offer;                // one line; empty if there is no doubt
  bool unsure = false;              // `offer` is as likely
  std::string doubt;                // one line: what is left out of the pictures' range; empty if nothing is
  bool by_view = false;             // the near end is the one that makes the view nearer below
  bool near_high = false;           // high is near whatever the view shows: disparities are never the other way round
  std::string black;                // of a film of brightness: the codes that are holes if near is dark; empty if none
};

// Whether a layer defines what a code is, so that the picture need not.
[[nodiscard]] bool definesCodes(const CalibrationLayers& said);

// 16-bit codes that leave out a large part of their range are not brightness but measurements: distances, or a Kinect's
// raw disparities. YUV that states no range has the full one if it uses codes outside the limited one. Where `said`
// defines what a code is, near and far alone are read. `kind`: that of the recording, if it was stated or recognised;
// the picture's samples are in order already.
[[nodiscard]] DepthReading readCodes(const Frame& depth, const CodeCount& count, const CalibrationLayers& said,
                                     const KnownKind* kind = nullptr);

// True if any layer states one of the keys.
[[nodiscard]] bool says(const CalibrationLayers& said, std::initializer_list<const char*> keys);

// For codes that are brightness: finds the range of YUV that states none, and whether black is a hole.
[[nodiscard]] DepthReading readShades(const Frame& depth, const CodeCount& count, const CalibrationLayers& said);

// For depth through a colour map: whether one of its ends is a hole, as the pictures show.
[[nodiscard]] DepthReading readColorMap(const Frame& depth, DepthCode code, const CalibrationLayers& said);

// The kind that `readCodes` will find, determined before the samples are put in its order. The unit of distances is
// determined from all pictures of `count`. Null if nothing is certain.
[[nodiscard]] const KnownKind* sensorKind(const Frame& depth, const CodeCount& all);

// True if a part of the picture, not all of it, is red: in depth coded as a hue, holes or both ends of its range.
[[nodiscard]] bool hasRed(const Frame& depth);

// The distances at both ends of the hues.
struct HueSpan {
  double near_mm = 0, far_mm = 3000;  // Record3D's
};
// For depth that is coded as a hue: which hues are holes; for Record3D also the range in use, of the later pictures
// too. `kind` as above.
[[nodiscard]] DepthReading readHues(const Frame& depth, const CalibrationLayers& said, const KnownKind* kind,
                                    HueSpan span, std::span<const Frame> later);

}  // namespace relievo
