// SPDX-License-Identifier: Apache-2.0
// Depth whose 16-bit codes lie in two bytes of an RGB picture: read, and not taken for hue; hues and photos are not
// taken for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "app/media/reading/code_count.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"
#include "tests/support/film/scene_film.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::expectScene;
using test::hueColor;
using test::makeClip;
using test::OpenedFilm;
using test::openFilm;
using test::TemporaryFolder;

// Pictures of RGB in 8 bits: the value of component k.
ClipTrack pictures(std::function<std::uint32_t(int, int, int)> value) {
  ClipTrack track{
      .codec = "png", .pix_fmt = "rgb24", .width = test::kSceneCols, .height = test::kSceneRows, .frames = 1};
  track.sample = [value = std::move(value)](int k, int c, int r, int) { return value(k, c, r); };
  return track;
}
ClipTrack packed(int upper, std::uint32_t blue = 0) {
  return pictures([=](int k, int c, int r) {
    const auto code = static_cast<std::uint32_t>(std::lround(distanceMm(c, r)));
    return k == 2 ? blue : k == upper ? code >> 8 : code & 0xff;
  });
}

TEST(PackedCodes, RedAndGreenAreTheBytesOfADistance) {
  for (const int upper : {0, 1}) {
    TemporaryFolder folder;
    makeClip(folder / "color.png", {pictures([](int, int c, int r) { return static_cast<std::uint32_t>(c + r); })});
    makeClip(folder / "depth.png", {packed(upper, upper == 0 ? 0 : 255)});
    const OpenedFilm film = openFilm({.url = folder / "color.png", .depth_url = folder / "depth.png"});
    expectScene(film, 1, {.mm = 0.51});
    const FilmReading& reading = film.info.reading;
    EXPECT_NE(plainLine(reading, film.info.calibration.calibration).find("two bytes"), std::string::npos);
  }
}

TEST(PackedCodes, AloneTheyAreFeltAsWell) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {packed(0)});
  const OpenedFilm film = openFilm({.url = folder / "a.png"});
  EXPECT_EQ(film.info.packing, Packing::DepthAlone);
  expectScene(film, 1, {.mm = 0.51});
  EXPECT_EQ(film.pair.color.components[0].bits, film.pair.color.components[1].bits) << "shown as gray";
}

// CARLA: (R + 256 G + 65536 B) / (2^24 - 1) km; the scene at ten times its distance, white for its holes.
TEST(PackedCodes, CarlasThreeBytesAreAKilometre) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {pictures([](int k, int c, int r) {
             const double mm = 10 * distanceMm(c, r);
             const auto code = mm == 0 ? 0xffffffu : static_cast<std::uint32_t>(mm / 1e6 * 0xffffff);
             return code >> (8 * k) & 0xff;
           })});
  const OpenedFilm film = openFilm({.url = folder / "a.png"});
  expectScene(film, 10, {.mm = 16});  // a code is 15.26 mm
}

// The upper byte in red, the lower one in green, by a program that takes red for blue.
TEST(PackedCodes, TwoBytesInBlueAndGreenAreMillimetres) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {pictures([](int k, int c, int r) {
             const auto mm = static_cast<std::uint32_t>(distanceMm(c, r));
             return k == 2 ? mm >> 8 : k == 1 ? mm & 0xff : 0;
           })});
  expectScene(openFilm({.url = folder / "a.png"}), 1, {.mm = 1.01});
}

// NYU Hand Pose: the upper byte in green, the lower one in blue.
TEST(PackedCodes, TwoBytesInGreenAndBlueAreMillimetres) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {pictures([](int k, int c, int r) {
             const auto mm = static_cast<std::uint32_t>(distanceMm(c, r));
             return k == 1 ? mm >> 8 : k == 2 ? mm & 0xff : 0;
           })});
  expectScene(openFilm({.url = folder / "a.png"}), 1, {.mm = 1.01});
}

// Of a room the blue byte is below 3, and red, the lowest byte, changes everywhere: that is no hue.
TEST(PackedCodes, CarlasThreeBytesOfARoomAreReadFinely) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {pictures([](int k, int c, int r) {
             const double mm = distanceMm(c, r);
             const auto code = mm == 0 ? 0xffffffu : static_cast<std::uint32_t>(mm / 1e6 * 0xffffff);
             return code >> (8 * k) & 0xff;
           })});
  const OpenedFilm film = openFilm({.url = folder / "a.png"});
  expectScene(film, 1, {.mm = 1});  // a code is .95 mm
  const std::string line = plainLine(film.info.reading, film.info.calibration.calibration);
  EXPECT_NE(line.find("62 m"), std::string::npos) << line;
}

// Green above red, without blue, on a slope on which red goes round every eleven columns.
TEST(PackedCodes, ASteepSlopeOfTwoBytesIsNotTakenForThree) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {pictures([](int k, int c, int) {
             const auto mm = static_cast<std::uint32_t>(1000 + 24 * c);
             return k == 2 ? 0u : k == 1 ? mm >> 8 : mm & 0xff;
           })});
  const OpenedFilm film = openFilm({.url = folder / "a.png"});
  const std::string line = plainLine(film.info.reading, film.info.calibration.calibration);
  EXPECT_NE(line.find("two bytes"), std::string::npos) << line;
}

// Tiles of terrain by their makers' formulas: a slope from 260 m below the sea to 1150 m above it.
struct Tile {
  const char* kind;
  double codes_a_metre, base;
};
constexpr Tile kTiles[] = {{"terrarium", 256, 32768}, {"mapbox", 10, 10000}};

double terrainMetres(int c, int r) {
  return -260 + 7.3 * c + 2.37 * r;
}
ClipTrack tileOf(const Tile& tile) {
  return pictures([=](int k, int c, int r) -> std::uint32_t {
    if (c == 0) return 0;  // no data
    return static_cast<std::uint32_t>((terrainMetres(c, r) + tile.base) * tile.codes_a_metre) >> (16 - 8 * k) & 0xff;
  });
}

TEST(PackedCodes, TilesOfTerrainAreHeights) {
  for (const Tile& tile : kTiles) {
    for (const bool stated : {false, true}) {
      TemporaryFolder folder;
      makeClip(folder / "a.png", {tileOf(tile)});
      const OpenedFilm film = openFilm({.url = folder / "a.png", .as = stated ? findKind(tile.kind) : nullptr});
      ASSERT_FALSE(film.pair.depth.empty());
      const double low = film.heightAt(1, 0), high = film.heightAt(test::kSceneCols - 1, test::kSceneRows - 1);
      ASSERT_GT(high, low + 0.5);
      const double bottom = terrainMetres(1, 0), top = terrainMetres(test::kSceneCols - 1, test::kSceneRows - 1);
      EXPECT_TRUE(std::isnan(film.heightAt(0, 5))) << tile.kind;
      for (int r = 0; r < test::kSceneRows; ++r) {
        for (int c = 1; c < test::kSceneCols; ++c) {
          const double metres = bottom + (film.heightAt(c, r) - low) / (high - low) * (top - bottom);
          ASSERT_NEAR(metres, terrainMetres(c, r), 0.5) << tile.kind << ", " << c << ", " << r;
        }
      }
    }
  }
}

// Android's DEPTH16: the confidence is in the upper three bits.
TEST(PackedCodes, ConfidenceAboveTheDistanceIsLeftOut) {
  for (const bool with : {true, false}) {
    TemporaryFolder folder;
    ClipTrack track{
        .codec = "png", .pix_fmt = "gray16be", .width = test::kSceneCols, .height = test::kSceneRows, .frames = 1};
    track.sample = [with](int, int c, int r, int) {
      const auto code = static_cast<std::uint32_t>(std::lround(distanceMm(c, r)));
      const auto confidence = static_cast<std::uint32_t>((c * 5 + r * 3) % 7 + 1);
      return code == 0 || !with ? code : code | confidence << 13;
    };
    makeClip(folder / "a.png", {track});
    const OpenedFilm film = openFilm({.url = folder / "a.png"});
    expectScene(film, 1, {.mm = 0.51});
  }
}

// Colour left, of many shades; the depth right of `seam` white columns.
ClipTrack besideColor(int seam, std::function<std::uint32_t(int, int, int)> depth) {
  constexpr int kDepthBegins = test::kSceneCols;
  ClipTrack track = pictures([=](int k, int c, int r) -> std::uint32_t {
    if (c < kDepthBegins) return static_cast<std::uint32_t>((40 * k + 5 * c + 3 * r + (c * r) % 23) % 256);
    return c < kDepthBegins + seam ? 255 : depth(k, c - kDepthBegins - seam, r);
  });
  track.width = 2 * test::kSceneCols + seam;
  return track;
}

TEST(PackedCodes, BesideTheirColourTheyAreFeltAsWell) {
  for (const bool with_blue : {false, true}) {
    TemporaryFolder folder;
    const auto code = [](int c, int r) { return static_cast<std::uint32_t>(std::lround(10 * distanceMm(c, r))); };
    makeClip(folder / "a.png", {besideColor(0, [&](int k, int c, int r) -> std::uint32_t {
               if (k == 2) return with_blue ? static_cast<std::uint32_t>(c * 37 + r * 11) % 256 : 0;
               return k == 0 ? code(c, r) >> 8 : code(c, r) & 0xff;
             })});
    const OpenedFilm film = openFilm({.url = folder / "a.png"});
    EXPECT_EQ(film.info.packing, Packing::SideBySide);
    ASSERT_EQ(film.pair.depth.width, test::kSceneCols);
    for (int r = 0; r < test::kSceneRows; ++r) {
      for (int c = 0; c < test::kSceneCols; ++c) ASSERT_EQ(test::sampleAt(film.pair.depth, 0, c, r), code(c, r));
    }
  }
}

// Depth Anything's films: 50 white columns between the picture and its depth.
TEST(PackedCodes, AWhiteMarginBetweenTheHalvesBelongsToNeither) {
  TemporaryFolder folder;
  const auto shade = [](int c, int r) { return static_cast<std::uint32_t>(20 + 2 * c % 200 + r % 30); };
  makeClip(folder / "a.png", {besideColor(50, [&](int, int c, int r) { return shade(c, r); })});
  const OpenedFilm film = openFilm({.url = folder / "a.png"});
  EXPECT_EQ(film.info.packing, Packing::SideBySide);
  ASSERT_EQ(film.pair.depth.width, test::kSceneCols);
  EXPECT_EQ(film.pair.color.width, test::kSceneCols);
  for (int r = 0; r < test::kSceneRows; ++r) {
    for (int c = 0; c < test::kSceneCols; ++c) ASSERT_EQ(test::sampleAt(film.pair.depth, 0, c, r), shade(c, r)) << c;
  }
}

// Depth Anything's pictures have a caption above both halves, too: what is left without it is read.
TEST(PackedCodes, ACaptionAboveTheHalvesIsTold) {
  constexpr int kCaption = 60;
  TemporaryFolder folder;
  const auto shade = [](int c, int r) { return static_cast<std::uint32_t>(20 + 2 * c % 200 + r % 30); };
  ClipTrack captioned = besideColor(50, [&](int, int c, int r) { return shade(c, r); });
  captioned.sample = [plain = captioned.sample](int k, int c, int r, int frame) -> std::uint32_t {
    const bool letter = r > 20 && r < 40 && c % (test::kSceneCols + 50) / 10 == 5;
    return r >= kCaption ? plain(k, c, r - kCaption, frame) : letter ? 0 : 255;
  };
  const ClipTrack plain = besideColor(50, [&](int, int c, int r) { return shade(c, r); });
  captioned.height += kCaption;
  makeClip(folder / "a.png", {captioned}), makeClip(folder / "b.png", {plain});
  const auto told = testing::Contains(testing::HasSubstr("crop=iw:ih-60:0:60 OUT.png"));
  EXPECT_THAT(openFilm({.url = folder / "a.png"}).info.notes, told);
  EXPECT_THAT(openFilm({.url = folder / "b.png"}).info.notes, testing::Not(told));
}

// In the rows between those that are examined, the upper byte changes and the lower one does not.
TEST(PackedCodes, OfAPhotosSizeAreFoundInSomeOfItsRows) {
  constexpr int kCols = 2048, kRows = 1024, kStep = 4;
  std::vector<std::uint8_t> samples;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      const bool examined = r % kStep == 0 || r % kStep == kStep - 1;  // each is compared with the row above, too
      const auto code = static_cast<unsigned>(examined ? 1000 + 2 * c + 3 * r : 256 * (c % 2));
      samples.insert(samples.end(), {static_cast<std::uint8_t>(code >> 8), static_cast<std::uint8_t>(code), 0});
    }
  }
  Frame frame{.width = kCols, .height = kRows, .model = ColorModel::Rgb};
  for (std::uint8_t k = 0; k < 3; ++k) frame.components[k] = {.offset_bytes = k, .step_bytes = 3};
  frame.planes[0] = {samples.data(), 3 * kCols};
  EXPECT_EQ(packedOrder(frame), SampleOrder::RedGreen);
}

// From red over yellow to green, one byte has its highest value while another one changes; blue is 0 throughout.
TEST(PackedCodes, HuesAndPhotosAreNone) {
  const auto orderOf = [](const ClipTrack& track) {
    TemporaryFolder folder;
    makeClip(folder / "a.png", {track});
    const OpenedFilm film = openFilm({.url = folder / "a.png", .packing = Packing::DepthAlone});
    return packedOrder(film.pair.depth);
  };
  EXPECT_EQ(orderOf(pictures([](int k, int c, int r) {
              const double mm = distanceMm(c, r), s = mm == 0 ? 0 : (mm - 1000) / 3300;
              return static_cast<std::uint32_t>(std::lround(255 * hueColor(s)[static_cast<std::size_t>(k)]));
            })),
            SampleOrder::AsStored);
  EXPECT_EQ(orderOf(pictures([](int k, int c, int r) {
              return k == 2 ? 0u : static_cast<std::uint32_t>(k == 0 ? c / 2 + r / 3 : 2 * c % 256 + (c * r) % 7);
            })),
            SampleOrder::AsStored);
}

}  // namespace
}  // namespace relievo
