// SPDX-License-Identifier: Apache-2.0
// A decoder of pictures whose samples may be floating-point numbers: each packet is a whole file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/floats/number.h"
#include "hal/media/video_decoder.h"

namespace relievo {

// A file's picture as numbers, row by row from the top.
struct FilePicture {
  int width = 0, height = 0;
  int components = 1;  // 1; or 3: red, green, blue, interleaved
  int whole_bits = 0;  // 8 or 16: whole numbers of so many bits, from 0 on; 0: any numbers
  std::vector<float> samples;
  Frame frame;  // instead of samples, if it is not empty: whole numbers that need no conversion
};

// A format: its name in StreamInfo::codec, and its reader. The reader returns nullopt for a damaged file, or one whose
// picture is none that it reads or is larger than VideoDecoder::kMostSamples; it allocates nothing in proportion to a
// size before that check.
struct PictureFormat {
  const char* codec = "";
  std::optional<FilePicture> (*read)(std::span<const std::uint8_t> file) = nullptr;
};

// FilePicture::whole_bits of samples that the file holds as `type`: whole numbers that fit into codes are codes.
[[nodiscard]] int wholeBits(const NumberType& type, std::span<const float> samples) noexcept;

// True for a size that a reader may allocate.
[[nodiscard]] bool isSoundSize(std::uint64_t width, std::uint64_t height) noexcept;

// One component, or three that are equal throughout the first picture, become 16-bit gray codes by one scale for the
// whole film (hal/media/float_codes.h); Frame::value_per_code says it. Whole numbers that fit become codes as they are,
// those of 8 bits stretched to 16. Other colours become 16-bit RGB, floating-point ones as light that is encoded for a
// screen.
[[nodiscard]] std::unique_ptr<VideoDecoder> makePictureFileDecoder(PictureFormat format);

}  // namespace relievo
