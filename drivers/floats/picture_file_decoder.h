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

// A format: its name in StreamInfo::codec, and its reader. The reader returns nullopt if the file is damaged, if it
// cannot read the picture, or if the picture is larger than VideoDecoder::kMostSamples. It checks the size before it
// allocates memory in proportion to it.
struct PictureFormat {
  const char* codec = "";
  std::optional<FilePicture> (*read)(std::span<const std::uint8_t> file) = nullptr;
};

// Returns FilePicture::whole_bits for samples that the file stores as `type`: whole numbers that fit into codes are
// used as codes.
[[nodiscard]] int wholeBits(const NumberType& type, std::span<const float> samples) noexcept;

// True for a size that a reader may allocate.
[[nodiscard]] bool isSoundSize(std::uint64_t width, std::uint64_t height) noexcept;

// One component, or three that are equal throughout the first picture, become 16-bit gray codes on one scale for the
// whole film (hal/media/float_codes.h), which Frame::value_per_code states; so does red where green and blue are 0 in
// floating point. Whole numbers that fit become codes unchanged, those of 8 bits stretched to 16. Other colours become
// 16-bit RGB; floating-point ones are taken as linear light and encoded for a screen.
[[nodiscard]] std::unique_ptr<VideoDecoder> makePictureFileDecoder(PictureFormat format);

}  // namespace relievo
