// SPDX-License-Identifier: Apache-2.0
// Finds the two views of a stereo photo: the multi-picture format and JPS (VRex, "JPEG
// stereoscopic file format", 1.0).
#include <algorithm>
#include <string_view>

#include "drivers/photo/jpeg_xmp.h"
#include "drivers/photo/multi_picture.h"
#include "drivers/photo/photo.h"
#include "hal/media/media_names.h"

namespace relievo {
namespace {

using namespace photo;

constexpr std::uint8_t kApp3 = 0xe3;

// The pictures of type "disparity": views side by side, from left to right. Phones list gain maps and previews the same
// way, with other types.
std::vector<PhotoPart> multiPicture(const PhotoBytes& file) {
  std::vector<PhotoPart> parts;
  for (const ListedPicture& view : picturesIn(*file)) {
    if (view.type != kViewType || parts.size() == 2) continue;
    PhotoPart part{.stream = {.codec = "mjpeg"}, .coded = view.coded, .owner = file};
    part.stream.rotation = exifRotation(view.coded).value_or(parts.empty() ? 0 : parts[0].stream.rotation);
    part.stream.tags[kViewTag] = parts.empty() ? "left" : "right";
    parts.push_back(std::move(part));
  }
  return parts.size() == 2 ? parts : std::vector<PhotoPart>{};
}

// The descriptor's bytes are, from the lowest: media type, layout, flags, distance between the views.
std::vector<PhotoPart> onePicture(const PhotoBytes& file) {
  constexpr std::string_view kName = "_JPSJPS_";
  constexpr std::size_t kDescriptor = 10, kStereo = 1, kBeside = 2, kAbove = 3;
  constexpr std::size_t kHalfHeight = 1, kHalfWidth = 2, kLeftFirst = 4;
  for (const std::string_view segment : segmentsOf(*file, kApp3)) {
    if (!segment.starts_with(kName) || segment.size() < kDescriptor + 4) continue;
    const std::size_t descriptor = Numbers{segment, true}.at(kDescriptor, 4);
    const std::size_t type = descriptor & 0xff, layout = descriptor >> 8 & 0xff, flags = descriptor >> 16 & 0xff;
    if (type != kStereo || (layout != kBeside && layout != kAbove)) return {};
    const bool left_first = (flags & kLeftFirst) != 0, beside = layout == kBeside;
    const bool squeezed = (flags & (beside ? kHalfWidth : kHalfHeight)) != 0;
    PhotoPart part{.stream = {.codec = "mjpeg"}, .coded = *file, .owner = file};
    part.stream.rotation = 0;  // of the whole picture, whose halves would change places
    part.stream.tags["STEREO_MODE"] =
        beside ? (left_first ? "left_right" : "right_left") : (left_first ? "top_bottom" : "bottom_top");
    part.stream.tags[kSqueezedTag] = squeezed ? "1" : "0";
    return {std::move(part)};
  }
  return {};
}

bool beginsLikeJpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

std::vector<PhotoPart> partsOf(const PhotoBytes& file) {
  auto views = multiPicture(file);
  return views.empty() ? onePicture(file) : views;
}

}  // namespace

const PhotoKind kStereoJpeg{beginsLikeJpeg, partsOf, kMostJpegBytes};

}  // namespace relievo
