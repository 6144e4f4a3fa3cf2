// SPDX-License-Identifier: Apache-2.0
// A straight line from one gain to the next.
#include "app/player/sound/sound_gain.h"

#include <algorithm>

namespace relievo {
namespace {
constexpr double kFadeS = 0.01;  // from a gain of 0 to 1
}  // namespace

double SoundGain::after(double before, std::size_t frames, const AudioFormat& format) const noexcept {
  const double most = static_cast<double>(frames) / (kFadeS * format.rate_hz);
  return before + std::clamp(wished_ - before, -most, most);
}

double SoundGain::amplify(std::span<float> samples, const AudioFormat& format) noexcept {
  const double began_with = now_;
  if (now_ == 1 && wished_ == 1) return began_with;
  const auto channels = static_cast<std::size_t>(format.channels);
  for (std::size_t i = 0; i < samples.size(); i += channels) {
    now_ = after(now_, 1, format);
    for (float& sample : samples.subspan(i, channels)) {
      sample = static_cast<float>(std::clamp(static_cast<double>(sample) * now_, -1.0, 1.0));
    }
  }
  return began_with;
}

void SoundGain::endAfter(std::size_t frames, double began_with, const AudioFormat& format) noexcept {
  now_ = after(began_with, frames, format);
}

}  // namespace relievo
