// SPDX-License-Identifier: Apache-2.0
// Decides whether this machine decodes a film in time, and which pictures it leaves out if not. Pure.
#pragma once

#include <optional>
#include <utility>

#include "platform/clock.h"

namespace relievo {

// A machine that is too slow leaves out pictures in two steps. While the reader never rests and its buffers run empty,
// pictures that no other refers to are not decoded. If the film is late all the same, the reader skips to a later key
// frame. Both end when the reader has rested for half of its time, for some seconds; if that was too early, the next
// attempt waits twice as long. One thread.
class DecodePace {
 public:
  // The observations of a round.
  struct Seen {
    bool filled = false;   // as many pictures are buffered as requested
    Duration rested{0};    // FilmFeed::Effort
    bool decodes = false;  // likewise
    Duration late{0};      // how long the last buffered picture has been over; 0 or less: it is not
  };
  void look(const Seen& seen, MonotonicTime now) noexcept;
  // Call when the film stood still, or was sought: discards earlier observations. Pictures continue to be left out.
  void pause() noexcept;

  // True if pictures that no other refers to should be left out.
  [[nodiscard]] bool leavesOut() const noexcept { return leaves_out_; }
  // True when the reader should skip ahead now; returned once.
  [[nodiscard]] bool takeHurry() noexcept { return std::exchange(hurry_, false); }
  // While nothing is buffered: true if the player waits for the source rather than the decoder. Needs several rounds,
  // since a busy processor can stop the reading thread anywhere for a short time.
  [[nodiscard]] bool waitsForSource() const noexcept { return dry_for_ >= kTelling && 2 * dry_decodes_ <= dry_rounds_; }

 private:
  void judge(double rest, bool decodes, MonotonicTime now) noexcept;
  void leaveOut(MonotonicTime now) noexcept;

  static constexpr Duration kTelling = std::chrono::milliseconds(200);
  static constexpr Duration kShortPatience = std::chrono::seconds(3);

  bool leaves_out_ = false, hurry_ = false;
  std::optional<MonotonicTime> since_;  // start of the present span
  Duration rested_{0};                  // at the span's start
  int rounds_ = 0, decodes_ = 0;        // in the span
  int dry_rounds_ = 0, dry_decodes_ = 0;
  std::optional<MonotonicTime> dry_since_;
  Duration dry_for_{0};
  bool filled_ = false;
  Duration idle_{0};  // for how long the reader has had time to spare
  Duration patience_ = kShortPatience;
  std::optional<MonotonicTime> recovered_, hurried_;
};

}  // namespace relievo
