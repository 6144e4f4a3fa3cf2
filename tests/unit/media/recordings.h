// SPDX-License-Identifier: Apache-2.0
// Recordings of a scene whose distances are known, and what the reader makes of them.
#pragma once

#include <cmath>
#include <functional>

#include "app/media/pair_reader.h"
#include "app/scene/height_field.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {

using test::ClipTrack;
using test::distanceMm;
using test::kSceneCols;
using test::kSceneRows;
using test::makeClip;
using test::photoOf;
using test::yuvCode;

inline constexpr DisplayVolume kVolume{160, 108, 40};
inline ClipTrack photo(int frames = 2) {
  ClipTrack track{.pix_fmt = "yuv444p", .width = kSceneCols, .height = kSceneRows, .frames = frames};
  track.sample = [](int k, int c, int r, int) { return yuvCode(k, photoOf(c, r)); };
  return track;
}

// Sixteen bits of gray in numbered PNG pictures: code(mm), where mm is 0 for a hole.
using Code = std::function<std::uint32_t(double mm, int c, int r)>;
inline ClipTrack coded(const Code& code, int frames = 2) {
  ClipTrack track{.codec = "png", .pix_fmt = "gray16be", .width = kSceneCols, .height = kSceneRows, .frames = frames};
  track.sample = [code](int, int c, int r, int) { return code(distanceMm(c, r), c, r); };
  return track;
}

inline std::uint32_t rounded(double x) {
  return static_cast<std::uint32_t>(std::lround(x));
}

struct Seen {
  FilmInfo info;
  Frame depth;
  std::string failure;
};
inline Seen open(const SourceOptions& options) {
  PairReader reader(kFfmpeg);
  if (const auto opened = reader.open(options); !opened) return {.failure = opened.error().message};
  auto pair = reader.next();
  if (!pair || !*pair) return {.failure = "no pair"};
  return {reader.info(), (*pair)->depth, ""};
}

// The distances of the samples that are no holes, by the definition in app/scene/depth_calibration.h, and the holes'
// share.
struct Distances {
  double median = 0, holes = 0;
};
inline Distances measure(const Seen& seen) {
  const DepthCalibration& c = seen.info.calibration.calibration;
  const HeightField field = HeightField::make(seen.depth, c, kVolume).value();
  std::vector<double> mm;
  for (int r = 0; r < field.rows(); ++r) {
    for (int x = 0; x < field.cols(); ++x) {
      const double height = field.heightMm(x, r);
      if (!std::isnan(height)) mm.push_back(c.far_mm - height / kVolume.depth_mm * (c.far_mm - c.near_mm));
    }
  }
  const double all = static_cast<double>(field.rows()) * field.cols();
  std::nth_element(mm.begin(), mm.begin() + static_cast<std::ptrdiff_t>(mm.size() / 2), mm.end());
  return {mm.empty() ? 0 : mm[mm.size() / 2], 1 - static_cast<double>(mm.size()) / all};
}

// The same of the scene itself, of the samples that `is_seen` leaves.
inline Distances truth(double scale = 1, const std::function<bool(int, int)>& is_seen = {}) {
  std::vector<double> mm;
  for (int r = 0; r < kSceneRows; ++r) {
    for (int c = 0; c < kSceneCols; ++c) {
      if (distanceMm(c, r) > 0 && (!is_seen || is_seen(c, r))) mm.push_back(scale * distanceMm(c, r));
    }
  }
  std::nth_element(mm.begin(), mm.begin() + static_cast<std::ptrdiff_t>(mm.size() / 2), mm.end());
  return {mm[mm.size() / 2], 1 - static_cast<double>(mm.size()) / (kSceneRows * kSceneCols)};
}

// Two halves in one picture, in H.264 4:2:0.
struct Half {
  std::function<std::array<double, 3>(int c, int r)> color;
};
inline void makeHalves(const std::string& path, bool beside, const Half& first, const Half& second,
                       const std::map<std::string, std::string>& tags = {}, int dark_frames = 0) {
  ClipTrack film{.codec = "libx264",
                 .pix_fmt = "yuv420p",
                 .width = beside ? 2 * kSceneCols : kSceneCols,
                 .height = beside ? kSceneRows : 2 * kSceneRows,
                 .frames = 2 + dark_frames,
                 .options = {{"crf", "8"}}};
  film.sample = [=](int k, int c, int r, int frame) {
    const int x = k == 0 ? c : 2 * c, y = k == 0 ? r : 2 * r;
    if (frame < dark_frames) return k == 0 ? 16u : 128u;
    const bool is_first = beside ? x < kSceneCols : y < kSceneRows;
    return yuvCode(k, (is_first ? first : second).color(x % kSceneCols, y % kSceneRows));
  };
  makeClip(path, {film}, tags);
}

inline const Half kPhoto{photoOf};

}  // namespace relievo
