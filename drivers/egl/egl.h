// SPDX-License-Identifier: Apache-2.0
// Displays that draw with GLES through EGL: the create functions.
#pragma once

#include <memory>
#include <string>

#include "hal/display.h"

namespace relievo {

// A display without a screen: a framebuffer object of the size asked for, on the surfaceless platform of Mesa or a
// pbuffer of the default one. It shows a frame at once.
//
// With a capture path every frame presented is also appended to that file, one picture each whenever it comes, as
// YUV4MPEG2: 4:2:0, BT.709, limited range. The display does not know how often it will be given a frame, so the rate
// in the file's header is said by who knows: "FILE.y4m@25", "FILE.y4m@29.97"; without it 30. `open` begins the file
// anew, and answers NotFound, PermissionDenied or Io where it cannot be written.
[[nodiscard]] std::unique_ptr<Display> makeOffscreenDisplay(std::string capture_path);

}  // namespace relievo
