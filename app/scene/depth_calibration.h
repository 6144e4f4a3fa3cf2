// SPDX-License-Identifier: Apache-2.0
// The meaning of a depth code: law, polarity, range, bits, holes, near and far; and which setting decided it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/codes/code_set.h"
#include "app/scene/codes/depth_code.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

enum class DepthLaw : std::uint8_t {
  Linear,   // z = D s
  Inverse,  // Z = 1/(s/near + (1 - s)/far), z = D (far - Z)/(far - near): disparity, near high
};
enum class DepthPolarity : std::uint8_t { NearIsHigh, NearIsLow };

// s is the normalised code: (code - low)/(high - low) clamped to [0, 1], and 1 minus that if near is low. Full range is
// 0 .. 2^bits - 1; limited range is 16 .. 235, times 2^(bits - 8); `codes` sets another range. Codes that are
// distances, `unit_mm` each, span near to far: then near is low, the law is linear and the range is ignored. A hue code
// is the hue over 360 degrees: s grows with distance, so its polarity is NearIsLow unless stated otherwise. The code of
// a colour map is its entry, 0 to 255.
struct DepthCalibration {
  static constexpr int kHueSteps = 6 * 256;  // a hue code is 0 .. 1535, red, yellow, green, ..
  static constexpr int kMapHighest = 255;
  DepthLaw law = DepthLaw::Linear;
  DepthPolarity polarity = DepthPolarity::NearIsHigh;
  ColorRange range = ColorRange::Full;
  DepthCode code = DepthCode::Luma;
  int bits = 8;
  CodeSet invalid;                      // samples with one of these codes are holes
  std::optional<CodeSet::Range> codes;  // the lowest and highest code, instead of `range`
  std::optional<double> unit_mm;        // codes are distances from the camera, so many mm each
  double near_mm = 500;                 // of distances, and of the inverse law, where only the ratio far/near matters
  double far_mm = 5000;

  [[nodiscard]] double lowCode() const noexcept;
  [[nodiscard]] double highCode() const noexcept;
};

// The height of a normalised code, mm above the far plane.
[[nodiscard]] double heightMm(const DepthCalibration& calibration, double s, double volume_depth_mm) noexcept;

// The calibration of depth that is re-encoded from `source`: luma of `bits`, full range, near high, with `law` or else
// the source's, never distances. Code 0 is reserved for holes if the source may have any.
[[nodiscard]] DepthCalibration recoded(const DepthCalibration& source, int bits,
                                       std::optional<DepthLaw> law = std::nullopt) noexcept;

// Where a value came from, highest precedence first.
enum class CalibrationOrigin : std::uint8_t {
  CommandLine,
  SideFile,       // --calibration FILE
  StatedKind,     // --as KIND
  ContainerTags,  // of the film, or of another program
  LikelyTags,     // likewise, where the film's maker had it from names or pictures
  AssumedTags,    // likewise, where the film's maker assumed it
  FileBeside,     // a file that the recording's own program left beside it
  Name,           // the names of files and folders
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

// Parses "law=inverse,near=500" or the lines of a side file ("key = value", # begins a comment). InvalidArgument, with
// the rule that was broken, for an unknown key, a value out of range (near and far: 1e-3 to 1e9 mm) or values that
// contradict each other.
[[nodiscard]] Result<CalibrationSettings> parseCalibration(std::string_view text);
// The DEPTH_ tags among the tags of a container or stream; invalid ones are left out.
[[nodiscard]] CalibrationSettings calibrationFromTags(const std::map<std::string, std::string>& tags);
// The calibration as tags to write.
[[nodiscard]] std::map<std::string, std::string> calibrationTags(const DepthCalibration& calibration);

// One value of a calibration, and which layer set it.
struct CalibrationPart {
  std::string key, value;
  CalibrationOrigin origin = CalibrationOrigin::Default;
};

struct CalibrationChoice {
  DepthCalibration calibration;
  CalibrationOrigin origin = CalibrationOrigin::Default;  // the highest layer that set a value
  std::vector<CalibrationPart> parts;                     // one for each key
  std::string explanation;                                // the parts in one line
};

// The settings by layer, highest precedence first.
struct CalibrationLayers {
  CalibrationSettings command_line;
  CalibrationSettings side_file;
  CalibrationSettings stated_kind;
  CalibrationSettings tags;
  CalibrationSettings beside;
  CalibrationSettings names;
  CalibrationSettings pictures;  // read off the first pictures

  struct Layer {
    CalibrationOrigin origin;
    const CalibrationSettings* settings;
  };
  [[nodiscard]] std::array<Layer, 7> order() const noexcept;
  // The value of the highest layer that sets `key`; null if none does.
  [[nodiscard]] const std::string* find(const std::string& key) const;
};

// Values that no layer sets come from the frame's own signalling (bits; range: full for gray and full-range formats,
// limited for other YUV), then from the defaults. A result that is invalid (far <= near, distances as hue, more bits
// than the samples have, an invalid code beyond them) is InvalidArgument if the command line caused it, Corrupt if a
// file did; bad bits and invalid codes from tags are dropped instead.
[[nodiscard]] Result<CalibrationChoice> chooseCalibration(const CalibrationLayers& layers, const Frame& depth_frame,
                                                          DepthCode code);

}  // namespace relievo
