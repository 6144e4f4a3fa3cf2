// SPDX-License-Identifier: Apache-2.0
// Subtitles over a picture that stands while the film goes on, as in a slide show.
#include <gtest/gtest.h>
#include <malloc.h>

#include "app/player/screen/film_screen.h"
#include "drivers/egl/egl.h"
#include "platform/log.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr auto kMs = std::chrono::milliseconds(1);

class SubtitlesOfAStandingPicture : public testing::Test {
 protected:
  void SetUp() override {
    setLogLevel(LogLevel::Error);
    if (!AssText::create()) GTEST_SKIP() << "no font here";
    if (const auto opened = screen_.open(stop_); !opened) GTEST_SKIP() << opened.error().message;
    screen_.subtitles().add({.begin = mediaTime(2),
                             .end = mediaTime(3),
                             .lines = {"0,0,Default,,0,0,0,,hello"},
                             .styles = std::make_shared<const std::string>("[Script Info]\nPlayResY: 64\n")});
  }
  // A picture of the film's beginning, shown when the film is at `place`.
  [[nodiscard]] bool hasWordsWhenShownAt(double place_s) {
    const Frame picture = test::makeGrayFrame(8, 8, 8, MediaTime{}, [](int, int) { return 100; });
    EXPECT_TRUE(screen_.show({.color = picture}, mediaTime(place_s), {}, {}, {}, clock_.now()));
    return hasWords();
  }
  [[nodiscard]] bool hasWordsAt(double place_s, Duration later, MonotonicTime next = MonotonicTime::max()) {
    clock_.sleepUntil(clock_.now() + later);
    EXPECT_TRUE(screen_.redraw({}, mediaTime(place_s), next, clock_.now()));
    return hasWords();
  }
  [[nodiscard]] bool hasWords() const { return !screen_.subtitles().pictures().empty(); }

  ManualClock clock_;
  std::atomic<bool> stop_{false};
  Journal journal_{clock_};
  FileWriter files_{FileWriter::Where::AtOnce};
  std::unique_ptr<Display> display_ = makeOffscreenDisplay({}, clock_);
  FilmScreen screen_{*display_, {.width = 64, .height = 64}, {}, true, clock_, journal_, files_};
};

TEST_F(SubtitlesOfAStandingPicture, ComeAndGoAtTheirTimes) {
  EXPECT_FALSE(hasWordsWhenShownAt(0));
  EXPECT_FALSE(hasWordsAt(1.9, 1900 * kMs));
  EXPECT_TRUE(hasWordsAt(2.1, 200 * kMs));
  EXPECT_TRUE(hasWordsAt(2.9, 800 * kMs));
  EXPECT_FALSE(hasWordsAt(3.1, 200 * kMs));
}

TEST_F(SubtitlesOfAStandingPicture, ComeWhileAFingerMoves) {
  EXPECT_FALSE(hasWordsWhenShownAt(0));
  for (int i = 1; i <= 5; ++i) {
    clock_.sleepUntil(clock_.now() + 500 * kMs);
    const FingerMarks finger{FingerMark{.position_mm = {i, 0, 0}}};
    EXPECT_TRUE(screen_.redraw(finger, mediaTime(0.5 * i), MonotonicTime::max(), clock_.now()));
  }
  EXPECT_TRUE(hasWords());
}

// As after a seek.
TEST_F(SubtitlesOfAStandingPicture, AreThoseOfThePlaceWhereItIsShown) {
  EXPECT_TRUE(hasWordsWhenShownAt(2.5));
  EXPECT_FALSE(hasWordsWhenShownAt(3.5));
}

TEST_F(SubtitlesOfAStandingPicture, StayWhileTheFilmHasNoPlace) {
  EXPECT_TRUE(hasWordsWhenShownAt(2.5));
  EXPECT_TRUE(hasWordsAt(0, 1000 * kMs));
}

TEST_F(SubtitlesOfAStandingPicture, WaitForAPictureThatComesSoon) {
  EXPECT_FALSE(hasWordsWhenShownAt(0));
  EXPECT_FALSE(hasWordsAt(2.1, 2100 * kMs, clock_.now() + 2120 * kMs));
}

// Before its first picture the drawing is tried several times; nothing is left of the reliefs that came in the film
// before. Their memory is unmapped when it is freed, so that a use of it ends the test.
TEST_F(SubtitlesOfAStandingPicture, StandInFrontOfTheirOwnFilmAlone) {
  ::mallopt(M_MMAP_THRESHOLD, 8192);
  for (const double width_mm : {160.0, 90.0}) {
    const auto depth = [](int k) {
      return test::makeGrayFrame(64, 64, 8, mediaTime(2 + 0.04 * k), [](int c, int) { return 3 * c; });
    };
    DepthComing coming{.count = width_mm == 160 ? 8U : 0U};
    for (int k = 0; k < 8; ++k) coming.frames[static_cast<std::size_t>(k)] = depth(k + 1);
    screen_.setScene({.bits = 8}, {width_mm, 90, 40}, false, 40 * kMs, clock_.now());
    EXPECT_TRUE(screen_.show({.color = depth(0), .depth = depth(0)}, mediaTime(2.5), {}, coming, {}, clock_.now()));
    EXPECT_TRUE(hasWords());
  }
}

// The journal's faults are told on the screen.
TEST_F(SubtitlesOfAStandingPicture, NameALetterThatNoFontHas) {
  screen_.subtitles().add({.begin = mediaTime(4),
                           .end = mediaTime(5),
                           .lines = {"1,0,Default,,0,0,0,,\xf4\x8f\xbf\xb4"},
                           .styles = std::make_shared<const std::string>("[Script Info]\nPlayResY: 64\n")});
  EXPECT_TRUE(hasWordsWhenShownAt(4.5)) << "a box";
  EXPECT_TRUE(hasWordsWhenShownAt(4.6));
  const auto& faults = journal_.written().faults;
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].what, "no font here has the letter U+10FFF4");
  EXPECT_EQ(faults[0].count, 1u) << "once";
}

// 40 ms after the picture that was drawn for the words; its end lies 10 ms behind that.
TEST_F(SubtitlesOfAStandingPicture, AreDrawnThirtyTimesASecondAtMost) {
  EXPECT_FALSE(hasWordsWhenShownAt(0));
  EXPECT_TRUE(hasWordsAt(2.99, 2990 * kMs));
  EXPECT_TRUE(hasWordsAt(3, 10 * kMs)) << "too soon";
  EXPECT_FALSE(hasWordsAt(3.03, 30 * kMs));
}

}  // namespace
}  // namespace relievo
