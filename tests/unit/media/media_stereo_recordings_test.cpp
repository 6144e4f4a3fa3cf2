// SPDX-License-Identifier: Apache-2.0
// Films of two views are distinguished from those of one view and from depth, and each eye is shown its own view.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/media/pair_reader.h"
#include "app/scene/height_field.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"
#include "tests/support/film/two_views.h"
#include "tests/unit/media/recordings.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::kSceneCols;
using test::kSceneRows;
using test::makeClip;
using test::photoOf;
using test::TemporaryFolder;
using test::yuvCode;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Spots of 2 pixels with pseudo-random brightness (Knuth's multiplicative hash). Neither half looks like the other,
// whereas the rows of `photo` repeat.
ClipTrack spots() {
  ClipTrack track{.pix_fmt = "yuv444p", .width = kSceneCols, .height = kSceneRows, .frames = 2};
  track.sample = [](int k, int c, int r, int) {
    const auto spot = static_cast<std::uint32_t>(c / 2 + 100 * (r / 2));
    return k > 0 ? 128u : 30 + (spot * spot * 2654435761u >> 16) % 190;
  };
  return track;
}

TEST(Recordings, TwoViewsAreToldAndNeverFelt) {
  const Half left{photoOf};
  const Half right{[](int c, int r) { return photoOf(c + 4 + (r > 50 ? 3 : 0), r); }};
  TemporaryFolder folder;
  makeHalves(folder / "sbs.mp4", true, left, right);
  makeHalves(folder / "tb.mp4", false, left, right);
  ClipTrack second = photo();
  second.sample = [](int k, int c, int r, int) { return yuvCode(k, photoOf(c + 5, r)); };
  makeClip(folder / "tracks.mkv", {photo(), second});
  for (const char* name : {"sbs.mp4", "tb.mp4", "tracks.mkv"}) {
    const Seen seen = open({.url = folder / name});
    ASSERT_EQ(seen.failure, "") << name;
    EXPECT_FALSE(seen.info.has_depth) << name;
    EXPECT_TRUE(seen.depth.empty()) << name;
    EXPECT_THAT(seen.info.reading.doubts, Contains(HasSubstr("two views"))) << name;
  }
  EXPECT_THAT(open({.url = folder / "sbs.mp4", .packing = Packing::SideBySide}).info.reading.doubts,
              Contains(HasSubstr("the same picture")));
}

// Black bars above and below each view meet in the middle, where there is no break; one wide film has none there.
TEST(Recordings, WideViewsBetweenBlackBarsAreTold) {
  const auto wide = [](int shift, int first, int last) {
    return Half{
        [=](int c, int r) { return r < first || r > last ? std::array{0.0, 0.0, 0.0} : photoOf(c + shift, r); }};
  };
  constexpr int kBar = 12, kLast = kSceneRows - 1 - kBar;
  TemporaryFolder folder;
  makeHalves(folder / "views.mp4", false, wide(0, kBar, kLast), wide(6, kBar, kLast));
  EXPECT_EQ(open({.url = folder / "views.mp4"}).info.packing, Packing::StereoTopBottom);
  makeHalves(folder / "one.mp4", false, wide(0, kBar, kSceneRows), wide(6, 0, kLast));
  EXPECT_FALSE(hasTwoViews(open({.url = folder / "one.mp4"}).info.packing));
}

// The left half looks much like the right one in both views; the views are more alike.
TEST(Recordings, TheHalvesThatAreMoreAlikeAreTheViews) {
  const auto repeating = [](int shift) {
    return Half{[=](int c, int r) {
      const int x = (r < kSceneRows * 3 / 4 ? c % (kSceneCols / 2) : c) + shift;
      const double level = 0.5 + 0.4 * test::smoothNoise(x / 8.0, r / 8.0, 7);
      return std::array{level, level, 0.8 * level};
    }};
  };
  TemporaryFolder folder;
  makeHalves(folder / "views.mp4", false, repeating(0), repeating(6));
  EXPECT_EQ(open({.url = folder / "views.mp4"}).info.packing, Packing::StereoTopBottom);
}

// 12 of 180 rows, as of two cameras that were held by hand.
TEST(Recordings, AViewThatLiesTooHighOrTooLowIsTold) {
  constexpr int kCols = 320, kRows = 180;
  const test::TwoViews scene = test::boards(kCols, kRows);
  TemporaryFolder folder;
  for (const double down : {-12, 12}) {
    const Frame left = scene.left(), right = scene.right({.down = down});
    makeClip(folder / "views.mkv", {{.pix_fmt = "bgr0",
                                     .width = 2 * kCols,
                                     .height = kRows,
                                     .frames = 2,
                                     .sample = [&](int component, int c, int r, int) {
                                       return test::sampleAt(c < kCols ? left : right, component, c % kCols, r);
                                     }}});
    EXPECT_THAT(open({.url = folder / "views.mkv"}).info.reading.doubts,
                ElementsAre(HasSubstr("may be two views of one scene (stereo), no depth; if so, --packing stereo-sbs")))
        << down;
  }
}

// --depth-from stereo: the reader keeps both views in each pair; the player makes the depth.
TEST(Recordings, DepthIsMadeOfTwoViewsOnlyWhereThereAreTwo) {
  const Half left{photoOf};
  const Half right{[](int c, int r) { return photoOf(c + 4 + (r > 50 ? 3 : 0), r); }};
  TemporaryFolder folder;
  makeHalves(folder / "views.mp4", true, left, right);
  makeClip(folder / "one.mkv", {spots()});
  const auto from = [&](const char* name, Packing packing = Packing::Auto) {
    return open({.url = folder / name, .packing = packing, .depth_from = DepthFrom::Views});
  };
  const Seen views = from("views.mp4", Packing::StereoSideBySide);
  EXPECT_TRUE(views.info.has_depth);
  EXPECT_TRUE(views.info.depth_from_views);
  EXPECT_EQ(views.info.calibration.calibration.bits, 16);
  EXPECT_THAT(views.info.reading.doubts, IsEmpty());
  const Seen one = from("one.mkv");
  EXPECT_FALSE(one.info.has_depth);
  EXPECT_THAT(one.info.reading.doubts, ElementsAre(HasSubstr("the film has one view")));
  ClipTrack depth = coded([](double mm, int, int) { return rounded(mm); });
  depth.codec = "ffv1";
  depth.pix_fmt = "gray16le";
  makeClip(folder / "both.mkv", {photo(), depth});
  const Seen both = from("both.mkv");
  EXPECT_TRUE(both.info.has_depth);
  EXPECT_FALSE(both.info.depth_from_views);
  EXPECT_THAT(both.info.reading.doubts, Contains(HasSubstr("the film has depth of its own")));
}

// The user takes a film of one view for two views: one line says that it has only one, and no depth is made of it.
TEST(Recordings, AFilmOfOneViewIsNotTakenForTwo) {
  TemporaryFolder folder;
  makeClip(folder / "one.mkv", {spots()});
  for (const Packing packing : {Packing::StereoSideBySide, Packing::StereoTopBottom}) {
    const Seen seen = open({.url = folder / "one.mkv", .packing = packing, .depth_from = DepthFrom::Views});
    EXPECT_FALSE(seen.info.has_depth);
    EXPECT_THAT(seen.info.reading.doubts, ElementsAre(HasSubstr("do not show one scene")));
  }
  const Half left{photoOf};
  const Half right{[](int c, int r) { return photoOf(c + 6, r); }};
  makeHalves(folder / "views.mp4", true, left, right);
  EXPECT_THAT(open({.url = folder / "views.mp4", .packing = Packing::StereoSideBySide}).info.reading.doubts, IsEmpty());
}

TEST(Recordings, EachEyeOfTwoViewsIsShownItsOwn) {
  const Half dark{[](int, int) { return std::array{0.2, 0.2, 0.2}; }},
      bright{[](int, int) { return std::array{0.8, 0.8, 0.8}; }};
  TemporaryFolder folder;
  makeHalves(folder / "sbs.mp4", true, dark, bright);
  makeHalves(folder / "tb.mp4", false, dark, bright);
  const test::OpenedFilm beside = test::openFilm({.url = folder / "sbs.mp4", .packing = Packing::StereoSideBySide});
  const test::OpenedFilm above = test::openFilm({.url = folder / "tb.mp4", .packing = Packing::StereoTopBottom});
  for (const test::OpenedFilm* film : {&beside, &above}) {
    EXPECT_FALSE(film->info.has_depth);
    ASSERT_FALSE(film->pair.right.empty());
    EXPECT_EQ(film->pair.color.width, kSceneCols);
    EXPECT_EQ(film->pair.right.height, kSceneRows);
    EXPECT_LT(test::sampleAt(film->pair.color, 0, 20, 20) + 50, test::sampleAt(film->pair.right, 0, 20, 20));
  }
  // 320 x 108 is wide enough for two whole views; 160 x 216 is two whole ones above each other.
  EXPECT_EQ(beside.pair.color.sample_aspect, 1);
  EXPECT_EQ(above.pair.color.sample_aspect, 1);
  ClipTrack squeezed{.codec = "libx264", .pix_fmt = "yuv420p", .width = 160, .height = 90, .frames = 2};
  makeClip(folder / "half.mp4", {squeezed});
  EXPECT_EQ(test::openFilm({.url = folder / "half.mp4", .packing = Packing::StereoSideBySide}).pair.color.sample_aspect,
            2);
  EXPECT_EQ(test::openFilm({.url = folder / "half.mp4", .packing = Packing::StereoTopBottom}).pair.color.sample_aspect,
            0.5);
}

TEST(Recordings, OrdinaryFilmsAreNeitherDepthNorViews) {
  const Half mirrored{[](int c, int r) { return photoOf(kSceneCols - 1 - c, r); }};
  const Half upside_down{[](int c, int r) { return photoOf(c, kSceneRows - 1 - r); }};
  const Half gray{[](int c, int r) {
    const double y = photoOf(c, r)[0];
    return std::array{y, y, y};
  }};
  const Half other_gray{[](int c, int r) {
    const double y = photoOf(c + 300, r + 500)[1];
    return std::array{y, y, y};
  }};
  const Half sky{[](int, int r) { return std::array{0.3 + 0.003 * r, 0.4 + 0.003 * r, 0.8}; }};
  TemporaryFolder folder;
  const struct {
    const Half &first, &second;
  } films[] = {{kPhoto, mirrored}, {kPhoto, upside_down}, {gray, other_gray}, {sky, sky}, {sky, kPhoto}};
  for (const auto& film : films) {
    for (const bool beside : {true, false}) {
      makeHalves(folder / "film.mp4", beside, film.first, film.second);
      const Seen seen = open({.url = folder / "film.mp4"});
      EXPECT_FALSE(seen.info.has_depth) << &film - films << beside;
      EXPECT_THAT(seen.info.reading.doubts, IsEmpty()) << &film - films << beside;
    }
  }
}

}  // namespace
}  // namespace relievo
