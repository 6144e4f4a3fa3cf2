// SPDX-License-Identifier: Apache-2.0
// The callbacks of an ALSA plug-in. It is a shared library: the test links it, and ALSA loads it by its path.
#include "tests/support/machine/fake_sound_card.h"

#include <alsa/asoundlib.h>
#include <alsa/pcm_external.h>
#include <alsa/pcm_ioplug.h>
#include <dlfcn.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace relievo::test {
namespace {

void waitForServer() {
  for (int i = 0; i < 2000 && sound_server_stalls; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

struct Stream {
  snd_pcm_ioplug_t io{};
  MonotonicTime begin;
};

int start(snd_pcm_ioplug_t* io) {
  FakeSoundCard& card = fakeSoundCard();
  static_cast<Stream*>(io->private_data)->begin = card.clock->now();
  card.played = 0;
  return card.unplugged ? -ENODEV : 0;
}

int stop(snd_pcm_ioplug_t* /*io*/) {
  return 0;
}

snd_pcm_sframes_t pointer(snd_pcm_ioplug_t* io) {
  FakeSoundCard& card = fakeSoundCard();
  if (card.unplugged) {
    snd_pcm_ioplug_set_state(io, SND_PCM_STATE_DISCONNECTED);
    return -ENODEV;
  }
  if (io->state != SND_PCM_STATE_RUNNING) return static_cast<snd_pcm_sframes_t>(io->hw_ptr % io->buffer_size);
  const Duration since = card.clock->now() - static_cast<Stream*>(io->private_data)->begin;
  const auto due = static_cast<std::int64_t>(toSeconds(since) * io->rate);
  const auto step = due - card.played;
  const auto queued = static_cast<std::int64_t>(snd_pcm_ioplug_hw_avail(io, io->hw_ptr, io->appl_ptr));
  if (step > queued) return -EPIPE;
  card.played = due;
  return static_cast<snd_pcm_sframes_t>((io->hw_ptr + static_cast<snd_pcm_uframes_t>(step)) % io->buffer_size);
}

snd_pcm_sframes_t transfer(snd_pcm_ioplug_t* io, const snd_pcm_channel_area_t* areas, snd_pcm_uframes_t offset,
                           snd_pcm_uframes_t size) {
  FakeSoundCard& card = fakeSoundCard();
  waitForServer();
  if (card.unplugged) return -ENODEV;
  if (io->format == SND_PCM_FORMAT_S16) {
    const auto* samples = static_cast<const std::int16_t*>(areas[0].addr) + offset * io->channels;
    for (snd_pcm_uframes_t i = 0; i < size * io->channels; ++i) card.loudest = std::max(card.loudest, samples[i]);
  }
  return static_cast<snd_pcm_sframes_t>(size);
}

int close(snd_pcm_ioplug_t* io) {
  waitForServer();
  fakeSoundCard().closed_by = std::this_thread::get_id();
  delete static_cast<Stream*>(io->private_data);
  return 0;
}

constexpr snd_pcm_ioplug_callback_t kCallbacks{
    .start = start, .stop = stop, .pointer = pointer, .transfer = transfer, .close = close};

}  // namespace

FakeSoundCard& fakeSoundCard() noexcept {
  static FakeSoundCard card;
  return card;
}

void plugFakeSoundCard() {
  Dl_info self{};
  dladdr(reinterpret_cast<const void*>(&plugFakeSoundCard), &self);
  const char* const folder = std::getenv("TMPDIR");
  const std::string path =
      std::string(folder == nullptr ? "/tmp" : folder) + "/relievo-asound-" + std::to_string(::getpid()) + ".conf";
  std::ofstream(path) << "pcm_type.relievo_fake { lib \"" << self.dli_fname << "\" }\n"
                      << "pcm.fake { type relievo_fake }\n"
                      << "pcm.null { type null }\n";
  ::setenv("ALSA_CONFIG_PATH", path.c_str(), 1);
  static_cast<void>(std::atexit([] { static_cast<void>(std::remove(std::getenv("ALSA_CONFIG_PATH"))); }));
}

}  // namespace relievo::test

extern "C" {

// ALSA looks this name up for a plug-in of type relievo_fake.
int _snd_pcm_relievo_fake_open(snd_pcm_t** pcm, const char* name, snd_config_t* /*root*/, snd_config_t* /*config*/,
                               snd_pcm_stream_t direction, int mode) {
  using namespace relievo::test;
  waitForServer();
  if (fakeSoundCard().unplugged) return -ENODEV;
  auto* const stream = new Stream;
  stream->io.version = SND_PCM_IOPLUG_VERSION;
  stream->io.name = "a card that is not there";
  stream->io.callback = &kCallbacks;
  stream->io.private_data = stream;
  if (const int code = snd_pcm_ioplug_create(&stream->io, name, direction, mode); code < 0) {
    delete stream;
    return code;
  }
  const unsigned format = fakeSoundCard().format;
  const unsigned access = SND_PCM_ACCESS_RW_INTERLEAVED;
  snd_pcm_ioplug_set_param_list(&stream->io, SND_PCM_IOPLUG_HW_FORMAT, 1, &format);
  snd_pcm_ioplug_set_param_list(&stream->io, SND_PCM_IOPLUG_HW_ACCESS, 1, &access);
  snd_pcm_ioplug_set_param_minmax(&stream->io, SND_PCM_IOPLUG_HW_RATE, 8000, 96000);
  snd_pcm_ioplug_set_param_minmax(&stream->io, SND_PCM_IOPLUG_HW_CHANNELS, 1, 2);
  *pcm = stream->io.pcm;
  return 0;
}
SND_PCM_PLUGIN_SYMBOL(relievo_fake);

}  // extern "C"
