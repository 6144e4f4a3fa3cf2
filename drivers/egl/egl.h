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

// Where an off-screen display writes what it shows: "FILE@25" is a file and its frames per second. An @ that no number
// from .001 to 1000 follows is part of the file's name.
struct Capture {
  std::string path;  // empty: nothing is written
  double rate = 30;

  [[nodiscard]] static Capture parse(std::string word);
};

// A display without a screen: a framebuffer object of the size asked for, on the surfaceless platform of Mesa or a
// pbuffer of the default one. It shows a frame at once.
//
// With a capture's path what is presented is also written to that file, as YUV4MPEG2: 4:2:0, BT.709, limited range. The
// display does not know how often it will be given a frame: the capture says the file's rate. The file
// holds that rate by `clock`, which must outlive the display: a frame that is late has the one before it repeated, one
// more than a period early is left out. `open` begins the file anew, and answers NotFound, PermissionDenied or Io where
// it cannot be written.
[[nodiscard]] std::unique_ptr<Display> makeOffscreenDisplay(Capture capture, const Clock& clock);

// A window of the size asked for on the desktop, X11 or Wayland, whose surface follows when the viewer resizes it; F11
// fills the screen. It is drawn at the pace of the screen where the GL driver can. What it hears of its other keys and
// of its mouse goes into `input`, in `attend`; the keys' times are `clock`'s, which must outlive the display. SDL is
// started with the first `open`, not before.
[[nodiscard]] std::unique_ptr<Display> makeWindowDisplay(std::shared_ptr<WindowInput> input, const Clock& clock);

// A whole screen without a desktop, by the kernel's mode setting (KMS), of the card `path` ("/dev/dri/card0"), or of
// the first card that has a screen. The mode is the screen's of the size asked for, else its favourite; it is set with
// the first frame and given back by `close`. `present` waits for the frame before, at most two refreshes and a tenth of
// a second: a screen that does not show it by then is Lost. So is one that is pulled out, within a second, and one that
// another program takes. PermissionDenied while another program (a desktop) has the card.
[[nodiscard]] std::unique_ptr<Display> makeKmsDisplay(std::string path = {});

struct KmsScreen {
  std::string card;  // "/dev/dri/card0"; empty where there is none
  bool there = false;
  std::string state;  // what it is, or why it is none
};
// Of every card. Asks the screens, which takes up to a tenth of a second each.
[[nodiscard]] std::vector<KmsScreen> lookAtKmsScreens();

}  // namespace relievo
