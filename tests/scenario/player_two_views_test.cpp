// SPDX-License-Identifier: Apache-2.0
// A film of two views and no depth, felt while it plays: in simulated time.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/two_views.h"

namespace relievo {
namespace {

using test::boards;

constexpr int kPictures = 30, kCols = 320, kRows = 200;

class PlayerTwoViews : public testing::Test {
 protected:
  PlayerTwoViews() {
    const Frame left = boards(kCols, kRows).left(), right = boards(kCols, kRows).right();
    test::makeClip(folder_ / "views.mkv", {{.pix_fmt = "bgr0",
                                            .width = 2 * kCols,
                                            .height = kRows,
                                            .fps_num = 25,
                                            .frames = kPictures,
                                            .sample = [left, right](int component, int c, int r, int) {
                                              return test::sampleAt(c < kCols ? left : right, component, c % kCols, r);
                                            }}});
    bench_.make_source = [] { return makeFfmpegSource(); };
    bench_.make_decoder = [] { return makeFfmpegDecoder(); };
    bench_.config.source = {
        .url = folder_ / "views.mkv", .packing = Packing::StereoSideBySide, .depth_from = DepthFrom::Views};
  }
  // The finger comes down at a place of the picture, to this height, and stays. Returns the greatest force upwards.
  double forceAt(int c, int r, double height_mm) {
    const DisplayVolume box = DisplayVolume::forPicture(kCols, kRows, 1);
    const double x = ((c + 0.5) / kCols - 0.5) * box.width_mm, y = (0.5 - (r + 0.5) / kRows) * box.height_mm;
    most_ = 0;
    bench_.haptic.position_mm = [this, x, y, height_mm](double s) {
      most_ = std::max(most_, bench_.hand->force_z_n.load());
      return glm::dvec3(x, y, std::max(height_mm, 60 - 100 * s));
    };
    EXPECT_TRUE(bench_.run().has_value());
    return most_;
  }

  test::TemporaryFolder folder_;
  PlayerBench bench_;
  double most_ = 0;
};

// The board before the screen is felt at a height at which there is nothing over the wall behind it.
TEST_F(PlayerTwoViews, WhatIsNearIsFeltWhereItIsSeen) {
  EXPECT_GT(forceAt(215, 95, 25), 1);
  EXPECT_EQ(bench_.report.reliefs.made, static_cast<std::uint64_t>(kPictures));
  EXPECT_EQ(bench_.report.reliefs.dropped, 0U);
  EXPECT_EQ(bench_.report.pairs.without_depth, 0U);
  EXPECT_EQ(bench_.faults("depth"), 0U);
  EXPECT_EQ(forceAt(290, 20, 25), 0) << "over the wall";
}

TEST_F(PlayerTwoViews, ItGoesOnAfterASeek) {
  bench_.press(0.8, KEY_LEFT);
  EXPECT_GT(forceAt(215, 95, 25), 1);
  EXPECT_GT(bench_.report.reliefs.made, static_cast<std::uint64_t>(kPictures));
  EXPECT_EQ(bench_.faults("depth"), 0U);
}

}  // namespace
}  // namespace relievo
