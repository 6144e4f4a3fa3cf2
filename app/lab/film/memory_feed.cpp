// SPDX-License-Identifier: Apache-2.0
// The list of frames that are there, and the shots among them.
#include "app/lab/film/memory_feed.h"

#include <algorithm>

namespace relievo {

std::vector<std::size_t> MemoryFeed::wanted(MediaTime now, double machine_s) const {
  std::vector<std::size_t> there;
  int ahead = 0;
  for (std::size_t i = 0; i < film_.size() && ahead < kAhead; ++i) {
    if (supply_ && !supply_(i, machine_s)) continue;
    there.push_back(i);
    if (film_[i].time > now) ++ahead;
  }
  // Of what is over, the present one and the two before it stay.
  const std::size_t over = there.size() - static_cast<std::size_t>(ahead);
  if (over > kBefore + 1) there.erase(there.begin(), there.begin() + static_cast<std::ptrdiff_t>(over - kBefore - 1));
  return there;
}

bool MemoryFeed::update(MediaTime now, double machine_s, std::uint32_t epoch, SurfaceWindow& window) {
  std::vector<std::size_t> indices = wanted(now, machine_s);
  if (epoch != epoch_ || first_) {
    held_.clear();
    shots_.forget();
  } else if (indices == indices_) {
    return false;
  }
  // What was there keeps its shot's number: the first frame is what the others are numbered from.
  std::vector<TimedSurface> frames;
  for (const std::size_t i : indices) {
    const auto known = std::find(indices_.begin(), indices_.end(), i);
    const bool was_held = !held_.empty() && known != indices_.end();
    frames.push_back(was_held ? held_[static_cast<std::size_t>(known - indices_.begin())] : film_[i]);
  }
  if (!frames.empty() && !held_.empty() && frames[0].time > held_.back().time) frames[0].shot = held_.back().shot;
  held_ = std::move(frames);
  indices_ = std::move(indices);
  epoch_ = epoch;
  first_ = false;
  shots_.mark(held_);

  window = SurfaceWindow{};
  window.count = static_cast<int>(held_.size());
  std::copy(held_.begin(), held_.end(), window.frames.begin());
  window.epoch = epoch;
  window.ended = !indices_.empty() && indices_.back() + 1 == film_.size();
  return true;
}

}  // namespace relievo
