// SPDX-License-Identifier: Apache-2.0
// Any bytes as a picture's file.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "drivers/floats/picture_file_decoder.h"
#include "drivers/photo/photo.h"
#include "platform/log.h"

namespace relievo {

// Decodes the bytes and reads all the memory that the frame announces.
inline void fuzzPicture(const PictureFormat& format, std::span<const std::uint8_t> bytes) {
  setLogLevel(LogLevel::Error);
  const auto decoder = makePictureFileDecoder(format);
  if (!decoder->open({.kind = StreamKind::Video, .codec = format.codec})) std::abort();
  if (!decoder->feed({.data = bytes.data(), .bytes = bytes.size()})) std::abort();
  const auto frame = decoder->receive();
  if (!frame || !*frame) return;
  const Frame& picture = **frame;
  if (!isSoundSize(static_cast<std::uint64_t>(picture.width), static_cast<std::uint64_t>(picture.height))) std::abort();
  const std::ptrdiff_t row = std::ptrdiff_t{picture.components[0].step_bytes} * picture.width;
  for (int r = 0; r < picture.height; ++r) {
    const volatile std::uint8_t last = picture.planes[0].data[r * picture.planes[0].stride_bytes + row - 1];
    static_cast<void>(last);
  }
}

// The pictures of a photo, each decoded if it has a format here.
inline void fuzzPhoto(const PhotoKind& kind, std::span<const PictureFormat> formats,
                      std::span<const std::uint8_t> bytes) {
  const auto file = std::make_shared<const std::vector<std::uint8_t>>(bytes.begin(), bytes.end());
  if (!kind.begins(*file)) return;
  for (const PhotoPart& part : kind.parts(file)) {
    for (const PictureFormat& format : formats) {
      if (part.stream.codec == format.codec) fuzzPicture(format, part.coded);
    }
  }
}

}  // namespace relievo
