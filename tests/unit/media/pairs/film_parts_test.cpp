// SPDX-License-Identifier: Apache-2.0
// Each part of a PairReader by itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "app/media/pairs/depth_reach.h"
#include "app/media/pairs/film_plan.h"
#include "app/media/pairs/pair_supply.h"
#include "app/media/pairs/stored_form.h"
#include "drivers/mock/mock.h"
#include "platform/clock.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Frame gray(std::vector<std::uint16_t> samples, int cols) {
  const int rows = static_cast<int>(samples.size()) / cols;
  return grayFrame(std::make_shared<std::vector<std::uint16_t>>(std::move(samples)), cols, rows);
}

std::uint16_t firstCode(const Frame& depth) {
  return *reinterpret_cast<const std::uint16_t*>(depth.planes[0].data);
}

class FilmParts : public testing::Test {
 protected:
  // The colour's source, open and with its tracks selected.
  void open(std::vector<MockTrack> tracks) {
    MockMediaProfile profile;
    profile.tracks = std::move(tracks);
    auto reader = std::make_unique<TrackReader>(makeMockSource(profile, clock_), film_.backends.make_decoder);
    ASSERT_TRUE(reader->open("film"));
    for (const StreamInfo& stream : reader->source().streams()) ASSERT_TRUE(reader->select(stream));
    ASSERT_TRUE(film_.sources.take(std::move(reader)));
    film_.options.url = "film";
  }
  [[nodiscard]] const StreamInfo& colorStream() const { return film_.sources.color()->source().streams().front(); }

  ManualClock clock_;
  OpenFilm film_{{.make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32}); }}};
};

TEST(StoredForm, PutsTheSamplesOfDepthInOrder) {
  StoredForm form{.order = SampleOrder::Swapped};
  const auto depth = form.depthIn(gray({0x1234, 0, 0, 0}, 2), Packing::Tracks);
  ASSERT_TRUE(depth);
  EXPECT_EQ(firstCode(*depth), 0x3412);
}

TEST(StoredForm, TakesAPackedPictureApartAndLeavesAnotherWhole) {
  const StoredForm form;
  FilmInfo info;
  info.packing = Packing::SideBySideDepthFirst;
  Frame picture = gray({7, 8, 9, 10, 7, 8, 9, 10}, 4);
  const auto pair = form.pairIn(picture, info);
  ASSERT_TRUE(pair && *pair);
  EXPECT_EQ((*pair)->color.width, 2);
  EXPECT_EQ(firstCode((*pair)->depth), 7);
  info.packing = Packing::Tracks;
  const auto none = form.pairIn(picture, info);
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none) << "its depth is elsewhere";
}

TEST(BeyondReach, NamesTheRangeThatIncludesThePicture) {
  DepthCalibration calibration{.bits = 16};
  calibration.codes = CodeSet::Range{100, 200};
  EXPECT_FALSE(beyondReach(gray({100, 150, 180, 200}, 2), calibration));
  const auto beyond = beyondReach(gray({100, 150, 180, 400}, 2), calibration);
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->percent, 25);
  EXPECT_THAT(beyond->option, HasSubstr("codes=100-400"));
}

TEST_F(FilmParts, APlanFollowsTheRecordingUnlessTheUserHasSpoken) {
  open({MockTrack{.model = ColorModel::Yuv}});
  const KnownKind kind{.name = "kind", .what = "", .help = "", .calibration = "", .packing = Packing::TopBottom};
  const RecordingPlace place{.kind = &kind, .origin = CalibrationOrigin::FileBeside};
  auto plan = planFilm(film_, FilmScout(film_), place);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->tracks.packing, Packing::TopBottom);
  EXPECT_EQ(plan->packing_by, CalibrationOrigin::FileBeside);
  film_.options.packing = Packing::SideBySide;
  plan = planFilm(film_, FilmScout(film_), place);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->tracks.packing, Packing::SideBySide);
  EXPECT_EQ(plan->packing_by, CalibrationOrigin::CommandLine);
}

TEST_F(FilmParts, OfExchangedTracksTheSecondIsTheColour) {
  open({MockTrack{.model = ColorModel::Yuv}, MockTrack{.model = ColorModel::Yuv}});
  film_.exchanged = true;
  const auto plan = planFilm(film_, FilmScout(film_), {});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->tracks.depth, &colorStream());
  EXPECT_THAT(plan->why, ElementsAre(HasSubstr("the second is the colour")));
}

TEST_F(FilmParts, TheSupplyPairsWhatItIsGivenAndSeeks) {
  MockTrack color{.width = 16, .height = 12, .model = ColorModel::Yuv, .keyframe_interval = 25};
  MockTrack depth{.width = 16, .height = 12, .keyframe_interval = 25};
  open({std::move(color), std::move(depth)});
  film_.info.packing = Packing::Tracks;
  film_.depth_beside.track = 1;
  StoredForm form;
  PairSupply supply(film_, form);
  ASSERT_TRUE(supply.readFirst(colorStream()));
  EXPECT_EQ(supply.pictures().size(), 2U);
  supply.followDepth();
  for (int i = 0; i < 5; ++i) {
    const auto pair = supply.next();
    ASSERT_TRUE(pair && *pair);
    EXPECT_EQ((*pair)->depth.pts, (*pair)->color.pts);
  }
  const MediaTime target = MockTrack{}.pts(40);
  ASSERT_TRUE(supply.seek(target, Duration(0)));
  const auto pair = supply.next();
  ASSERT_TRUE(pair && *pair);
  EXPECT_EQ((*pair)->color.pts, target);
  EXPECT_EQ((*pair)->depth.pts, target);
  EXPECT_EQ(supply.counters().pairs, 6U);
}

}  // namespace
}  // namespace relievo
