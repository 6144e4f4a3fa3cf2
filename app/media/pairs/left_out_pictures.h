// SPDX-License-Identifier: Apache-2.0
// Detects and counts colour pictures that were left out for lack of time. Pure.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "app/media/pair_reader.h"
#include "hal/media/media_time.h"

namespace relievo {

class LeftOutPictures {
 public:
  // From now on, a gap between two pictures means that pictures were left out.
  void begin() noexcept { begun_ = true; }
  // The next picture does not follow the last one.
  void jump() noexcept { last_color_ = last_pair_ = std::nullopt; }

  // True if pictures are missing between the last one and this one.
  [[nodiscard]] bool areBefore(MediaTime color, Duration period) const noexcept {
    return begun_ && last_color_ && toSeconds(color - *last_color_) >= kGap * toSeconds(period);
  }
  // The time of the last pair; only if there was one.
  [[nodiscard]] MediaTime lastPair() const noexcept { return last_pair_.value_or(*last_color_); }
  // Counts the pictures that are missing before this pair, which follows the last one.
  [[nodiscard]] std::uint64_t countBefore(const FramePair& pair, Duration period) noexcept {
    const MediaTime time = pair.color.pts;
    last_pair_ = time;
    if (pair.stands) return 0;
    const auto before = std::exchange(last_color_, time);
    if (!begun_ || !before || period <= Duration(0)) return 0;
    const double steps = toSeconds(time - *before) / toSeconds(period);
    return steps > kGap ? static_cast<std::uint64_t>(std::lround(steps) - 1) : 0;
  }

 private:
  static constexpr double kGap = 1.5;  // of the frame period, from which on a picture is missing

  bool begun_ = false;
  std::optional<MediaTime> last_color_, last_pair_;
};

}  // namespace relievo
