// SPDX-License-Identifier: Apache-2.0
// A film with sound, subtitles, languages, chapters and a title, made by the ffmpeg program; films of relievo-author
// are judged by ffprobe.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo::test {

inline std::string say(const std::string& command) {
  std::string text;
  FILE* const pipe = ::popen(command.c_str(), "r");  // NOLINT(bugprone-command-processor): the test's command
  if (pipe == nullptr) return text;
  std::array<char, 4096> some{};
  while (const std::size_t bytes = std::fread(some.data(), 1, some.size(), pipe)) text.append(some.data(), bytes);
  ::pclose(pipe);
  return text;
}

inline std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

// Times in s of one stream's packets.
inline std::vector<double> timesOf(const std::string& film, const std::string& stream) {
  std::vector<double> times;
  const std::string probe =
      "ffprobe -v error -select_streams " + stream + " -show_entries packet=pts_time -of default=nk=1:nw=1 " + film;
  for (const std::string& line : linesOf(say(probe))) times.push_back(std::strtod(line.c_str(), nullptr));
  return times;
}

// Each chapter as "0.700 1.400 Middle": begin and end, in s from the first picture. Not from the file's time 0, because
// FFmpeg 7 shifts all times by the sound's encoder delay.
inline std::vector<std::string> chaptersOf(const std::string& film) {
  const double first_picture = timesOf(film, "v:0").at(0);
  std::vector<std::string> chapters;
  for (const std::string& line : linesOf(
           say("ffprobe -v error -show_entries chapter=start_time,end_time:chapter_tags=title -of compact=p=0:nk=1 " +
               film))) {
    char* rest = nullptr;
    const double start = std::strtod(line.c_str(), &rest), end = std::strtod(rest + 1, &rest);
    std::array<char, 80> times{};
    std::snprintf(times.data(), times.size(), "%.3f %.3f ", start - first_picture, end - first_picture);
    chapters.push_back(times.data() + std::string(rest + 1));
  }
  return chapters;
}

// The text and the times of a subtitle track, as an .srt.
inline std::string wordsOf(const std::string& film, int track) {
  return say("ffmpeg -v error -i " + film + " -map 0:s:" + std::to_string(track) + " -f srt -");
}

// "aac|eng|Director" for each sound or subtitle track.
inline std::vector<std::string> tracksOf(const std::string& film, const std::string& kind) {
  std::vector<std::string> tracks;
  for (const std::string& line :
       linesOf(say("ffprobe -v error -select_streams " + kind +
                   " -show_entries stream=codec_name:stream_tags=language,title -of compact=p=0:nk=1 " + film))) {
    const bool of_programme =
        line.find('|') == std::string::npos;  // ffprobe lists each track of a transport stream twice
    if (!of_programme) tracks.push_back(line);
  }
  return tracks;
}

class AuthorKeeps : public testing::Test {
 protected:
  // A film of 2 s: two languages of sound, the second longer than the picture; two of text; three chapters; a title.
  void SetUp() override {
    if (std::system("command -v ffmpeg ffprobe >/dev/null") != 0) GTEST_SKIP() << "no ffmpeg program here";
    ClipTrack color{.pix_fmt = "yuv420p", .width = 64, .height = 48, .fps_num = 25, .frames = 50};
    ClipTrack depth = color;
    depth.pix_fmt = "gray";
    makeClip(folder_ / "pictures.mkv", {color, depth});
    std::ofstream(folder_ / "en.srt") << "1\n00:00:00,200 --> 00:00:00,900\nHello there\n\n"
                                         "2\n00:00:01,100 --> 00:00:01,700\n<i>Second</i> line\n\n";
    std::ofstream(folder_ / "ja.srt") << "1\n00:00:00,400 --> 00:00:01,300\nこんにちは\n\n";
    std::ofstream(folder_ / "meta") << ";FFMETADATA1\ntitle=A walk\n"
                                       "[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=700\ntitle=Start\n"
                                       "[CHAPTER]\nTIMEBASE=1/1000\nSTART=700\nEND=1400\ntitle=Middle\n"
                                       "[CHAPTER]\nTIMEBASE=1/1000\nSTART=1400\nEND=2000\ntitle=End\n";
    const std::string make =
        "ffmpeg -v error -y -i @/pictures.mkv -f lavfi -i sine=440:d=2 -f lavfi -i sine=880:d=3 -i @/en.srt -i @/ja.srt"
        " -i @/meta -map 0:0 -map 0:1 -map 1 -map 2 -map 3 -map 4 -map_metadata 5 -map_chapters 5 -c copy"
        " -c:a aac -metadata:s:a:0 language=eng -metadata:s:a:1 language=jpn -metadata:s:a:1 title=Director"
        " -metadata:s:s:0 language=eng -metadata:s:s:1 language=jpn @/film.mkv";
    ASSERT_EQ(std::system(inFolder(make).c_str()), 0);
    film_ = folder_ / "film.mkv";
  }
  [[nodiscard]] std::string inFolder(std::string words) const {
    std::string folder = folder_ / "";
    folder.pop_back();
    for (std::size_t at = words.find('@'); at != std::string::npos; at = words.find('@', at)) {
      words.replace(at, 1, folder);
    }
    return words;
  }
  // Runs relievo-author and returns what it printed.
  std::string author(const std::string& options, const std::string& source = "@/film.mkv") {
    const auto ran = runProgram(inFolder("relievo-author --color " + source + " " + options), folder_ / "");
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return ran.out;
  }
  // Every packet of sound track `track` has kept its distance from the first picture.
  void expectSameSound(const std::string& made, int track) const {
    const std::string stream = "a:" + std::to_string(track);
    const std::vector<double> before = timesOf(film_, stream), after = timesOf(made, stream);
    ASSERT_EQ(before.size(), after.size());
    ASSERT_FALSE(before.empty());
    const double begins = timesOf(film_, "v:0").front(), begins_made = timesOf(made, "v:0").front();
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_NEAR(before[i] - begins, after[i] - begins_made, 1.1e-3) << "packet " << i;
    }
  }

  TemporaryFolder folder_;
  std::string film_;
};

}  // namespace relievo::test
