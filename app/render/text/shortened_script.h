// SPDX-License-Identifier: Apache-2.0
// The first lines of a script, for what takes too long or too much memory to draw as a whole.
#pragma once

#include <ass/ass.h>

#include <cstddef>
#include <vector>

namespace relievo {

// While it lives, at most `most` of the lines are seen at `now_ms`, and no more than cover 128 squares as high as the
// screen: 240 MB in 1920 x 1080. `areas`: letterArea of each line.
class Shortened {
 public:
  Shortened(ASS_Track& track, const std::vector<double>& areas, long long now_ms, int most) noexcept
      : track_(track), all_(track.n_events) {
    int end = 0;
    double area = 0;
    for (; end < all_; ++end) {
      const ASS_Event& line = track.events[end];
      if (now_ms < line.Start || now_ms >= line.Start + line.Duration) continue;
      area += areas[static_cast<std::size_t>(end)];
      full_ = area > kMostArea;
      if (seen_ == most || full_) break;
      ++seen_;
    }
    track.n_events = end;
  }
  ~Shortened() { track_.n_events = all_; }
  Shortened(const Shortened&) = delete;
  Shortened& operator=(const Shortened&) = delete;

  [[nodiscard]] int seen() const noexcept { return seen_; }
  // The screen has no room for more of them.
  [[nodiscard]] bool full() const noexcept { return full_; }
  [[nodiscard]] bool all() const noexcept { return track_.n_events == all_; }

 private:
  static constexpr double kMostArea = 128;

  ASS_Track& track_;
  const int all_;
  int seen_ = 0;
  bool full_ = false;
};

}  // namespace relievo
