// SPDX-License-Identifier: Apache-2.0
// Films that the tests of FilmWriter write and read back.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <vector>

#include "app/author/package/film_writer.h"
#include "app/scene/depth_calibration.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo::test {

inline constexpr Duration kPeriod = std::chrono::nanoseconds(1'000'000'000 / 30);

inline FilmFormat formatOf(int width, int height) {
  FilmFormat format;
  format.color_width = format.depth_width = width;
  format.color_height = format.depth_height = height;
  format.color_matrix = ColorMatrix::Bt709;
  format.frame_period = kPeriod;
  return format;
}

// Every code from 0 to 255 in every picture, without pattern (a multiplicative hash).
inline std::uint8_t scattered(int c, int r, int k) {
  const auto n = static_cast<std::uint32_t>(c + 1000 * r + 1'000'000 * k);
  return static_cast<std::uint8_t>((n * 2654435761u) >> 24);
}
inline DepthPicture depthPicture(int width, int height, const std::function<std::uint8_t(int, int)>& code) {
  DepthPicture picture{width, height, {}};
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) picture.codes.push_back(code(c, r));
  }
  return picture;
}
inline ColorPicture420 colorPicture(int width, int height, int k) {
  ColorPicture420 picture{.width = width, .height = height, .y = {}, .u = {}, .v = {}};
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture.y.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    picture.y[i] = static_cast<std::uint8_t>(16 + (i + 3 * static_cast<std::size_t>(k)) % 219);
  picture.u.assign(pixels / 4, 110);
  picture.v.assign(pixels / 4, 150);
  return picture;
}

struct ReadFilm {
  std::vector<StreamInfo> streams;
  std::map<std::string, std::string> tags;
  std::map<int, std::vector<MediaTime>> keys;  // by stream
  std::map<int, std::vector<Frame>> frames;
};

inline ReadFilm readFilm(const std::string& path) {
  ReadFilm film;
  const auto source = makeFfmpegSource();
  EXPECT_TRUE(source->open(path).has_value());
  film.streams = source->streams();
  film.tags = source->tags();
  std::map<int, std::unique_ptr<VideoDecoder>> decoders;
  for (const StreamInfo& stream : film.streams) {
    decoders[stream.index] = makeFfmpegDecoder();
    EXPECT_TRUE(decoders[stream.index]->open(stream).has_value());
  }
  const auto receiveAll = [&](int stream) {
    for (auto got = decoders[stream]->receive(); got.value(); got = decoders[stream]->receive()) {
      film.frames[stream].push_back(std::move(**got));
    }
  };
  while (auto packet = source->read().value()) {
    if (packet->keyframe) film.keys[packet->stream].push_back(*packet->pts);
    while (decoders[packet->stream]->feed(*packet).value() == Feed::Full) receiveAll(packet->stream);
  }
  for (auto& [stream, decoder] : decoders) {
    EXPECT_TRUE(decoder->drain().has_value());
    receiveAll(stream);
  }
  return film;
}

// Writes `times` pictures of both tracks, the keys where `key` says.
inline void writeFilm(const std::string& path, const FilmFormat& format, const std::vector<MediaTime>& times,
                      const std::function<DepthPicture(int)>& depth, const std::function<bool(int)>& key) {
  auto writer = FilmWriter::create(path, format);
  ASSERT_TRUE(writer.has_value()) << writer.error().message;
  for (int k = 0; k < static_cast<int>(times.size()); ++k) {
    const MediaTime time = times[static_cast<std::size_t>(k)];
    ASSERT_TRUE(
        (*writer)->writeColor(colorPicture(format.color_width, format.color_height, k), time, key(k)).has_value());
    ASSERT_TRUE((*writer)->writeDepth(depth(k), time, key(k)).has_value());
  }
  const auto totals = (*writer)->finish();
  ASSERT_TRUE(totals.has_value()) << totals.error().message;
  EXPECT_EQ(totals->color.frames, times.size());
  EXPECT_EQ(totals->depth.frames, times.size());
  EXPECT_EQ(totals->file_bytes, std::filesystem::file_size(path));
  EXPECT_GT(totals->file_bytes, totals->color.bytes + totals->depth.bytes);
}

inline std::vector<MediaTime> regularTimes(int frames) {
  std::vector<MediaTime> times;
  for (int k = 0; k < frames; ++k) times.push_back(mediaTime(k / 30.0));
  return times;
}

}  // namespace relievo::test
