// SPDX-License-Identifier: Apache-2.0
// The clock of a film: maps monotonic time to media time by a pair of times and a rate.
#pragma once

#include <optional>

#include "hal/media/media_time.h"
#include "platform/error.h"

namespace relievo {

// At `monotonic` the film was at `media` and ran at `rate`. Trivially copyable: it is passed to the real-time task
// inside the surface window, so that both sides agree on the time without sharing a clock object.
struct ClockSample {
  MediaTime media;
  MonotonicTime monotonic;
  double rate = 0;  // about 1 playing, 0 paused, 0.5 slow motion

  [[nodiscard]] constexpr MediaTime at(MonotonicTime now) const noexcept {
    const auto elapsed = now - monotonic;
    if (rate == 1.0) return media + elapsed;
    return media + Duration(static_cast<Duration::rep>(static_cast<double>(elapsed.count()) * rate));
  }
  // A moment at which the film is at `time` or up to 2 ns beyond it; for a rate over 0.
  [[nodiscard]] constexpr MonotonicTime when(MediaTime time) const noexcept {
    const auto ahead = time - media;
    if (rate == 1.0) return monotonic + ahead;
    constexpr Duration kRounding(2);
    return monotonic + Duration(static_cast<Duration::rep>(static_cast<double>(ahead.count()) / rate)) + kRounding;
  }
};

// States: Unset (until the first frame, and after `reset`) -> Running <-> Paused. Owner's thread only; never blocks.
// The time is injected: `now` comes from the caller's Clock, so that a test runs in simulated time. Another master
// clock (sound) corrects it by `steer`, without jumps, since the finger feels the film at this clock's time as well.
class MediaClock {
 public:
  // Sets the pair, in any state. The clock runs at the rate last set (initially 1), or stays paused if it was paused.
  void start(MediaTime media, MonotonicTime now) noexcept;
  // Returns to Unset and ends a pause: for a seek or a new film.
  void reset() noexcept;
  // InvalidState while Unset. Each keeps the media time continuous.
  [[nodiscard]] Result<void> pause(MonotonicTime now) noexcept;
  [[nodiscard]] Result<void> resume(MonotonicTime now) noexcept;
  // 0 < rate <= 16, else InvalidArgument. While Unset, takes effect at the next `start`.
  [[nodiscard]] Result<void> setRate(double rate, MonotonicTime now) noexcept;
  // Multiplies the rate by `ratio` until the next call; initially 1. Clamped to kMostSteering around 1. The media time
  // stays continuous. In any state; `reset` keeps it.
  void steer(double ratio, MonotonicTime now) noexcept;
  static constexpr double kMostSteering = 0.005;

  [[nodiscard]] bool paused() const noexcept { return paused_; }
  // nullopt while Unset.
  [[nodiscard]] std::optional<ClockSample> sample() const noexcept { return sample_; }
  [[nodiscard]] std::optional<MediaTime> position(MonotonicTime now) const noexcept;

 private:
  std::optional<ClockSample> sample_;
  double rate_ = 1.0;
  double steering_ = 1.0;
  bool paused_ = false;
};

}  // namespace relievo
