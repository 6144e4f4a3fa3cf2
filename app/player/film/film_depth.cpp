// SPDX-License-Identifier: Apache-2.0
// The depth of the present picture and of those after it: for touch, and for what is shown in front of it.
#include <algorithm>
#include <span>

#include "app/player/film/film_playback.h"

namespace relievo {

DepthAround FilmPlayback::depth() const {
  DepthAround around;
  if (!rushes()) around.present = picture().depth;
  around.material = picture().material;
  around.expected = !rushes() && info_.has_depth;
  if (makesReliefs()) {
    gatherReliefs(around);
    return around;
  }
  around.ahead_count = std::min(head_.ahead().size(), around.ahead.size());
  for (std::size_t i = 0; i < around.ahead_count; ++i) {
    around.ahead[i] = head_.ahead()[i].depth;
    around.material_ahead[i] = head_.ahead()[i].material;
  }
  if (isLive()) around.felt = clock_.position(clock_source_.now());
  around.last = head_.last() && around.ahead_count == head_.ahead().size();
  return around;
}

// The feed may have more pictures than the playhead; if depth is made from the views, theirs is not made yet.
DepthComing FilmPlayback::coming() const {
  DepthComing coming;
  for (const FramePair& pair : head_.ahead()) {
    if (coming.count == DepthComing::kMost) return coming;
    coming.frames[coming.count++] = pair.depth;
  }
  coming.count += feed_.peekDepths(std::span(coming.frames).subspan(coming.count));
  coming.last = head_.last() && coming.count == head_.ahead().size();
  return coming;
}

}  // namespace relievo
