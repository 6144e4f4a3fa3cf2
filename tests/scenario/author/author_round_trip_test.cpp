// SPDX-License-Identifier: Apache-2.0
// A film through every container and codec of the author: the player reads the same codes and timestamps that went in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "app/author/package/film_writer.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/film_ways.h"
#include "tests/support/network/loopback.h"

namespace relievo {
namespace {

using test::colorPicture;
using test::formatOf;
using test::kWays;
using test::ReadFilm;
using test::readFilm;
using test::TemporaryFolder;
using test::Way;

constexpr Duration kPeriod = std::chrono::nanoseconds(1'000'000'000 / 30);

constexpr const char* kMaterial = "stiffness=0.3,friction=0.2/0.15,texture=0.1@0.8";
constexpr int kCols = test::kWayCols, kRows = test::kWayRows;

// The full range in every picture, without pattern (a multiplicative hash); the first sample identifies the picture.
std::uint32_t scattered(int c, int r, int k, int bits) {
  if (c == 0 && r == 0) return static_cast<std::uint32_t>(k & 255);
  if (c == 1 && r == 0) return 0;
  if (c == 2 && r == 0) return (1u << bits) - 1;
  const auto n = static_cast<std::uint32_t>(c + 1000 * r + 1'000'000 * k);
  return (n * 2654435761u) >> (32 - bits);
}
DepthPicture scatteredPicture(int k, int bits) {
  DepthPicture picture{kCols, kRows, {}};
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) picture.codes.push_back(static_cast<std::uint16_t>(scattered(c, r, k, bits)));
  }
  return picture;
}

void expectPicture(const Frame& depth, int k, int bits) {
  ASSERT_EQ(depth.width, kCols);
  ASSERT_EQ(depth.height, kRows);
  EXPECT_EQ(depth.range, ColorRange::Full);
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      ASSERT_EQ(test::sampleAt(depth, 0, c, r), scattered(c, r, k, bits)) << c << "," << r << " of " << k;
    }
  }
}

void expectMeaning(const FilmInfo& info, const DepthCalibration& meant) {
  const DepthCalibration& c = info.calibration.calibration;
  EXPECT_TRUE(info.has_depth);
  EXPECT_EQ(info.calibration.origin, CalibrationOrigin::ContainerTags) << info.calibration.explanation;
  EXPECT_EQ(c.law, meant.law);
  EXPECT_EQ(c.polarity, meant.polarity);
  EXPECT_EQ(c.range, ColorRange::Full);
  EXPECT_EQ(c.bits, meant.bits);
  EXPECT_EQ(c.invalid, meant.invalid);
  EXPECT_EQ(c.near_mm, meant.near_mm);
  EXPECT_EQ(c.far_mm, meant.far_mm);
}

DepthCalibration meaningOf(const Way& way) {
  return {.law = DepthLaw::Inverse, .bits = way.bits, .invalid = 0, .near_mm = 412.5, .far_mm = 3100};
}

class AuthorRoundTrip : public testing::TestWithParam<Way> {
 protected:
  TemporaryFolder folder_;
  [[nodiscard]] std::string path() const { return folder_ / (std::string("film") + GetParam().ending); }
};

TEST_P(AuthorRoundTrip, BringsBackCodesTimesAndMeaning) {
  const Way way = GetParam();
  std::vector<MediaTime> times;  // with a gap and uneven steps
  for (const int ms : {0, 33, 67, 100, 400, 417, 500, 533, 567, 600}) times.emplace_back(std::chrono::milliseconds(ms));
  {
    FilmFormat format = formatOf(way, 0, meaningOf(way));
    format.depth_tags[kMaterialTag] = kMaterial;
    auto writer = FilmWriter::create(path(), format);
    ASSERT_TRUE(writer) << writer.error().message;
    for (int k = 0; k < static_cast<int>(times.size()); ++k) {
      const MediaTime time = times[static_cast<std::size_t>(k)];
      ASSERT_TRUE((*writer)->writeColor(colorPicture(kCols, kRows, k), time, k == 0));
      ASSERT_TRUE((*writer)->writeDepth(scatteredPicture(k, way.bits), time, k == 0));
    }
    const auto totals = (*writer)->finish();
    ASSERT_TRUE(totals) << totals.error().message;
    EXPECT_GT(totals->file_bytes, totals->color.bytes + totals->depth.bytes);
  }
  const ReadFilm film = readFilm(path());
  expectMeaning(film.info, meaningOf(way));
  EXPECT_EQ(materialText(film.info.material), kMaterial);
  ASSERT_EQ(film.pairs.size(), times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_NEAR(toSeconds(film.pairs[k].color.pts), toSeconds(times[k]), 12e-6) << k;
    ASSERT_FALSE(film.pairs[k].depth.empty()) << k;
    EXPECT_EQ(film.pairs[k].depth.pts, film.pairs[k].color.pts) << k;
    expectPicture(film.pairs[k].depth, static_cast<int>(k), way.bits);
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, AuthorRoundTrip, testing::ValuesIn(kWays));

// A receiver may join a network stream at any time: it begins with a key frame and knows the calibration.
class AuthorLine : public testing::TestWithParam<Way> {};

TEST_P(AuthorLine, ReachesWhoComesLater) {
  const Way way = GetParam();
  const std::string url =
      std::string(way.ending) + "://127.0.0.1:" + std::to_string(test::portOf(test::bindLoopback(SOCK_DGRAM)));
  const bool is_srt = std::string_view(way.ending) == "srt";
  std::atomic<bool> enough{false};
  ReadFilm film;
  std::thread reader([&] {
    film = readFilm(is_srt ? url + "?mode=listener" : url, 20);
    enough = true;
  });
  {
    auto writer = FilmWriter::create(url, formatOf(way, 0, meaningOf(way)));
    EXPECT_TRUE(writer) << writer.error().message;
    Result<void> sent;
    for (int k = 0; writer && sent && (is_srt || !enough) && k < 30 * 60; ++k) {
      const MediaTime time(kPeriod * k);
      sent = (*writer)->writeColor(colorPicture(kCols, kRows, k), time, k % 15 == 0);
      if (sent) sent = (*writer)->writeDepth(scatteredPicture(k, way.bits), time, k % 15 == 0);
    }
    EXPECT_EQ(sent.has_value(), !is_srt) << "over SRT a receiver that has had enough ends the line";
    if (!sent) {
      EXPECT_THAT(sent.error().message, testing::HasSubstr("the receiver has gone"));
    }
  }
  reader.join();
  expectMeaning(film.info, meaningOf(way));
  ASSERT_EQ(film.pairs.size(), 20u);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < film.pairs.size(); ++i) {
    const Frame& depth = film.pairs[i].depth;
    if (depth.empty()) continue;  // before its first key frame
    ++seen;
    const int k = static_cast<int>(test::sampleAt(depth, 0, 0, 0));
    EXPECT_NEAR(toSeconds(depth.pts - film.pairs[0].color.pts), toSeconds(kPeriod) * static_cast<double>(i), 1e-4) << i;
    for (const auto& [c, r] : {std::pair{1, 0}, {2, 0}, {95, 63}, {40, 20}}) {
      // The first sample gives k modulo 256.
      const auto code = test::sampleAt(depth, 0, c, r);
      bool found = false;
      for (int turn = 0; turn < 8 && !found; ++turn) found = code == scattered(c, r, k + 256 * turn, way.bits);
      EXPECT_TRUE(found) << c << "," << r << " of " << k;
    }
  }
  EXPECT_GE(seen, 10u);
}

INSTANTIATE_TEST_SUITE_P(Ways, AuthorLine, testing::Values(Way{"udp"}, Way{"udp", VideoCodec::Hevc, 10}, Way{"srt"}));

}  // namespace
}  // namespace relievo
