// SPDX-License-Identifier: Apache-2.0
// Media source of a photo that holds colour and depth, or two views, in one file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/media/media_source.h"

namespace relievo {

using PhotoBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

// One picture of a photo: its stream, and its coded bytes (a part of `owner`).
struct PhotoPart {
  StreamInfo stream;
  std::span<const std::uint8_t> coded;
  PhotoBytes owner;
  std::string note;  // a line for the user; empty if there is none
};

// A kind of photo: whether a file that begins with these bytes (64, or all of it) may be one; and its pictures, colour
// or the left view first, or none if the file is of another kind or holds nothing beside its colour.
struct PhotoKind {
  bool (*begins)(std::span<const std::uint8_t> first_bytes) = nullptr;
  std::vector<PhotoPart> (*parts)(const PhotoBytes& file) = nullptr;
  std::uint64_t most_bytes = std::uint64_t{256} << 20;  // of a file, which is held whole
};

// A JPEG's, which FFmpeg's decoder holds two times more.
inline constexpr std::uint64_t kMostJpegBytes = 140'000'000;

// JPEG with a depth map in its XMP metadata (GDepth, standard or extended) or behind the picture (Dynamic
// Depth; an iPhone's photo in the most compatible form).
extern const PhotoKind kDepthJpeg;

// JPEG of two views: several pictures in one file (MPO; CIPA DC-007) as two streams with kViewTag, or both views in one
// picture (JPS), with the tags STEREO_MODE and kSqueezedTag.
extern const PhotoKind kStereoJpeg;

// A line about depth in a photo of a kind that is not read (Samsung's, Huawei's, Leia's), with what to do; null if the
// file, which begins like a JPEG, has none.
[[nodiscard]] const char* unreadDepth(const std::string& path);

// The pictures of a file that one of the kinds takes; none if it is another. Reads the file if it begins
// like one.
[[nodiscard]] std::vector<PhotoPart> photoParts(const std::string& path, std::span<const PhotoKind> kinds);
// True if the path is a file that one of the kinds takes. Reads it if it begins like one.
[[nodiscard]] bool isPhoto(const std::string& path, std::span<const PhotoKind> kinds);

// One stream for each picture, with one packet at time 0. `kinds` must outlive it.
[[nodiscard]] std::unique_ptr<MediaSource> makePhotoSource(std::span<const PhotoKind> kinds);

}  // namespace relievo
