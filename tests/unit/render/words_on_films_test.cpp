// SPDX-License-Identifier: Apache-2.0
// Subtitles in depth over real films: never behind what they cover, and without jumps.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <filesystem>
#include <iostream>

#include "app/media/pair_reader.h"
#include "app/render/relief/relief_triangles.h"
#include "app/render/relief/words_place.h"
#include "drivers/ffmpeg/ffmpeg.h"

namespace relievo {
namespace {

constexpr double kWidthPx = 1280;

// A line of words at the foot, a third of the picture wide, as on each eye's screen of 1280 pixels.
class WordsOnFilm : public testing::Test {
 protected:
  struct Shown {
    FramePair pair;
    DisplayVolume volume;
    HeightField field;
    CoarseRelief coarse;
  };
  static bool take(PairReader& reader, std::deque<Shown>& window) {
    auto pair = reader.next().value();
    if (!pair) return false;
    if (pair->depth.empty()) return true;
    const auto volume = DisplayVolume::forPicture(pair->depth.width, pair->depth.height);
    const auto field = HeightField::make(pair->depth, reader.info().calibration.calibration, volume).value();
    window.push_back({std::move(*pair), volume, field, CoarseRelief::of(field)});
    return true;
  }
  struct Seen {
    int pictures = 0;
    double most_up = 0, most_down = 0, nearest_gap = 1e9, mean_gap = 0;  // px a picture; px
    std::uint64_t lifted = 0;
  };
  // `ahead`: how many pictures are known before they are shown.
  Seen play(const SourceOptions& source, int most, std::size_t ahead) {
    PairReader reader({.make_source = [](const std::string&) { return makeFfmpegSource(); },
                       .make_decoder = [](const StreamInfo&) { return makeFfmpegDecoder(); }});
    EXPECT_TRUE(reader.open(source));
    Seen seen;
    WordsPlace words;
    ReliefTriangles triangles;
    std::deque<Shown> window;
    bool more = true;
    while (seen.pictures < most) {
      while (more && window.size() <= ahead) more = take(reader, window);
      if (window.empty()) break;
      const DisplayVolume& volume = window.front().volume;
      triangles.build(window.front().field, volume, {.most_across = 512, .error_mm = 0.2});
      const WordsBox box{-0.17 * volume.width_mm, -0.46 * volume.height_mm, 0.17 * volume.width_mm,
                         -0.36 * volume.height_mm};
      ReliefAhead coming{.more = more};
      for (std::size_t i = 1; i < window.size(); ++i) {
        coming.coming[coming.count++] = {static_cast<int>(i), &window[i].coarse};
      }
      const double last = words.disparity();
      words.follow({triangles.vertices().data(), triangles.vertices().size()},
                   {triangles.indices().data(), 3 * triangles.surfaceTriangles()}, box,
                   {.layout = StereoLayout::FramePacking}, kWidthPx, kWidthPx / volume.width_mm, coming);
      const double gap = words.disparity() - words.behind();
      seen.nearest_gap = std::min(seen.nearest_gap, gap);
      seen.mean_gap += (gap - seen.mean_gap) / (seen.pictures + 1);
      if (seen.pictures++ > 0) {
        seen.most_up = std::max(seen.most_up, words.disparity() - last);
        seen.most_down = std::max(seen.most_down, last - words.disparity());
      }
      window.pop_front();
    }
    seen.lifted = words.lifted();
    std::cout << seen.pictures << " pictures, up " << seen.most_up << ", down " << seen.most_down << ", gap "
              << seen.nearest_gap << ", mean " << seen.mean_gap << ", lifted " << seen.lifted << "\n";
    return seen;
  }
  static void expectSteady(const Seen& seen) {
    EXPECT_GT(seen.pictures, 30);
    EXPECT_GE(seen.nearest_gap, 0) << "behind what it covers";
    EXPECT_LE(seen.most_up, WordsPlace::kStep + 1e-9);
    EXPECT_LE(seen.most_down, WordsPlace::kStep + 1e-9);
    EXPECT_EQ(seen.lifted, 0u) << "jumped to stay in front";
  }
};

TEST_F(WordsOnFilm, StayInFrontOfAHandAndACup) {
  const std::string folder = RELIEVO_TEST_DATA "/cup/";
  if (!std::filesystem::exists(folder + "color_output.webm")) GTEST_SKIP() << "no real depth video at " << folder;
  expectSteady(play({.url = folder + "color_output.webm", .depth_url = folder + "depth_output.webm"}, 150, 8));
}

TEST_F(WordsOnFilm, StayInFrontOfAManAtADesk) {
  const std::string film = RELIEVO_TEST_DATA "/desk/Test.mov";
  if (!std::filesystem::exists(film)) GTEST_SKIP() << "no real depth video at " << film;
  expectSteady(play({.url = film, .packing = Packing::TopBottom, .depth_code = DepthCode::Hue}, 100, 8));
}

}  // namespace
}  // namespace relievo
