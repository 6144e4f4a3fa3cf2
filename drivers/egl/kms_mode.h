// SPDX-License-Identifier: Apache-2.0
// Chooses one of the modes that the kernel lists for a screen; pure arithmetic.
#pragma once

#include <xf86drmMode.h>

#include <span>

#include "hal/display.h"
#include "platform/clock.h"

namespace relievo::kms {

// The stereo signal in the mode's flags; None for a 2D mode and for an unsupported stereo mode.
[[nodiscard]] StereoSignal stereoOf(const drmModeModeInfo& mode) noexcept;
// The stereo signals that any of the modes has.
[[nodiscard]] StereoSignals stereoSignals(std::span<const drmModeModeInfo> modes) noexcept;

// The first mode with `config`'s stereo signal and size; else the screen's preferred mode with that signal; else the
// first mode with it. Interlaced and doublescan modes are skipped. Null if none is left.
[[nodiscard]] const drmModeModeInfo* chooseMode(std::span<const drmModeModeInfo> modes,
                                                const DisplayConfig& config) noexcept;

[[nodiscard]] Duration refreshPeriod(const drmModeModeInfo& mode) noexcept;

// The size that is scanned out: with frame packing both eyes' pictures and the blanking between them (HDMI 1.4a,
// 8.2.3.2), in the kernel's layout (drm_mode_set_crtcinfo, CRTC_STEREO_DOUBLE).
struct ScanOut {
  int width = 0, height = 0;
  int eye_gap_rows = 0;
};
[[nodiscard]] ScanOut scanOut(const drmModeModeInfo& mode) noexcept;

}  // namespace relievo::kms
