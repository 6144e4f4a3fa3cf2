// SPDX-License-Identifier: Apache-2.0
// Where a film stores colour and depth: in two tracks, or in the two halves of one picture.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo {

enum class Packing : std::uint8_t {
  Auto,                  // as the film's tags or pictures say (`planTracks`); otherwise colour alone
  Tracks,                // two tracks of one file, or two files
  SideBySide,            // one picture: colour left, depth right
  TopBottom,             // one picture: colour on top, depth below
  SideBySideDepthFirst,  // depth left, colour right
  TopBottomDepthFirst,   // depth on top, colour below
  Alpha,                 // one picture: depth in its alpha channel
  DepthAlone,            // one picture: depth without colour
  StereoSideBySide,      // one picture: two views, left and right, no depth
  StereoTopBottom,       // one picture: two views, above and below, no depth
  StereoTracks,          // two tracks: the left view and the right one, no depth
  StereoLayers,          // one track whose packets hold two pictures, the left view and the right one, no depth
};
// Two views in one picture.
[[nodiscard]] constexpr bool isStereo(Packing packing) noexcept {
  return packing == Packing::StereoSideBySide || packing == Packing::StereoTopBottom;
}

// Two views, however they are stored.
[[nodiscard]] constexpr bool hasTwoViews(Packing packing) noexcept {
  return isStereo(packing) || packing == Packing::StereoTracks || packing == Packing::StereoLayers;
}

// Which streams to decode, as pointers into the source's list. A null depth stream means no depth, or packed depth.
struct TrackPlan {
  const StreamInfo* color = nullptr;
  const StreamInfo* depth = nullptr;
  const StreamInfo* material = nullptr;  // null: none
  Packing packing = Packing::Tracks;
  bool by_tag = false;  // DEPTH_PACKING
};
[[nodiscard]] const char* name(Packing packing) noexcept;
[[nodiscard]] constexpr bool isPacked(Packing packing) noexcept {
  return packing != Packing::Auto && packing != Packing::Tracks && !hasTwoViews(packing);
}
// Whether the track itself says that it is depth: signalled as auxiliary, DEPTH_ tags, or its name.
[[nodiscard]] bool isMarkedAsDepth(const StreamInfo& track);

// The depth track of a source. Of two or more video tracks: the one signalled as auxiliary; else the one that has
// DEPTH_ tags or whose TITLE, NAME or HANDLER_NAME mentions depth, disparity or an auxiliary picture; else the only
// one of gray; else the second.
// Of one video track: that one. Null if there is none. Material tracks do not count.
[[nodiscard]] const StreamInfo* findDepthTrack(const MediaSource& source);
// The tracks of gray of more than 8 bits, any of which may be the depth; none if a track is marked as depth.
[[nodiscard]] std::vector<const StreamInfo*> likelyDepthTracks(const MediaSource& source);
// The track that is shown with `depth`: no infrared, if there is another.
[[nodiscard]] const StreamInfo* findColorTrack(const MediaSource& source, const StreamInfo* depth);

// Plans a source that holds the colour, and the depth too unless `depth_elsewhere`. Auto decides first by a tag
// DEPTH_PACKING=sbs|tb|sbs-depth-first|tb-depth-first|alpha of the container or the track, then by the presence of a
// second video track. A picture's shape decides nothing: a wide film is not assumed to be packed. NotFound if the
// source lacks the tracks that the packing needs.
[[nodiscard]] Result<TrackPlan> planTracks(const MediaSource& source, Packing packing, bool depth_elsewhere);

// Which component of a colour picture holds brightness.
enum class GrayFrom : std::uint8_t { Luma, Red };

struct Halves {
  Frame color;
  Frame depth;
};

// The two halves of a packed picture, by reference; the depth is as large as the colour. If the number of columns
// (rows) is odd, the middle one belongs to neither half; nor do the middle `seam` ones, a margin. Depth read from luma
// (`code`) becomes a gray view that begins at the exact sample; depth that needs chroma begins at a whole chroma
// sample, at most one pixel late. `gray`: red is read from RGB unchanged, and from YUV as luma. With Packing::Alpha the
// halves are the whole picture and its alpha channel. Unsupported if the picture is too small to be halved, or has no
// alpha channel.
[[nodiscard]] Result<Halves> splitPacked(const Frame& picture, Packing packing, DepthCode code,
                                         GrayFrom gray = GrayFrom::Luma, int seam = 0) noexcept;

}  // namespace relievo
