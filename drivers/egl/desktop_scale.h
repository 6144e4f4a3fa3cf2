// SPDX-License-Identifier: Apache-2.0
// The scale factor at which the desktop wants things drawn.
#pragma once

namespace relievo {

// Returns 1, 2, ..: for the X desktop that DISPLAY names, its resource Xft.dpi over the usual 96. Returns 1 without
// that resource, and on Wayland, which enlarges windows itself. Waits for the X server's answer. Call after SDL has
// started.
[[nodiscard]] int desktopScale() noexcept;

}  // namespace relievo
