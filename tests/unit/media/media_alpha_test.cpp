// SPDX-License-Identifier: Apache-2.0
// Depth in a picture's alpha channel, as PNG, FFV1 and WebM hold it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::kSceneCols;
using test::kSceneRows;
using test::photoOf;
using test::yuvCode;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// Near bright from 40 to 250; 0 where the camera sees nothing.
std::uint32_t alphaCode(int c, int r) {
  const double mm = distanceMm(c, r);
  return mm == 0 ? 0 : static_cast<std::uint32_t>(std::lround(250 - 210 * (mm - 1100) / 900));
}

ClipTrack track(const std::string& codec, const std::string& format,
                std::function<std::uint32_t(int c, int r)> alpha = alphaCode) {
  ClipTrack made{.codec = codec, .pix_fmt = format, .width = kSceneCols, .height = kSceneRows, .frames = 2};
  if (codec == "png") made.frames = 1;
  const bool rgb = format.starts_with("rgb");
  const int top = format == "rgba64be" ? 65535 : 255;
  const bool half = format == "yuva420p";
  made.sample = [=](int k, int c, int r, int) {
    if (k == 3) return alpha(c, r);
    const int x = half && k > 0 ? 2 * c : c, y = half && k > 0 ? 2 * r : r;
    const auto color = photoOf(x, y);
    return rgb ? static_cast<std::uint32_t>(top * color[static_cast<std::size_t>(k)]) : yuvCode(k, color);
  };
  return made;
}

// Row 60, every fifth column: heights are the codes' shares of 255, and code 0 is a hole.
void expectAlpha(const test::OpenedFilm& film, double tolerance) {
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.info.packing, Packing::Alpha);
  EXPECT_EQ(film.info.depth_width, kSceneCols);
  for (int c = 3; c < kSceneCols; c += 5) {
    if (alphaCode(c, 60) == 0) {
      EXPECT_TRUE(std::isnan(film.heightAt(c, 60))) << c;
    } else {
      EXPECT_NEAR(film.heightAt(c, 60), alphaCode(c, 60) / 255.0, tolerance) << c;
    }
  }
}

TEST(AlphaDepth, OfPngAndFfv1IsFelt) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a.png", {track("png", "rgba")});
  test::makeClip(folder / "a.mkv", {track("ffv1", "yuva420p")});
  for (const char* name : {"a.png", "a.mkv"}) {
    const test::OpenedFilm film = test::openFilm({.url = folder / name});
    expectAlpha(film, 1e-6);
    EXPECT_THAT(plainLine(film.info.reading, film.info.calibration.calibration), HasSubstr("in the alpha channel"));
    EXPECT_THAT(film.info.reading.why, Contains(HasSubstr("alpha"))) << name;
  }
  // The colour is as it was.
  const test::OpenedFilm png = test::openFilm({.url = folder / "a.png"});
  EXPECT_EQ(test::sampleAt(png.pair.color, 1, 70, 40), static_cast<std::uint32_t>(255 * photoOf(70, 40)[1]));
}

TEST(AlphaDepth, OfWebmIsFelt) {
  const test::TemporaryFolder folder;
  ClipTrack film = track("libvpx-vp9", "yuva420p");
  film.options = {{"lossless", "1"}, {"auto-alt-ref", "0"}};
  film.tags = {{"alpha_mode", "1"}};
  test::makeClip(folder / "a.webm", {film});
  expectAlpha(test::openFilm({.url = folder / "a.webm"}), 1e-6);
}

TEST(AlphaDepth, OfSixteenBitsMayBeDistances) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a.png", {track("png", "rgba64be", [](int c, int r) {
                   return static_cast<std::uint32_t>(std::lround(distanceMm(c, r)));
                 })});
  const test::OpenedFilm film = test::openFilm({.url = folder / "a.png"});
  ASSERT_TRUE(film.info.has_depth);
  EXPECT_EQ(film.info.calibration.calibration.unit_mm, 1.0);
  EXPECT_NEAR(film.distanceAt(80, 54), distanceMm(80, 54), 1);
  EXPECT_TRUE(std::isnan(film.heightAt(5, 54)));
}

TEST(AlphaDepth, HolesAreWhereTheyAreSaidToBe) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a.png", {track("png", "rgba")});
  const test::OpenedFilm none = test::openFilm({.url = folder / "a.png", .command_line = {{"invalid", "none"}}});
  EXPECT_EQ(none.heightAt(5, 60), 0);
  const auto code = std::to_string(alphaCode(80, 54));
  const test::OpenedFilm other = test::openFilm({.url = folder / "a.png", .command_line = {{"invalid", code}}});
  EXPECT_TRUE(std::isnan(other.heightAt(80, 54)));
  EXPECT_EQ(other.heightAt(5, 60), 0);
}

TEST(AlphaDepth, AMatteIsNotTakenForDepth) {
  const test::TemporaryFolder folder;
  // A disc with a soft edge.
  const auto matte = [](int c, int r) {
    const double inside = 40 - std::hypot(c - 80, r - 54);
    return static_cast<std::uint32_t>(std::lround(255 * std::clamp(inside / 4, 0.0, 1.0)));
  };
  test::makeClip(folder / "matte.png", {track("png", "rgba", matte)});
  test::makeClip(folder / "opaque.png", {track("png", "rgba", [](int, int) { return 255u; })});
  const test::OpenedFilm film = test::openFilm({.url = folder / "matte.png"});
  EXPECT_FALSE(film.info.has_depth);
  EXPECT_THAT(film.info.reading.doubts, Contains(HasSubstr("--packing alpha")));
  EXPECT_TRUE(test::openFilm({.url = folder / "matte.png", .packing = Packing::Alpha}).info.has_depth);
  EXPECT_THAT(test::openFilm({.url = folder / "opaque.png"}).info.reading.doubts, Not(Contains(HasSubstr("alpha"))));
}

TEST(AlphaDepth, ThatIsSaidButNotThereIsRefused) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a.png", {{.codec = "png", .pix_fmt = "rgb24", .frames = 1}});
  PairReader reader({.make_source = drivers::makeMediaSource, .make_decoder = drivers::makeSoftwareDecoder});
  const auto opened = reader.open({.url = folder / "a.png", .packing = Packing::Alpha});
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("no alpha channel"));
}

}  // namespace
}  // namespace relievo
