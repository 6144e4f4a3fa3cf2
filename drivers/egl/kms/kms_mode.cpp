// SPDX-License-Identifier: Apache-2.0
// Ranks a screen's modes by stereo signal, size and preference.
#include "drivers/egl/kms/kms_mode.h"

#include <cstdio>

namespace relievo::kms {
namespace {

// The sizes that HDMI 1.4a defines for frame packing; others, such as 480 rows, would need their own picture layout.
bool hasPackedSize(const drmModeModeInfo& mode) noexcept {
  return (mode.hdisplay == 1920 && mode.vdisplay == 1080) || (mode.hdisplay == 1280 && mode.vdisplay == 720);
}

bool wanted(const drmModeModeInfo& mode, StereoSignal stereo) noexcept {
  const bool stereo_of_another_kind = stereoOf(mode) == StereoSignal::None && (mode.flags & DRM_MODE_FLAG_3D_MASK) != 0;
  return (mode.flags & (DRM_MODE_FLAG_INTERLACE | DRM_MODE_FLAG_DBLSCAN)) == 0 && !stereo_of_another_kind &&
         stereoOf(mode) == stereo && (stereo != StereoSignal::FramePacking || hasPackedSize(mode));
}

const char* nameOf(StereoSignal signal) noexcept {
  switch (signal) {
    case StereoSignal::FramePacking:
      return "frame packing";
    case StereoSignal::SideBySideHalf:
      return "side by side";
    case StereoSignal::TopAndBottom:
      return "top and bottom";
    case StereoSignal::None:
      break;
  }
  return "no 3D signal";
}

}  // namespace

Packing packingOf(std::string_view driver) noexcept {
  return driver == "vc4" ? Packing::Beside : Packing::Tall;
}

StereoSignal stereoOf(const drmModeModeInfo& mode) noexcept {
  switch (mode.flags & DRM_MODE_FLAG_3D_MASK) {
    case DRM_MODE_FLAG_3D_FRAME_PACKING:
      return StereoSignal::FramePacking;
    case DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF:
      return StereoSignal::SideBySideHalf;
    case DRM_MODE_FLAG_3D_TOP_AND_BOTTOM:
      return StereoSignal::TopAndBottom;
    default:
      return StereoSignal::None;
  }
}

StereoSignals stereoSignals(std::span<const drmModeModeInfo> modes) noexcept {
  StereoSignals signals;
  for (const drmModeModeInfo& mode : modes) {
    const StereoSignal stereo = stereoOf(mode);
    if (stereo == StereoSignal::None || !wanted(mode, stereo)) continue;
    signals.frame_packing = signals.frame_packing || stereo == StereoSignal::FramePacking;
    signals.side_by_side_half = signals.side_by_side_half || stereo == StereoSignal::SideBySideHalf;
    signals.top_and_bottom = signals.top_and_bottom || stereo == StereoSignal::TopAndBottom;
  }
  return signals;
}

const drmModeModeInfo* chooseMode(std::span<const drmModeModeInfo> modes, const DisplayConfig& config) noexcept {
  const drmModeModeInfo *favourite = nullptr, *first = nullptr;
  for (const drmModeModeInfo& mode : modes) {
    if (!wanted(mode, config.stereo)) continue;
    if (!config.film_size && mode.hdisplay == config.width && mode.vdisplay == config.height) return &mode;
    if (first == nullptr) first = &mode;
    if (favourite == nullptr && (mode.type & DRM_MODE_TYPE_PREFERRED) != 0) favourite = &mode;
  }
  return favourite != nullptr ? favourite : first;
}

Duration refreshPeriod(const drmModeModeInfo& mode) noexcept {
  if (mode.clock == 0) return Duration(0);
  return fromSeconds(static_cast<double>(mode.htotal) * mode.vtotal / (1e3 * mode.clock));
}

ScanOut scanOut(const drmModeModeInfo& mode, Packing packing) noexcept {
  const int width = mode.hdisplay, height = mode.vdisplay, both = mode.vdisplay + mode.vtotal;
  if (stereoOf(mode) != StereoSignal::FramePacking) return {width, height, width, height, 0};
  if (packing == Packing::Beside) return {2 * width, height, width, height, 0};
  return {width, both, width, both, mode.vtotal - mode.vdisplay};
}

std::string wordsOf(const drmModeModeInfo& mode, Packing packing) {
  const StereoSignal signal = stereoOf(mode);
  const ScanOut size = scanOut(mode, packing);
  const Duration period = refreshPeriod(mode);
  char text[120];
  std::snprintf(text, sizeof text, "%dx%d at %.2f Hz, %s", mode.hdisplay, mode.vdisplay,
                period > Duration(0) ? 1 / toSeconds(period) : 0.0, nameOf(signal));
  if (signal != StereoSignal::FramePacking) return text;
  const std::string buffer = std::to_string(size.width) + "x" + std::to_string(size.height);
  return std::string(text) + (size.eye_gap_rows > 0 ? " in one picture of " : " as two halves of ") + buffer;
}

std::string wordsOf(const StereoSignals& signals) {
  std::string words;
  for (const auto signal : {StereoSignal::FramePacking, StereoSignal::SideBySideHalf, StereoSignal::TopAndBottom}) {
    if (signals.has(signal)) words += (words.empty() ? "" : ", ") + std::string(nameOf(signal));
  }
  return words.empty() ? "no 3D signals" : "3D signals: " + words;
}

}  // namespace relievo::kms
