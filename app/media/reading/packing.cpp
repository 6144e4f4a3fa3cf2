// SPDX-License-Identifier: Apache-2.0
// Finds the depth among a source's tracks or in one half of a picture.
#include "app/media/reading/packing.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "app/scene/material.h"
#include "hal/media/media_names.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

using Tags = std::map<std::string, std::string>;
constexpr const char* kPackingTag = "DEPTH_PACKING";

// True for a track that is neither colour nor depth but the surface's material: it has the tag kMaterialScaleTag, or it
// is called "material" and the container has the tag.
bool isMaterial(const StreamInfo& track, const Tags& container_tags) {
  if (track.tags.contains(kMaterialScaleTag)) return true;
  if (!container_tags.contains(kMaterialScaleTag)) return false;
  return std::ranges::any_of(track.tags, [](const auto& tag) {
    const auto& [key, value] = tag;
    return (key == "TITLE" || key == "NAME" || key == "HANDLER_NAME") && lowerCase(value) == "material";
  });
}

std::vector<const StreamInfo*> videoTracks(const MediaSource& source) {
  std::vector<const StreamInfo*> tracks;
  for (const StreamInfo& stream : source.streams()) {
    if (stream.kind == StreamKind::Video && !isMaterial(stream, source.tags())) tracks.push_back(&stream);
  }
  return tracks;
}

bool speaksOfDepth(const StreamInfo& track) {
  for (const auto& [key, value] : track.tags) {
    if (key.starts_with("DEPTH_") && key != kPackingTag) return true;
    if (key != "TITLE" && key != "NAME" && key != "HANDLER_NAME") continue;
    const std::string words = lowerCase(value);
    for (const char* word : {"depth", "disparity", "auxiliary"}) {
      if (words.find(word) != std::string::npos) return true;
    }
  }
  return false;
}

const StreamInfo* depthAmong(const std::vector<const StreamInfo*>& tracks) {
  if (tracks.empty()) return nullptr;
  const auto signalled = std::find_if(tracks.begin(), tracks.end(), [](auto* track) { return track->auxiliary; });
  if (signalled != tracks.end()) return *signalled;
  const auto marked = std::find_if(tracks.begin(), tracks.end(), [](auto* track) { return speaksOfDepth(*track); });
  if (marked != tracks.end()) return *marked;
  // A camera's colour is not stored as gray.
  const auto is_gray = [](auto* track) { return track->pixel_format.starts_with("gray"); };
  if (std::ranges::count_if(tracks, is_gray) == 1) return *std::ranges::find_if(tracks, is_gray);
  return tracks.size() > 1 ? tracks[1] : tracks[0];
}

bool speaksOfInfrared(const StreamInfo& track) {
  const auto title = track.tags.find("TITLE");
  return track.tags.contains("K4A_IR_TRACK") || (title != track.tags.end() && title->second == "IR");
}

// The first track that is neither the depth nor, unless there is no other, infrared.
const StreamInfo* colorAmong(const std::vector<const StreamInfo*>& tracks, const StreamInfo* depth) {
  const auto fits = [&](auto* track) { return track != depth && !speaksOfInfrared(*track); };
  const auto found = std::find_if(tracks.begin(), tracks.end(), fits);
  if (found != tracks.end()) return *found;
  return depth == tracks[0] ? tracks[1] : tracks[0];
}

bool isRightView(const StreamInfo* track) {
  const auto view = track->tags.find(kViewTag);
  return view != track->tags.end() && view->second == "right";
}

std::optional<Packing> packingTag(const Tags& tags) {
  const auto found = tags.find(kPackingTag);
  if (found == tags.end()) return std::nullopt;
  const std::string value = lowerCase(found->second);
  if (value == "sbs") return Packing::SideBySide;
  if (value == "tb") return Packing::TopBottom;
  if (value == "sbs-depth-first") return Packing::SideBySideDepthFirst;
  if (value == "tb-depth-first") return Packing::TopBottomDepthFirst;
  if (value == "alpha") return Packing::Alpha;
  return std::nullopt;
}

Error noPicture(const MediaSource& source) noexcept {
  const auto has = [&source](StreamKind kind) {
    return std::ranges::any_of(source.streams(), [kind](const StreamInfo& each) { return each.kind == kind; });
  };
  if (has(StreamKind::Audio)) return {ErrorCode::NotFound, 0, "it is sound without a picture; give a film"};
  if (has(StreamKind::Subtitle)) {
    return {ErrorCode::NotFound, 0,
            "it holds subtitles; give the film: a subtitle file of its name is found beside it"};
  }
  return {ErrorCode::NotFound, 0, "it has no video track; check the file"};
}

// Colour and depth.
Result<TrackPlan> planPictures(const MediaSource& source, Packing packing, bool depth_elsewhere) {
  const auto tracks = videoTracks(source);
  if (tracks.empty()) return std::unexpected(noPicture(source));
  if (isPacked(packing) || isStereo(packing)) return TrackPlan{tracks[0], nullptr, nullptr, packing};
  if (packing == Packing::StereoTracks) {
    if (depth_elsewhere) return TrackPlan{tracks[0], nullptr, nullptr, packing};
    if (tracks.size() < 2) return fail(ErrorCode::NotFound, "two views in two tracks need a second video track");
    return TrackPlan{tracks[0], tracks[1], nullptr, packing};
  }
  if (!depth_elsewhere && packing == Packing::Auto) {
    auto tagged = packingTag(tracks[0]->tags);
    if (!tagged) tagged = packingTag(source.tags());
    if (tagged) return TrackPlan{tracks[0], nullptr, nullptr, *tagged, true};
  }
  if (tracks.size() == 1) {
    if (!depth_elsewhere && packing == Packing::Tracks) {
      return fail(ErrorCode::NotFound,
                  "the source has only one video track; give --depth SOURCE, or --packing sbs or tb");
    }
    return TrackPlan{tracks[0], nullptr, nullptr, Packing::Tracks};
  }
  const auto right = std::find_if(tracks.begin(), tracks.end(), isRightView);
  if (packing == Packing::Auto && !depth_elsewhere && right != tracks.end()) {
    return TrackPlan{*right == tracks[0] ? tracks[1] : tracks[0], *right, nullptr, Packing::StereoTracks, true};
  }
  const StreamInfo* const depth = depthAmong(tracks);
  const StreamInfo* const color = colorAmong(tracks, depth);
  return TrackPlan{color, depth_elsewhere ? nullptr : depth, nullptr, Packing::Tracks};
}

// The luma plane alone, as a gray picture of the same range.
Frame lumaOf(const Frame& picture) noexcept {
  Frame gray = picture;
  if (picture.model != ColorModel::Yuv) return gray;
  gray.model = ColorModel::Gray;
  gray.chroma_shift_x = gray.chroma_shift_y = 0;
  if (gray.range == ColorRange::Unspecified) gray.range = ColorRange::Limited;  // the default for YUV
  return gray;
}

// A gray view of one component of RGB.
Frame componentOf(const Frame& picture, std::size_t component) noexcept {
  Frame gray = picture;
  gray.model = ColorModel::Gray;
  gray.components[0] = picture.components[component];
  return gray;
}

// The alpha channel as a gray picture.
Frame alphaOf(const Frame& picture) noexcept {
  Frame gray = picture;
  gray.model = ColorModel::Gray;
  gray.range = ColorRange::Full;
  gray.chroma_shift_x = gray.chroma_shift_y = 0;
  gray.components[0] = *picture.alpha;
  gray.alpha.reset();
  return gray;
}

int alignUp(int value, int shift) noexcept {
  return ((value + (1 << shift) - 1) >> shift) << shift;
}

}  // namespace

bool isMarkedAsDepth(const StreamInfo& track) {
  return track.auxiliary || speaksOfDepth(track);
}

const StreamInfo* findDepthTrack(const MediaSource& source) {
  return depthAmong(videoTracks(source));
}

std::vector<const StreamInfo*> likelyDepthTracks(const MediaSource& source) {
  auto tracks = videoTracks(source);
  if (std::ranges::any_of(tracks, [](auto* track) { return isMarkedAsDepth(*track); })) return {};
  const auto is_deep = [](auto* track) {  // "gray16le", "gray12le", ..
    return track->pixel_format.starts_with("gray") && track->pixel_format != "gray";
  };
  std::erase_if(tracks, std::not_fn(is_deep));
  return tracks;
}

const StreamInfo* findColorTrack(const MediaSource& source, const StreamInfo* depth) {
  return colorAmong(videoTracks(source), depth);
}

const char* name(Packing packing) noexcept {
  switch (packing) {
    case Packing::Auto:
      return "auto";
    case Packing::Tracks:
      return "tracks";
    case Packing::SideBySide:
      return "sbs";
    case Packing::TopBottom:
      return "tb";
    case Packing::SideBySideDepthFirst:
      return "sbs-depth-first";
    case Packing::TopBottomDepthFirst:
      return "tb-depth-first";
    case Packing::Alpha:
      return "alpha";
    case Packing::DepthAlone:
      return "depth-alone";
    case Packing::StereoSideBySide:
      return "stereo-sbs";
    case Packing::StereoTopBottom:
      return "stereo-tb";
    case Packing::StereoTracks:
      return "stereo-tracks";
    case Packing::StereoLayers:
      return "stereo-layers";
  }
  return "";
}

Result<TrackPlan> planTracks(const MediaSource& source, Packing packing, bool depth_elsewhere) {
  auto plan = planPictures(source, packing, depth_elsewhere);
  if (!plan) return plan;
  const auto found = std::ranges::find_if(source.streams(), [&](const StreamInfo& stream) {
    return stream.kind == StreamKind::Video && isMaterial(stream, source.tags());
  });
  if (found != source.streams().end()) plan->material = &*found;
  return plan;
}

Result<Halves> splitPacked(const Frame& picture, Packing packing, DepthCode code, GrayFrom gray, int seam) noexcept {
  if (packing == Packing::Alpha) {
    if (!picture.alpha) return fail(ErrorCode::Unsupported, "the picture has no alpha channel; leave out --packing");
    return Halves{picture, alphaOf(picture)};
  }
  const bool beside = packing == Packing::SideBySide || packing == Packing::SideBySideDepthFirst;
  const bool depth_first = packing == Packing::SideBySideDepthFirst || packing == Packing::TopBottomDepthFirst;
  const int whole = beside ? picture.width : picture.height;
  const bool red = gray == GrayFrom::Red && picture.model == ColorModel::Rgb;
  const Frame depth = code != DepthCode::Luma ? picture : red ? componentOf(picture, 0) : lumaOf(picture);
  // A half that is read with chroma begins at a whole chroma sample.
  const Frame& second = depth_first ? picture : depth;
  const int start = alignUp(whole - (whole - seam) / 2, beside ? second.chroma_shift_x : second.chroma_shift_y);
  const int half = whole - start;
  const bool empty = half < 1 || picture.width < 1 || picture.height < 1;
  if (empty)
    return fail(ErrorCode::Unsupported, "the picture is too small to hold both colour and depth; check --packing");
  const auto cut = [&](const Frame& from, bool first) {
    if (beside) return crop(from, first ? 0 : start, 0, half, from.height);
    return crop(from, 0, first ? 0 : start, from.width, half);
  };
  return Halves{cut(picture, !depth_first), cut(depth, depth_first)};
}

}  // namespace relievo
