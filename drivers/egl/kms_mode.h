// SPDX-License-Identifier: Apache-2.0
// Which of a screen's modes to show in: pure arithmetic on what the kernel lists.
#pragma once

#include <xf86drmMode.h>

#include <span>

#include "hal/display.h"
#include "platform/clock.h"

namespace relievo::kms {

// Of its flags: None for an ordinary mode, and for a stereo one that is none of ours.
[[nodiscard]] StereoSignal stereoOf(const drmModeModeInfo& mode) noexcept;
// What the screen takes, over all its modes.
[[nodiscard]] StereoSignals stereoSignals(std::span<const drmModeModeInfo> modes) noexcept;

// The first mode that sends `config`'s stereo signal and is as large as it wishes; else the screen's favourite of those
// that send the signal, or their first. Interlaced and doubled modes are passed over. Null when none is left.
[[nodiscard]] const drmModeModeInfo* chooseMode(std::span<const drmModeModeInfo> modes,
                                                const DisplayConfig& config) noexcept;

[[nodiscard]] Duration refreshPeriod(const drmModeModeInfo& mode) noexcept;

// What is scanned out: with frame packing both eyes' pictures and the blanking between them (HDMI 1.4a, 8.2.3.2), as
// the kernel lays them out (drm_mode_set_crtcinfo, CRTC_STEREO_DOUBLE).
struct ScanOut {
  int width = 0, height = 0;
  int eye_gap_rows = 0;
};
[[nodiscard]] ScanOut scanOut(const drmModeModeInfo& mode) noexcept;

}  // namespace relievo::kms
