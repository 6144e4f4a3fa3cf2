// SPDX-License-Identifier: Apache-2.0
// How much larger than usual a desktop wants things drawn.
#pragma once

namespace relievo {

// 1, 2, ..: of an X desktop by its resource Xft.dpi, 96 of which are usual, of the server that DISPLAY names. 1 without
// that resource, and on Wayland, which enlarges windows by itself. Waits for the server's answer. After SDL's start.
[[nodiscard]] int desktopScale() noexcept;

}  // namespace relievo
