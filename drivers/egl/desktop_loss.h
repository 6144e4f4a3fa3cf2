// SPDX-License-Identifier: Apache-2.0
// What happens when the X server ends while a window is open.
#pragma once

struct SDL_Window;

namespace relievo {

// From now on the program ends with one line and exit code 1 when the window's X server has gone, even while a GL
// driver holds the thread that draws: Mesa's software driver can repeat a transfer on the broken connection for
// minutes. What is registered by atexit and at_quick_exit runs before that end. Does nothing on Wayland, whose
// functions return an error instead. From the thread that draws; calls after the first do nothing, since SDL keeps its
// one connection.
void endWithXServer(SDL_Window& window) noexcept;

}  // namespace relievo
