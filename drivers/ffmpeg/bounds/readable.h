// SPDX-License-Identifier: Apache-2.0
// The bytes of a file, or of a picture in memory, for what looks at them before FFmpeg does.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "platform/files/answered_file.h"

namespace relievo::ffmpeg {

// Fills `out` from a place on; how many bytes there are: fewer at the end, 0 for what cannot be read.
using Readable = std::function<std::size_t(std::uint64_t place, std::span<std::uint8_t> out)>;

// `picture` must outlive it.
[[nodiscard]] inline Readable readable(std::span<const std::uint8_t> picture) {
  return [picture](std::uint64_t place, std::span<std::uint8_t> out) {
    const auto rest = picture.subspan(static_cast<std::size_t>(std::min<std::uint64_t>(place, picture.size())));
    const std::size_t bytes = std::min(rest.size(), out.size());
    std::ranges::copy(rest.first(bytes), out.begin());
    return bytes;
  };
}

[[nodiscard]] inline Readable readable(AnsweredFile file) {
  return [file = std::move(file)](std::uint64_t place, std::span<std::uint8_t> out) {
    return file.read(place, out).value_or(0);
  };
}

}  // namespace relievo::ffmpeg
