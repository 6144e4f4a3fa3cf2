// SPDX-License-Identifier: Apache-2.0
// Checks that an installation works as a whole, without any hardware.
#pragma once

#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "hal/display.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

struct SelfTestParts {
  Clock& clock;
  Display& display;      // off screen
  HapticDevice& haptic;  // held by a hand that strokes the surface
  PairReader::Backends backends;
  std::string film;  // a few seconds long, with a surface to touch
};

struct SelfTestLine {
  enum class Verdict : std::uint8_t { Good, Note, Bad };  // Note: works without it, but less well
  Verdict verdict = Verdict::Good;
  std::string thing, said;  // what was tested; why it failed, and what to do
};

// Finds the font, opens the decoders, plays and feels the film once: takes as long as that. The calling thread becomes
// the display's.
[[nodiscard]] std::vector<SelfTestLine> selfTest(SelfTestParts parts);

}  // namespace relievo
