// SPDX-License-Identifier: Apache-2.0
// Two rules, and a list of the last arrivals.
#include "app/depth_window/look_ahead.h"

#include <algorithm>
#include <numbers>

namespace relievo {
namespace {

// An object that moves to and fro once a second, as a nodding head does, has an amplitude a and w = 2 pi/s. A surface
// that is C old is off by up to a w C. A surface extrapolated by C, at the rate measured half a period T earlier, is
// off by up to a w^2 C (T + C)/2, which is less while T + C < 2/w, a third of a second.
constexpr double kNodHz = 1;
constexpr Duration kLongestToCarry(static_cast<Duration::rep>(1e9 / (std::numbers::pi * kNodHz)));

// One of 50 frames may come later; of fewer than 16, none.
constexpr std::size_t kOneInSoMany = 50, kFew = 16;

}  // namespace

LookAhead lookAheadFor(Duration period, Duration late) noexcept {
  LookAhead ahead;
  if (period <= Duration(0)) return ahead;
  const Duration left = kLiveAge - late - Arrivals::kMargin;
  const auto room = static_cast<int>(std::max(left, Duration(0)) / period);
  ahead.frames = std::clamp(room, 1, ahead.frames);
  const Duration most = std::max(std::min(period, kLongestToCarry - period), Duration(0));
  ahead.carried = std::clamp(period - left, Duration(0), most);
  return ahead;
}

TimeLaw lawWithin(TimeLaw law, int frames) noexcept {
  if (frames >= 3 || law == TimeLaw::Hold || law == TimeLaw::Linear) return law;
  return frames == 2 ? TimeLaw::BSpline : TimeLaw::Linear;
}

double rateToGain(Duration behind) noexcept {
  constexpr double kInS = 0.5, kMost = 0.05;
  return 1 + std::clamp(toSeconds(behind) / kInS, -kMost, kMost);
}

void Arrivals::add(MediaTime media, Duration delay) noexcept {
  if (count_ > 0 && media <= back(0).media) count_ = 0;  // another stream
  frames_[count_ % kCounted] = {media, delay};
  ++count_;
}

void Arrivals::forgetAllBut(std::size_t last) noexcept {
  const std::size_t kept = std::min(last, held());
  std::array<Frame, kCounted> frames;
  for (std::size_t i = 0; i < kept; ++i) frames[kept - 1 - i] = back(i);
  frames_ = frames;
  count_ = kept;
}

bool Arrivals::keepsPace() const noexcept {
  return count_ >= 2 && back(0).delay >= back(1).delay - (back(0).media - back(1).media) / 2;
}

template <class Figure>
Duration Arrivals::usualMost(std::size_t figures, Figure&& figure) const noexcept {
  if (figures == 0) return Duration(0);
  std::array<Duration, kCounted> sorted;
  for (std::size_t i = 0; i < figures; ++i) sorted[i] = figure(i);
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(figures);
  const std::size_t outliers = figures < kFew ? 0 : std::max<std::size_t>(figures / kOneInSoMany, 1);
  const auto place = end - 1 - static_cast<std::ptrdiff_t>(outliers);
  std::nth_element(sorted.begin(), place, end);
  return *place;
}

Duration Arrivals::late() const noexcept {
  return usualMost(held(), [this](std::size_t i) { return back(i).delay; });
}

Duration Arrivals::soonest() const noexcept {
  Duration least = late();
  for (std::size_t i = 0; i < held(); ++i) least = std::min(least, back(i).delay);
  return least;
}

Duration Arrivals::period() const noexcept {
  if (held() < 2) return Duration(0);
  return (back(0).media - back(held() - 1).media) / static_cast<Duration::rep>(held() - 1);
}

Duration Arrivals::age(const LookAhead& ahead) const noexcept {
  const auto apart = static_cast<std::size_t>(ahead.frames);
  if (held() <= apart) return static_cast<Duration::rep>(apart) * period() + late() - ahead.carried + kMargin;
  const Duration most =
      usualMost(held() - apart, [&](std::size_t i) { return back(i).delay + (back(i).media - back(i + apart).media); });
  return most - ahead.carried + kMargin;
}

}  // namespace relievo
