// SPDX-License-Identifier: Apache-2.0
// The short film of the contracts, as each back end of source and decoder has it.
#pragma once

#include <memory>
#include <string>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/mock/mock.h"
#include "drivers/sample/sample.h"
#include "tests/contract/suite/film.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/sample_clip.h"

namespace relievo::test {

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

}  // namespace relievo::test
