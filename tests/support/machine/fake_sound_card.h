// SPDX-License-Identifier: Apache-2.0
// A simulated sound card: an ALSA plug-in that plays in time with a test's clock.
#pragma once

#include <alsa/asoundlib.h>

#include <atomic>
#include <cstdint>
#include <thread>

#include "platform/clock.h"

namespace relievo::test {

// The process's only card, named "fake"; "null" is ALSA's own.
struct FakeSoundCard {
  const Clock* clock = nullptr;
  bool unplugged = false;
  snd_pcm_format_t format = SND_PCM_FORMAT_FLOAT;  // the only one that it takes
  std::int64_t played = 0;                         // frames, since the last start
  std::int16_t loudest = 0;                        // of 16 bit samples
  std::thread::id closed_by;
};
[[nodiscard]] FakeSoundCard& fakeSoundCard() noexcept;

// While true, and for at most 20 s, opening and closing the card and writing to it do not return: as with a sound
// server that does not answer.
inline std::atomic<bool> sound_server_stalls{false};

// Call before ALSA is used: it then finds only these cards.
void plugFakeSoundCard();

}  // namespace relievo::test
