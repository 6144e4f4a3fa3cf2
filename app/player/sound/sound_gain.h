// SPDX-License-Identifier: Apache-2.0
// The gain of the sound. It changes over a hundredth of a second, to avoid a click.
#pragma once

#include <cstddef>
#include <span>

#include "hal/audio_output.h"

namespace relievo {

// One thread; nothing blocks or allocates.
class SoundGain {
 public:
  void set(double gain) noexcept { wished_ = gain; }
  // The next samples begin with this gain.
  void setAtOnce(double gain) noexcept { now_ = wished_ = gain; }
  // Multiplies whole frames, limited to full scale, and continues from the last call. Returns the gain at their
  // beginning, for `endAfter`.
  double amplify(std::span<float> samples, const AudioFormat& format) noexcept;
  // Only the first `frames` of the last call were used: the next call continues from there.
  void endAfter(std::size_t frames, double began_with, const AudioFormat& format) noexcept;

 private:
  [[nodiscard]] double after(double before, std::size_t frames, const AudioFormat& format) const noexcept;

  double now_ = 1, wished_ = 1;
};

}  // namespace relievo
