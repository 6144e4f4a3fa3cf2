// SPDX-License-Identifier: Apache-2.0
// What relievo-author measures while it writes, against the film as it is read back; and films too far from their
// source.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/height_field.h"
#include "tests/scenario/author/author_film.h"

namespace relievo {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

constexpr int kCols = 64, kRows = 48;  // so small that every sample is compared

// Waves with holes between them; 16 bits.
std::uint32_t waves(int c, int r, int k) {
  if ((c / 8 + r / 8) % 7 == 0) return 0;
  return static_cast<std::uint32_t>(30'000 + 20'000 * std::sin(0.2 * c + 0.3 * k) * std::cos(0.15 * r));
}

struct Coded {
  const char* ending;
  VideoCodec codec = VideoCodec::H264;
  int bits = 8;
  int crf = 8;
  std::optional<DepthLaw> law{};
};
void PrintTo(const Coded& coded, std::ostream* out) {
  *out << coded.ending << " " << name(coded.codec) << " " << coded.bits << " bits, crf " << coded.crf
       << (coded.law ? ", inverse" : "");
}

class AuthorDepthCheck : public AuthorFilm, public testing::WithParamInterface<Coded> {};

// In N, of 0.5 N/mm and a box 40 mm deep.
double errorOf(std::vector<double>& heights_mm, double share) {
  std::ranges::sort(heights_mm);
  return 0.5 * heights_mm[static_cast<std::size_t>(share * static_cast<double>(heights_mm.size() - 1))];
}

TEST_P(AuthorDepthCheck, MeasuresTheFilmAsItIsReadBack) {
  const Coded coded = GetParam();
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray16le", waves)});
  const SourceOptions source{
      .url = folder_ / "color.mkv",
      .depth_url = folder_ / "depth.mkv",
      .command_line = {{"polarity", "near-high"}, {"invalid", "0"}, {"near", "500"}, {"far", "3000"}}};
  const std::string path = folder_ / (std::string("out") + coded.ending);
  const auto summary = authorFilm(
      source, kFfmpeg,
      {.path = path, .depth = {.codec = coded.codec, .bits = coded.bits, .law = coded.law, .crf = coded.crf}}, stop_,
      kNoReport);
  ASSERT_TRUE(summary) << summary.error().thing << ": " << summary.error().error.message;

  const Film film = readFilm(path);
  ASSERT_EQ(film.pairs.size(), 30u);
  const DisplayVolume box = DisplayVolume::forPicture(kCols, kRows);
  std::vector<double> errors;
  double holes = 0, samples = 0;
  for (std::size_t k = 0; k < film.pairs.size(); ++k) {
    const auto field = HeightField::make(film.pairs[k].depth, film.info.calibration.calibration, box);
    ASSERT_TRUE(field);
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c, ++samples) {
        const double height = field->heightMm(c, r);
        holes += std::isnan(height) ? 1 : 0;
        const std::uint32_t code = waves(c, r, static_cast<int>(k));
        if (code != 0 && !std::isnan(height)) errors.push_back(std::abs(height - 40.0 * code / 65535));
      }
    }
  }
  const DepthLoss& loss = summary->loss;
  EXPECT_NEAR(loss.all.quantile(0.5), errorOf(errors, 0.5), 0.0011);
  EXPECT_NEAR(loss.all.quantile(0.99), errorOf(errors, 0.99), 0.0011);
  EXPECT_NEAR(loss.film.holes(), holes / samples, 1e-9);
  EXPECT_GT(loss.source.holes(), 0.1);
  if (coded.crf == 0) {
    EXPECT_EQ(loss.coding.quantile(1), 0);
    EXPECT_EQ(loss.coding.moved(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, AuthorDepthCheck,
                         testing::Values(Coded{".mkv"}, Coded{".mp4", VideoCodec::H264, 10},
                                         Coded{".mkv", VideoCodec::H264, 8, 0}, Coded{".ts", VideoCodec::Hevc, 12},
                                         Coded{".m3u8", VideoCodec::Hevc, 10}, Coded{".mkv", VideoCodec::Ffv1, 16, 0},
                                         Coded{".mov", VideoCodec::H264, 10, 8, DepthLaw::Inverse}));

class AuthorDepthTooFar : public AuthorFilm {};

// 40 mm deep, 0.5 N/mm: 25,828 of 65,535 are 7.8822 N, and 100 of 255 are 7.8431 N.
TEST_F(AuthorDepthTooFar, RoundingIsToldInNewtons) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray16le", [](int, int, int) { return 25'828u; })});
  const auto said = run(
      "--color @/color.mkv --depth @/depth.mkv -o @/out.mkv --depth-crf 0 --calibration polarity=near-high,unit=none");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("measured in the film: force off by 0.039 N in the median, 0.039 N at p99, rounding "
                                  "0.039 and 0.039, coding 0.000 and 0.000\n"));
  EXPECT_THAT(said.out,
              HasSubstr("holes 0.0 %, in the source 0.0 %; at an end of the range 0.0 %, in the source 0.0 %\n"));
}

// Noise over the whole range at the worst quality.
TEST_F(AuthorDepthTooFar, CodingThatMovesTheReliefFailsTheRun) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int c, int r, int k) {
             return static_cast<std::uint32_t>((c * 7919 + r * 104'729 + k * 1299) % 251);
           })});
  const std::string words = "--color @/color.mkv --depth @/depth.mkv -o @/out.mkv --force --depth-crf ";
  const auto failed = run(words + "51");
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("out.mkv: coding changes the force"));
  EXPECT_THAT(failed.err, EndsWith("try --depth-crf 0\n"));
  EXPECT_EQ(readFilm(folder_ / "out.mkv").pairs.size(), 30u) << "the film is there all the same";
  const auto exact = run(words + "0");
  EXPECT_EQ(exact.exit_code, 0) << exact.err;
  EXPECT_THAT(exact.out, HasSubstr("force off by 0.000 N in the median, 0.000 N at p99"));
}

// Of distances of 1.8 to 9.8 m as disparities, a step of 8 bits is up to 1.2 m.
TEST_F(AuthorDepthTooFar, CodesThatAreTooCoarseFailTheRun) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv",
           {depthTrack("gray16le", [](int c, int, int) { return static_cast<std::uint32_t>(9000 + 13 * c); })});
  const std::string words =
      "--color @/color.mkv --depth @/depth.mkv -o @/out.mkv --force --depth-crf 0 --depth-law inverse --calibration "
      "unit=1,near=100,far=10000";
  const auto failed = run(words);
  EXPECT_EQ(failed.exit_code, 1) << failed.out;
  EXPECT_THAT(failed.err, HasSubstr("out.mkv: its codes are too coarse for the depth"));
  const auto fine = run(words + " --depth-codec ffv1 --depth-bits 16");
  EXPECT_EQ(fine.exit_code, 0) << fine.err;
}

// Five of six samples are holes, as of a laser: with the default coding they stay holes, and depth stays depth.
TEST_F(AuthorDepthTooFar, ScatteredHolesStayHoles) {
  const auto isHole = [](int c, int r, int k) { return (c * 7919 + r * 104'729 + k * 1299) % 6 != 0; };
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray16le", [&](int c, int r, int k) {
             return isHole(c, r, k) ? 0u : static_cast<std::uint32_t>(1000 + 60 * r + c);
           })});
  const auto said =
      run("--color @/color.mkv --depth @/depth.mkv -o @/out.mkv --calibration unit=1,invalid=0,near=900,far=4000");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  const Film film = readFilm(folder_ / "out.mkv");
  int moved = 0, samples = 0;
  for (std::size_t k = 0; k < film.pairs.size(); ++k) {
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c, ++samples) {
        const auto code = static_cast<std::uint32_t>(film.code(k, c, r));
        moved += film.info.calibration.calibration.invalid.contains(code) != isHole(c, r, static_cast<int>(k)) ? 1 : 0;
      }
    }
  }
  EXPECT_LT(moved, 0.02 * samples) << said.out;
}

TEST_F(AuthorDepthTooFar, EnhancementIsAStepOfItsOwn) {
  DepthLoss loss;
  for (int i = 0; i < 100; ++i) {
    loss.enhancing.add(10, 12.5F);  // 1.25 N
    loss.rounding.add(12.5F, 12.5F);
  }
  ASSERT_NE(whyTooFar(loss), nullptr);
  EXPECT_THAT(whyTooFar(loss), EndsWith("leave out --enhance"));
}

// It is sent in real time.
TEST_F(AuthorDepthTooFar, AStreamIsNotMeasured) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int c, int, int) { return static_cast<std::uint32_t>(c); })});
  const auto said = run("--color @/color.mkv --depth @/depth.mkv -o udp://127.0.0.1:9");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("depth codes"));
  EXPECT_THAT(said.out, Not(HasSubstr("measured in the film")));
}

}  // namespace
}  // namespace relievo
