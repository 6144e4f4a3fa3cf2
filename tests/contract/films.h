// SPDX-License-Identifier: Apache-2.0
// The same short film for every back end of source and decoder: 30 pictures at 25 a second, every tenth
// a key frame.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/mock/mock.h"
#include "drivers/sample/sample.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/sample_clip.h"

namespace relievo::test {

inline constexpr int kFilmFrames = 30;
inline constexpr int kFilmKeyInterval = 10;
inline constexpr Duration kFilmPeriod = std::chrono::milliseconds(40);

struct FilmBackend {
  const char* name;
  std::unique_ptr<MediaSource> (*make_source)();
  std::unique_ptr<VideoDecoder> (*make_decoder)();
  std::string (*url)();
  const char* missing_url;  // null if every URL is a film
  Duration key_step = std::chrono::milliseconds(400);
  bool titled = true;  // the container has a tag TITLE
};
inline void PrintTo(const FilmBackend& backend, std::ostream* out) {
  *out << backend.name;
}

// H.264 with pictures that are coded out of order, so that decoding order and presentation order differ.
inline std::string encodedFilm() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    const ClipTrack track{.codec = "libx264",
                          .pix_fmt = "yuv420p",
                          .fps_num = 25,
                          .frames = kFilmFrames,
                          .gop = kFilmKeyInterval,
                          .b_frames = 2};
    makeClip(folder / "film.mkv", {track}, {{"title", "film"}});
    return folder / "film.mkv";
  }();
  return path;
}

inline std::unique_ptr<MediaSource> mockFilm() {
  static ManualClock clock;
  MockTrack track;
  track.width = 64, track.height = 48;
  track.frames = kFilmFrames;
  track.frame_period = kFilmPeriod;
  track.keyframe_interval = kFilmKeyInterval;
  return makeMockSource({.tracks = {track}, .tags = {{"TITLE", "film"}}}, clock);
}

inline std::string sampleFilm() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    writeSampleClip(folder / "film",
                    {.pictures = kFilmFrames, .key_interval = kFilmKeyInterval, .period = kFilmPeriod});
    return folder / "film";
  }();
  return path;
}

inline const FilmBackend kFilmBackends[] = {
    {"mock", mockFilm, [] { return makeMockDecoder({.reorder_frames = 2}); }, [] { return std::string("mock:"); },
     nullptr},
    {"ffmpeg", makeFfmpegSource, makeFfmpegDecoder, encodedFilm, "/nonexistent/film.mkv"},
    {"sample", makeSampleSource, makeSampleDecoder, sampleFilm, "/nonexistent/film"},
};

class FilmContract : public testing::TestWithParam<FilmBackend> {
 protected:
  [[nodiscard]] std::unique_ptr<MediaSource> openSource() const {
    auto source = GetParam().make_source();
    EXPECT_TRUE(source->open(GetParam().url()));
    return source;
  }
  // All packets from here to the end.
  [[nodiscard]] static std::vector<Packet> readAll(MediaSource& source) {
    std::vector<Packet> packets;
    for (;;) {
      auto packet = source.read();
      EXPECT_TRUE(packet);
      if (!packet || !*packet) return packets;
      packets.push_back(std::move(**packet));
    }
  }
};

}  // namespace relievo::test
