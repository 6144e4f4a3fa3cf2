// SPDX-License-Identifier: Apache-2.0
// Sound output by ALSA in non-blocking mode.
#include "drivers/alsa/alsa.h"

#include <alsa/asoundlib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <memory>
#include <utility>

#include "platform/files/file_system_answer.h"

namespace relievo {
namespace {

constexpr unsigned kBufferUs = 500'000;
constexpr unsigned kPeriodUs = 20'000;
constexpr std::size_t kConvertedAtOnce = 2048;  // samples
constexpr Duration kServerPatience = std::chrono::seconds(3);

// Keeps alsa-lib from printing to stderr; the program prints its own messages.
void printNothing(const char* /*file*/, int /*line*/, const char* /*function*/, int /*error*/, const char* /*text*/,
                  ...) {}

Error openError(int code) noexcept {
  switch (code) {
    case -ENOENT:
    case -ENODEV:
    case -ENXIO:
      return {ErrorCode::NotFound, -code, "there is no such sound card; `aplay -L` lists the cards"};
    case -EBUSY:
      return {ErrorCode::Exhausted, EBUSY, "another program uses the sound card; stop it, or name a shared device"};
    case -EACCES:
    case -EPERM:
      return {ErrorCode::PermissionDenied, -code,
              "no permission to use the sound card; add the user to the group audio"};
    default:
      return {ErrorCode::Unsupported, std::max(-code, 0), "the sound card does not work; `speaker-test` shows more"};
  }
}

// What a helper thread opens; closed unless it is taken.
struct OpenedCard {
  explicit OpenedCard(const AudioFormat& asked) : wished(asked), format(asked) {}
  ~OpenedCard() {
    if (pcm != nullptr) snd_pcm_close(pcm);
  }
  OpenedCard(const OpenedCard&) = delete;
  OpenedCard& operator=(const OpenedCard&) = delete;

  void open(const std::string& device) {
    refused = snd_pcm_open(&pcm, device.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
    if (refused < 0) pcm = nullptr;
    else unfit = configure();
    done = true;
  }

  int configure() {
    snd_pcm_hw_params_t* hardware = nullptr;
    snd_pcm_hw_params_alloca(&hardware);
    if (const int code = snd_pcm_hw_params_any(pcm, hardware); code < 0) return code;
    if (const int code = snd_pcm_hw_params_set_access(pcm, hardware, SND_PCM_ACCESS_RW_INTERLEAVED); code < 0) {
      return code;
    }
    as_float = snd_pcm_hw_params_set_format(pcm, hardware, SND_PCM_FORMAT_FLOAT) >= 0;
    if (!as_float) {
      if (const int code = snd_pcm_hw_params_set_format(pcm, hardware, SND_PCM_FORMAT_S16); code < 0) return code;
    }
    auto channels = static_cast<unsigned>(format.channels);
    auto rate = static_cast<unsigned>(format.rate_hz);
    unsigned buffer_us = kBufferUs, period_us = kPeriodUs;
    for (const int code : {snd_pcm_hw_params_set_channels_near(pcm, hardware, &channels),
                           snd_pcm_hw_params_set_rate_near(pcm, hardware, &rate, nullptr),
                           snd_pcm_hw_params_set_buffer_time_near(pcm, hardware, &buffer_us, nullptr),
                           snd_pcm_hw_params_set_period_time_near(pcm, hardware, &period_us, nullptr),
                           snd_pcm_hw_params(pcm, hardware)}) {
      if (code < 0) return code;
    }
    snd_pcm_uframes_t frames = 0;
    if (const int code = snd_pcm_hw_params_get_buffer_size(hardware, &frames); code < 0) return code;
    buffer = fromSeconds(static_cast<double>(frames) / rate);
    format = {.rate_hz = static_cast<int>(rate), .channels = static_cast<int>(channels)};

    snd_pcm_sw_params_t* software = nullptr;
    snd_pcm_sw_params_alloca(&software);
    if (const int code = snd_pcm_sw_params_current(pcm, software); code < 0) return code;
    if (const int code = snd_pcm_sw_params_set_start_threshold(pcm, software, 1); code < 0) return code;
    return snd_pcm_sw_params(pcm, software);
  }

  const AudioFormat wished;
  AudioFormat format;
  std::atomic<bool> done = false;  // what follows stands, and belongs to the player's thread
  snd_pcm_t* pcm = nullptr;
  int refused = 0, unfit = 0;  // ALSA's errors
  bool as_float = true;
  Duration buffer{0};
};

class AlsaOutput final : public AudioOutput {
 public:
  AlsaOutput(std::string device, const Clock& clock) : device_(std::move(device)), clock_(clock) {
    snd_lib_error_set_handler(printNothing);
  }
  ~AlsaOutput() override { close(); }
  AlsaOutput(const AlsaOutput&) = delete;
  AlsaOutput& operator=(const AlsaOutput&) = delete;

  [[nodiscard]] Capabilities capabilities() const noexcept override { return {.name = "alsa", .buffer = buffer_}; }

 private:
  Result<AudioFormat> openOutput(const AudioFormat& wished) override {
    constexpr Error kNoAnswer{ErrorCode::Timeout, 0, "the sound server does not answer within 3 s; start it anew"};
    std::shared_ptr<OpenedCard> card = late_;
    if (card != nullptr && !card->done) return std::unexpected(kNoAnswer);
    late_ = nullptr;
    if (card == nullptr || card->wished.rate_hz != wished.rate_hz || card->wished.channels != wished.channels) {
      card = std::make_shared<OpenedCard>(wished);
      // A plug-in for a sound server waits for the server's answer, also in non-blocking mode.
      const auto asked = server_.ask("/", [card, device = device_] { card->open(device); });
      if (!asked && asked.error().code == ErrorCode::Timeout) late_ = card;
      if (!asked) return std::unexpected(late_ != nullptr ? kNoAnswer : asked.error());
    }
    if (card->refused < 0) return std::unexpected(openError(card->refused));
    if (card->unfit < 0) {
      return fail(ErrorCode::Unsupported,
                  "the sound card takes neither float nor 16-bit samples; use a converting device, plughw:..",
                  -card->unfit);
    }
    pcm_ = std::exchange(card->pcm, nullptr);
    as_float_ = card->as_float;
    buffer_ = card->buffer;
    written_ = 0;
    return card->format;
  }

  Result<std::size_t> writeFrames(const float* samples, std::size_t frames) override {
    const auto channels = static_cast<std::size_t>(format().channels);
    std::size_t done = 0;
    bool recovered = false;
    while (done < frames) {
      // Ask for the room first, since snd_pcm_writei alone would not write less than a period.
      snd_pcm_sframes_t taken = snd_pcm_avail_update(pcm_);
      if (taken > 0) {
        const std::size_t most = as_float_ ? frames : kConvertedAtOnce / channels;
        const std::size_t count = std::min({frames - done, static_cast<std::size_t>(taken), most});
        taken = snd_pcm_writei(pcm_, native(samples + done * channels, count * channels), count);
      }
      if (taken == 0 || taken == -EAGAIN) break;
      if (taken > 0) {
        done += static_cast<std::size_t>(taken);
        continue;
      }
      // After an underrun or a suspend, restart the device.
      const bool anew = (taken == -EPIPE || taken == -ESTRPIPE) && !std::exchange(recovered, true);
      if (!anew || snd_pcm_prepare(pcm_) < 0) return std::unexpected(lost(static_cast<int>(taken)));
    }
    written_ += static_cast<std::int64_t>(done);
    return done;
  }

  const void* native(const float* samples, std::size_t count) noexcept {
    if (as_float_) return samples;
    for (std::size_t i = 0; i < count; ++i) {
      converted_[i] = static_cast<std::int16_t>(std::lround(32767.0F * std::clamp(samples[i], -1.0F, 1.0F)));
    }
    return converted_.data();
  }

  // The time is read before and after the call, and the mean is taken. ALSA's own timestamps are not used: with some of
  // its plug-ins they come from another clock.
  Result<std::optional<AudioPosition>> samplePosition() override {
    const snd_pcm_state_t state = snd_pcm_state(pcm_);
    if (state == SND_PCM_STATE_DISCONNECTED) return std::unexpected(lost(-ENODEV));
    if (state != SND_PCM_STATE_RUNNING) return std::nullopt;
    snd_pcm_sframes_t available = 0, delay = 0;
    const MonotonicTime before = clock_.now();
    const int code = snd_pcm_avail_delay(pcm_, &available, &delay);  // snd_pcm_delay might not report an underrun
    const MonotonicTime after = clock_.now();
    if (code == -EPIPE || code == -ESTRPIPE) return std::nullopt;
    if (code < 0) return std::unexpected(lost(code));
    return AudioPosition{written_ - delay, before + (after - before) / 2};
  }

  Result<void> dropFrames() override {
    for (const int code : {snd_pcm_drop(pcm_), snd_pcm_prepare(pcm_)}) {
      if (code < 0) return std::unexpected(lost(code));
    }
    written_ = 0;
    return {};
  }

  void closeOutput() noexcept override {
    if (pcm_ != nullptr) snd_pcm_close(std::exchange(pcm_, nullptr));
  }

  static Error lost(int code) noexcept {
    return {ErrorCode::Lost, std::max(-code, 0), "the sound card has gone away; plug it in again"};
  }

  const std::string device_;
  const Clock& clock_;
  FileSystemAnswers server_{kServerPatience};
  std::shared_ptr<OpenedCard> late_;  // a server that answers later is taken at the next try
  snd_pcm_t* pcm_ = nullptr;
  bool as_float_ = true;
  Duration buffer_{0};
  std::int64_t written_ = 0;  // since `open` or the last flush
  std::array<std::int16_t, kConvertedAtOnce> converted_{};
};

}  // namespace

std::unique_ptr<AudioOutput> makeAlsaOutput(std::string device, const Clock& clock) {
  return std::make_unique<AlsaOutput>(std::move(device), clock);
}

}  // namespace relievo
