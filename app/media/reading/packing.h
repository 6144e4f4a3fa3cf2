// SPDX-License-Identifier: Apache-2.0
// Where the colour and the depth of a film are: in two tracks, or in two halves of one picture.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "app/scene/depth_calibration.h"
#include "hal/frame.h"
#include "hal/media_source.h"
#include "platform/error.h"

namespace relievo {

enum class Packing : std::uint8_t {
  Auto,                  // what the film says or shows (`planTracks`); a film that does neither is colour alone
  Tracks,                // colour and depth are two tracks of one file, or two files
  SideBySide,            // one picture: colour left, depth right
  TopBottom,             // one picture: colour on top, depth below
  SideBySideDepthFirst,  // depth left, colour right
  TopBottomDepthFirst,   // depth on top, colour below
};

// Which streams to decode, as pointers into the source's list. No depth stream: there is none, or it is packed.
struct TrackPlan {
  const StreamInfo* color = nullptr;
  const StreamInfo* depth = nullptr;
  Packing packing = Packing::Tracks;
};

// The depth track of a source with two or more video tracks: the one that is signalled as auxiliary; else the one whose
// TITLE, NAME or HANDLER_NAME speaks of depth, disparity or an auxiliary picture, or that has DEPTH_ tags; else the
// second. Of one video track: that one. Null without any.
[[nodiscard]] const StreamInfo* findDepthTrack(const MediaSource& source);

// For a source that holds the colour, and the depth too unless `depth_elsewhere`. Auto decides, in this order: by a tag
// DEPTH_PACKING=sbs|tb|sbs-depth-first|tb-depth-first of the container or the track; by a second video track. A
// picture's shape decides nothing: a wide film is not taken for a packed one. NotFound where the source has not the
// tracks that the packing asks for.
[[nodiscard]] Result<TrackPlan> planTracks(const MediaSource& source, Packing packing, bool depth_elsewhere);

struct Halves {
  Frame color;
  Frame depth;
};

// The halves of a packed picture, by reference; the depth's size is the colour's. Of an odd number of
// columns (rows) the middle one belongs to neither. Depth that is read from luma (`code`) becomes a gray view, so that
// it begins at the exact sample; where chroma is read too it begins at a whole chroma sample, at most one pixel late.
// Unsupported for a picture too small to be halved.
[[nodiscard]] Result<Halves> splitPacked(const Frame& picture, Packing packing, DepthCode code) noexcept;

}  // namespace relievo
