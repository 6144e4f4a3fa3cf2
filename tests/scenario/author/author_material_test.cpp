// SPDX-License-Identifier: Apache-2.0
// A material per place through the author's containers, and from maps that are painted over pictures of a film.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "app/author/author.h"
#include "app/author/package/output.h"
#include "app/scene/material_map.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"
#include "tests/support/film/film_ways.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::colorPicture;
using test::formatOf;
using test::makeClip;
using test::readFilm;
using test::TemporaryFolder;
using test::Way;

constexpr int kCols = test::kWayCols, kRows = test::kWayRows, kPictures = 12;
constexpr DisplayVolume kVolume = DisplayVolume::forPicture(kCols, kRows);
constexpr const char* kScale = "stiffness=1.2,friction=0.5/0.4,texture=0.2@0.8";

// A patch that moves two samples a picture, on other ground.
struct Codes {
  int y = 0, u = 0, v = 0;
};
Codes codesAt(int c, int r, int k) {
  const bool patch = c >= 16 + 2 * k && c < 40 + 2 * k && r >= 16 && r < 48;
  return patch ? Codes{212, 176, 140} : Codes{61, 20, 0};
}
ColorPicture420 materialPicture(int k) {
  ColorPicture420 picture{.width = kCols, .height = kRows, .y = {}, .u = {}, .v = {}};
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) picture.y.push_back(static_cast<std::uint8_t>(codesAt(c, r, k).y));
  }
  for (int r = 0; r < kRows; r += 2) {
    for (int c = 0; c < kCols; c += 2) {
      picture.u.push_back(static_cast<std::uint8_t>(codesAt(c, r, k).u));
      picture.v.push_back(static_cast<std::uint8_t>(codesAt(c, r, k).v));
    }
  }
  return picture;
}
DepthPicture slope() {
  DepthPicture depth{kCols, kRows, {}};
  for (int i = 0; i < kCols * kRows; ++i) depth.codes.push_back(static_cast<std::uint16_t>(100 + i % kCols));
  return depth;
}

class MaterialRoundTrip : public testing::TestWithParam<Way> {
 protected:
  TemporaryFolder folder_;
};

TEST_P(MaterialRoundTrip, BringsBackEachPlacesMaterial) {
  const std::string path = folder_ / (std::string("film") + GetParam().ending);
  FilmFormat format = formatOf(GetParam(), 8, DepthCalibration{});
  format.material_width = kCols;
  format.material_height = kRows;
  format.material_scale = kScale;
  auto writer = FilmWriter::create(path, format);
  ASSERT_TRUE(writer) << writer.error().message;
  for (int k = 0; k < kPictures; ++k) {
    const MediaTime time(std::chrono::milliseconds(40) * k);
    ASSERT_TRUE((*writer)->writeColor(colorPicture(kCols, kRows, k), time, k == 0));
    ASSERT_TRUE((*writer)->writeDepth(slope(), time, k == 0));
    ASSERT_TRUE((*writer)->writeMaterial(materialPicture(k), time, k == 0));
  }
  const auto totals = (*writer)->finish();
  ASSERT_TRUE(totals) << totals.error().message;
  EXPECT_EQ(totals->material.frames, static_cast<std::uint64_t>(kPictures));

  const test::ReadFilm film = readFilm(path);
  EXPECT_TRUE(film.info.has_depth);
  EXPECT_EQ(materialText(film.info.material_scale), kScale);
  EXPECT_EQ(film.info.video_tracks_unused, 0);
  ASSERT_EQ(film.pairs.size(), static_cast<std::size_t>(kPictures));
  int worst = 0;
  for (std::size_t k = 0; k < film.pairs.size(); ++k) {
    ASSERT_EQ(film.pairs[k].depth.width, kCols) << "the depth is the depth";
    const auto map = MaterialMap::make(film.pairs[k].material, kVolume);
    ASSERT_TRUE(map.has_value()) << k;
    const GridMapping grid(kVolume, kCols, kRows);
    for (int r = 0; r < kRows; r += 2) {
      for (int c = 0; c < kCols; c += 2) {
        // The middle of four samples is one of the chroma's.
        const auto shares = map->at(grid.x(c + 0.5), grid.y(r + 0.5));
        const Codes codes = codesAt(c, r, static_cast<int>(k));
        for (const auto& [share, code] :
             {std::pair{shares.stiffness, codes.y}, {shares.friction, codes.u}, {shares.texture, codes.v}}) {
          worst = std::max(worst, static_cast<int>(std::lround(std::abs(255 * share - code))));
        }
      }
    }
  }
  EXPECT_LE(worst, 1) << "codes";
}

INSTANTIATE_TEST_SUITE_P(Ways, MaterialRoundTrip,
                         testing::Values(Way{".mkv"}, Way{".mkv", VideoCodec::Ffv1, 16}, Way{".mp4"},
                                         Way{".mp4", VideoCodec::Hevc, 12}, Way{".mov"}, Way{".ts"},
                                         Way{".ts", VideoCodec::Hevc, 10}, Way{".m3u8"}));

// A disc that goes two samples to the right and one down in each picture, over ground that stands still; both have
// marks of their own. Another scene begins at kCut.
constexpr int kWide = 160, kHigh = 120, kLong = 26, kCut = 20, kRadius = 22;

double marks(double x, double y, int seed) {
  const auto value = [seed](int c, int r) {
    auto n = static_cast<std::uint32_t>(c) * 73856093U ^ static_cast<std::uint32_t>(r) * 19349663U ^
             static_cast<std::uint32_t>(seed) * 83492791U;
    n = (n ^ n >> 13) * 1274126177U;
    return static_cast<double>((n >> 16) & 255);
  };
  x = x / 4 + 100;
  y = y / 4 + 100;
  const int c = static_cast<int>(x), r = static_cast<int>(y);
  const double s = x - c, t = y - r;
  return (1 - t) * ((1 - s) * value(c, r) + s * value(c + 1, r)) +
         t * ((1 - s) * value(c, r + 1) + s * value(c + 1, r + 1));
}
double centreX(int k) {
  return 50 + 2 * k;
}
double centreY(int k) {
  return 45 + k;
}
bool onDisc(double c, double r, int k, double more = 0) {
  return std::hypot(c - centreX(k), r - centreY(k)) < kRadius + more;
}

class PaintedFilm : public testing::Test {
 protected:
  void SetUp() override {
    ClipTrack color{.pix_fmt = "yuv420p", .width = kWide, .height = kHigh, .frames = kLong};
    color.sample = [](int component, int c, int r, int k) -> std::uint32_t {
      if (component > 0) return 128;
      if (k >= kCut) return static_cast<std::uint32_t>(30 + 0.7 * marks(c, r, 3));
      const double code = onDisc(c, r, k) ? marks(c - centreX(k), r - centreY(k), 1) : marks(c, r, 2);
      return static_cast<std::uint32_t>(30 + 0.7 * code);
    };
    ClipTrack depth{.pix_fmt = "gray", .width = kWide, .height = kHigh, .frames = kLong};
    depth.sample = [](int, int c, int r, int k) { return k >= kCut ? 220U : onDisc(c, r, k) ? 130U : 60U; };
    ClipTrack map{.codec = "png", .pix_fmt = "rgba", .width = kWide, .height = kHigh, .frames = 1};
    map.sample = [](int component, int c, int r, int) {
      const std::uint32_t painted[] = {204, 102, 51, 255};
      return onDisc(c, r, 0) ? painted[component] : 0U;
    };
    makeClip(folder_ / "color.mkv", {color});
    makeClip(folder_ / "depth.mkv", {depth});
    makeClip(folder_ / "map.png", {map});
  }
  AuthorSummary author(const SourceOptions& source, const std::vector<Painting>& paintings, const std::string& out) {
    const std::atomic<bool> stop{false};
    OutputOptions output;
    output.path = folder_ / out;
    for (const Painting& painting : paintings) {
      output.paintings.push_back({.path = folder_ / painting.path, .from_s = painting.from_s});
    }
    auto summary = authorFilm(source, kFfmpeg, output, stop, [](std::uint64_t, std::optional<std::uint64_t>) {});
    EXPECT_TRUE(summary.has_value()) << (summary ? "" : summary.error().thing + ": " + summary.error().error.message);
    return summary.value_or(AuthorSummary{});
  }
  AuthorSummary author(const std::string& map, const Material& words) { return author({{.path = map}}, words); }
  AuthorSummary author(const std::vector<Painting>& paintings, const Material& words) {
    SourceOptions source;
    source.url = folder_ / "color.mkv";
    source.depth_url = folder_ / "depth.mkv";
    source.material = words;
    return author(source, paintings, "film.mkv");
  }
  static MaterialMap::Shares at(const test::ReadFilm& film, std::size_t k, double c, double r) {
    constexpr DisplayVolume kBox = DisplayVolume::forPicture(kWide, kHigh);
    const GridMapping grid(kBox, kWide, kHigh);
    return MaterialMap::make(film.pairs.at(k).material, kBox).value().at(grid.x(c), grid.y(r));
  }

  TemporaryFolder folder_;
};

TEST_F(PaintedFilm, AMapOverTheFirstPictureStaysOnItsThingUntilTheCut) {
  const AuthorSummary summary = author("map.png", {});
  EXPECT_EQ(summary.format.material_scale, "stiffness=1,friction=0.6/0.5,texture=0.2@0.8");
  EXPECT_THAT(summary.notes, testing::Contains(testing::HasSubstr("nothing is painted after the cut at 0.667 s;")));
  EXPECT_THAT(toText("film", summary), testing::HasSubstr("material of each place: up to stiffness=1"));
  const test::ReadFilm film = readFilm(folder_ / "film.mkv");
  ASSERT_EQ(film.pairs.size(), static_cast<std::size_t>(kLong));
  constexpr double kTwoCodes = 2.0 / 255, kUnpainted = 128.0 / 255;
  int wrong = 0, looked = 0;
  for (int k = 0; k < kLong; ++k) {
    for (int r = 8; r < kHigh - 8; r += 3) {
      for (int c = 8; c < kWide - 8; c += 3) {
        const bool in = onDisc(c, r, k, -4);
        if (k < kCut && !in && onDisc(c, r, k, 4)) continue;  // its edge
        const auto shares = at(film, static_cast<std::size_t>(k), c, r);
        const bool painted = k < kCut && in;
        const bool good = std::abs(shares.stiffness - (painted ? 0.8 : kUnpainted)) < kTwoCodes &&
                          std::abs(shares.friction - (painted ? 0.4 : 0)) < kTwoCodes &&
                          std::abs(shares.texture - (painted ? 0.2 : 0)) < kTwoCodes;
        ++looked;
        wrong += good ? 0 : 1;
      }
    }
  }
  EXPECT_LT(wrong, 0.005 * looked) << "of " << looked;
}

TEST_F(PaintedFilm, WordsSayWhatFullCodesStandForAndTheWholeFilmKeepsTheRest) {
  ClipTrack gray{.codec = "png", .pix_fmt = "gray", .width = 80, .height = 60, .frames = 1};
  gray.sample = [](int, int c, int, int) { return c < 40 ? 51U : 255U; };
  makeClip(folder_ / "gray.png", {gray});
  static_cast<void>(author("gray.png", parseMaterial("stiffness=2,friction=.3").value()));
  const test::ReadFilm film = readFilm(folder_ / "film.mkv");
  EXPECT_EQ(materialText(film.info.material_scale), "stiffness=2") << "gray is stiffness alone";
  EXPECT_EQ(materialText(film.info.material), "friction=0.3/0.3");
  EXPECT_NEAR(at(film, 0, 30, 60).stiffness, 0.2, 0.01);
  EXPECT_NEAR(at(film, 0, 130, 60).stiffness, 1, 0.01);
}

TEST_F(PaintedFilm, AFilmOfMapsIsTakenByItsTimes) {
  ClipTrack maps{.pix_fmt = "gray", .width = kWide, .height = kHigh, .fps_num = 10, .frames = 3};
  maps.sample = [](int, int, int, int k) { return 50U + 60U * static_cast<unsigned>(k); };
  makeClip(folder_ / "maps.mkv", {maps});
  EXPECT_THAT(author("maps.mkv", {}).notes, testing::Not(testing::Contains(testing::HasSubstr("painted"))));
  const test::ReadFilm film = readFilm(folder_ / "film.mkv");
  for (std::size_t k = 0; k < film.pairs.size(); ++k) {
    EXPECT_NEAR(255 * at(film, k, 80, 60).stiffness, 50 + 60 * static_cast<double>(std::min<std::size_t>(k / 3, 2)),
                1.01)
        << k;
  }
}

TEST_F(PaintedFilm, EachShotHasAPaintingOfItsOwn) {
  ClipTrack half{.codec = "png", .pix_fmt = "gray", .width = kWide, .height = kHigh, .frames = 1};
  half.sample = [](int, int c, int, int) { return c < kWide / 2 ? 51U : 230U; };
  makeClip(folder_ / "half.png", {half});
  const AuthorSummary summary = author({{.path = "map.png"}, {.path = "half.png", .from_s = 0.666}}, {});
  EXPECT_THAT(summary.notes, testing::Not(testing::Contains(testing::HasSubstr("painted"))));
  EXPECT_EQ(summary.format.material_scale, "stiffness=1,friction=0.6/0.5,texture=0.2@0.8") << "one of them has colours";
  const test::ReadFilm film = readFilm(folder_ / "film.mkv");
  EXPECT_NEAR(at(film, kCut - 1, centreX(kCut - 1), centreY(kCut - 1)).stiffness, 0.8, 0.01);
  EXPECT_NEAR(at(film, kCut - 1, 20, 100).stiffness, 128.0 / 255, 0.01);
  for (const std::size_t k : {kCut, kLong - 1}) {
    EXPECT_NEAR(at(film, k, 20, 60).stiffness, 0.2, 0.01) << k;
    EXPECT_NEAR(at(film, k, 140, 60).stiffness, 230.0 / 255, 0.01) << k;
    EXPECT_NEAR(at(film, k, 140, 60).friction, 0, 0.01) << "gray is stiffness alone";
  }
}

TEST_F(PaintedFilm, APaintingMayBeginWithinAShot) {
  constexpr int kFrom = 10;
  ClipTrack later{.codec = "png", .pix_fmt = "rgba", .width = kWide, .height = kHigh, .frames = 1};
  later.sample = [](int component, int c, int r, int) {
    const std::uint32_t painted[] = {255, 0, 0, 255};
    return onDisc(c, r, kFrom) ? painted[component] : 0U;
  };
  makeClip(folder_ / "later.png", {later});
  const AuthorSummary summary = author({{"later.png", kFrom / 30.0}, {"map.png", 99}}, {});
  EXPECT_THAT(summary.notes, testing::IsSupersetOf({testing::HasSubstr("after the cut at 0.667 s"),
                                                    testing::HasSubstr("map.png: the film ends before 99 s")}));
  const test::ReadFilm film = readFilm(folder_ / "film.mkv");
  EXPECT_NEAR(at(film, kFrom - 1, centreX(kFrom - 1), centreY(kFrom - 1)).stiffness, 128.0 / 255, 0.01);
  for (const int k : {kFrom, kCut - 1}) {
    EXPECT_NEAR(at(film, static_cast<std::size_t>(k), centreX(k), centreY(k)).stiffness, 1, 0.01) << k;
    EXPECT_NEAR(at(film, static_cast<std::size_t>(k), 20, 100).stiffness, 128.0 / 255, 0.01) << k;
  }
  EXPECT_NEAR(at(film, kCut, centreX(kCut), centreY(kCut)).stiffness, 128.0 / 255, 0.01);
}

TEST_F(PaintedFilm, APaintingMayBeginWhileADepthPictureIsHeld) {
  constexpr int kFrom = 11;
  ClipTrack depth{.pix_fmt = "gray", .width = kWide, .height = kHigh, .fps_num = 15, .frames = kLong / 2};
  depth.sample = [](int, int c, int, int) { return c < kWide / 2 ? 60U : 130U; };
  makeClip(folder_ / "depth.mkv", {depth});
  ClipTrack all{.codec = "png", .pix_fmt = "gray", .width = kWide, .height = kHigh, .frames = 1};
  all.sample = [](int, int, int, int) { return 255U; };
  makeClip(folder_ / "all.png", {all});
  static_cast<void>(author({{"all.png", kFrom / 30.0}}, {}));
  const test::ReadFilm film = readFilm(folder_ / "film.mkv");
  EXPECT_NEAR(at(film, kFrom - 1, 80, 60).stiffness, 128.0 / 255, 0.01);
  EXPECT_NEAR(at(film, kFrom, 80, 60).stiffness, 1, 0.01);
}

TEST_F(PaintedFilm, AFilmThatIsMadeAgainKeepsItsTrack) {
  static_cast<void>(author("map.png", {}));
  SourceOptions source;
  source.url = folder_ / "film.mkv";
  EXPECT_EQ(author(source, {}, "again.mp4").format.material_scale, "stiffness=1,friction=0.6/0.5,texture=0.2@0.8");
  const test::ReadFilm again = readFilm(folder_ / "again.mp4");
  EXPECT_NEAR(at(again, 10, centreX(10), centreY(10)).stiffness, 0.8, 0.01);
  EXPECT_NEAR(at(again, 10, 20, 100).stiffness, 128.0 / 255, 0.01);
}

TEST_F(PaintedFilm, AFileThatIsNoPictureIsNamed) {
  SourceOptions source;
  source.url = folder_ / "color.mkv";
  source.depth_url = folder_ / "depth.mkv";
  OutputOptions output;
  output.path = folder_ / "film.mkv";
  output.paintings = {{.path = folder_ / "none.png"}};
  const std::atomic<bool> stop{false};
  const auto made = authorFilm(source, kFfmpeg, output, stop, [](std::uint64_t, std::optional<std::uint64_t>) {});
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().thing, output.paintings[0].path);
}

}  // namespace
}  // namespace relievo
