// SPDX-License-Identifier: Apache-2.0
// Finds the two views of a stereo photo: the multi-picture format (CIPA DC-007-2009, 5.2) and JPS (VRex, "JPEG
// stereoscopic file format", 1.0).
#include <algorithm>
#include <string_view>

#include "drivers/photo/jpeg_xmp.h"
#include "drivers/photo/photo.h"
#include "hal/media/media_names.h"

namespace relievo {
namespace {

using namespace photo;

constexpr std::uint8_t kApp2 = 0xe2, kApp3 = 0xe3;

// The numbers of a TIFF structure, in its byte order; 0 beyond its end.
struct Numbers {
  std::string_view bytes;
  bool high_first = false;

  [[nodiscard]] std::size_t at(std::size_t place, std::size_t size) const noexcept {
    std::size_t value = 0;
    if (place > bytes.size() || size > bytes.size() - place) return 0;
    for (std::size_t i = 0; i < size; ++i) {
      value = value << 8 | static_cast<std::uint8_t>(bytes[high_first ? place + i : place + size - 1 - i]);
    }
    return value;
  }
};

// One of the pictures that the index lists: of a view's type, at `begin` of the file.
struct View {
  std::size_t begin = 0, length = 0;
};

// The entries of type "disparity": views side by side, from left to right. Phones list gain maps and previews the same
// way, with other types.
std::vector<View> viewsIn(const Numbers& index, std::size_t index_begin) {
  constexpr std::size_t kEntries = 0xb002, kDisparity = 0x020002, kEntryBytes = 16, kMostPictures = 64;
  std::vector<View> views;
  const std::size_t directory = index.at(4, 4), fields = index.at(directory, 2);
  for (std::size_t i = 0; i < fields && i < kMostPictures; ++i) {
    const std::size_t field = directory + 2 + 12 * i;
    if (index.at(field, 2) != kEntries) continue;
    const std::size_t count = std::min(index.at(field + 4, 4) / kEntryBytes, kMostPictures),
                      at = index.at(field + 8, 4);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t entry = at + kEntryBytes * k;
      if ((index.at(entry, 4) & 0xffffff) != kDisparity) continue;
      const std::size_t offset = index.at(entry + 8, 4);  // from the index; 0 for the file's first picture
      views.push_back({offset == 0 ? 0 : index_begin + offset, index.at(entry + 4, 4)});
    }
    break;
  }
  return views;
}

std::vector<PhotoPart> multiPicture(const PhotoBytes& file) {
  constexpr std::string_view kName("MPF\0", 4);
  std::vector<PhotoPart> parts;
  for (const std::string_view segment : segmentsOf(*file, kApp2)) {
    if (!segment.starts_with(kName)) continue;
    const std::string_view bytes = segment.substr(kName.size());
    const auto begin = static_cast<std::size_t>(bytes.data() - reinterpret_cast<const char*>(file->data()));
    for (const View& view : viewsIn({bytes, bytes.starts_with("MM")}, begin)) {
      if (parts.size() == 2 || view.begin > file->size() || view.length > file->size() - view.begin) break;
      const auto coded = std::span(*file).subspan(view.begin, view.length);
      PhotoPart part{.stream = {.codec = "mjpeg"}, .coded = coded, .owner = file};
      part.stream.rotation = exifRotation(coded).value_or(parts.empty() ? 0 : parts[0].stream.rotation);
      part.stream.tags[kViewTag] = parts.empty() ? "left" : "right";
      parts.push_back(std::move(part));
    }
    break;
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
