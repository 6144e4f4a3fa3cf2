// SPDX-License-Identifier: Apache-2.0
// Finds the depth picture that belongs to each colour picture, by timestamp.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// A depth picture belongs to the colour pictures from its own time, minus a tolerance, up to the next depth picture's.
// The tolerance is an eighth of the depth's frame period, but at least 1 ms, since two containers round to
// milliseconds, and at most 4 ms, the jitter of two clocks. The frame period is the median of recent time steps, not
// the container's nominal one.
//
//   depth at a lower rate     each picture is held
//   at a higher rate          pictures that no colour picture uses are counted as skipped
//   begins later              no depth before it; not a mismatch
//   ends earlier              the last picture lasts one period, then there is no depth; not a mismatch
//   is a single picture       a still: valid for the whole film
//   lacks a picture           the older one is held, and mismatched once it is older than one period
class DepthFollower {
 public:
  struct Supplied {
    std::optional<Frame> frame;
    bool ended = false;  // without a frame: true at the end of the track, false if no picture is available yet
  };
  using Supply = std::function<Result<Supplied>()>;
  struct Match {
    Frame depth;  // empty: no depth at this time
    bool matched = true;
  };

  // `supply` returns the track's pictures in order.
  explicit DepthFollower(Supply supply);

  // In a live film, a depth picture with the colour's own time is used at once: the next one has yet to be captured.
  void setLive(bool live) noexcept { live_ = live; }
  // Returns the depth for this colour time. Times must not decrease from call to call.
  [[nodiscard]] Result<Match> at(MediaTime color);
  // The picture that `at` would examine next, without consuming it; null if there is none.
  [[nodiscard]] Result<const Frame*> peek();
  // Call after a seek in the track.
  void restart() noexcept;

  [[nodiscard]] Duration period() const noexcept;
  // Depth pictures that no colour picture used, except those between a seek's key frame and its target.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

 private:
  static constexpr std::size_t kSteps = 9;
  [[nodiscard]] Result<bool> fetch();
  [[nodiscard]] Duration tolerance() const noexcept;
  [[nodiscard]] Match judge(Duration age) const;

  Supply supply_;
  Frame current_;
  std::optional<Frame> next_;
  std::optional<MediaTime> last_pts_;  // of the newest picture supplied
  std::array<Duration, kSteps> steps_{};
  std::size_t step_count_ = 0;
  bool ended_ = false;
  bool asked_for_ = false;  // whether a colour picture has used `current_`
  bool catching_up_ = false;
  bool live_ = false;
  std::uint64_t skipped_ = 0;
};

}  // namespace relievo
