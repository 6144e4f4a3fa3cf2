// SPDX-License-Identifier: Apache-2.0
// What the program that had the screen before has left set.
#pragma once

#include <xf86drmMode.h>

#include <cstdint>

namespace relievo::kms {

struct ScreenParts {
  std::uint32_t connector, crtc, plane;
};
// Adds to `request` what undoes HDR, tints, and other planes such as a mouse pointer's. A program sets these for
// itself, and the kernel keeps them when another takes over. False if nothing is left.
[[nodiscard]] bool addLeftovers(int card, const ScreenParts& parts, drmModeAtomicReq& request);

}  // namespace relievo::kms
