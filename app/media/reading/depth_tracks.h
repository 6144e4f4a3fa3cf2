// SPDX-License-Identifier: Apache-2.0
// Which tracks of a source may be its depth where none says so.
#pragma once

#include <vector>

#include "hal/media/media_source.h"

namespace relievo {

// The tracks of gray of more than 8 bits; none if a track is marked as depth.
[[nodiscard]] std::vector<const StreamInfo*> likelyDepthTracks(const MediaSource& source);

// The track that is shown with `depth`: no infrared, if there is another.
[[nodiscard]] const StreamInfo* findColorTrack(const MediaSource& source, const StreamInfo* depth);

}  // namespace relievo
