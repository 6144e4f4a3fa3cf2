// SPDX-License-Identifier: Apache-2.0
// A film whose depth is made from two views while it plays: pictures go to the maker, reliefs come back.
#include <algorithm>

#include "app/player/film/film_playback.h"

namespace relievo {

void FilmPlayback::beginReliefs() {
  if (!reliefs_.canMake()) {
    info_.has_depth = info_.depth_from_views = false;
    journal_.note("--depth-from stereo: this relievo was built without it; build it with -DRELIEVO_STEREO_PLAY=ON",
                  "its views are shown, without force");
    return;
  }
  head_.waitForDepth(ReliefMaker::kAhead);
  reliefs_.begin(period());
  if (own_threads_) reliefs_.startThread();
}

void FilmPlayback::followReliefs() {
  if (!makesReliefs()) return;
  while (const auto relief = reliefs_.take()) head_.attach(*relief);
  for (const FramePair& pair : head_.ahead()) reliefs_.offer(pair);
  if (const auto slow = reliefs_.takeSlowness())
    journal_.note(*slow, "every picture is shown; the finger feels the surface between two reliefs");
  if (const auto caution = reliefs_.takeCaution()) journal_.note(caution->what, caution->done);
}

// Enough to begin with: the first picture's, and as many ahead as touch looks at.
bool FilmPlayback::hasReliefs() const {
  if (!makesReliefs() || reliefs_.idle()) return true;
  const auto made = std::ranges::count_if(head_.ahead(), [](const FramePair& pair) { return !pair.depth.empty(); });
  return !head_.ahead().front().depth.empty() && made > SurfaceWindow::kAhead;
}

// The next few reliefs; pictures without a relief of their own are skipped.
void FilmPlayback::gatherReliefs(DepthAround& around) const {
  for (const FramePair& pair : head_.ahead()) {
    if (around.ahead_count == around.ahead.size()) return;
    if (!pair.depth.empty()) around.ahead[around.ahead_count++] = pair.depth;
  }
  around.last = head_.last() && reliefs_.idle();
}

}  // namespace relievo
