// SPDX-License-Identifier: Apache-2.0
#include "app/media/frame_rate.h"

#include <algorithm>
#include <cmath>

#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kRounding = std::chrono::milliseconds(1);  // Matroska's clock
constexpr double kAgree = 0.002;                              // of two rates: 30 and 29.97 differ by half of that

double value(const Ratio& ratio) noexcept {
  return ratio.known() ? static_cast<double>(ratio.num) / ratio.den : 0;
}

// For few pictures, the measured rate is only as exact as the container's clock.
bool agrees(double stated, double measured, Duration span) noexcept {
  const double clock = toSeconds(kRounding) / toSeconds(span);
  return stated > 0 && std::abs(measured / stated - 1) < std::max(kAgree / 4, 2 * clock);
}

}  // namespace

FrameRate frameRateOf(const StreamInfo& stream, std::vector<MediaTime> times, bool whole) {
  std::ranges::sort(times);
  const auto repeated = std::ranges::unique(times);
  times.erase(repeated.begin(), repeated.end());
  FrameRate rate;
  rate.still = whole && times.size() == 1;
  if (rate.still) return rate;
  const double stated = value(stream.average_rate);
  if (times.size() < 3) {
    rate.average = stated;
    rate.exact = stream.average_rate;
    return rate;
  }
  Duration shortest = times[1] - times[0], longest = shortest;
  for (std::size_t i = 1; i < times.size(); ++i) {
    shortest = std::min(shortest, times[i] - times[i - 1]);
    longest = std::max(longest, times[i] - times[i - 1]);
  }
  const Duration span = times.back() - times.front();
  rate.average = static_cast<double>(times.size() - 1) / toSeconds(span);
  if (longest - shortest > kRounding + std::chrono::microseconds(1)) {
    rate.lowest = 1 / toSeconds(longest);
    rate.highest = 1 / toSeconds(shortest);
    if (!whole && stated > rate.lowest && stated < rate.highest)
      rate.average = stated;  // the container has counted more pictures
    return rate;
  }
  if (!agrees(stated, rate.average, span)) return rate;
  rate.average = stated;
  rate.exact = stream.average_rate;
  return rate;
}

std::string rateText(const FrameRate& rate) {
  if (rate.still) return "one picture";
  if (rate.average <= 0) return "rate unknown";
  std::string text = print("%.4g frames a second", rate.average);
  if (!rate.varies()) return text;
  return text + print(" on average, variable from %.3g to %.3g", rate.lowest, rate.highest);
}

Duration framePeriod(Duration between, const StreamInfo& stream) noexcept {
  if (between <= Duration(0)) return Duration(0);
  const Duration stated = stream.frame_period;
  if (stated > Duration(0) && std::chrono::abs(between - stated) <= kRounding) return stated;
  const double average = value(stream.average_rate), base = value(stream.base_rate);
  const bool varies = average > 0 && base > 0 && std::abs(average / base - 1) > kAgree;
  return varies ? fromSeconds(1 / average) : between;
}

}  // namespace relievo
