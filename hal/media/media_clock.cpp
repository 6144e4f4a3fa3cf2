// SPDX-License-Identifier: Apache-2.0
// The film's clock: every change of rate starts a new pair at the current position, so that time never jumps.
#include "hal/media/media_clock.h"

#include <algorithm>

namespace relievo {

void MediaClock::start(MediaTime media, MonotonicTime now) noexcept {
  sample_ = ClockSample{media, now, paused_ ? 0.0 : rate_ * steering_};
}

void MediaClock::reset() noexcept {
  sample_.reset();
  paused_ = false;
}

Result<void> MediaClock::pause(MonotonicTime now) noexcept {
  if (!sample_) return fail(ErrorCode::InvalidState, "the media clock is not set yet");
  sample_ = ClockSample{sample_->at(now), now, 0.0};
  paused_ = true;
  return {};
}

Result<void> MediaClock::resume(MonotonicTime now) noexcept {
  if (!sample_) return fail(ErrorCode::InvalidState, "the media clock is not set yet");
  sample_ = ClockSample{sample_->at(now), now, rate_ * steering_};
  paused_ = false;
  return {};
}

Result<void> MediaClock::setRate(double rate, MonotonicTime now) noexcept {
  if (!(rate > 0.0 && rate <= 16.0)) return fail(ErrorCode::InvalidArgument, "a rate must be over 0 and at most 16");
  rate_ = rate;
  if (sample_ && !paused_) sample_ = ClockSample{sample_->at(now), now, rate_ * steering_};
  return {};
}

void MediaClock::steer(double ratio, MonotonicTime now) noexcept {
  const double steering = std::clamp(ratio, 1.0 - kMostSteering, 1.0 + kMostSteering);
  if (steering == steering_) return;
  steering_ = steering;
  if (sample_ && !paused_) sample_ = ClockSample{sample_->at(now), now, rate_ * steering_};
}

std::optional<MediaTime> MediaClock::position(MonotonicTime now) const noexcept {
  if (!sample_) return std::nullopt;
  return sample_->at(now);
}

}  // namespace relievo
