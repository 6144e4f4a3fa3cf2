// SPDX-License-Identifier: Apache-2.0
// The control loop between the output's position and the film's clock.
#include "app/player/sound/sound.h"

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
// A drift of 200 ppm is corrected with an offset of 1 ms; the offset halves in 3.5 s.
constexpr double kGainPerS = 0.2;
constexpr double kSteeringStep = 1e-5;  // finer ones are not worth a new clock sample
constexpr Duration kRetryPeriod = std::chrono::seconds(5);
// A sound server that has not answered yet may soon.
constexpr Duration kLatePeriod = std::chrono::milliseconds(200);
constexpr Duration kServerPatience = std::chrono::seconds(3);
constexpr Duration kMostLatency = std::chrono::seconds(1);
constexpr int kMostRestarts = 5;
constexpr Duration kMostLate = std::chrono::milliseconds(100);  // of a picture; more is a hitch
constexpr int kLatenessPictures = 64;                           // that are averaged
constexpr std::size_t kBlockFrames = 4096;

}  // namespace

void Sound::open() {
  if (output_ == nullptr) return;
  const auto opened = output_->open({});
  known_ = opened.has_value();
  take(opened.value_or(AudioFormat{}));
}

void Sound::take(const AudioFormat& format) {
  format_ = format;
  window_.emplace(format);
  block_.resize(kBlockFrames * static_cast<std::size_t>(format.channels));
}

void Sound::beginFilm() {
  if (!other_) return;
  take(*std::exchange(other_, std::nullopt));
  next_try_ = {};
}

void Sound::forget() noexcept {
  if (window_) window_->clear();
}

void Sound::rest() noexcept {
  if (output_ != nullptr && output_->state() == AudioOutput::State::Open) output_->close();
  run_.reset();
}

void Sound::close() noexcept {
  if (output_ != nullptr) output_->close();
  run_.reset();
}

SoundSummary Sound::summary() const {
  SoundSummary summary = summary_;
  if (output_ != nullptr && sounds_) summary.device = output_->capabilities().name;
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
  if (run_ && !listen(clock, feed, now)) stop();
  sounds_ = sounds_ || !window_->empty();
  if (plays && position && !window_->empty() && ready(feed, now)) {
    if (!run_) start(*position);
    fill();
  }
  clock.steer(run_ ? run_->steering : 1.0, now);
}

// Takes the sound that will be written soon, and drops what is past.
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
  const std::int64_t first = window_->frameAt(position + latency_ - fromSeconds(picture_late_s_));
  if (window_->end() > first) run_ = Run{.base = first, .cursor = first};
}

void Sound::fill() {
  const auto channels = static_cast<std::size_t>(format_->channels);
  while (run_) {
    const std::size_t there = window_->read(run_->cursor, block_);
    if (there == 0) return;
    const std::span<float> samples{block_.data(), there * channels};
    const double began_with = gain_.amplify(samples, *format_);
    const auto taken = output_->write(samples);
    if (!taken) return lose(taken.error());
    gain_.endAfter(*taken, began_with, *format_);  // the rest is amplified and written again
    run_->cursor += static_cast<std::int64_t>(*taken);
    if (*taken < there) return;
  }
}

void Sound::setGain(double gain, bool at_once) noexcept {
  if (!at_once) return gain_.set(gain);
  gain_.setAtOnce(gain);
  stop();
}

void Sound::setDelay(Duration delay) noexcept {
  delay_ = delay;
  stop();  // it starts anew at its new place
}

MediaTime Sound::end() const noexcept {
  const bool sounds = run_ && window_ && !window_->empty();
  return sounds ? window_->timeOf(window_->end()) + delay_ : MediaTime{};
}

// False if the sound has to be restarted, or is over.
bool Sound::listen(MediaClock& clock, const FilmFeed& feed, MonotonicTime now) {
  if (now < run_->next_reading) return true;
  run_->next_reading = now + kReadingPeriod;
  const auto heard = output_->position();
  if (!heard) {
    lose(heard.error());
    return true;
  }
  if (!*heard) {
    if (!run_->heard) return true;
    const bool more = !window_->empty() && window_->end() > run_->cursor;
    if (more || !feed.hasSoundUntil(window_->timeOf(run_->cursor + 1))) ++summary_.underruns;
    return false;
  }
  run_->heard = true;
  run_->last = **heard;
  const MediaTime film =
      clock.position(run_->last.time).value_or(MediaTime{}) - delay_;  // the clock has a position while the film plays
  const double offset_s = toSeconds(window_->timeOf(run_->base + run_->last.frames) - film) + picture_late_s_;
  ++run_->readings;
  run_->offset_s += (offset_s - run_->offset_s) * std::max(1.0 / run_->readings, kSmoothing);
  if (run_->readings < kSettledAfter) return true;
  if (std::abs(run_->offset_s) > toSeconds(run_->settled ? kFar : kNear)) return realign();
  run_->settled = true;
  restarts_ = 0;
  run_->steering = 1 + std::round(kGainPerS * run_->offset_s / kSteeringStep) * kSteeringStep;
  summary_.drift_ppm = 1e6 * (clock.sample()->rate - 1);
  return true;
}

// False: restart. An output that is no closer after several restarts is not used as a clock.
bool Sound::realign() {
  ++summary_.realigned;
  if (++restarts_ > kMostRestarts) {
    lose({ErrorCode::Unsupported, 0, "the sound output reports no position"});
    gave_up_ = true;
    return true;
  }
  latency_ = std::clamp(latency_ - fromSeconds(run_->offset_s), Duration(0), kMostLatency);
  return false;
}

void Sound::stop() noexcept {
  if (!run_) return;
  run_.reset();
  static_cast<void>(output_->flush());  // one that is lost is found out by the next write
}

// True when there is an output to write to.
bool Sound::ready(FilmFeed& feed, MonotonicTime now) {
  if (output_->state() == AudioOutput::State::Open) return true;
  if (gave_up_ || other_ || now < next_try_) return false;
  next_try_ = now + kRetryPeriod;
  output_->close();
  const auto opened = output_->open(*format_);
  if (opened && !std::exchange(known_, true) && *opened != *format_) {
    take(*opened);
    feed.setSoundFormat(*opened);
    late_since_.reset();
    return false;  // its samples come next
  }
  if (opened && *opened == *format_) {
    late_since_.reset();
    if (std::exchange(lost_, false)) news_ = News{"sound output back", "it is heard again"};
    return true;
  }
  output_->close();
  if (opened) {  // another card: the film is not decoded for that
    other_ = *opened;
    news_ = News{"sound: the output has another rate or number of channels than before",
                 "this film goes on without sound; the next one has it"};
    return false;
  }
  if (opened.error().code != ErrorCode::Timeout) late_since_.reset();
  else if (!late_since_) late_since_ = now;
  const bool waits = late_since_ && now - *late_since_ < kServerPatience;
  if (waits) next_try_ = now + kLatePeriod;
  else if (!lost_ && !std::exchange(told_, true)) {
    news_ =
        News{std::string("sound: ") + opened.error().message, "the film plays without sound; the player tries again"};
  }
  return false;
}

void Sound::lose(const Error& error) {
  output_->close();
  run_.reset();
  lost_ = true;
  next_try_ = clock_.now() + kRetryPeriod;
  news_ = News{std::string("sound: ") + error.message, "the film goes on by the system's clock"};
}

void Sound::noteShown(MediaTime picture, const MediaClock& clock) {
  const MonotonicTime now = clock_.now();
  if (!run_) return;
  const Duration late = std::clamp(clock.position(now).value_or(picture) - picture, Duration(0), kMostLate);
  pictures_late_ = std::min(pictures_late_ + 1, kLatenessPictures);
  picture_late_s_ += (toSeconds(late) - picture_late_s_) / pictures_late_;
  if (!run_->settled) return;
  const MediaTime sound = window_->timeOf(run_->base + run_->last.frames) + (now - run_->last.time) + delay_;
  const double offset_ms = 1e3 * toSeconds(sound - picture);
  ++summary_.pictures;
  sum_offset_ms_ += offset_ms;
  summary_.max_offset_ms = std::max(summary_.max_offset_ms, std::abs(offset_ms));
}

}  // namespace relievo
