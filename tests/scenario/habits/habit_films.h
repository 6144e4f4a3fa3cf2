// SPDX-License-Identifier: Apache-2.0
// Films for trying a player's keys.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/film/clip_maker.h"

namespace relievo::test {

using namespace std::chrono_literals;

// A gray picture; its depth is that of a wall in the middle.
inline void makeFilm(const std::string& path, int seconds, const std::vector<ClipSound>& sounds = {}) {
  const auto even = [](unsigned luma) {
    return [luma](int component, int, int, int) { return component == 0 ? luma : 128U; };
  };
  ClipTrack color{.pix_fmt = "yuv420p", .fps_num = 5, .frames = 5 * seconds, .tags = {{"title", "color"}}};
  ClipTrack depth{.pix_fmt = "gray", .fps_num = 5, .frames = 5 * seconds, .tags = {{"title", "depth"}}};
  color.sample = even(180);
  depth.sample = even(128);
  makeClip(path, {color, depth}, {}, sounds);
}

// film.mkv: 100 s, two sound tracks, chapters at 0, 30 and 60 s, and beside it subtitles of two languages, a line a
// second.
inline void makeFilmOfTracks(const TemporaryFolder& folder) {
  makeFilm(folder / "bare.mkv", 100, {{.length = 100s}, {.length = 100s}});
  std::ofstream chapters(folder / "chapters.txt");
  chapters << ";FFMETADATA1\n";
  for (const int begin : {0, 30, 60}) {
    chapters << "[CHAPTER]\nTIMEBASE=1/1\nSTART=" << begin << "\nEND=" << begin + 30 << "\ntitle=" << begin << "\n";
  }
  chapters.close();
  for (const char* language : {"de", "en"}) {
    std::ofstream words(folder / ("film." + std::string(language) + ".srt"));
    for (int k = 0; k < 100; ++k) {
      const std::string minute =
          "00:0" + std::to_string(k / 60) + ":" + (k % 60 < 10 ? "0" : "") + std::to_string(k % 60);
      words << k + 1 << "\n" << minute << ",000 --> " << minute << ",990\nWORDS " << language << "\n\n";
    }
  }
  const std::string mux = "ffmpeg -v error -i " + folder / "bare.mkv" + " -i " + folder / "chapters.txt" +
                          " -map 0 -map_chapters 1 -c copy -metadata:s:a:0 language=eng -metadata:s:a:1 language=deu "
                          "-metadata title='A film' " +
                          folder / "film.mkv";
  ASSERT_EQ(std::system(mux.c_str()), 0);  // NOLINT(bugprone-command-processor): the test's command
}

}  // namespace relievo::test
