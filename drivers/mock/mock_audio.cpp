// SPDX-License-Identifier: Apache-2.0
// A virtual sound card: a buffer that empties at its crystal's rate, a latency to the ear, and a bench for tests.
#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "drivers/mock/mock.h"

namespace relievo {
namespace {

constexpr std::int64_t kHistoryFrames = 48'000;  // the least history that the bench can query

class MockAudio final : public AudioOutput {
 public:
  MockAudio(MockAudioProfile profile, const Clock& clock, std::shared_ptr<MockAudioBench> bench)
      : profile_(profile), clock_(clock), bench_(std::move(bench)) {
    if (bench_ == nullptr) bench_ = std::make_shared<MockAudioBench>();
    bench_->heard = [this](MonotonicTime time) { return heardAt(time); };
  }
  ~MockAudio() override { bench_->heard = nullptr; }
  MockAudio(const MockAudio&) = delete;
  MockAudio& operator=(const MockAudio&) = delete;

  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = profile_.name, .buffer = profile_.buffer};
  }

 private:
  Result<AudioFormat> openOutput(const AudioFormat& wished) override {
    if (bench_->unplugged) return fail(ErrorCode::NotFound, "the mock sound card is unplugged");
    if (profile_.fail_open && opens_++ < profile_.failing_opens) {
      return fail(*profile_.fail_open, "the mock sound card was told not to open");
    }
    format_ = profile_.format.value_or(wished);
    frames_per_ns_ = format_.rate_hz * (1 + 1e-6 * profile_.drift_ppm) * 1e-9;
    room_ = std::llround(toSeconds(profile_.buffer) * format_.rate_hz);
    played_before_ = 0;
    forget();
    return format_;
  }

  Result<std::size_t> writeFrames(const float* samples, std::size_t frames) override {
    const MonotonicTime now = clock_.now();
    if (auto there = follow(now); !there) return std::unexpected(there.error());
    const std::int64_t taken =
        profile_.paced ? std::min<std::int64_t>(static_cast<std::int64_t>(frames), room_ - (written_ - left(now)))
                       : static_cast<std::int64_t>(frames);
    if (!running_) {
      running_ = true;
      begin_ = now + profile_.start_latency;
      begin_frame_ = written_;
    }
    const auto stride = static_cast<std::size_t>(format_.channels);
    for (std::int64_t i = 0; i < taken; ++i) line_.push_back(samples[static_cast<std::size_t>(i) * stride]);
    written_ += taken;
    return static_cast<std::size_t>(taken);
  }

  Result<std::optional<AudioPosition>> samplePosition() override {
    const MonotonicTime now = clock_.now();
    if (auto there = follow(now); !there) return std::unexpected(there.error());
    if (!running_ || now < begin_) return std::nullopt;
    if (!profile_.paced) return AudioPosition{written_, now};
    const double off = std::uniform_real_distribution(-1.0, 1.0)(random_) * toSeconds(profile_.jitter);
    return AudioPosition{frameAt(now - profile_.latency) + std::llround(off * format_.rate_hz), now};
  }

  Result<void> dropFrames() override {
    if (auto there = follow(clock_.now()); !there) return there;
    played_before_ += left(clock_.now());
    forget();
    return {};
  }

  void closeOutput() noexcept override { forget(); }

  void forget() noexcept {
    line_.clear();
    line_begin_ = written_ = 0;
    running_ = false;
  }

  // Updates the state to `now`: an underrun or a loss may have happened.
  Result<void> follow(MonotonicTime now) {
    if (bench_->unplugged || played_before_ + left(now) >= static_cast<std::int64_t>(std::min(
                                                               profile_.lose_after_frames, std::uint64_t{1} << 62))) {
      return fail(ErrorCode::Lost, "the mock sound card has gone away");
    }
    if (running_ && profile_.paced && now >= begin_ && frameAt(now) >= written_) running_ = false;
    while (line_begin_ < left(now) - kHistoryFrames && !line_.empty()) {
      line_.pop_front();
      ++line_begin_;
    }
    return {};
  }

  // The frame that leaves the buffer at that time, if it was written by then.
  [[nodiscard]] std::int64_t frameAt(MonotonicTime time) const noexcept {
    return begin_frame_ +
           static_cast<std::int64_t>(std::floor(static_cast<double>((time - begin_).count()) * frames_per_ns_));
  }

  // The number of frames that have left the buffer.
  [[nodiscard]] std::int64_t left(MonotonicTime now) const noexcept {
    if (!running_ || !profile_.paced) return written_;
    return std::clamp(frameAt(now), begin_frame_, written_);
  }

  [[nodiscard]] std::optional<float> heardAt(MonotonicTime time) const {
    if (!running_) return std::nullopt;
    const std::int64_t frame = frameAt(time - profile_.latency);
    if (frame < std::max(begin_frame_, line_begin_) || frame >= written_) return std::nullopt;
    return line_[static_cast<std::size_t>(frame - line_begin_)];
  }

  MockAudioProfile profile_;
  const Clock& clock_;
  std::shared_ptr<MockAudioBench> bench_;
  AudioFormat format_;
  double frames_per_ns_ = 0;
  std::int64_t room_ = 0;
  std::uint64_t opens_ = 0;
  std::int64_t played_before_ = 0;  // frames between `open` and the last flush

  std::int64_t written_ = 0;  // since the last flush
  std::deque<float> line_;    // the first channel of frames from line_begin_ to written_
  std::int64_t line_begin_ = 0;
  bool running_ = false;
  MonotonicTime begin_;           // when playback began
  std::int64_t begin_frame_ = 0;  // the first frame played then
  // NOLINTNEXTLINE(bugprone-random-generator-seed): the same in every run
  std::minstd_rand random_{1};
};

}  // namespace

std::unique_ptr<AudioOutput> makeMockAudio(MockAudioProfile profile, const Clock& clock,
                                           std::shared_ptr<MockAudioBench> bench) {
  return std::make_unique<MockAudio>(profile, clock, std::move(bench));
}

}  // namespace relievo
