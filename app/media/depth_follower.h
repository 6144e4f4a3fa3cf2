// SPDX-License-Identifier: Apache-2.0
// Follows a depth track along the times of a colour track: which depth picture belongs to a colour picture.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// A depth picture belongs to the colour pictures from its own time, less a tolerance, to the next depth picture's. The
// tolerance is an eighth of the depth's frame period, but at least 1 ms, since two containers round to milliseconds,
// and at most 4 ms, the jitter of two clocks. The period is the median of the last time steps, never a nominal one.
//
//   depth of a lower rate   held
//   of a higher rate        thinned; what no colour picture asked for is counted
//   begins later            no depth before, and no mismatch
//   ends earlier            the last picture lasts one period, then there is no depth, and no mismatch
//   of a single picture     a still: lasts for ever
//   lacks a picture         the older one is held, mismatched once it is as old as the period
class DepthFollower {
 public:
  struct Supplied {
    std::optional<Frame> frame;
    bool ended = false;  // without a frame: the track has none any more; otherwise: none for now
  };
  using Supply = std::function<Result<Supplied>()>;
  struct Match {
    Frame depth;  // empty: none
    bool matched = true;
  };

  // `supply` gives the track's pictures in order.
  explicit DepthFollower(Supply supply);

  // For colour times that do not fall.
  [[nodiscard]] Result<Match> at(MediaTime color);
  // The picture that `at` would look at next, without taking it; null when there is none.
  [[nodiscard]] Result<const Frame*> peek();
  // After a seek in the track.
  void restart() noexcept;

  [[nodiscard]] Duration period() const noexcept;
  // Pictures that no colour picture asked for, but for those between a seek's key frame and its target.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

 private:
  static constexpr std::size_t kSteps = 9;
  [[nodiscard]] Result<bool> fetch();
  [[nodiscard]] Duration tolerance() const noexcept;
  [[nodiscard]] Match judge(Duration age) const;

  Supply supply_;
  Frame current_;
  std::optional<Frame> next_;
  std::optional<MediaTime> last_pts_;  // of the pictures supplied
  std::array<Duration, kSteps> steps_{};
  std::size_t step_count_ = 0;
  bool ended_ = false;
  bool asked_for_ = false;  // the current one, by a colour picture
  bool catching_up_ = false;
  std::uint64_t skipped_ = 0;
};

}  // namespace relievo
