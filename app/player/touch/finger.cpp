// SPDX-License-Identifier: Apache-2.0
// Follows one device and drains its ticks and faults.
#include "app/player/touch/finger.h"

namespace relievo {
namespace {

const char* answerTo(HapticFault::Kind kind) noexcept {
  switch (kind) {
    case HapticFault::Kind::DeviceLost:
      return "zero force; the film plays on, and the player looks for the device";
    case HapticFault::Kind::DeviceError:
      return "the tick was left out";
    case HapticFault::Kind::FeedStale:
      return "force off until it catches up";
    case HapticFault::Kind::FeedRecovered:
      return "force on again";
  }
  return "";
}

}  // namespace

void Finger::follow() {
  using Kind = DeviceKeeper::News::Kind;
  while (const auto news = session_.poll()) {
    if (news->kind == Kind::Refused) {
      journal_.note(who_ + "haptic device: " + news->error.message,
                    "the film plays without force; the player tries again");
    } else if (news->kind == Kind::Homing) {
      journal_.note(who_ + "haptic device: not calibrated; move the handle through its whole range",
                    "no force until then");
    } else if (was_lost_) {
      journal_.note(who_ + "haptic device back", "the force fades in");
    }
  }
}

void Finger::start(const DisplayVolume& volume, const Material& material, const Material& material_scale,
                   const LookAhead& ahead, const SurfaceFeeder& first) {
  if (!session_.waiting()) return;
  if (auto started = session_.start(volume, material, material_scale, ahead, first); !started) {
    journal_.note(who_ + "haptic device: " + started.error().message, "the film plays without force");
    return;
  }
  if (recorder_ != nullptr) recorder_->setDevice(session_.capabilities());
  if (const std::string& reduced = session_.reducedMaterial(); !reduced.empty()) {
    journal_.note(who_ + "material: " + reduced, "this device holds no more");
  }
  // The real-time thread logs these itself.
  for (const char* missing : {session_.missingMemory(), session_.missingScheduler()}) {
    if (missing != nullptr) journal_.noteQuietly(who_ + "haptic: " + missing, "ticks may come late");
  }
}

void Finger::drain(const SurfaceFeeder& surface, SeekTimes& seeks, LiveTimes* live) {
  while (const auto tick = session_.nextTick()) {
    if (recorder_ != nullptr) recorder_->add(*tick);
    if (!first_tick_ && tick->device_present) first_tick_ = tick->time;
    if (live != nullptr && tick->device_present) live->felt(tick->time, tick->surface_time);
    if (seeks.waitsForTouch(tick->time)) seeks.felt(tick->time, surface.frameAt(tick->media_time));
  }
  session_.printLog();
  while (const auto fault = session_.nextFault()) {
    was_lost_ = was_lost_ || fault->kind == HapticFault::Kind::DeviceLost;
    journal_.note(who_ + name(fault->kind), answerTo(fault->kind), fault->time);
  }
}

std::optional<FingerMark> Finger::mark() noexcept {
  const FingerState* finger = session_.finger();
  if (finger == nullptr) return std::nullopt;
  return FingerMark{finger->proxy_mm, finger->force_n, finger->contact};
}

}  // namespace relievo
