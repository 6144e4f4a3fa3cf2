// SPDX-License-Identifier: Apache-2.0
// Files for the FFmpeg source, and what it reads of them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string_view>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {

using test::ClipTrack;

inline const ClipTrack kH264{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 48};

inline Error openErrorOf(const std::string& url) {
  const auto source = makeFfmpegSource();
  const auto opened = source->open(url);
  EXPECT_FALSE(opened.has_value()) << url;
  EXPECT_EQ(source->state(), MediaSource::State::Closed);
  return opened ? Error{} : opened.error();
}

inline std::vector<Packet> readAll(MediaSource& source) {
  std::vector<Packet> packets;
  while (auto packet = source.read().value()) packets.push_back(*packet);
  return packets;
}

inline void writeFile(const std::string& path, std::string_view content) {
  std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
}

// Keeps the first `part` of the file, 0 to 1.
inline void cutFile(const std::string& path, double part) {
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  std::filesystem::resize_file(path, static_cast<std::uintmax_t>(size * part));
}

}  // namespace relievo
