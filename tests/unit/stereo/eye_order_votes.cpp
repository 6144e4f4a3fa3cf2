// SPDX-License-Identifier: Apache-2.0
// Votes on which of two views is the right eye's.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "app/stereo/eye_order.h"
#include "app/stereo/quick/small_view.h"

namespace relievo {
namespace {

// One row: a dark side at disparity 0, a bright one at 6, and six pixels between them that one eye alone sees: so many
// of them dark.
struct RowOfViews {
  static constexpr int kWidth = 40, kRun = 16, kEnd = 22;
  ViewPicture view{kWidth, 1};
  DisparityMap map{kWidth, 1};

  explicit RowOfViews(int dark_of_run) {
    for (int c = 0; c < kWidth; ++c) {
      std::fill_n(view.pixel(view.indexOf(c, 0)), 3, c < kRun + dark_of_run ? std::uint8_t{60} : std::uint8_t{180});
      map.pixels[map.at(c, 0)] = c < kRun ? 0.0F : 6.0F;
      map.seen[map.at(c, 0)] = c < kRun || c >= kEnd ? 1 : 0;
      map.from_right[map.at(c, 0)] = -std::numeric_limits<float>::infinity();
    }
  }
};

EyeVotes votesOn(int dark_of_run, float uneven = 0) {
  RowOfViews row(dark_of_run);
  row.map.pixels[row.map.at(RowOfViews::kRun - 3, 0)] = uneven;
  return voteOnEyes(row.map, row.view, row.view);
}

TEST(EyeOrder, WhatOneEyeAloneSeesVotesForTheSideThatItIsLike) {
  EXPECT_EQ(votesOn(6).in_order, 6U);
  EXPECT_EQ(votesOn(6).swapped, 0U);
  EXPECT_EQ(votesOn(0).in_order, 0U);
  EXPECT_EQ(votesOn(0).swapped, 6U);
}

TEST(EyeOrder, WhatIsLikeBothSidesOrLiesBesideAnUnevenOneDoesNotVote) {
  for (const EyeVotes& votes : {votesOn(3), votesOn(6, 3), votesOn(0, 3)}) {
    EXPECT_EQ(votes.in_order, 0U);
    EXPECT_EQ(votes.swapped, 0U);
  }
}

// The right view shows the row in a mirror; the left one, which sees all of it, has it without the run.
TEST(EyeOrder, WhatTheRightEyeAloneSeesVotesAsWell) {
  for (const bool dark : {true, false}) {
    const RowOfViews row(dark ? 6 : 0);
    ViewPicture right = row.view;
    mirror(right);
    DisparityMap map(RowOfViews::kWidth, 1);
    std::ranges::fill(map.seen, std::uint8_t{1});
    for (int c = 0; c < RowOfViews::kWidth; ++c) {
      const std::size_t in_mirror = row.map.at(RowOfViews::kWidth - 1 - c, 0);
      const bool seen = row.map.seen[in_mirror] != 0;
      map.from_right[map.at(c, 0)] = seen ? row.map.pixels[in_mirror] : -std::numeric_limits<float>::infinity();
      const int there = c + static_cast<int>(row.map.pixels[in_mirror]);
      if (seen && there < RowOfViews::kWidth) map.pixels[map.at(there, 0)] = row.map.pixels[in_mirror];
    }
    const EyeVotes votes = voteOnEyes(map, right, right);
    EXPECT_EQ(votes.in_order, dark ? 6U : 0U);
    EXPECT_EQ(votes.swapped, dark ? 0U : 6U);
  }
}

TEST(EyeOrder, FewVotesTellIfHardlyAnyIsAgainstThem) {
  EXPECT_TRUE((EyeVotes{.in_order = 50, .swapped = 6}.areInOrder()));
  EXPECT_FALSE((EyeVotes{.in_order = 50, .swapped = 7}.areInOrder()));
  EXPECT_FALSE((EyeVotes{.in_order = 40, .swapped = 0}.areInOrder()));
  EXPECT_TRUE((EyeVotes{.in_order = 99, .swapped = 151}.areSwapped()));
  EXPECT_FALSE((EyeVotes{.in_order = 101, .swapped = 151}.areSwapped()));
}

}  // namespace
}  // namespace relievo
