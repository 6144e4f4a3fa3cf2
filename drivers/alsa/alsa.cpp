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
#include <optional>
#include <span>
#include <utility>
#include <vector>

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

// A card, as a helper thread uses it: it opens it, and the last one that holds it closes it.
class Card {
 public:
  Card(const AudioFormat& asked, std::shared_ptr<Card> other)
      : wished(asked), format(asked), before(std::move(other)) {}
  ~Card() { close(); }
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;

  void open(const std::string& device) {
    before.reset();
    refused = snd_pcm_open(&pcm_, device.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
    if (refused < 0) pcm_ = nullptr;
    else unfit = configure();
    if (unfit < 0) close();
    done = true;
  }

  // How many frames it took, or ALSA's error.
  snd_pcm_sframes_t write(std::span<const float> samples) {
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

  struct Delay {
    int code = 0;  // 0, or ALSA's error; -EPIPE: silent
    snd_pcm_sframes_t frames = 0;
  };
  Delay delay() {
    const snd_pcm_state_t state = snd_pcm_state(pcm_);
    if (state == SND_PCM_STATE_DISCONNECTED) return {.code = -ENODEV};
    if (state != SND_PCM_STATE_RUNNING) return {.code = -EPIPE};
    snd_pcm_sframes_t available = 0, waiting = 0;
    const int code = snd_pcm_avail_delay(pcm_, &available, &waiting);  // snd_pcm_delay might not report an underrun
    return {code, waiting};
  }

  int drop() {
    const int dropped = snd_pcm_drop(pcm_), prepared = snd_pcm_prepare(pcm_);
    return dropped < 0 ? dropped : prepared;
  }

  const AudioFormat wished;
  AudioFormat format;
  std::shared_ptr<Card> before;    // is closed first
  std::atomic<bool> done = false;  // what follows stands, and belongs to the player's thread
  int refused = 0, unfit = 0;      // ALSA's errors
  Duration buffer{0};

 private:
  void close() {
    if (pcm_ != nullptr) snd_pcm_close(std::exchange(pcm_, nullptr));
  }

  int configure() {
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

  const void* native(std::span<const float> samples) noexcept {
    if (as_float_) return samples.data();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      converted_[i] = static_cast<std::int16_t>(std::lround(32767.0F * std::clamp(samples[i], -1.0F, 1.0F)));
    }
    return converted_.data();
  }

  snd_pcm_t* pcm_ = nullptr;
  bool as_float_ = true;
  std::array<std::int16_t, kConvertedAtOnce> converted_{};
};

// A plug-in for a sound server waits for the server's answer, also in non-blocking mode: all calls are made by a helper
// thread. One that does not return costs that thread, and the card is lost.
class AlsaOutput final : public AudioOutput {
 public:
  AlsaOutput(std::string device, const Clock& clock) : device_(std::move(device)), clock_(clock) {
    snd_lib_error_set_handler(printNothing);
  }
  ~AlsaOutput() override {
    close();
    card_ = std::move(late_);
    closeOutput();
  }
  AlsaOutput(const AlsaOutput&) = delete;
  AlsaOutput& operator=(const AlsaOutput&) = delete;

  [[nodiscard]] Capabilities capabilities() const noexcept override { return {.name = "alsa", .buffer = buffer_}; }

 private:
  Result<AudioFormat> openOutput(const AudioFormat& wished) override {
    constexpr Error kNotYet{ErrorCode::Timeout, 0, kSilentServer};
    if (late_ != nullptr && !late_->done) return std::unexpected(kNotYet);
    std::shared_ptr<Card> card = std::exchange(late_, nullptr);
    if (card == nullptr || card->wished.rate_hz != wished.rate_hz || card->wished.channels != wished.channels) {
      card = std::make_shared<Card>(wished, std::move(card));
      const auto asked = server_.ask(kServer, [card, device = device_] { card->open(device); });
      if (!asked && asked.error().code == ErrorCode::Timeout) {
        const bool begun = card.use_count() > 1 || card->done;  // none is while an earlier call hangs
        late_ = begun ? card : std::move(card->before);
        return std::unexpected(kNotYet);
      }
      if (!asked) return std::unexpected(asked.error());
    }
    if (card->refused < 0) return std::unexpected(openError(card->refused));
    if (card->unfit < 0) {
      return fail(ErrorCode::Unsupported,
                  "the sound card takes neither float nor 16-bit samples; use a converting device, plughw:..",
                  -card->unfit);
    }
    card_ = std::move(card);
    buffer_ = card_->buffer;
    written_ = 0;
    return card_->format;
  }

  Result<std::size_t> writeFrames(const float* samples, std::size_t frames) override {
    std::vector<float> copy(samples, samples + frames * static_cast<std::size_t>(card_->format.channels));
    const auto taken = answerOf([copy = std::move(copy)](Card& card) { return card.write(copy); });
    if (!taken) return std::unexpected(taken.error());
    if (*taken < 0) return std::unexpected(lost(static_cast<int>(*taken)));
    written_ += *taken;
    return static_cast<std::size_t>(*taken);
  }

  // The time is read before and after the call, and the mean is taken. ALSA's own timestamps are not used: with some of
  // its plug-ins they come from another clock.
  Result<std::optional<AudioPosition>> samplePosition() override {
    const MonotonicTime before = clock_.now();
    const auto delay = answerOf([](Card& card) { return card.delay(); });
    const MonotonicTime after = clock_.now();
    if (!delay) return std::unexpected(delay.error());
    if (delay->code == -EPIPE || delay->code == -ESTRPIPE) return std::nullopt;
    if (delay->code < 0) return std::unexpected(lost(delay->code));
    return AudioPosition{written_ - delay->frames, before + (after - before) / 2};
  }

  Result<void> dropFrames() override {
    const auto code = answerOf([](Card& card) { return card.drop(); });
    if (!code) return std::unexpected(code.error());
    if (*code < 0) return std::unexpected(lost(*code));
    written_ = 0;
    return {};
  }

  void closeOutput() noexcept override {
    if (card_ == nullptr) return;
    static_cast<void>(server_.ask(kServer, [card = std::move(card_)]() mutable { card.reset(); }));
    card_ = nullptr;
  }

  // What `call` returns, which must own all that it uses.
  template <class Call>
  auto answerOf(Call call) -> Result<decltype(call(std::declval<Card&>()))> {
    const auto answer =
        relievo::answerOf(kServer, [card = card_, call = std::move(call)] { return call(*card); }, server_);
    if (answer) return answer;
    card_ = nullptr;  // the helper thread still holds it
    return fail(ErrorCode::Lost, answer.error().code == ErrorCode::Timeout ? kSilentServer : answer.error().message);
  }

  static Error lost(int code) noexcept {
    return {ErrorCode::Lost, std::max(-code, 0), "the sound card has gone away; plug it in again"};
  }

  static constexpr const char* kServer = "/";  // all calls wait for the same one
  static constexpr const char* kSilentServer = "the sound server does not answer within 3 s; start it anew";

  const std::string device_;
  const Clock& clock_;
  FileSystemAnswers server_{kServerPatience};
  std::shared_ptr<Card> card_;  // null: closed
  std::shared_ptr<Card> late_;  // a server that answers later is taken at the next try
  Duration buffer_{0};
  std::int64_t written_ = 0;  // since `open` or the last flush
};

}  // namespace

std::unique_ptr<AudioOutput> makeAlsaOutput(std::string device, const Clock& clock) {
  return std::make_unique<AlsaOutput>(std::move(device), clock);
}

}  // namespace relievo
