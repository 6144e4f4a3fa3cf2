// SPDX-License-Identifier: Apache-2.0
// Small pictures of films: their shape and colour, and that they are made only while they are wished for.
#include "app/player/browse/poster_maker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <thread>

#include "drivers/mock/mock.h"
#include "tests/support/machine/until.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

Frame gray(int width, int height, double sample_aspect, std::uint16_t value) {
  Frame frame = grayFrame(std::make_shared<std::vector<std::uint16_t>>(
                              static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value),
                          width, height);
  frame.sample_aspect = sample_aspect;
  return frame;
}

TEST(Poster, HasTheFilmsShapeAndFitsItsBox) {
  const auto shape = [](const TextPicture& p) { return std::pair(p.cols, p.rows); };
  EXPECT_EQ(shape(posterOf(gray(1920, 1080, 1, 0))), std::pair(192, 108));
  EXPECT_EQ(shape(posterOf(gray(320, 240, 1, 0))), std::pair(144, 108));
  EXPECT_EQ(shape(posterOf(gray(960, 1080, 2, 0))), std::pair(192, 108)) << "wide samples";
  EXPECT_EQ(shape(posterOf(gray(1000, 10, 1, 0))), std::pair(192, 2));
  EXPECT_EQ(shape(posterOf(gray(1, 1, 1, 0))), std::pair(108, 108));
  EXPECT_TRUE(posterOf({}).rgba.empty());
}

TEST(Poster, ShowsTheFramesBrightnessAndIsOpaque) {
  const TextPicture poster = posterOf(gray(64, 36, 1, 0x8000));
  for (std::size_t i = 0; i < poster.rgba.size(); i += 4) {
    ASSERT_EQ(poster.rgba[i], 128);
    ASSERT_EQ(poster.rgba[i + 2], 128);
    ASSERT_EQ(poster.rgba[i + 3], 255);
  }
}

class Posters : public testing::Test {
 protected:
  // 100 pictures of 40 ms: dark ones first, then a bright left half and a dark right one.
  static MockMediaProfile film(int bright_from) {
    MockTrack track{.width = 64, .height = 36, .model = ColorModel::Yuv, .frames = 100, .frame_period = 40ms};
    track.sample = [bright_from](int frame, int component, int c, int) -> std::uint16_t {
      if (component > 0) return 128;
      return frame >= bright_from && c < 32 ? 200 : 0;
    };
    return {.tracks = {track}};
  }
  PairReader::Backends backends() {
    return {.make_source =
                [this](const std::string&) {
                  ++opened_;
                  return makeMockSources(films_, clock_);
                },
            .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32}); },
            .read_text = [](const std::string&, std::size_t, const std::atomic<bool>&) -> Result<std::string> {
              return fail(ErrorCode::NotFound, "no text");
            }};
  }
  std::map<std::string, MockMediaProfile> films_{{"a", film(0)}, {"late", film(15)}};
  std::atomic<int> opened_{0};
  MonotonicClock clock_;
};

TEST_F(Posters, AreMadeOfAPictureThatTellsSomethingWithTheFilmsLength) {
  PosterMaker maker(backends(), {});
  EXPECT_EQ(maker.find("late"), nullptr);
  maker.wish({{"late", ""}, {"absent", ""}});
  ASSERT_TRUE(test::until([&] { return maker.find("absent") != nullptr; }));
  EXPECT_TRUE(maker.attend());
  EXPECT_FALSE(maker.attend());
  const auto late = maker.find("late");
  ASSERT_TRUE(late);
  EXPECT_NEAR(late->length_s, 4, 0.05);
  ASSERT_FALSE(late->empty());
  const auto& rgba = late->picture.rgba;
  EXPECT_NEAR(rgba[4 * 10], 200, 2) << "a tenth of the film is dark: a later picture is taken";
  EXPECT_NEAR(rgba[4 * 180], 0, 2);
  EXPECT_TRUE(maker.find("absent")->empty()) << "it is not tried again";
}

TEST_F(Posters, AreMadeOnceAndOnlyOnWish) {
  PosterMaker maker(backends(), {});
  maker.wish({{"a", ""}});
  ASSERT_TRUE(test::until([&] { return maker.find("a") != nullptr; }));
  const int opened = opened_;
  maker.wish({{"a", ""}});
  maker.wish({});
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(opened_, opened);
}

TEST_F(Posters, WithoutBackEndsThereAreNone) {
  PosterMaker maker({}, {});
  maker.wish({{"a", ""}});
  EXPECT_FALSE(maker.attend());
  EXPECT_EQ(maker.find("a"), nullptr);
}

// A film whose source hangs is left when something else is wished for.
TEST_F(Posters, OneThatHangsIsLeftForTheNext) {
  films_["hangs"] = film(0);
  films_["hangs"].stall_after_packets = 0;
  films_["hangs"].stall = 1h;
  PosterMaker maker(backends(), {});
  maker.wish({{"hangs", ""}});
  ASSERT_TRUE(test::until([&] { return opened_ > 0; }));
  EXPECT_TRUE(test::until([&] {
    maker.wish({{"a", ""}});
    return maker.find("a") != nullptr;
  }));
}

}  // namespace
}  // namespace relievo
