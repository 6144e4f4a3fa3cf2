// SPDX-License-Identifier: Apache-2.0
// Writes one Matroska or MP4 file with a colour and a depth track of H.264, which appears whole or not at all.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "app/author/picture.h"
#include "hal/media_time.h"
#include "platform/error.h"

namespace relievo {

struct FilmFormat {
  int color_width = 0, color_height = 0;
  int depth_width = 0, depth_height = 0;
  ColorRange color_range = ColorRange::Limited;
  ColorMatrix color_matrix = ColorMatrix::Unspecified;
  double color_aspect = 1.0, depth_aspect = 1.0;  // width of a sample over its height
  Duration frame_period{0};                       // for the rate control alone; 0 unknown
  int color_crf = 18;
  int depth_crf = 8;                              // 0: lossless, every code comes back
  std::map<std::string, std::string> depth_tags;  // calibrationTags()
};

struct TrackTotals {
  std::uint64_t frames = 0;
  std::uint64_t bytes = 0;
  MediaTime first, last;
};
struct FilmTotals {
  TrackTotals color, depth;
  std::uint64_t file_bytes = 0;
};

// Track 0 is the colour, 4:2:0, titled "color"; track 1 is the depth, 4:0:0 of full range, titled "depth" and carrying
// the tags. MP4 keeps few tags of a track: there the depth is named by its handler and the tags are the file's.
//
// One thread; libx264 has threads of its own. It is written under a temporary name beside the target, which is renamed
// by `finish`; without that nothing is left. Times of a track must rise.
class FilmWriter {
 public:
  // InvalidArgument for an ending other than .mkv, .mp4, .mov or .m4v, NotFound for a folder that is not there,
  // Unsupported without libx264.
  [[nodiscard]] static Result<std::unique_ptr<FilmWriter>> create(const std::string& path, const FilmFormat& format);
  // Whether `create` knows the file's ending; so that a typing error is told before any work is done.
  [[nodiscard]] static bool knowsEnding(const std::string& path);
  ~FilmWriter();

  // `key` makes it a key frame; no others are made, apart from the first.
  [[nodiscard]] Result<void> writeColor(const ColorPicture420& picture, MediaTime time, bool key);
  [[nodiscard]] Result<void> writeDepth(const DepthPicture& picture, MediaTime time, bool key);
  [[nodiscard]] Result<FilmTotals> finish();

 private:
  struct Impl;
  explicit FilmWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace relievo
