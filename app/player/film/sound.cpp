// SPDX-License-Identifier: Apache-2.0
// The loop between the output's position and the film's clock.
#include "app/player/film/sound.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace relievo {
namespace {

constexpr Duration kWindowAhead = std::chrono::milliseconds(800);  // more than the output takes
constexpr Duration kWindowBehind = std::chrono::milliseconds(100);
constexpr Duration kReadingPeriod = std::chrono::milliseconds(20);
constexpr int kSettledAfter = 10;        // readings
constexpr double kSmoothing = 1.0 / 16;  // of a reading, in the end
// 200 ppm of drift are led with an offset of 1 ms; the offset halves in 3.5 s.
constexpr double kGainPerS = 0.2;
constexpr double kSteeringStep = 1e-5;  // finer ones are not worth a new clock sample
constexpr Duration kRetryPeriod = std::chrono::seconds(5);
constexpr Duration kMostLatency = std::chrono::seconds(1);
constexpr int kMostRestarts = 5;
constexpr Duration kMostLate = std::chrono::milliseconds(100);  // of a picture; more is a hitch
constexpr int kLatenessPictures = 64;                           // that are averaged
constexpr std::size_t kBlockFrames = 4096;
constexpr double kFadeS = 0.01;  // from one gain to another

}  // namespace

void Sound::open() {
  if (output_ == nullptr) return;
  const auto opened = output_->open({});
  format_ = opened.value_or(AudioFormat{});
  window_.emplace(*format_);
  block_.resize(kBlockFrames * static_cast<std::size_t>(format_->channels));
}

void Sound::forget() noexcept {
  if (window_) window_->clear();
}

void Sound::close() noexcept {
  if (output_ != nullptr) output_->close();
  running_ = false;
}

SoundSummary Sound::summary() const {
  SoundSummary summary = summary_;
  if (output_ != nullptr) summary.device = output_->capabilities().name;
  if (format_) summary.rate_hz = format_->rate_hz;
  if (summary.pictures > 0) summary.mean_offset_ms = sum_offset_ms_ / static_cast<double>(summary.pictures);
  return summary;
}

void Sound::follow(bool plays, MediaClock& clock, FilmFeed& feed) {
  if (!window_) return;
  const MonotonicTime now = clock_.now();
  auto position = clock.position(now);
  if (position) *position -= delay_;
  if (position) collect(*position, feed);
  if (!plays || !position) stop();
  if (running_ && !listen(clock, feed, now)) stop();
  if (plays && position && !window_->empty() && ready(now)) {
    if (!running_) start(*position);
    fill();
  }
  clock.steer(running_ ? steering_ : 1.0, now);
}

// Takes what is near enough to be written, and drops what is over.
void Sound::collect(MediaTime position, FilmFeed& feed) {
  const std::int64_t behind = window_->frameAt(position - kWindowBehind);
  const std::int64_t ahead = window_->frameAt(position + kWindowAhead);
  window_->dropBefore(behind);
  while (window_->empty() || window_->end() < ahead) {
    const auto chunk = feed.takeSound();
    if (!chunk) return;
    window_->add(*chunk);
    window_->dropBefore(behind);
  }
}

void Sound::start(MediaTime position) {
  base_ = cursor_ = window_->frameAt(position + latency_ - fromSeconds(picture_late_s_));
  readings_ = 0;
  offset_s_ = 0;
  heard_ = settled_ = false;
  next_reading_ = {};
  steering_ = 1;
  running_ = window_->end() > cursor_;
}

void Sound::fill() {
  const auto channels = static_cast<std::size_t>(format_->channels);
  while (running_) {
    const std::size_t there = window_->read(cursor_, block_);
    if (there == 0) return;
    const double before = gain_;
    amplify(there * channels);
    const auto taken = output_->write({block_.data(), there * channels});
    if (!taken) return lose(taken.error());
    gain_ = gainAfter(before, *taken);  // the rest is written, and faded, again
    cursor_ += static_cast<std::int64_t>(*taken);
    if (*taken < there) return;
  }
}

double Sound::gainAfter(double before, std::size_t frames) const noexcept {
  const double most = static_cast<double>(frames) / (kFadeS * format_->rate_hz);
  return before + std::clamp(wished_gain_ - before, -most, most);
}

void Sound::setGain(double gain, bool at_once) noexcept {
  wished_gain_ = gain;
  if (!at_once) return;
  gain_ = gain;
  stop();
}

// Louder than whole is cut off at the whole.
void Sound::amplify(std::size_t samples) noexcept {
  if (gain_ == 1 && wished_gain_ == 1) return;
  const auto channels = static_cast<std::size_t>(format_->channels);
  for (std::size_t i = 0; i < samples; i += channels) {
    gain_ = gainAfter(gain_, 1);
    for (std::size_t c = 0; c < channels; ++c) {
      const double louder = static_cast<double>(block_[i + c]) * gain_;
      block_[i + c] = static_cast<float>(std::clamp(louder, -1.0, 1.0));
    }
  }
}

void Sound::setDelay(Duration delay) noexcept {
  delay_ = delay;
  stop();  // it starts anew at its new place
}

MediaTime Sound::end() const noexcept {
  const bool sounds = running_ && window_ && !window_->empty();
  return sounds ? window_->timeOf(window_->end()) + delay_ : MediaTime{};
}

// False when it has to be started anew, or is over.
bool Sound::listen(MediaClock& clock, const FilmFeed& feed, MonotonicTime now) {
  if (now < next_reading_) return true;
  next_reading_ = now + kReadingPeriod;
  const auto heard = output_->position();
  if (!heard) {
    lose(heard.error());
    return true;
  }
  if (!*heard) {
    if (!heard_) return true;
    const bool more = !window_->empty() && window_->end() > cursor_;
    if (more || !feed.hasSoundUntil(window_->timeOf(cursor_ + 1))) ++summary_.underruns;
    return false;
  }
  heard_ = true;
  last_ = **heard;
  const MediaTime film = clock.position(last_.time).value_or(MediaTime{}) - delay_;  // it plays: there is one
  const double offset_s = toSeconds(window_->timeOf(base_ + last_.frames) - film) + picture_late_s_;
  ++readings_;
  offset_s_ += (offset_s - offset_s_) * std::max(1.0 / readings_, kSmoothing);
  if (readings_ < kSettledAfter) return true;
  if (std::abs(offset_s_) > toSeconds(settled_ ? kFar : kNear)) return realign();
  settled_ = true;
  restarts_ = 0;
  steering_ = 1 + std::round(kGainPerS * offset_s_ / kSteeringStep) * kSteeringStep;
  summary_.drift_ppm = 1e6 * (clock.sample()->rate - 1);
  return true;
}

// To start anew: false. An output that is no nearer after several starts is no clock.
bool Sound::realign() {
  ++summary_.realigned;
  if (++restarts_ > kMostRestarts) {
    lose({ErrorCode::Unsupported, 0, "the sound output reports no position"});
    gave_up_ = true;
    return true;
  }
  latency_ = std::clamp(latency_ - fromSeconds(offset_s_), Duration(0), kMostLatency);
  return false;
}

void Sound::stop() noexcept {
  if (!std::exchange(running_, false)) return;
  static_cast<void>(output_->flush());  // one that is lost is found out by the next write
}

// True when there is an output to write to.
bool Sound::ready(MonotonicTime now) {
  if (output_->state() == AudioOutput::State::Open) return true;
  if (gave_up_ || now < next_try_) return false;
  next_try_ = now + kRetryPeriod;
  output_->close();
  const auto opened = output_->open(*format_);
  if (opened && *opened == *format_) {
    if (std::exchange(lost_, false)) news_ = News{"sound output back", "it is heard again"};
    return true;
  }
  gave_up_ = opened.has_value();  // another card: the film is not decoded for that
  output_->close();
  if (!lost_ && !std::exchange(told_, true)) {
    news_ = News{std::string("sound: ") + (opened ? "the output has changed its rate" : opened.error().message),
                 "the film plays without sound; the player tries again"};
  }
  return false;
}

void Sound::lose(const Error& error) {
  output_->close();
  running_ = false;
  lost_ = true;
  next_try_ = clock_.now() + kRetryPeriod;
  news_ = News{std::string("sound: ") + error.message, "the film goes on by the system's clock"};
}

void Sound::noteShown(MediaTime picture, const MediaClock& clock) {
  const MonotonicTime now = clock_.now();
  if (!running_) return;
  const Duration late = std::clamp(clock.position(now).value_or(picture) - picture, Duration(0), kMostLate);
  pictures_late_ = std::min(pictures_late_ + 1, kLatenessPictures);
  picture_late_s_ += (toSeconds(late) - picture_late_s_) / pictures_late_;
  if (!settled_) return;
  const MediaTime sound = window_->timeOf(base_ + last_.frames) + (now - last_.time) + delay_;
  const double offset_ms = 1e3 * toSeconds(sound - picture);
  ++summary_.pictures;
  sum_offset_ms_ += offset_ms;
  summary_.max_offset_ms = std::max(summary_.max_offset_ms, std::abs(offset_ms));
}

}  // namespace relievo
