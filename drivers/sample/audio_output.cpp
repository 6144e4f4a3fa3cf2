// SPDX-License-Identifier: Apache-2.0
// Sound output: a buffer that empties in real time. A driver of a real card computes the same values from the state of
// the card's own buffer.
#include <algorithm>

#include "drivers/sample/sample.h"

namespace relievo {
namespace {

constexpr Duration kBuffer = std::chrono::milliseconds(500);  // at least 400 ms: longer than a picture takes to draw
constexpr const char* kGone = "the sound card has gone away; plug it in again";

class SampleAudio final : public AudioOutput {
 public:
  SampleAudio(std::shared_ptr<const SampleCard> card, const Clock& clock) : card_(std::move(card)), clock_(clock) {}

  [[nodiscard]] Capabilities capabilities() const noexcept override { return {.name = "sample", .buffer = kBuffer}; }

 private:
  // Returns the actual format.
  Result<AudioFormat> openOutput(const AudioFormat& wished) override {
    if (!card_->there) return fail(ErrorCode::NotFound, "there is no such sound card; see relievo devices");
    rate_hz_ = wished.rate_hz;
    forget();
    return AudioFormat{.rate_hz = rate_hz_, .channels = 2};
  }

  // Takes as many frames as fit, without waiting. The first write starts playback.
  Result<std::size_t> writeFrames(const float* /*samples*/, std::size_t frames) override {
    const MonotonicTime now = clock_.now();
    if (!card_->there) return fail(ErrorCode::Lost, kGone);
    if (isDry(now)) {
      begin_ = now;
      begin_frame_ = written_;
    }
    const std::int64_t room = framesIn(kBuffer) - (written_ - heardAt(now));
    const std::int64_t taken = std::clamp<std::int64_t>(static_cast<std::int64_t>(frames), 0, room);
    written_ += taken;
    return static_cast<std::size_t>(taken);
  }

  // Samples frames and time together; nullopt while silent.
  Result<std::optional<AudioPosition>> samplePosition() override {
    const MonotonicTime now = clock_.now();
    if (!card_->there) return fail(ErrorCode::Lost, kGone);
    if (isDry(now)) return std::nullopt;
    return AudioPosition{.frames = heardAt(now), .time = now};
  }

  Result<void> dropFrames() override {
    forget();
    return {};
  }
  void closeOutput() noexcept override { forget(); }

  void forget() noexcept { written_ = begin_frame_ = 0; }

  [[nodiscard]] std::int64_t framesIn(Duration d) const noexcept {
    return static_cast<std::int64_t>(toSeconds(d) * rate_hz_);
  }
  // Frames heard since the last flush; valid unless in an underrun.
  [[nodiscard]] std::int64_t heardAt(MonotonicTime now) const noexcept { return begin_frame_ + framesIn(now - begin_); }
  [[nodiscard]] bool isDry(MonotonicTime now) const noexcept { return written_ == 0 || heardAt(now) >= written_; }

  const std::shared_ptr<const SampleCard> card_;
  const Clock& clock_;
  int rate_hz_ = 48000;
  std::int64_t written_ = 0;      // since the last flush
  MonotonicTime begin_;           // when playback last began
  std::int64_t begin_frame_ = 0;  // the first frame played then
};

}  // namespace

std::unique_ptr<AudioOutput> makeSampleAudio(std::shared_ptr<const SampleCard> card, const Clock& clock) {
  return std::make_unique<SampleAudio>(std::move(card), clock);
}

}  // namespace relievo
