// SPDX-License-Identifier: Apache-2.0
// The EGL displays that draw without a screen.
#pragma once

#include <EGL/egl.h>

#include <vector>

namespace relievo {

// In the order in which they should be tried: Mesa's surfaceless platform, then each graphics card as an EGL device
// (EGL_EXT_platform_device: a vendor's driver without Mesa, as NVIDIA's on a machine without a desktop), then EGL's
// default display. None of them is initialised.
[[nodiscard]] std::vector<EGLDisplay> offscreenDisplays();

}  // namespace relievo
