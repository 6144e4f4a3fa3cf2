// SPDX-License-Identifier: Apache-2.0
// What a depth code means: law, polarity, range, bits, holes, near and far; and who said so.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "app/scene/code_set.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

enum class DepthLaw : std::uint8_t {
  Linear,   // z = D s
  Inverse,  // Z = 1/(s/near + (1 - s)/far), z = D (far - Z)/(far - near): disparity, near high
};
enum class DepthPolarity : std::uint8_t { NearIsHigh, NearIsLow };
enum class DepthCode : std::uint8_t { Luma, Hue };

// s is the normalised code: (code - low)/(high - low) clamped to [0, 1], and 1 - that when near is low.
// Full range is 0 .. 2^bits - 1; limited range is 16 .. 235, times 2^(bits - 8); `codes` says another range. Codes that
// are distances, `unit_mm` each, reach from near to far: near is low then, the law is linear and the range is not asked
// for. A hue code is the hue over 360 degrees: s grows with distance, so its polarity is NearIsLow unless it is said
// otherwise.
struct DepthCalibration {
  static constexpr int kHueSteps = 6 * 256;  // a hue code is 0 .. 1535, red, yellow, green, ..
  DepthLaw law = DepthLaw::Linear;
  DepthPolarity polarity = DepthPolarity::NearIsHigh;
  ColorRange range = ColorRange::Full;
  DepthCode code = DepthCode::Luma;
  int bits = 8;
  CodeSet invalid;                      // a sample with one of these codes is a hole
  std::optional<CodeSet::Range> codes;  // what the code reaches from and to, in place of `range`
  std::optional<double> unit_mm;        // a code is so many mm of distance from the camera
  double near_mm = 500;                 // of distances, and of the inverse law, where far/near alone counts
  double far_mm = 5000;

  [[nodiscard]] double lowCode() const noexcept;
  [[nodiscard]] double highCode() const noexcept;
};

// A height for a normalised code, mm above the far plane.
[[nodiscard]] double heightMm(const DepthCalibration& calibration, double s, double volume_depth_mm) noexcept;

// The meaning of codes that are written anew from `source`: luma of `bits`, full range, near high, in `law` or else the
// source's, and never distances. Code 0 is reserved for holes where the source may have any.
[[nodiscard]] DepthCalibration recoded(const DepthCalibration& source, int bits,
                                       std::optional<DepthLaw> law = std::nullopt) noexcept;

// Where a value came from, in order of precedence.
enum class CalibrationOrigin : std::uint8_t {
  CommandLine,
  SideFile,
  ContainerTags,
  FirstPicture,
  StreamSignalling,
  Default
};
[[nodiscard]] const char* name(CalibrationOrigin origin) noexcept;

// Keys: law=linear|inverse  polarity=near-high|near-low  range=full|limited  bits=8..16  codes=LOW-HIGH|none
// invalid=none, or codes and ranges of codes (0, 0+65535, 0+2000-2047)
// unit=MM|none  near=MM  far=MM. In container tags the same keys in capitals behind DEPTH_: DEPTH_LAW=inverse,
// DEPTH_NEAR=500, ..
using CalibrationSettings = std::map<std::string, std::string>;

// "law=inverse,near=500" or the lines of a side file ("key = value", # begins a comment). InvalidArgument, naming
// nothing more than the rule that was broken, for an unknown key, a value out of its range (near and far: 1e-3 to 1e9
// mm) or values that contradict one another.
[[nodiscard]] Result<CalibrationSettings> parseCalibration(std::string_view text);
// The DEPTH_ tags among a container's or a stream's tags; those that make no sense are left out.
[[nodiscard]] CalibrationSettings calibrationFromTags(const std::map<std::string, std::string>& tags);
// The settings, as tags to write.
[[nodiscard]] std::map<std::string, std::string> calibrationTags(const DepthCalibration& calibration);

struct CalibrationChoice {
  DepthCalibration calibration;
  CalibrationOrigin origin = CalibrationOrigin::Default;  // the highest that said anything
  std::string explanation;                                // one line: each value and who said it
};

// The layers in order of precedence; what none of them says comes from the frame's own signalling (bits, range: full
// for gray and full-range formats, limited for other YUV) and then the defaults. Where the whole makes no sense (far <=
// near, more bits than the frame's samples have, an invalid code beyond them): InvalidArgument when the command line
// has said it, Corrupt when a file has; bits and an invalid code of tags are left out then.
struct CalibrationLayers {
  CalibrationSettings command_line;
  CalibrationSettings side_file;
  CalibrationSettings tags;
  CalibrationSettings pictures;  // what the first ones look like
};
[[nodiscard]] Result<CalibrationChoice> chooseCalibration(const CalibrationLayers& layers, const Frame& depth_frame,
                                                          DepthCode code);

}  // namespace relievo
