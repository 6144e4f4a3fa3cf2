// SPDX-License-Identifier: Apache-2.0
// Films that relievo-author makes of clips whose codes and times are known.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "app/author/author.h"
#include "app/author/package/output.h"
#include "app/media/pair_reader.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"
#include "tests/support/machine/program.h"

namespace relievo {

using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;

inline const ProgressReport kNoReport = [](std::uint64_t, std::optional<std::uint64_t>) {};

inline ClipTrack colorTrack(int width = 64, int height = 48, int fps = 30, int frames = 30) {
  return {.pix_fmt = "yuv420p", .width = width, .height = height, .fps_num = fps, .frames = frames};
}
inline ClipTrack depthTrack(const char* pix_fmt, std::function<std::uint32_t(int, int, int)> code, int width = 64,
                            int height = 48) {
  return {.pix_fmt = pix_fmt, .width = width, .height = height, .sample = [code](int component, int c, int r, int k) {
            return component == 0 ? code(c, r, k) : 128u;
          }};
}

struct Film {
  FilmInfo info;
  std::vector<FramePair> pairs;
  // The depth plane's code, as it was encoded.
  [[nodiscard]] int code(std::size_t pair, int c, int r) const {
    return static_cast<int>(test::sampleAt(pairs.at(pair).depth, 0, c, r));
  }
};

inline Film readFilm(const std::string& path) {
  PairReader reader(kFfmpeg);
  const auto opened = reader.open({.url = path});
  EXPECT_TRUE(opened.has_value()) << (opened ? "" : opened.error().message);
  Film film{reader.info(), {}};
  while (auto pair = reader.next().value()) film.pairs.push_back(std::move(*pair));
  return film;
}

inline std::vector<std::string> filesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

class AuthorFilm : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::atomic<bool> stop_{false};

  Outcome<AuthorSummary> make(const SourceOptions& source, const std::string& out = "out.mkv") {
    return authorFilm(source, kFfmpeg, {.path = folder_ / out, .color_crf = 18, .depth = {.crf = 0}}, stop_, kNoReport);
  }
  // Packages colour and depth from two files into out.mkv.
  AuthorSummary package(const ClipTrack& color, const ClipTrack& depth, SourceOptions source = {}) {
    makeClip(folder_ / "color.mkv", {color});
    makeClip(folder_ / "depth.mkv", {depth});
    source.url = folder_ / "color.mkv";
    source.depth_url = folder_ / "depth.mkv";
    auto summary = make(source);
    EXPECT_TRUE(summary.has_value()) << (summary ? "" : summary.error().thing + ": " + summary.error().error.message);
    return summary.value_or(AuthorSummary{});
  }
  // Runs `relievo-author ARGUMENTS`, where @ stands for the folder.
  test::ProgramResult run(std::string arguments) {
    const std::string folder = (folder_ / "");
    for (std::size_t at = arguments.find('@'); at != std::string::npos; at = arguments.find('@', at)) {
      arguments.replace(at, 1, folder.substr(0, folder.size() - 1));
    }
    return test::runProgram("relievo-author " + arguments, folder_ / "said");
  }
  void SetUp() override { std::filesystem::create_directory(folder_ / "said"); }
  // The files in the folder, except the inputs and the captured output.
  [[nodiscard]] std::vector<std::string> made() const {
    std::vector<std::string> names = filesIn(folder_ / "");
    std::erase_if(names, [](const std::string& n) { return n == "said" || n == "color.mkv" || n == "depth.mkv"; });
    return names;
  }
};

inline std::string textOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace relievo
