// SPDX-License-Identifier: Apache-2.0
// Displays that draw with GLES through EGL: the create functions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/window/window_input.h"
#include "hal/display.h"
#include "platform/clock.h"

namespace relievo {

// The file that an off-screen display writes its pictures to: "FILE@25" is a file and its frames per second. An @ is
// part of the file's name unless a number from .001 to 1000 follows it.
struct Capture {
  std::string path;  // empty: nothing is written
  double rate = 30;

  [[nodiscard]] static Capture parse(std::string word);
};

// A display without a screen: a framebuffer object of the requested size, on Mesa's surfaceless platform or a pbuffer
// of the default one. It shows a frame at once.
//
// With a capture path, presented frames are also written to that file, as YUV4MPEG2: 4:2:0, BT.709, limited range. The
// file keeps `capture.rate` by `clock`, which must outlive the display: before a late frame the previous one is
// repeated; a frame over a period early is dropped. `open` truncates the file, and returns PermissionDenied or Io if it
// cannot be written.
[[nodiscard]] std::unique_ptr<Display> makeOffscreenDisplay(Capture capture, const Clock& clock);

// A window of the requested size on the desktop, X11 or Wayland; with `film_size` it appears with the first frame. The
// viewer may resize it, and then it keeps that size; a double click toggles full screen. It is synchronised to the
// screen's refresh if the GL driver can. `attend` puts its keys and its mouse into `input`; the keys' times come from
// `clock`, which must outlive the display. The first `open` starts SDL.
[[nodiscard]] std::unique_ptr<Display> makeWindowDisplay(std::shared_ptr<WindowInput> input, const Clock& clock);

// Whether a window can be opened: starts SDL.
[[nodiscard]] bool desktopIsThere();

// Shows a message on the desktop until the viewer closes it; nothing where there is none.
void tellOnDesktop(const std::string& message);

// A whole screen without a desktop, by the kernel's mode setting (KMS), on the card `path` ("/dev/dri/card0"), or on
// the first card that has a screen. The mode is the one of the requested size, else the screen's preferred one. The
// first frame sets it and `close` restores the previous one. `present` waits for the previous frame's flip; the screen
// is Lost if that takes over two refreshes and a tenth of a second. An unplugged screen is Lost within a second, and so
// is one that another program takes. PermissionDenied while another program (a desktop) uses the card.
[[nodiscard]] std::unique_ptr<Display> makeKmsDisplay(std::string path = {});

struct KmsScreen {
  std::string card;  // "/dev/dri/card0"; empty if there is no card
  bool there = false;
  std::string state;  // a description, or why it cannot be used
};
// The screens of every card. Probes each screen, which takes up to a tenth of a second.
[[nodiscard]] std::vector<KmsScreen> lookAtKmsScreens();

}  // namespace relievo
