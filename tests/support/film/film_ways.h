// SPDX-License-Identifier: Apache-2.0
// The containers and codecs that the author offers, and a film through one of them.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "app/author/package/film_writer.h"
#include "app/media/pair_reader.h"
#include "app/scene/depth_calibration.h"
#include "tests/support/film/ffmpeg_backends.h"

namespace relievo::test {

struct Way {
  const char* ending;
  VideoCodec codec = VideoCodec::H264;
  int bits = 8;
  bool flat = false;

  [[nodiscard]] DepthCoding coding(int crf) const {
    return {.codec = codec, .bits = bits, .flat_chroma = flat, .law = {}, .crf = crf};
  }
};
inline void PrintTo(const Way& way, std::ostream* out) {
  *out << way.ending << " " << name(way.codec) << " " << way.bits << (way.flat ? " flat" : "");
}

inline constexpr Way kWays[] = {
    {".mkv"},
    {".mkv", VideoCodec::H264, 8, true},
    {".mkv", VideoCodec::H264, 10},
    {".mkv", VideoCodec::H264, 10, true},
    {".mkv", VideoCodec::Hevc, 8},
    {".mkv", VideoCodec::Hevc, 10},
    {".mkv", VideoCodec::Hevc, 12},
    {".mkv", VideoCodec::Hevc, 12, true},
    {".mkv", VideoCodec::Ffv1, 8},
    {".mkv", VideoCodec::Ffv1, 10},
    {".mkv", VideoCodec::Ffv1, 12},
    {".mkv", VideoCodec::Ffv1, 16},
    {".mp4"},
    {".mp4", VideoCodec::H264, 10},
    {".mp4", VideoCodec::Hevc, 12},
    {".mov", VideoCodec::Hevc, 10},
    {".ts"},
    {".ts", VideoCodec::H264, 10, true},
    {".ts", VideoCodec::Hevc, 10},
    {".ts", VideoCodec::Hevc, 12, true},
    {".m3u8"},
    {".m3u8", VideoCodec::H264, 10},
    {".m3u8", VideoCodec::Hevc, 10},
};

inline ColorPicture420 colorPicture(int width, int height, int k) {
  ColorPicture420 picture{.width = width, .height = height, .y = {}, .u = {}, .v = {}};
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (std::size_t i = 0; i < pixels; ++i) {
    picture.y.push_back(static_cast<std::uint8_t>(16 + (i + 3 * static_cast<std::size_t>(k)) % 219));
  }
  picture.u.assign(pixels / 4, 110);
  picture.v.assign(pixels / 4, 150);
  return picture;
}

inline constexpr int kWayCols = 96, kWayRows = 64;

inline FilmFormat formatOf(const Way& way, int crf, const DepthCalibration& meaning) {
  FilmFormat format;
  format.color_width = format.depth_width = kWayCols;
  format.color_height = format.depth_height = kWayRows;
  format.frame_period = std::chrono::nanoseconds(1'000'000'000 / 30);
  format.color_crf = 30;
  format.depth = way.coding(crf);
  format.depth_tags = calibrationTags(meaning);
  return format;
}

struct ReadFilm {
  FilmInfo info;
  std::vector<FramePair> pairs;
};
inline ReadFilm readFilm(const std::string& url, std::size_t most = 1000) {
  PairReader reader(kFfmpeg);
  const auto opened = reader.open({.url = url});
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
  ReadFilm film{reader.info(), {}};
  while (opened && film.pairs.size() < most) {
    auto pair = reader.next();
    EXPECT_TRUE(pair) << (pair ? "" : pair.error().message);
    if (!pair || !*pair) break;
    film.pairs.push_back(std::move(**pair));
  }
  return film;
}

}  // namespace relievo::test
