// SPDX-License-Identifier: Apache-2.0
// Sound output by ALSA, whose calls may hang.
#include "drivers/alsa/alsa.h"

#include <alsa/asoundlib.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/alsa/card.h"
#include "drivers/alsa/one_call.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using alsa::Card;

constexpr Duration kServerPatience = 3s;
constexpr Duration kLastPatience = 500ms;  // a program that ends while the library closes a card may crash
constexpr Error kNotYet{ErrorCode::Timeout, 0, "the sound server does not answer; start it anew"};

constexpr Error kNoThread{ErrorCode::Timeout, EAGAIN,
                          "the limit on processes is reached; raise it (ulimit -u) or end some"};

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

// A plug-in for a sound server waits for the server's answer, also in non-blocking mode: each call is made by a helper
// thread. While one has not returned, the output takes nothing and is where it was heard last; after 3 s the card is
// lost, and the thread with it.
class AlsaOutput final : public AudioOutput {
 public:
  AlsaOutput(std::string device, const Clock& clock, AlsaPatience patience)
      : device_(std::move(device)), clock_(clock), patience_(patience) {
    snd_lib_error_set_handler(printNothing);
  }
  ~AlsaOutput() override {
    close();
    card_ = std::move(late_);
    closeOutput();
    call_.wait(kLastPatience);
  }
  AlsaOutput(const AlsaOutput&) = delete;
  AlsaOutput& operator=(const AlsaOutput&) = delete;

  [[nodiscard]] Capabilities capabilities() const noexcept override { return {.name = "alsa", .buffer = buffer_}; }

 private:
  // What the last call wrote, and its kind.
  struct Answer {
    enum class Of : std::uint8_t { Write, Delay, Drop } of = Of::Write;
    snd_pcm_sframes_t code = 0;  // of a write: frames; negative: ALSA's error
    snd_pcm_sframes_t waiting = 0;
  };

  Result<AudioFormat> openOutput(const AudioFormat& wished) override {
    call_.tryAgain();
    if (!call_.ended()) return std::unexpected(late());
    std::shared_ptr<Card> card = std::exchange(late_, nullptr);
    if (card == nullptr || card->wished != wished) {
      card = std::make_shared<Card>(wished, std::move(card));
      const bool opened = call_.start([card, device = device_] { card->open(device); },
                                      std::exchange(opened_before_, true) ? patience_.call : patience_.open);
      if (!opened) {
        late_ = std::move(card);
        return std::unexpected(late());
      }
    }
    if (card->refused < 0) return std::unexpected(openError(card->refused));
    if (card->unfit < 0) {
      return fail(ErrorCode::Unsupported,
                  "the sound card takes neither float nor 16-bit samples; use a converting device, plughw:..",
                  -card->unfit);
    }
    card_ = std::move(card);
    buffer_ = card_->buffer;
    answer_ = nullptr;
    drops_ = false;
    forget();
    return card_->format;
  }

  // Frames that a late call took are counted by the next write, which begins with the same ones.
  Result<std::size_t> writeFrames(const float* samples, std::size_t frames) override {
    const auto free = settle();
    if (!free) return std::unexpected(free.error());
    if (*free && untold_ == 0) {
      std::vector<float> copy(samples, samples + frames * static_cast<std::size_t>(card_->format.channels));
      const auto written = ask(
          Answer::Of::Write, [copy = std::move(copy)](Card& card, Answer& answer) { answer.code = card.write(copy); });
      if (!written) return std::unexpected(written.error());
    }
    const std::size_t told = std::min(untold_, frames);
    untold_ -= told;
    return told;
  }

  Result<std::optional<AudioPosition>> samplePosition() override {
    const auto free = settle();
    if (!free) return std::unexpected(free.error());
    if (!*free) return heard_;
    const auto asked = ask(Answer::Of::Delay, [](Card& card, Answer& answer) {
      const Card::Delay delay = card.delay();
      answer.code = delay.code;
      answer.waiting = delay.frames;
    });
    if (!asked) return std::unexpected(asked.error());
    return heard_;
  }

  Result<void> dropFrames() override {
    drops_ = true;
    forget();
    const auto free = settle();
    return free ? Result<void>() : std::unexpected(free.error());
  }

  void closeOutput() noexcept override {
    if (card_ == nullptr) return;
    if (call_.ended()) call_.start([card = std::move(card_)]() mutable { card.reset(); }, patience_.call);
    else call_.letGo(std::move(card_));  // the call that has not returned closes it
    card_ = nullptr;
  }

  // Why the call has not ended.
  [[nodiscard]] const Error& late() const noexcept { return call_.begun() ? kNotYet : kNoThread; }

  void forget() {
    written_ = 0;
    untold_ = 0;
    heard_.reset();
  }

  // Starts a call of the card. False if it has not returned yet.
  Result<bool> ask(Answer::Of of, std::function<void(Card&, Answer&)> call) {
    answer_ = std::make_shared<Answer>(Answer{.of = of});
    asked_ = clock_.now();
    const bool ended = call_.start([card = card_, answer = answer_, call = std::move(call)]() { call(*card, *answer); },
                                   patience_.call);
    if (!ended) return false;
    auto taken = take(true);
    return taken ? Result<bool>(true) : std::unexpected(taken.error());
  }

  // True when no call runs: what the last one wrote is taken, and what was to be dropped is.
  Result<bool> settle() {
    if (!call_.ended()) {
      if (clock_.now() - asked_ < kServerPatience) return false;
      call_.letGo(std::exchange(card_, nullptr));
      return std::unexpected(Error{ErrorCode::Lost, 0, late().message});
    }
    if (auto taken = take(false); !taken) return std::unexpected(taken.error());
    if (!std::exchange(drops_, false)) return true;
    return ask(Answer::Of::Drop, [](Card& card, Answer& answer) { answer.code = card.drop(); });
  }

  // The time of a position is read before and after the call, and the mean is taken: it must be at once. ALSA's own
  // timestamps are not used: with some of its plug-ins they come from another clock.
  Result<void> take(bool at_once) {
    const std::shared_ptr<Answer> answer = std::exchange(answer_, nullptr);
    if (answer == nullptr) return {};
    const bool silent = answer->of == Answer::Of::Delay && (answer->code == -EPIPE || answer->code == -ESTRPIPE);
    if (answer->code < 0 && !silent) {
      return fail(ErrorCode::Lost, "the sound card has gone away; plug it in again", static_cast<int>(-answer->code));
    }
    if (drops_) return {};  // it concerns what is to be dropped
    if (answer->of == Answer::Of::Write) {
      written_ += answer->code;
      untold_ += static_cast<std::size_t>(answer->code);
    }
    if (silent) heard_.reset();
    else if (answer->of == Answer::Of::Delay && at_once)
      heard_ = AudioPosition{written_ - answer->waiting, asked_ + (clock_.now() - asked_) / 2};
    return {};
  }

  const std::string device_;
  const Clock& clock_;
  const AlsaPatience patience_;
  alsa::OneCall call_;
  std::shared_ptr<Card> card_;  // null: closed
  std::shared_ptr<Card> late_;  // a server that answers later is taken at the next try
  bool opened_before_ = false;
  Duration buffer_{0};

  std::shared_ptr<Answer> answer_;  // of the call that was started last; null: taken
  MonotonicTime asked_;             // when that was
  bool drops_ = false;              // what the card holds is to be dropped before anything else
  std::int64_t written_ = 0;        // frames, since `open` or the last flush
  std::size_t untold_ = 0;          // of these, those that no `write` has returned yet
  std::optional<AudioPosition> heard_;
};

}  // namespace

std::unique_ptr<AudioOutput> makeAlsaOutput(std::string device, const Clock& clock, AlsaPatience patience) {
  return std::make_unique<AlsaOutput>(std::move(device), clock, patience);
}

}  // namespace relievo
