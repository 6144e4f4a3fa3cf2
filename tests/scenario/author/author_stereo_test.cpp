// SPDX-License-Identifier: Apache-2.0
// relievo-author on films of two views: from end to end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "app/author/author.h"
#include "app/media/pair_reader.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"
#include "tests/support/film/two_views.h"

namespace relievo {
namespace {

using test::boards;
using test::ClipTrack;
using test::makeClip;
using test::RightEye;
using test::TemporaryFolder;
using test::TwoViews;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// Two pictures side by side or one above the other, as RGB without loss.
ClipTrack packed(const Frame& first, const Frame& second, bool beside) {
  return {.pix_fmt = "bgr0",
          .width = beside ? 2 * first.width : first.width,
          .height = beside ? first.height : 2 * first.height,
          .fps_num = 5,
          .frames = 3,
          .sample = [first, second, beside](int component, int c, int r, int) {
            const bool in_second = beside ? c >= first.width : r >= first.height;
            const Frame& view = in_second ? second : first;
            return test::sampleAt(view, component, beside ? c % first.width : c, beside ? r : r % first.height);
          }};
}

ClipTrack alone(const Frame& view) {
  return {.pix_fmt = "bgr0",
          .width = view.width,
          .height = view.height,
          .frames = 2,
          .sample = [view](int component, int c, int r, int) { return test::sampleAt(view, component, c, r); }};
}

class AuthorStereo : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::atomic<bool> stop_{false};
  TwoViews scene_ = boards();

  Outcome<AuthorSummary> make(const ClipTrack& film, SourceOptions source, SwapEyes swap = SwapEyes::Auto,
                              std::optional<Enhancement> enhancement = std::nullopt) {
    makeClip(folder_ / "in.mkv", {film});
    source.url = folder_ / "in.mkv";
    return authorFilm(source, kFfmpeg,
                      {.path = folder_ / "out.mkv",
                       .color_crf = 0,
                       .depth = {.codec = VideoCodec::Ffv1, .bits = 16, .crf = 0},
                       .from_views = swap,
                       .enhancement = enhancement},
                      stop_, [](std::uint64_t, std::optional<std::uint64_t>) {});
  }
  [[nodiscard]] FramePair firstOf(const std::string& name) const {
    PairReader reader(kFfmpeg);
    EXPECT_TRUE(reader.open({.url = folder_ / name}).has_value());
    EXPECT_TRUE(reader.info().has_depth);
    EXPECT_THAT(reader.info().reading.doubts, Not(Contains(HasSubstr("which end of the depth is near"))));
    return reader.next().value().value();
  }
  // The height of the middle board, as a share of the way from the wall to the nearest board. Heights follow
  // disparities, so that it must equal `middleBoardInTruth`.
  [[nodiscard]] double middleBoard(const Frame& depth) const {
    const auto at = [&](double x, double y) {
      return static_cast<double>(
          test::sampleAt(depth, 0, static_cast<int>(x * scene_.cols), static_cast<int>(y * scene_.rows)));
    };
    const double wall = at(0.45, 0.7), middle = at(0.25, 0.7), near = at(0.67, 0.5);
    EXPECT_LT(wall, middle);
    EXPECT_LT(middle, near);
    return (middle - wall) / (near - wall);
  }
  [[nodiscard]] double middleBoardInTruth() const {
    const double wall = scene_.disparity(144, 140);
    return (0 - wall) / (12.5 - wall);
  }
};

TEST_F(AuthorStereo, MakesAFilmOfTheLeftViewAndItsDepth) {
  const auto summary = make(packed(scene_.left(), scene_.right(), true), {.packing = Packing::StereoSideBySide});
  ASSERT_TRUE(summary.has_value()) << summary.error().error.message;
  EXPECT_EQ(summary->totals.color.frames, 3u);
  EXPECT_EQ(summary->totals.depth.frames, 3u);
  EXPECT_EQ(summary->format.depth_tags.at("DEPTH_LAW"), "linear");
  EXPECT_EQ(summary->format.depth_tags.at("DEPTH_ASSUMED"), "law,near,far") << "the pictures show which eye is which";
  const FramePair pair = firstOf("out.mkv");
  EXPECT_EQ(pair.color.width, scene_.cols);
  EXPECT_EQ(pair.depth.width, scene_.cols);
  EXPECT_NEAR(middleBoard(pair.depth), middleBoardInTruth(), 0.03);
  // Blue is strong on the near board, where the left eye sees it.
  const int row = scene_.rows / 2, edge = static_cast<int>(0.55 * scene_.cols);
  EXPECT_GT(test::sampleAt(pair.color, 1, (edge + 6) / 2, row / 2), 140u);
  EXPECT_LT(test::sampleAt(pair.color, 1, (edge - 6) / 2, row / 2), 130u);
}

TEST_F(AuthorStereo, TakesViewsAboveEachOther) {
  const auto summary = make(packed(scene_.left(), scene_.right(), false), {.packing = Packing::StereoTopBottom});
  ASSERT_TRUE(summary.has_value()) << summary.error().error.message;
  EXPECT_NEAR(middleBoard(firstOf("out.mkv").depth), middleBoardInTruth(), 0.03);
}

TEST_F(AuthorStereo, FindsTheHalvesItself) {
  const auto summary = make(packed(scene_.left(), scene_.right(), true), {});
  ASSERT_TRUE(summary.has_value()) << summary.error().error.message;
  EXPECT_NEAR(middleBoard(firstOf("out.mkv").depth), middleBoardInTruth(), 0.03);
}

TEST_F(AuthorStereo, SwapsViewsThatAreInTheWrongOrderAndSaysSo) {
  const SourceOptions source{.packing = Packing::StereoSideBySide};
  const ClipTrack swapped = packed(scene_.right(), scene_.left(), true);
  const auto summary = make(swapped, source);
  ASSERT_TRUE(summary.has_value()) << summary.error().error.message;
  EXPECT_THAT(summary->notes, Contains(HasSubstr("the right eye's view came first")));
  EXPECT_NEAR(middleBoard(firstOf("out.mkv").depth), middleBoardInTruth(), 0.03);
}

TEST_F(AuthorStereo, KeepsTheOrderThatTheUserSays) {
  const auto summary =
      make(packed(scene_.right(), scene_.left(), true), {.packing = Packing::StereoSideBySide}, SwapEyes::No);
  ASSERT_TRUE(summary.has_value()) << summary.error().error.message;
  EXPECT_THAT(summary->notes, Contains(HasSubstr("look swapped")));
  const FramePair pair = firstOf("out.mkv");  // near and far are exchanged
  EXPECT_LT(test::sampleAt(pair.depth, 0, static_cast<int>(0.65 * scene_.cols), scene_.rows / 2),
            test::sampleAt(pair.depth, 0, static_cast<int>(0.45 * scene_.cols), scene_.rows / 2));
}

TEST_F(AuthorStereo, CorrectsATurnedViewOfOtherExposureAndSaysSo) {
  const Frame right = scene_.right({.down = 12, .degrees = 1, .gain = 0.7, .offset = 20});
  const auto summary = make(packed(scene_.left(), right, true), {.packing = Packing::StereoSideBySide});
  ASSERT_TRUE(summary.has_value()) << summary.error().error.message;
  EXPECT_THAT(summary->notes, Contains(HasSubstr("the right view was straightened")));
  EXPECT_THAT(summary->notes, Contains(HasSubstr("exposure was balanced")));
  EXPECT_NEAR(middleBoard(firstOf("out.mkv").depth), middleBoardInTruth(), 0.04);
}

TEST_F(AuthorStereo, EnhancesTheDepthThatItMade) {
  const auto summary = make(packed(scene_.left(), scene_.right(), true), {.packing = Packing::StereoSideBySide},
                            SwapEyes::Auto, Enhancement::SpaceTime);
  ASSERT_TRUE(summary.has_value()) << summary.error().error.message;
  EXPECT_EQ(summary->enhanced.pictures, 3u);
  EXPECT_NEAR(middleBoard(firstOf("out.mkv").depth), middleBoardInTruth(), 0.03);
}

TEST_F(AuthorStereo, RefusesInOneLine) {
  const auto black =
      make(packed(scene_.left(), scene_.right({.gain = 0}), true), {.packing = Packing::StereoSideBySide});
  ASSERT_FALSE(black.has_value());
  EXPECT_THAT(black.error().error.message, HasSubstr("one of its two views is black"));
  const auto one = make(alone(scene_.left()), {});
  ASSERT_FALSE(one.has_value());
  EXPECT_THAT(one.error().error.message, HasSubstr("not a film of two views"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.mkv"));
}

}  // namespace
}  // namespace relievo
