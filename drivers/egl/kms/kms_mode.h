// SPDX-License-Identifier: Apache-2.0
// Chooses one of the modes that the kernel lists for a screen; pure arithmetic.
#pragma once

#include <xf86drmMode.h>

#include <span>
#include <string>
#include <string_view>

#include "hal/display.h"
#include "platform/clock.h"

namespace relievo::kms {

// How a card takes the two pictures of a frame packing mode.
enum class Packing : std::uint8_t {
  Tall,    // the left eye's over the right eye's with the blanking's lines between them, as HDMI sends them
  Beside,  // side by side, each as large as the mode; the card puts one above the other
};
// By the name of the kernel's driver. amdgpu, i915 and nouveau take one tall buffer, vc4 (Raspberry Pi) one of twice
// the width (raspberrypi/linux, pull request 7524).
[[nodiscard]] Packing packingOf(std::string_view driver) noexcept;

// The stereo signal in the mode's flags; None for a 2D mode and for an unsupported stereo mode.
[[nodiscard]] StereoSignal stereoOf(const drmModeModeInfo& mode) noexcept;
// The stereo signals that any of the modes has.
[[nodiscard]] StereoSignals stereoSignals(std::span<const drmModeModeInfo> modes) noexcept;

// The first mode with `config`'s stereo signal and size (not with `film_size`); else the screen's preferred mode with
// that signal; else the first mode with it. Interlaced and doublescan modes are skipped, and frame packing of other
// than 1080 or 720 rows. Null if none is left.
[[nodiscard]] const drmModeModeInfo* chooseMode(std::span<const drmModeModeInfo> modes,
                                                const DisplayConfig& config) noexcept;

[[nodiscard]] Duration refreshPeriod(const drmModeModeInfo& mode) noexcept;

// The size of the buffer, and of the part of it that the plane is set to. A tall buffer holds both eyes' pictures and
// the blanking between them (HDMI 1.4a, 8.2.3.2; drm_mode_set_crtcinfo, CRTC_STEREO_DOUBLE); of two pictures side by
// side the plane is set to the left one.
struct ScanOut {
  int width = 0, height = 0;
  int plane_width = 0, plane_height = 0;
  int eye_gap_rows = 0;
};
[[nodiscard]] ScanOut scanOut(const drmModeModeInfo& mode, Packing packing) noexcept;

// "1920x1080 at 24.00 Hz, frame packing in one picture of 1920x2205".
[[nodiscard]] std::string wordsOf(const drmModeModeInfo& mode, Packing packing);
// "3D signals: frame packing, side by side".
[[nodiscard]] std::string wordsOf(const StereoSignals& signals);

}  // namespace relievo::kms
