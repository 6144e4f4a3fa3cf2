// SPDX-License-Identifier: Apache-2.0
// Publishes surfaces; drains ticks and faults.
#include "app/player/touch/film_touch.h"

#include <span>
#include <utility>

namespace relievo {
namespace {

const char* answerTo(HapticFault::Kind kind) noexcept {
  switch (kind) {
    case HapticFault::Kind::DeviceLost:
      return "zero force; the film plays on, and the player looks for the device";
    case HapticFault::Kind::DeviceError:
      return "the tick was left out";
    case HapticFault::Kind::FeedStale:
      return "force faded";
    case HapticFault::Kind::FeedRecovered:
      return "force faded in again";
  }
  return "";
}

}  // namespace

void FilmTouch::stop() noexcept {
  const std::scoped_lock lock(mutex_);
  session_.stop();
}

void FilmTouch::rest() noexcept {
  const std::scoped_lock lock(mutex_);
  session_.rest();
  surface_.beginEpoch();
  missing_ = refused_ = false;
}

void FilmTouch::setScene(const DepthCalibration& calibration, const DisplayVolume& volume, const Material& material,
                         const Material& material_scale) noexcept {
  const std::scoped_lock lock(mutex_);
  volume_ = volume;
  material_ = material;
  material_scale_ = material_scale;
  surface_.setScene(calibration, volume);
}

void FilmTouch::setLookAhead(const LookAhead& ahead) noexcept {
  const std::scoped_lock lock(mutex_);
  look_ahead_ = ahead;
  surface_.setCarried(ahead.carried);
}

void FilmTouch::beginEpoch() noexcept {
  const std::scoped_lock lock(mutex_);
  surface_.beginEpoch();
}

void FilmTouch::hear(const Frame& depth, const Frame& material) {
  const std::scoped_lock lock(mutex_);
  if (surface_.hear(depth, material)) session_.publish(surface_);
}

void FilmTouch::feed(const DepthAround& depth, const ClockSample& clock) {
  const std::scoped_lock lock(mutex_);
  const auto ahead = std::span(depth.ahead).first(depth.ahead_count);
  const std::span<const Frame> materials = std::span(depth.material_ahead).first(depth.ahead_count);
  const auto changed =
      surface_.update(depth.present, ahead, depth.last, clock, {depth.material, materials}, depth.felt);
  if (!changed) {
    if (!std::exchange(refused_, true)) {
      journal_.note(std::string("depth: ") + changed.error().message, "it plays without force");
    }
    session_.publish(surface_);
    return;
  }
  if (*changed) session_.publish(surface_);
  const bool missing = depth.expected && depth.present.empty();
  if (missing && !missing_) journal_.note("no depth at this time", "the picture is flat there, without force");
  missing_ = missing;
}

bool FilmTouch::followDevice() {
  using Kind = DeviceKeeper::News::Kind;
  const std::scoped_lock lock(mutex_);
  while (const auto news = session_.poll()) {
    if (news->kind == Kind::Refused) {
      journal_.note(std::string("haptic device: ") + news->error.message,
                    "the film plays without force; the player tries again");
    } else if (news->kind == Kind::Homing) {
      journal_.note("haptic device: not calibrated; move the handle through its whole range", "no force until then");
    } else if (was_lost_) {
      journal_.note("haptic device back", "the force fades in");
    }
  }
  return waiting();
}

void FilmTouch::start() {
  const std::scoped_lock lock(mutex_);
  if (auto started = session_.start(volume_, material_, material_scale_, look_ahead_, surface_); !started) {
    journal_.note(std::string("haptic device: ") + started.error().message, "the film plays without force");
    return;
  }
  if (recorder_ != nullptr) recorder_->setDevice(session_.capabilities());
  if (const std::string& reduced = session_.reducedMaterial(); !reduced.empty()) {
    journal_.note("material: " + reduced, "this device holds no more");
  }
  // The real-time thread logs these itself.
  for (const char* missing : {session_.missingMemory(), session_.missingScheduler()}) {
    if (missing != nullptr) journal_.noteQuietly(std::string("haptic: ") + missing, "ticks may come late");
  }
}

void FilmTouch::drain(SeekTimes& seeks, LiveTimes* live) {
  const std::scoped_lock lock(mutex_);
  while (const auto tick = session_.nextTick()) {
    if (recorder_ != nullptr) recorder_->add(*tick);
    if (!first_tick_ && tick->device_present) first_tick_ = tick->time;
    if (live != nullptr && tick->device_present) live->felt(tick->time, tick->surface_time);
    if (seeks.waitsForTouch(tick->time)) seeks.felt(tick->time, surface_.frameAt(tick->media_time));
  }
  session_.printLog();
  while (const auto fault = session_.nextFault()) {
    was_lost_ = was_lost_ || fault->kind == HapticFault::Kind::DeviceLost;
    journal_.note(name(fault->kind), answerTo(fault->kind), fault->time);
  }
}

std::optional<FingerMark> FilmTouch::mark() noexcept {
  const FingerState* finger = session_.finger();
  if (finger == nullptr) return std::nullopt;
  return FingerMark{finger->proxy_mm, finger->force_n, finger->contact};
}

}  // namespace relievo
