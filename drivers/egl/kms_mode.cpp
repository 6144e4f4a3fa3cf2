// SPDX-License-Identifier: Apache-2.0
// Ranks a screen's modes by stereo signal, size and preference.
#include "drivers/egl/kms_mode.h"

namespace relievo::kms {
namespace {

bool wanted(const drmModeModeInfo& mode, StereoSignal stereo) noexcept {
  const bool stereo_of_another_kind = stereoOf(mode) == StereoSignal::None && (mode.flags & DRM_MODE_FLAG_3D_MASK) != 0;
  return (mode.flags & (DRM_MODE_FLAG_INTERLACE | DRM_MODE_FLAG_DBLSCAN)) == 0 && !stereo_of_another_kind &&
         stereoOf(mode) == stereo;
}

}  // namespace

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
    if (mode.hdisplay == config.width && mode.vdisplay == config.height) return &mode;
    if (first == nullptr) first = &mode;
    if (favourite == nullptr && (mode.type & DRM_MODE_TYPE_PREFERRED) != 0) favourite = &mode;
  }
  return favourite != nullptr ? favourite : first;
}

Duration refreshPeriod(const drmModeModeInfo& mode) noexcept {
  if (mode.clock == 0) return Duration(0);
  return fromSeconds(static_cast<double>(mode.htotal) * mode.vtotal / (1e3 * mode.clock));
}

ScanOut scanOut(const drmModeModeInfo& mode) noexcept {
  if (stereoOf(mode) != StereoSignal::FramePacking) return {mode.hdisplay, mode.vdisplay, 0};
  return {mode.hdisplay, mode.vdisplay + mode.vtotal, mode.vtotal - mode.vdisplay};
}

}  // namespace relievo::kms
