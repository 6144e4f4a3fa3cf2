// SPDX-License-Identifier: Apache-2.0
#include "drivers/alsa/card.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <utility>

namespace relievo::alsa {
namespace {

constexpr unsigned kBufferUs = 500'000;
constexpr unsigned kPeriodUs = 20'000;

}  // namespace

void Card::open(const std::string& device) {
  before.reset();
  refused = snd_pcm_open(&pcm_, device.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
  if (refused < 0) pcm_ = nullptr;
  else unfit = configure();
  if (unfit < 0) close();
}

snd_pcm_sframes_t Card::write(std::span<const float> samples) {
  const auto channels = static_cast<std::size_t>(format.channels);
  const std::size_t frames = samples.size() / channels;
  std::size_t taken_before = 0;
  bool recovered = false;
  while (taken_before < frames) {
    // Ask for the room first, since snd_pcm_writei alone would not write less than a period.
    snd_pcm_sframes_t taken = snd_pcm_avail_update(pcm_);
    if (taken > 0) {
      const std::size_t most = as_float_ ? frames : kConvertedAtOnce / channels;
      const std::size_t count = std::min({frames - taken_before, static_cast<std::size_t>(taken), most});
      taken = snd_pcm_writei(pcm_, native(samples.subspan(taken_before * channels, count * channels)), count);
    }
    if (taken == 0 || taken == -EAGAIN) break;
    if (taken > 0) {
      taken_before += static_cast<std::size_t>(taken);
      continue;
    }
    // After an underrun or a suspend, restart the device.
    const bool anew = (taken == -EPIPE || taken == -ESTRPIPE) && !std::exchange(recovered, true);
    if (!anew || snd_pcm_prepare(pcm_) < 0) return taken;
  }
  return static_cast<snd_pcm_sframes_t>(taken_before);
}

Card::Delay Card::delay() {
  const snd_pcm_state_t state = snd_pcm_state(pcm_);
  if (state == SND_PCM_STATE_DISCONNECTED) return {.code = -ENODEV};
  if (state != SND_PCM_STATE_RUNNING) return {.code = -EPIPE};
  snd_pcm_sframes_t available = 0, waiting = 0;
  const int code = snd_pcm_avail_delay(pcm_, &available, &waiting);  // snd_pcm_delay might not report an underrun
  return {code, waiting};
}

int Card::drop() {
  const int dropped = snd_pcm_drop(pcm_), prepared = snd_pcm_prepare(pcm_);
  return dropped < 0 ? dropped : prepared;
}

void Card::close() {
  if (pcm_ != nullptr) snd_pcm_close(std::exchange(pcm_, nullptr));
}

int Card::configure() {
  snd_pcm_hw_params_t* hardware = nullptr;
  snd_pcm_hw_params_alloca(&hardware);
  if (const int code = snd_pcm_hw_params_any(pcm_, hardware); code < 0) return code;
  if (const int code = snd_pcm_hw_params_set_access(pcm_, hardware, SND_PCM_ACCESS_RW_INTERLEAVED); code < 0) {
    return code;
  }
  as_float_ = snd_pcm_hw_params_set_format(pcm_, hardware, SND_PCM_FORMAT_FLOAT) >= 0;
  if (!as_float_) {
    if (const int code = snd_pcm_hw_params_set_format(pcm_, hardware, SND_PCM_FORMAT_S16); code < 0) return code;
  }
  auto channels = static_cast<unsigned>(format.channels);
  auto rate = static_cast<unsigned>(format.rate_hz);
  unsigned buffer_us = kBufferUs, period_us = kPeriodUs;
  for (const int code : {snd_pcm_hw_params_set_channels_near(pcm_, hardware, &channels),
                         snd_pcm_hw_params_set_rate_near(pcm_, hardware, &rate, nullptr),
                         snd_pcm_hw_params_set_buffer_time_near(pcm_, hardware, &buffer_us, nullptr),
                         snd_pcm_hw_params_set_period_time_near(pcm_, hardware, &period_us, nullptr),
                         snd_pcm_hw_params(pcm_, hardware)}) {
    if (code < 0) return code;
  }
  snd_pcm_uframes_t frames = 0;
  if (const int code = snd_pcm_hw_params_get_buffer_size(hardware, &frames); code < 0) return code;
  buffer = fromSeconds(static_cast<double>(frames) / rate);
  format = {.rate_hz = static_cast<int>(rate), .channels = static_cast<int>(channels)};

  snd_pcm_sw_params_t* software = nullptr;
  snd_pcm_sw_params_alloca(&software);
  if (const int code = snd_pcm_sw_params_current(pcm_, software); code < 0) return code;
  if (const int code = snd_pcm_sw_params_set_start_threshold(pcm_, software, 1); code < 0) return code;
  return snd_pcm_sw_params(pcm_, software);
}

const void* Card::native(std::span<const float> samples) noexcept {
  if (as_float_) return samples.data();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    converted_[i] = static_cast<std::int16_t>(std::lround(32767.0F * std::clamp(samples[i], -1.0F, 1.0F)));
  }
  return converted_.data();
}

}  // namespace relievo::alsa
