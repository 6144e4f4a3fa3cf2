// SPDX-License-Identifier: Apache-2.0
// Depth coded as brightness, with black holes: the holes are still found if the user states only which end is near.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <random>

#include "app/media/reading/depth_doubts.h"
#include "app/media/reading/depth_meaning.h"
#include "app/media/reading/depth_reading.h"
#include "app/scene/film_box.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using test::makeGrayFrame;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Not;

// Shades from `low` on, `black` in the first of 16 columns.
Frame shades(int bits, std::uint32_t black, std::uint32_t low) {
  return makeGrayFrame(256, 8, bits, {}, [=](int c, int) {
    return c < 16 ? black : low + (static_cast<std::uint32_t>(c - 16) * 150 << (bits - 8)) / 240;
  });
}
Frame film(int bits, std::uint32_t black, std::uint32_t low, ColorRange range = ColorRange::Limited) {
  Frame frame = shades(bits, black, low);
  frame.model = ColorModel::Yuv;
  frame.range = range;
  return frame;
}
DepthReading readingOf(const Frame& frame, const CalibrationLayers& said = {}) {
  return readCodes(frame, CodeCount(frame), said);
}

TEST(ShadeReading, BlackHolesOfGrayStayWhenTheNearEndIsSaid) {
  for (const int bits : {8, 16}) {
    const Frame frame = shades(bits, 0, 60u << (bits - 8));
    ASSERT_EQ(readingOf(frame).settings.at("invalid"), "0");
    EXPECT_EQ(readingOf(frame, {.command_line = {{"polarity", "near-low"}}}).settings.at("invalid"), "0");
  }
}

TEST(ShadeReading, WhoSaysMoreHasSaidTheHolesToo) {
  const Frame frame = shades(8, 0, 60);
  const CalibrationSettings near_low{{"polarity", "near-low"}};
  EXPECT_THAT(readingOf(frame, {.tags = near_low}).settings, IsEmpty());
  for (const char* key : {"law", "codes", "unit", "invalid"}) {
    CalibrationLayers said{.command_line = near_low};
    said.command_line[key] = "none";
    EXPECT_THAT(readingOf(frame, said).settings, Not(Contains(Key("invalid")))) << key;
  }
}

TEST(ShadeReading, AFilmsBlackMayBeAHole) {
  EXPECT_EQ(readingOf(film(8, 17, 60)).black, "0-19");
  EXPECT_EQ(readingOf(film(10, 66, 240)).black, "0-76");
  EXPECT_EQ(readingOf(film(8, 1, 60, ColorRange::Full)).black, "0-3");
  EXPECT_EQ(readingOf(film(8, 0, 60, ColorRange::Unspecified)).black, "0-3");
  EXPECT_EQ(readingOf(film(8, 17, 18)).black, "") << "black is one of the shades";
  EXPECT_EQ(readingOf(film(8, 60, 60)).black, "") << "there is no black";
  EXPECT_EQ(readingOf(film(8, 17, 60), {.command_line = {{"invalid", "none"}}}).black, "");
}

// Gray of 64 x 96 without a word of what it means, of the given code.
template <class Code>
DepthMeaning meaningOf(Code&& code, ColorModel model = ColorModel::Gray, const DepthClues& clues = {}) {
  Frame frame = makeGrayFrame(64, 96, 8, {}, code);
  frame.model = model;
  return readMeaning(clues, nullptr, frame).value();
}

// A street: the road below is nearer than the houses and the sky above.
TEST(ShadeReading, BrightIsNearAndADoubtSaysWhatTheViewSays) {
  const auto expect = [](const auto& code, const char* view) {
    const DepthMeaning meaning = meaningOf(code);
    EXPECT_EQ(meaning.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
    EXPECT_THAT(meaning.reading.doubts, ElementsAre(AllOf(HasSubstr(view), HasSubstr("polarity=near-low"))));
  };
  expect([](int, int r) { return 220 - 2 * r; }, "bright is taken, although");
  expect([](int, int r) { return 30 + 2 * r; }, "bright is taken, which makes");
  expect([](int c, int) { return 30 + 2 * c; }, "bright is taken;");
}

// Renderings of distances and photos with a lens blur are dark where they are near. A film keeps to bright.
TEST(ShadeReading, OfAPicturesGrayTheEndIsNearThatMakesTheViewNearerBelow) {
  const auto darker_below = [](int, int r) { return static_cast<std::uint32_t>(220 - 2 * r); };
  const auto brighter_below = [](int, int r) { return static_cast<std::uint32_t>(30 + 2 * r); };
  for (const char* const codec : {"png", "mjpeg", "webp"}) {
    const DepthMeaning dark = meaningOf(darker_below, ColorModel::Gray, {.codec = codec, .single = true});
    EXPECT_EQ(dark.calibration.calibration.polarity, DepthPolarity::NearIsLow) << codec;
    EXPECT_THAT(dark.reading.doubts,
                ElementsAre(AllOf(HasSubstr("dark is taken, which makes"), HasSubstr("polarity=near-high"))));
    const DepthMeaning bright = meaningOf(brighter_below, ColorModel::Gray, {.codec = codec, .single = true});
    EXPECT_EQ(bright.calibration.calibration.polarity, DepthPolarity::NearIsHigh) << codec;
    DepthClues said{.codec = codec, .single = true};
    said.command_line = {{"polarity", "near-high"}};
    EXPECT_EQ(meaningOf(darker_below, ColorModel::Gray, said).calibration.calibration.polarity,
              DepthPolarity::NearIsHigh);
  }
  for (const DepthClues& film : {DepthClues{.codec = "h264", .single = true}, DepthClues{.codec = "png"},
                                 DepthClues{.codec = "mjpeg", .live = true, .single = true}}) {
    EXPECT_EQ(meaningOf(darker_below, ColorModel::Gray, film).calibration.calibration.polarity,
              DepthPolarity::NearIsHigh)
        << film.codec;
  }
  // A JPEG's black apart from the other shades is no wall in front of them.
  const auto with_black = [&](int c, int r) { return c < 8 ? 0 : darker_below(c, r); };
  const DepthMeaning black = meaningOf(with_black, ColorModel::Yuv, {.codec = "mjpeg", .single = true});
  EXPECT_EQ(black.calibration.calibration.polarity, DepthPolarity::NearIsLow);
  EXPECT_TRUE(black.calibration.calibration.invalid.contains(0));
  EXPECT_THAT(black.reading.doubts, ElementsAre(HasSubstr("black is a hole now")));
}

TEST(ShadeReading, ALevelPictureIsNearAtNeitherEnd) {
  const auto doubts = [](std::uint32_t others) {
    const Frame frame = makeGrayFrame(64, 96, 8, {}, [=](int, int r) { return r < 4 ? 90 : others; });
    const DepthMeaning meaning = readMeaning({}, nullptr, frame).value();
    std::vector<std::string> all = meaning.reading.doubts;
    std::ranges::move(doubtsOf(frame, meaning.calibration.calibration), std::back_inserter(all));
    return all;
  };
  EXPECT_THAT(doubts(90), ElementsAre(HasSubstr("is one code")));
  EXPECT_THAT(doubts(7), ElementsAre(HasSubstr("is one code")));
}

// Sixteen bits whose codes begin at nearly 0, as a network's raw numbers do: in mm they would be nearer than any sensor
// sees. Others without a hole are distances, doubted if that makes the floor far.
TEST(ShadeReading, SixteenBitsFromZeroOnAreNotMillimetres) {
  const auto meaning_of = [](int low, int high) {
    const Frame frame =
        makeGrayFrame(64, 96, 16, {}, [=](int c, int r) { return low + (high - low) * (64 * r + c) / (64 * 96); });
    return readMeaning({}, nullptr, frame).value();
  };
  for (const auto& [low, high] : {std::pair{0, 12}, {0, 300}, {60, 300}, {40, 5000}, {0, 20000}}) {
    const DepthMeaning meaning = meaning_of(low, high);
    const DepthCalibration& calibration = meaning.calibration.calibration;
    EXPECT_EQ(calibration.polarity, DepthPolarity::NearIsHigh) << high;
    EXPECT_FALSE(calibration.unit_mm) << high;
    EXPECT_NEAR(calibration.codes.value().high, 1.1 * high, 0.01 * high + 1);
    EXPECT_THAT(meaning.reading.doubts, ElementsAre(AllOf(HasSubstr("bright is taken"), HasSubstr("near-low"))));
    EXPECT_THAT(meaning.reading.offers, ElementsAre(HasSubstr("--as mm")));
  }
  for (const auto& [low, high] : {std::pair{250, 1200}, {700, 5000}, {130, 20000}}) {
    const DepthMeaning meaning = meaning_of(low, high);
    EXPECT_EQ(meaning.calibration.calibration.unit_mm, 1) << high;
    EXPECT_THAT(meaning.reading.doubts, ElementsAre(AllOf(HasSubstr("nearer above"), HasSubstr("--as heights"))));
  }
}

// Its high codes are near even in a picture by itself whose view is nearer above then.
TEST(ShadeReading, ANetworksNumbersAreNearWhereTheyAreHigh) {
  const Frame frame = makeGrayFrame(64, 96, 16, {}, [](int c, int r) { return 286 - 3 * r + c % 2; });
  const DepthClues clues{.codec = "png", .single = true};
  ASSERT_EQ(kindOf(clues, frame), nullptr);
  const DepthMeaning network = readMeaning(clues, nullptr, frame).value();
  EXPECT_THAT(network.reading.why, ElementsAre(HasSubstr("a network's numbers")));
  EXPECT_EQ(network.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
  EXPECT_THAT(network.reading.doubts, ElementsAre(AllOf(HasSubstr("although"), HasSubstr("near-low"))));
}

// A camera for close views (70 to 190 mm), or a room in centimetres: with holes, or nearer below as distances.
TEST(ShadeReading, FewCodesOfACloseViewStayDistances) {
  const auto kind = [](bool holes, bool near_below) {
    const Frame frame = makeGrayFrame(
        64, 96, 16, {}, [=](int c, int r) { return holes && c < 6 ? 0 : 70 + (near_below ? 95 - r : r) + c % 3; });
    return sensorKind(frame, CodeCount(frame));
  };
  EXPECT_EQ(kind(true, false), findKind("mm"));
  EXPECT_EQ(kind(true, true), findKind("mm"));
  EXPECT_EQ(kind(false, true), findKind("mm"));
  EXPECT_EQ(kind(false, false), nullptr);
  const Frame black = makeGrayFrame(8, 8, 16, {}, [](int, int) { return 0; });
  EXPECT_EQ(readMeaning({}, nullptr, black).value().reading.offers.size(), 0) << "no network's numbers";
}

TEST(ShadeReading, HolesWithSoftEdgesStayHolesOfDistances) {
  const Frame resized = makeGrayFrame(200, 100, 16, {}, [](int c, int r) {
    return c < 20 ? 0 : c == 20 ? r : 800 + 10 * c;
  });
  EXPECT_EQ(sensorKind(resized, CodeCount(resized)), findKind("mm"));
}

// A view that is nearer above than below speaks against the end that is taken.
TEST(ShadeReading, ANearEndThatNothingSpeaksAgainstIsTakenAsInMostFilms) {
  const auto usual = [](auto code, const DepthClues& clues = {}) {
    return meaningOf(code, ColorModel::Yuv, clues).reading.near_end_is_usual;
  };
  EXPECT_TRUE(usual([](int, int r) { return 30 + 2 * r; }));
  EXPECT_TRUE(usual([](int c, int) { return 30 + c; })) << "neither";
  EXPECT_FALSE(usual([](int, int r) { return 220 - 2 * r; }));
  EXPECT_FALSE(usual([](int, int r) { return 220 - 2 * r; }, {.path = "a/clip_disparity.mp4"}));
}

TEST(ShadeReading, AFilmThatIsNamedDisparityIsNearWhereItIsBright) {
  const DepthMeaning named =
      meaningOf([](int, int r) { return 220 - 2 * r; }, ColorModel::Yuv, {.path = "a/clip_disparity.mp4"});
  EXPECT_EQ(named.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
  EXPECT_THAT(named.reading.doubts, ElementsAre(AllOf(HasSubstr("nearer above"), HasSubstr("polarity=near-low"))));
  const DepthMeaning told = meaningOf([](int, int r) { return 220 - 2 * r; }, ColorModel::Yuv,
                                      {.command_line = {{"unit", "10"}}, .path = "a/clip_disparity.mp4"});
  EXPECT_EQ(told.calibration.calibration.unit_mm, 10);
}

TEST(ShadeReading, WhoeverStatesTheNearEndIsNotDoubted) {
  const auto road = [](int, int r) { return 220 - 2 * r; };
  const CalibrationSettings bright{{"polarity", "near-high"}};
  EXPECT_THAT(meaningOf(road, ColorModel::Gray, {.command_line = bright}).reading.doubts, IsEmpty());
  EXPECT_THAT(meaningOf(road, ColorModel::Gray, {.tags = {{"DEPTH_POLARITY", "near-high"}}}).reading.doubts, IsEmpty());
  const DepthMeaning assumed =
      meaningOf(road, ColorModel::Gray, {.tags = {{"DEPTH_POLARITY", "near-high"}, {"DEPTH_ASSUMED", "polarity"}}});
  EXPECT_EQ(assumed.calibration.calibration.polarity, DepthPolarity::NearIsHigh);
  EXPECT_THAT(assumed.reading.doubts, ElementsAre(HasSubstr("polarity=near-low")));
}

// Black stands at the top, as a sky without depth does: it says nothing of the ground.
TEST(ShadeReading, BlackThatMayBeAHoleIsOfferedAsOne) {
  const auto shades = [](int bottom) { return [=](int, int r) { return r < 24 ? 1 : r < 48 ? 130 : bottom; }; };
  for (const int bottom : {60, 200}) {
    const DepthMeaning meaning = meaningOf(shades(bottom), ColorModel::Yuv);
    EXPECT_TRUE(meaning.calibration.calibration.invalid.empty());
    EXPECT_THAT(meaning.reading.doubts, ElementsAre(AllOf(HasSubstr(bottom == 60 ? "although" : "which makes"),
                                                          HasSubstr("polarity=near-low,invalid=0-3"))));
  }
}

// A sensor's distances fit into 12 bits of HEVC or of gray; 10 bits are too few for a room.
TEST(ShadeReading, DeepShadesMayBeMillimetres) {
  const auto doubts = [](int bits) {
    Frame frame = makeGrayFrame(64, 96, bits, {}, [](int c, int r) { return c < 4 ? 0 : 300 + 4 * r + c; });
    frame.model = ColorModel::Yuv;
    return readMeaning({}, nullptr, frame).value().reading.doubts;
  };
  EXPECT_THAT(doubts(12), ElementsAre(HasSubstr("--as mm")));
  EXPECT_THAT(doubts(10), ElementsAre(Not(HasSubstr("--as mm"))));
}

// A telephone's colour is upright, its depth as the sensor lies.
TEST(ShadeReading, DepthThatLiesOnItsSideIsToBeTurned) {
  const auto of_size = [](int cols, int rows) {
    return makeGrayFrame(cols, rows, 8, {}, [](int c, int r) { return (3 * c + r) % 256; });
  };
  const Frame color = of_size(96, 128);
  EXPECT_THAT(doubtsOf(of_size(64, 48), {}, &color), Contains(AllOf(HasSubstr("transpose"), Not(HasSubstr("--box")))));
  EXPECT_THAT(doubtsOf(of_size(72, 48), {}, &color), Contains(AllOf(HasSubstr("--box"), Not(HasSubstr("transpose")))));
}

// A square picture has a network's size: if one of the two has it, the film is shown in the other's shape.
TEST(ShadeReading, OfTwoShapesTheSquareOneIsTakenForSqueezed) {
  const auto of_size = [](int cols, int rows) {
    return makeGrayFrame(cols, rows, 8, {}, [](int c, int r) { return (3 * c + r) % 256; });
  };
  const Frame square = of_size(64, 64), wide = of_size(128, 72), high = of_size(72, 128), tall = of_size(72, 120);
  EXPECT_DOUBLE_EQ(usualBox(wide, square).height_mm, 90);
  EXPECT_DOUBLE_EQ(usualBox(wide, high).height_mm, 90);
  EXPECT_DOUBLE_EQ(usualBox(square, wide).height_mm, 90);
  EXPECT_DOUBLE_EQ(usualBox(square, {}).height_mm, 160);
  const auto boxes = [](const std::string& shown, const std::string& right, const std::string& box) {
    return Contains(
        HasSubstr("in the " + shown + "'s shape; if the " + right + "'s is right, play it with --box " + box));
  };
  EXPECT_THAT(doubtsOf(square, {}, &wide), boxes("colour", "depth", "160x160x40"));
  EXPECT_THAT(doubtsOf(tall, {}, &square), boxes("depth", "colour", "160x160x40"));
  EXPECT_THAT(doubtsOf(tall, {}, &wide), boxes("colour", "depth", "96x160x40"));
}

// A tilted plane with the texture of a photo, with a sensor's rounding, and with steps of two codes.
TEST(ShadeReading, DepthAsRoughAsAPhotoIsDoubted) {
  std::mt19937 random(5);
  const auto doubts = [&](int texture) {
    std::uniform_int_distribution<int> grain(0, texture);
    return doubtsOf(makeGrayFrame(320, 200, 8, {}, [&](int c, int r) { return 40 + (c + r) / 4 + grain(random); }), {});
  };
  EXPECT_THAT(doubts(20), ElementsAre(HasSubstr("as rough as a photo")));
  EXPECT_THAT(doubts(1), IsEmpty());
  EXPECT_THAT(doubts(2), IsEmpty());
}

// RealSense's Pattern; a fence has as many steps from black to white, but steep ones.
TEST(ShadeReading, ShadesThatSwingAlongASlopeAreDoubted) {
  const auto doubts = [](const auto& code) { return doubtsOf(makeGrayFrame(256, 64, 8, {}, code), {}); };
  const auto pattern = [](int c, int r) { return std::abs((8 * (c + r) & 511) - 255); };
  EXPECT_THAT(doubts(pattern), Contains(HasSubstr("Pattern")));
  EXPECT_THAT(doubts([](int, int r) { return std::abs((32 * r & 511) - 255); }), Contains(HasSubstr("Pattern")));
  EXPECT_THAT(doubts([](int c, int) { return c; }), IsEmpty());
  EXPECT_THAT(doubts([](int c, int r) { return c / 8 % 2 == 0 ? 0 : 200 + r / 2; }),
              Not(Contains(HasSubstr("Pattern"))));
}

}  // namespace
}  // namespace relievo
