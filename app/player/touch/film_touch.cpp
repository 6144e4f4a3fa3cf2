// SPDX-License-Identifier: Apache-2.0
// Publishes one surface to all fingers.
#include "app/player/touch/film_touch.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "app/player/touch/finger_name.h"

namespace relievo {

FilmTouch::FilmTouch(const FingerParts& first, const FingerParts& second, Clock& clock, Ticking ticking,
                     Journal& journal)
    : clock_(clock), journal_(journal) {
  const bool two = second.device != nullptr;
  fingers_.emplace_back(first, two ? std::string(kFirstFinger) + ": " : "", clock, ticking, journal);
  if (two) fingers_.emplace_back(second, std::string(kSecondFinger) + ": ", clock, ticking, journal);
}

void FilmTouch::begin() {
  for (Finger& finger : fingers_) finger.session().begin();
}

void FilmTouch::stop() noexcept {
  const std::scoped_lock lock(mutex_);
  for (Finger& finger : fingers_) finger.session().rest();  // no force waits for the other device's end
  for (Finger& finger : fingers_) finger.session().stop();
}

void FilmTouch::rest() noexcept {
  const std::scoped_lock lock(mutex_);
  for (Finger& finger : fingers_) finger.session().rest();
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
  if (surface_.hear(depth, material)) publish();
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
    publish();
    return;
  }
  if (*changed) publish();
  const bool missing = depth.expected && depth.present.empty();
  if (missing && !missing_) journal_.note("no depth at this time", "the picture is flat there, without force");
  missing_ = missing;
}

void FilmTouch::publish() noexcept {
  for (Finger& finger : fingers_) finger.session().publish(surface_);
}

bool FilmTouch::followDevice() {
  const std::scoped_lock lock(mutex_);
  for (Finger& finger : fingers_) finger.follow();
  return waiting();
}

bool FilmTouch::waiting() const noexcept {
  return std::ranges::any_of(fingers_, [](const Finger& finger) { return finger.session().waiting(); });
}

bool FilmTouch::running() const noexcept {
  return std::ranges::any_of(fingers_, [](const Finger& finger) { return finger.session().running(); });
}

void FilmTouch::start() {
  const std::scoped_lock lock(mutex_);
  for (Finger& finger : fingers_) finger.start(volume_, material_, material_scale_, look_ahead_, surface_);
}

void FilmTouch::drain(SeekTimes& seeks, LiveTimes* live) {
  const std::scoped_lock lock(mutex_);
  for (Finger& finger : fingers_) finger.drain(surface_, seeks, live);
}

// Ticks of two fingers run in the order of their times.
void FilmTouch::sleepUntil(MonotonicTime deadline) noexcept {
  const auto due = [](const Finger& finger) { return finger.session().nextTickByHand(); };
  for (;;) {
    Finger& next = *std::ranges::min_element(fingers_, {}, due);
    if (due(next) > deadline) break;
    next.session().tickByHand();
  }
  clock_.sleepUntil(deadline);
}

FingerMarks FilmTouch::marks() noexcept {
  FingerMarks marks;
  for (std::size_t i = 0; i < fingers_.size(); ++i) marks[i] = fingers_[i].mark();
  return marks;
}

}  // namespace relievo
