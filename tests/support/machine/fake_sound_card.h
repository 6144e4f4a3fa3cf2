// SPDX-License-Identifier: Apache-2.0
// A sound card for ALSA's library to find: a plug-in of its own kind, that plays at the pace of a test's clock.
#pragma once

#include <cstdint>
#include <string>

#include "platform/clock.h"

namespace relievo::test {

// One card in the process, named "fake"; "null" is the library's own.
struct FakeSoundCard {
  const Clock* clock = nullptr;
  bool unplugged = false;
  bool takes_float = true;
  std::int64_t played = 0;   // frames, since the last start
  std::int16_t loudest = 0;  // of 16 bit samples
};
[[nodiscard]] FakeSoundCard& fakeSoundCard() noexcept;

// Before the library is used: it finds these cards, and no others.
void plugFakeSoundCard();

}  // namespace relievo::test
