// SPDX-License-Identifier: Apache-2.0
// relievo-author on films of one view: a pan, a cut and a zoom over still scenes, from end to end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <tuple>
#include <vector>

#include "app/author/author.h"
#include "app/media/pair_reader.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ffmpeg_backends.h"
#include "tests/support/film/still_scene.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::ReliefEnds;
using test::StillScene;
using test::StillView;
using test::TemporaryFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr int kCols = 160, kRows = 90, kPan = 28, kZoom = 24, kPictures = kPan + kZoom;
const std::string kMock =
    std::string("python3 " RELIEVO_SOURCE_DIR "/tests/programs/mock_estimator.py ") + std::to_string(kPictures);

// Blue is the inverse depth, which is all that the mock estimator looks at.
double blueOf(double depth) {
  return 255 * depth;
}

class AuthorOneView : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::atomic<bool> stop_{false};
  std::vector<StillView> views_;

  void SetUp() override {
    for (int k = 0; k < kPan; ++k) views_.emplace_back(StillScene{.seed = 1}, test::pan(k), kCols, kRows);
    for (int k = 0; k < kZoom; ++k) views_.emplace_back(StillScene{.seed = 77}, test::zoom(k), kCols, kRows);
    makeClip(folder_ / "in.mkv", {{.pix_fmt = "bgr0",
                                   .width = kCols,
                                   .height = kRows,
                                   .frames = kPictures,
                                   .sample = [this](int component, int c, int r, int k) {
                                     const StillView& view = views_[static_cast<std::size_t>(k)];
                                     const auto i = static_cast<std::size_t>(r) * kCols + static_cast<std::size_t>(c);
                                     return component == 2
                                                ? static_cast<std::uint32_t>(std::lround(blueOf(view.depth[i])))
                                                : std::uint32_t{view.light[i]};
                                   }}});
  }
  Outcome<AuthorSummary> make(const std::string& how, const std::string& film = "in.mkv") {
    return authorFilm({.url = folder_ / film}, kFfmpeg,
                      {.path = folder_ / "out.mkv",
                       .color_crf = 0,
                       .depth = {.codec = VideoCodec::Ffv1, .bits = 16, .crf = 0},
                       .from_one_view = OneViewWishes{how, {}}},
                      stop_, [](std::uint64_t, std::optional<std::uint64_t>) {});
  }
  // The nearest and the farthest depth of the scene, as each picture of the film shows them.
  [[nodiscard]] std::vector<ReliefEnds> endsInFilm() const {
    std::vector<ReliefEnds> ends;
    PairReader reader(kFfmpeg);
    EXPECT_TRUE(reader.open({.url = folder_ / "out.mkv"}).has_value());
    for (auto pair = reader.next(); pair && *pair && ends.size() < kPictures; pair = reader.next()) {
      ends.push_back(test::endsOf(views_[ends.size()], (*pair)->depth));
    }
    return ends;
  }
};

// What the mock's own depth shows, by its formula.
std::vector<ReliefEnds> endsOfMock(int first, int pictures) {
  std::vector<ReliefEnds> ends;
  for (int k = first; k < first + pictures; ++k) {
    const double gone = static_cast<double>(k) / kPictures;
    const double scale = 60 * (1 + 0.2 * gone) * (1 + 0.05 * std::sqrt(2) * std::sin(2.3 * k));
    const double offset = 8000 + 60 * 204 * (0.2 * gone + 0.05 * std::sqrt(2) * std::cos(1.7 * k));
    ends.push_back({scale * blueOf(StillScene::kFar) + offset, scale * blueOf(StillScene::kNear) + offset});
  }
  return ends;
}

TEST_F(AuthorOneView, ADriftingFlickeringLateEstimatorMakesASteadyFilm) {
  const auto summary = make(kMock);
  ASSERT_TRUE(summary.has_value()) << summary.error().thing << ": " << summary.error().error.message;
  EXPECT_EQ(summary->totals.depth.frames, static_cast<std::uint64_t>(kPictures));
  EXPECT_THAT(summary->notes, Contains(AllOf(HasSubstr("made steady over 2 shots"), HasSubstr("%"))));
  EXPECT_EQ(summary->format.depth_tags.at("DEPTH_LAW"), "linear");
  EXPECT_EQ(summary->format.depth_tags.at("DEPTH_LIKELY"), "polarity");
  EXPECT_EQ(summary->format.depth_tags.at("DEPTH_ASSUMED"), "law,near,far");
  EXPECT_THAT(summary->format.depth_tags.at("DEPTH_READ_AS"), HasSubstr("guessed from one view"));
  const std::vector<ReliefEnds> ends = endsInFilm();
  ASSERT_EQ(ends.size(), static_cast<std::size_t>(kPictures));
  for (const auto& [first, count] : {std::pair(0, kPan), std::pair(kPan, kZoom)}) {
    const auto before = test::unrestOf(endsOfMock(first, count));
    const auto after = test::unrestOf({ends.begin() + first, ends.begin() + first + count});
    const double quieter_db = 20 * std::log10(before.flicker / after.flicker);
    std::printf("drift %.2f %% -> %.3f %%, flicker %.2f %% -> %.3f %%: %.1f dB down\n", 100 * before.drift,
                100 * after.drift, 100 * before.flicker, 100 * after.flicker, quieter_db);
    EXPECT_GT(before.drift, 0.04);
    EXPECT_LT(after.drift, 0.01);
    EXPECT_GT(quieter_db, 20);
  }
  // Before and after the cut every picture is of its own scene, to a hundredth of the relief.
  for (const ReliefEnds& end : ends) EXPECT_LT(end.rest, 0.01);

  std::filesystem::rename(folder_ / "out.mkv", folder_ / "has-depth.mkv");
  const auto again = make(kMock, "has-depth.mkv");
  ASSERT_FALSE(again.has_value());
  EXPECT_THAT(again.error().error.message, HasSubstr("has depth, in it or in a file beside it"));
}

// Writes the same for each picture: `code`, of the row r.
std::string writing(const std::string& code) {
  return "python3 -c 'import os, sys; w, h = (int(os.environ[k]) for k in (\"RELIEVO_WIDTH\", \"RELIEVO_HEIGHT\")); "
         "sys.stdin.buffer.read(); [sys.stdout.buffer.write((" +
         code + ").to_bytes(2, \"little\") * w) for _ in range(" + std::to_string(kPictures) + ") for r in range(h)]'";
}

TEST_F(AuthorOneView, DoubtsDepthThatIsFlatOrNearerAbove) {
  const auto flat = Contains(HasSubstr("is one code")), above = Contains(HasSubstr("nearer above than below"));
  for (const auto& [code, is_flat, is_above] :
       {std::tuple("0", true, false), {"9000 - 90 * r", false, true}, {"900 + 90 * r", false, false}}) {
    std::filesystem::remove(folder_ / "out.mkv");
    const auto summary = make(writing(code));
    ASSERT_TRUE(summary.has_value()) << summary.error().thing << ": " << summary.error().error.message;
    EXPECT_EQ(testing::Value(summary->notes, flat), is_flat) << code;
    EXPECT_EQ(testing::Value(summary->notes, above), is_above) << code;
  }
}

TEST_F(AuthorOneView, AGrayFilmIsNotTakenForDepth) {
  makeClip(folder_ / "gray.mkv", {{.pix_fmt = "gray",
                                   .width = kCols,
                                   .height = kRows,
                                   .frames = kPictures,
                                   .sample = [this](int, int c, int r, int k) -> std::uint32_t {
                                     return views_[static_cast<std::size_t>(k)]
                                         .light[static_cast<std::size_t>(r) * kCols + static_cast<std::size_t>(c)];
                                   }}});
  const auto as_depth = Contains(HasSubstr("--packing depth-alone"));
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder_ / "gray.mkv"}).has_value());
  EXPECT_THAT(reader.info().notes, as_depth);
  const auto summary = make(writing("900 + 90 * r"), "gray.mkv");
  ASSERT_TRUE(summary.has_value()) << summary.error().thing << ": " << summary.error().error.message;
  EXPECT_THAT(summary->notes, testing::Not(as_depth));
}

TEST_F(AuthorOneView, RefusesInOneLineAndLeavesNoFilm) {
  const auto failed = make("head -c 100; echo out of paper >&2; exit 4");
  ASSERT_FALSE(failed.has_value());
  EXPECT_THAT(failed.error().thing, AllOf(HasSubstr("exit code 4"), HasSubstr("(out of paper)")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.mkv"));
}

}  // namespace
}  // namespace relievo
