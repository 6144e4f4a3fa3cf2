// SPDX-License-Identifier: Apache-2.0
// The pair on the screen and the few after it, selected by timestamp.
#pragma once

#include <cstdint>
#include <deque>

#include "app/media/film_feed.h"
#include "app/media/pair_reader.h"
#include "hal/media/media_time.h"

namespace relievo {

class Playhead {
 public:
  static constexpr std::size_t kAhead = 4;  // the look-ahead of the depth window

  // For depth that is made while the film plays: buffers `pairs` pairs, whose depth is added by `attach`. A pair whose
  // depth is missing when it becomes the present one gets the last depth.
  void waitForDepth(std::size_t pairs) noexcept {
    wanted_ = pairs;
    holds_ = true;
  }
  // Gives the buffered pair of the same time this depth; its right view is dropped.
  void attach(const Frame& depth);

  // Takes pairs from the feed until kAhead are buffered, or as many as `waitForDepth` says. False when no more will
  // come.
  bool refill(FilmFeed& feed);
  // Makes the newest pair at or before `position` the present one, refilling as needed. Returns by how many pairs it
  // advanced: more than one means that pictures were skipped.
  std::size_t advance(MediaTime position, FilmFeed& feed);
  // Makes the first pair after a start or a seek the present one, whatever its time. Does nothing if there is none.
  void begin();
  // Drops the first buffered pair, as of a live film whose oldest is too old.
  void skip() { ahead_.pop_front(); }
  // Turns the present pair and those that are buffered (turnTo).
  void turn(int turn) noexcept;
  // Drops the buffered pairs; the present pair stays.
  void clear() {
    ahead_.clear();
    held_ = {};
  }

  [[nodiscard]] const FramePair& present() const noexcept { return present_; }
  // Counts the present pairs so far, without those that repeat the colour of the pair before.
  [[nodiscard]] std::uint64_t colors() const noexcept { return colors_; }
  [[nodiscard]] const std::deque<FramePair>& ahead() const noexcept { return ahead_; }
  [[nodiscard]] bool filled() const noexcept { return ahead_.size() >= wanted_; }
  // No pair follows the buffered ones.
  [[nodiscard]] bool last() const noexcept { return last_; }

 private:
  FramePair present_;
  std::deque<FramePair> ahead_;
  bool last_ = false;
  std::size_t wanted_ = kAhead;
  bool holds_ = false;
  std::uint64_t colors_ = 0;
  Frame held_;  // the last depth, if it is to be held
};

}  // namespace relievo
