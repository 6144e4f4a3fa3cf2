// SPDX-License-Identifier: Apache-2.0
// A sound card of ALSA in non-blocking mode.
#pragma once

#include <alsa/asoundlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "hal/audio_output.h"
#include "platform/clock.h"

namespace relievo::alsa {

// A card, as a helper thread uses it: it opens it, and the last one that holds it closes it.
class Card {
 public:
  Card(const AudioFormat& asked, std::shared_ptr<Card> other)
      : wished(asked), format(asked), before(std::move(other)) {}
  ~Card() { close(); }
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;

  void open(const std::string& device);
  // How many frames it took, or ALSA's error.
  snd_pcm_sframes_t write(std::span<const float> samples);

  struct Delay {
    int code = 0;  // 0, or ALSA's error; -EPIPE: silent
    snd_pcm_sframes_t frames = 0;
  };
  Delay delay();
  int drop();

  const AudioFormat wished;
  AudioFormat format;
  std::shared_ptr<Card> before;  // is closed first
  int refused = 0, unfit = 0;    // ALSA's errors
  Duration buffer{0};

 private:
  void close();
  int configure();
  const void* native(std::span<const float> samples) noexcept;

  static constexpr std::size_t kConvertedAtOnce = 2048;  // samples

  snd_pcm_t* pcm_ = nullptr;
  bool as_float_ = true;
  std::array<std::int16_t, kConvertedAtOnce> converted_{};
};

}  // namespace relievo::alsa
