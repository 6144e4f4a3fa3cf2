// SPDX-License-Identifier: Apache-2.0
// The near end of gray that nobody describes: what a picture shows is no rule for a film.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "app/media/reading/near_end.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;

// If bright is near, the view is nearer above than below.
ClipTrack darkerBelow(const std::string& codec, const std::string& format, int frames) {
  return {
      .codec = codec,
      .pix_fmt = format,
      .width = 64,
      .height = 96,
      .frames = frames,
      .range = format == "gray" ? ColorRange::Unspecified : ColorRange::Full,
      .sample = [](int k, int, int r, int n) { return k == 0 ? static_cast<std::uint32_t>(220 - 2 * r - n) : 128u; }};
}

DepthPolarity polarityOf(const std::string& url) {
  return test::openFilm({.url = url, .packing = Packing::DepthAlone}).info.calibration.calibration.polarity;
}

TEST(NearEnd, AFilmOfPicturesIsNearWhereItIsBrightWhateverItsViewShows) {
  const TemporaryFolder folder;
  makeClip(folder / "depth.avi", {darkerBelow("mjpeg", "yuvj420p", 25)});
  EXPECT_EQ(polarityOf(folder / "depth.avi"), DepthPolarity::NearIsHigh);
  makeClip(folder / "depth.mov", {darkerBelow("png", "gray", 25)});
  EXPECT_EQ(polarityOf(folder / "depth.mov"), DepthPolarity::NearIsHigh);
  makeClip(folder / "depth.mjpeg", {darkerBelow("mjpeg", "yuvj420p", 25)});  // no container
  EXPECT_EQ(polarityOf(folder / "depth.mjpeg"), DepthPolarity::NearIsHigh);
  std::filesystem::create_directories(folder / "depth");
  makeClip(folder / "depth/%03d.png", {darkerBelow("png", "gray", 25)});
  EXPECT_EQ(polarityOf(folder / "depth"), DepthPolarity::NearIsHigh);
  EXPECT_EQ(polarityOf(folder / "depth/001.png"), DepthPolarity::NearIsLow) << "a picture by itself";
}

// Photos of different things, of which the reader of pictures shows each for five seconds; a slow film has its own
// times.
TEST(NearEnd, PhotosAreStillsAndASlowFilmIsNone) {
  EXPECT_TRUE(isStill({.average_rate = {200, 1000}, .counted = true}));
  EXPECT_FALSE(isStill({.average_rate = {200, 1000}, .counted = false}));
  EXPECT_FALSE(isStill({.average_rate = {30'000, 1000}, .counted = true}));
}

}  // namespace
}  // namespace relievo
