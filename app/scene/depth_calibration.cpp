// SPDX-License-Identifier: Apache-2.0
// Converts a normalised code to a height.
#include "app/scene/depth_calibration.h"

#include <algorithm>

namespace relievo {

double DepthCalibration::lowCode() const noexcept {
  if (unit_mm) return near_mm / *unit_mm;
  if (codes) return codes->low;
  if (code != DepthCode::Luma) return 0;
  return range == ColorRange::Limited ? 16.0 * (1u << (bits - 8)) : 0.0;
}

double DepthCalibration::highCode() const noexcept {
  if (unit_mm) return far_mm / *unit_mm;
  if (codes) return codes->high;
  if (code != DepthCode::Luma) return code == DepthCode::Hue ? kHueSteps : kMapHighest;
  return range == ColorRange::Limited ? 235.0 * (1u << (bits - 8)) : static_cast<double>((1u << bits) - 1);
}

double heightMm(const DepthCalibration& calibration, double s, double volume_depth_mm) noexcept {
  s = std::clamp(s, 0.0, 1.0);
  if (calibration.polarity == DepthPolarity::NearIsLow) s = 1.0 - s;
  if (calibration.law == DepthLaw::Linear) return volume_depth_mm * s;
  const double distance = 1.0 / (s / calibration.near_mm + (1.0 - s) / calibration.far_mm);
  return volume_depth_mm * (calibration.far_mm - distance) / (calibration.far_mm - calibration.near_mm);
}

DepthCalibration recoded(const DepthCalibration& source, int bits, std::optional<DepthLaw> law) noexcept {
  const bool has_holes = !source.invalid.empty() || source.code != DepthCode::Luma;
  DepthCalibration written = source;
  written.law = law.value_or(source.law);
  written.polarity = DepthPolarity::NearIsHigh;
  written.range = ColorRange::Full;
  written.code = DepthCode::Luma;
  written.bits = bits;
  written.unit_mm.reset();
  written.invalid = has_holes ? CodeSet(0) : CodeSet();
  written.codes.reset();
  return written;
}

const char* name(CalibrationOrigin origin) noexcept {
  switch (origin) {
    case CalibrationOrigin::CommandLine:
      return "command line";
    case CalibrationOrigin::SideFile:
      return "side file";
    case CalibrationOrigin::StatedKind:
      return "--as";
    case CalibrationOrigin::ContainerTags:
      return "container tags";
    case CalibrationOrigin::LikelyTags:
      return "container tags, thought likely by its maker";
    case CalibrationOrigin::AssumedTags:
      return "container tags, assumed by its maker";
    case CalibrationOrigin::FileBeside:
      return "file beside it";
    case CalibrationOrigin::Name:
      return "name";
    case CalibrationOrigin::FirstPicture:
      return "first picture";
    case CalibrationOrigin::StreamSignalling:
      return "stream signalling";
    case CalibrationOrigin::Default:
      return "default";
  }
  return "";
}

}  // namespace relievo
