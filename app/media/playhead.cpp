// SPDX-License-Identifier: Apache-2.0
// Takes pairs from the feed and selects the one to show.
#include "app/media/playhead.h"

#include <utility>

namespace relievo {

bool Playhead::refill(FilmFeed& feed) {
  // Read the state first: if it says Ended, all pairs are already in the queue.
  const FilmFeed::State state = feed.state();
  while (!filled()) {
    auto pair = feed.take();
    if (!pair) {
      last_ = state == FilmFeed::State::Ended || state == FilmFeed::State::Failed;
      return !last_;
    }
    ahead_.push_back(std::move(*pair));
  }
  last_ = false;
  return true;
}

std::size_t Playhead::advance(MediaTime position, FilmFeed& feed) {
  std::size_t steps = 0;
  for (refill(feed); !ahead_.empty() && ahead_.front().color.pts <= position; refill(feed)) {
    begin();
    ++steps;
  }
  return steps;
}

void Playhead::begin() {
  FramePair next = std::move(ahead_.front());
  ahead_.pop_front();
  if (next.stands) {
    const MediaTime time = next.color.pts;
    next.color = std::move(present_.color);
    next.color.pts = time;
  } else {
    ++colors_;
  }
  present_ = std::move(next);
  if (!holds_) return;
  if (present_.depth.empty() && !held_.empty()) {
    present_.depth = held_;
    present_.right = {};
  }
  held_ = present_.depth;
}

void Playhead::turn(int turn) noexcept {
  turnTo(present_, turn);
  for (FramePair& pair : ahead_) turnTo(pair, turn);
}

void Playhead::attach(const Frame& depth) {
  for (FramePair& pair : ahead_) {
    if (pair.color.pts != depth.pts) continue;
    pair.depth = depth;
    pair.right = {};
  }
}

}  // namespace relievo
