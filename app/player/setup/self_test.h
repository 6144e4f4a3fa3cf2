// SPDX-License-Identifier: Apache-2.0
// Tells whether what is installed works as a whole, without any hardware: for who has just installed it.
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
  HapticDevice& haptic;  // in a hand that strokes what it meets
  PairReader::Backends backends;
  std::string film;  // of some seconds, with something to touch in it
};

struct SelfTestLine {
  enum class Verdict : std::uint8_t { Good, Note, Bad };  // Note: works without it, but less well
  Verdict verdict = Verdict::Good;
  std::string thing, said;  // what it is; why not, and what to do
};

// Finds the font, opens the decoders, plays and feels the film once: takes as long as that. The calling thread becomes
// the display's.
[[nodiscard]] std::vector<SelfTestLine> selfTest(SelfTestParts parts);

}  // namespace relievo
