// SPDX-License-Identifier: Apache-2.0
// The screen alone: when it draws, what it counts and what it notes, on a display that shows nothing.
#include "app/player/screen/film_screen.h"

#include <gtest/gtest.h>

#include "drivers/egl/egl.h"
#include "drivers/mock/mock.h"
#include "platform/log.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/player/film_screen_stage.h"

namespace relievo {
namespace {

using test::kMs;

class FilmScreenTest : public test::FilmScreenStage {};

struct Wish {
  StereoSignals taken;
  StereoSignal wished;
  StereoLayout layout;  // of --stereo
  const char* shown;
  const char* told;  // null: nothing
};

TEST_F(FilmScreenTest, ThePictureLiesAsTheSignalSaysThatTheTelevisionTakes) {
  using enum StereoSignal;
  constexpr StereoSignals kNone, kAll{true, true, true}, kHalves{.side_by_side_half = true},
      kMandatory{.top_and_bottom = true, .frame_packing = true};
  const Wish wishes[] = {
      {kAll, FramePacking, StereoLayout::Mono, "frame-packing", nullptr},
      {kAll, TopAndBottom, StereoLayout::Mono, "tab", nullptr},
      {kAll, SideBySideHalf, StereoLayout::Mono, "sbs", nullptr},
      {kMandatory, SideBySideHalf, StereoLayout::Mono, "frame-packing", "takes no side by side"},
      {kHalves, FramePacking, StereoLayout::FramePacking, "sbs", "takes no frame packing"},
      {kNone, FramePacking, StereoLayout::FramePacking, "sbs", "takes no frame packing"},
      {kNone, FramePacking, StereoLayout::Mono, "mono", "takes no frame packing"},
      {kNone, TopAndBottom, StereoLayout::SideBySide, "sbs", "takes no top and bottom"},
  };
  for (const Wish& wish : wishes) {
    SCOPED_TRACE(wish.shown);
    const auto television = makeMockDisplay({.refresh_period = Duration(0), .stereo = wish.taken}, clock_);
    Journal journal(clock_);
    FilmScreen screen(*television, {.stereo = wish.wished, .other_stereo = true}, {.layout = wish.layout}, true, clock_,
                      journal, files_);
    ASSERT_TRUE(screen.open(stop_));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(screen.show({}, {}, {}, {}, {}, clock_.now()));
    PlayReport report;
    screen.describe(report);
    EXPECT_EQ(report.stereo, wish.shown);
    const auto& faults = journal.written().faults;
    ASSERT_EQ(faults.size(), wish.told == nullptr ? 0U : 1U);
    if (wish.told == nullptr) continue;
    EXPECT_NE(faults[0].what.find(wish.told), std::string::npos) << faults[0].what;
    EXPECT_EQ(faults[0].count, 1U) << "once";
    EXPECT_EQ(faults[0].done, std::string("shown as ") + wish.shown);
  }
}

// The mode of such a size may be one that the viewer has made.
TEST_F(FilmScreenTest, ASurfaceOfItsSizeNeedsNoSignalForFramePacking) {
  for (const auto& [width, height] : {std::pair{1920, 2205}, {1280, 1470}, {3840, 1080}, {2560, 720}}) {
    config_ = {.width = width, .height = height, .stereo = StereoSignal::FramePacking, .other_stereo = true};
    stereo_ = {.layout = StereoLayout::FramePacking};
    make();
    EXPECT_TRUE(show());
    EXPECT_EQ(report().stereo, "frame-packing");
  }
  EXPECT_TRUE(journal_.written().faults.empty());
}

TEST_F(FilmScreenTest, WhileASignalIsSentTheLayoutStays) {
  profile_.stereo = {.top_and_bottom = true};
  config_.stereo = StereoSignal::TopAndBottom;
  make();
  EXPECT_TRUE(show());
  screen_->obey({.verb = PlayerVerb::Layout, .value = 0, .word = ""});
  EXPECT_TRUE(show());
  EXPECT_EQ(report().stereo, "tab");
  EXPECT_TRUE(noted("--tv-signal off"));
}

TEST_F(FilmScreenTest, AFilmThatTakesLongToOpenIsNamedBeforeItsFirstPicture) {
  make();
  for (const int presented : {0, 0, 1}) {  // after 0, 3 and 6 s
    screen_->write({.title = "a.mkv", .state = PlayerState::Opening}, MonotonicTime::max(), clock_.now());
    EXPECT_EQ(redraw({}, 3000 * kMs), presented);
  }
  EXPECT_EQ(screen_->text().noticed(clock_.now() - 3000 * kMs), "Opening a.mkv");
}

TEST_F(FilmScreenTest, TheFirstHintLastsFromTheFirstPictureOnHoweverSlowlyThatIsDrawn) {
  const auto hint = [&](Duration later) { return screen_->text().content({}, {}, clock_.now() + later).hint; };
  make();
  screen_->setFirstHint("press");
  drawing_ = 5000 * kMs;
  EXPECT_TRUE(show());
  EXPECT_EQ(hint(1900 * kMs), "press");
  EXPECT_TRUE(screen_->text().showsBar({}, clock_.now() + 3900 * kMs));
  EXPECT_TRUE(show());
  EXPECT_EQ(hint(Duration(0)), "") << "once";
}

// Elsewhere many small pictures are of no use.
TEST_F(FilmScreenTest, AQuiltIsAmongTheLayoutsOnceItWasAskedFor) {
  const auto next = [&](const char* word) {
    screen_->obey({.verb = PlayerVerb::Layout, .value = 0, .word = word});
    return std::string(report().stereo);
  };
  stereo_ = {.layout = StereoLayout::Anaglyph};
  make();
  EXPECT_TRUE(show());
  EXPECT_EQ(next(""), "mono");
  EXPECT_EQ(next("quilt"), "quilt:8x6");
  EXPECT_EQ(next("anaglyph"), "anaglyph");
  EXPECT_EQ(next(""), "quilt:8x6");
  stereo_ = {.layout = StereoLayout::Quilt};
  make();
  EXPECT_TRUE(show());
  EXPECT_EQ(next("anaglyph"), "anaglyph");
  EXPECT_EQ(next(""), "quilt:8x6");
}

TEST_F(FilmScreenTest, WithoutTextOverThePictureTheKeysAreInTheProgramsHelp) {
  osd_ = false;
  make();
  screen_->turnKeys({{"q", "end the program"}});
  EXPECT_FALSE(screen_->text().showsKeys());
  EXPECT_EQ(screen_->text().noticed(clock_.now()), "All keys: relievo play --help");
}

TEST_F(FilmScreenTest, CountsWhatWasSeenAndWhatWasNot) {
  make();
  EXPECT_EQ(screen_->firstShown(), std::nullopt);
  clock_.sleepUntil(clock_.now() + 5 * kMs);
  EXPECT_TRUE(show());
  EXPECT_EQ(screen_->firstShown(), clock_.now());
  cable_->unplugged = true;
  EXPECT_FALSE(show());
  EXPECT_TRUE(noted("display lost"));
  cable_->unplugged = false;
  clock_.sleepUntil(clock_.now() + 1100 * kMs);
  EXPECT_TRUE(show());
  EXPECT_TRUE(noted("display back"));
  screen_->skip(3);
  EXPECT_EQ(report().frames_shown, 2U);
  EXPECT_EQ(report().frames_dropped, 4U);
}

TEST_F(FilmScreenTest, WithoutAScreenItGoesOnAndSaysSo) {
  cable_->unplugged = true;
  make();
  EXPECT_TRUE(noted("display: "));
  EXPECT_FALSE(show());
  EXPECT_EQ(report().frames_dropped, 1U);
}

TEST_F(FilmScreenTest, DrawsAgainForAFingerThatMovesVisiblyAndOnlyWhereThereIsTime) {
  make();
  ASSERT_TRUE(show());
  const FingerMark finger{{0, 0, 10}, {0, 0, 0}, false};
  EXPECT_EQ(redraw(finger, 40 * kMs), 1) << "it has come";
  EXPECT_EQ(redraw(finger, 40 * kMs), 0) << "it rests";
  EXPECT_EQ(redraw(FingerMark{{0, 0, 10.1}, {0, 0, 0}, false}, 40 * kMs), 0) << "less than is seen";
  EXPECT_EQ(redraw(FingerMark{{0, 0, 11}, {0, 0, 0}, false}, 40 * kMs, clock_.now() + 50 * kMs), 0)
      << "the next picture comes in 10 ms";
  EXPECT_EQ(redraw(FingerMark{{0, 0, 11}, {0, 0, 0}, false}, 40 * kMs), 1);
  EXPECT_EQ(redraw(FingerMark{{0, 0, 14}, {0, 0, 0}, false}, 10 * kMs), 0) << "too soon";
  EXPECT_EQ(redraw(FingerMark{{0, 0, 11}, {0, 0, 0}, true}, 40 * kMs), 1) << "it touches";
  EXPECT_TRUE(screen_->fingers()[0]->contact);
}

TEST_F(FilmScreenTest, ANewTextOnAStandingPictureIsDrawnAtOnce) {
  make();
  const ScreenFacts facts{.title = "film", .state = PlayerState::Paused, .held = true};
  screen_->write(facts, MonotonicTime::max(), clock_.now());
  EXPECT_EQ(redraw(std::nullopt, kMs), 0) << "no picture yet";
  ASSERT_TRUE(show());
  screen_->write(facts, MonotonicTime::max(), clock_.now());
  EXPECT_EQ(redraw(std::nullopt, kMs), 1);
  screen_->write(facts, MonotonicTime::max(), clock_.now());
  EXPECT_EQ(redraw(std::nullopt, kMs), 0) << "the same text";
}

TEST_F(FilmScreenTest, CarriesTheCommandsOutThatAreItsOwn) {
  make();
  ASSERT_TRUE(show());
  screen_->obey({.verb = PlayerVerb::SwapEyes, .value = 0, .word = ""});
  EXPECT_TRUE(screen_->stereo().swap_eyes);
  screen_->obey({.verb = PlayerVerb::Layout, .value = 0, .word = "tab"});
  EXPECT_EQ(screen_->stereo().layout, StereoLayout::TopBottom);
  screen_->obey({.verb = PlayerVerb::DepthBy, .value = -0.25, .word = ""});
  EXPECT_DOUBLE_EQ(screen_->stereo().strength, 0.75);
  EXPECT_EQ(redraw(std::nullopt, kMs), 1);
  screen_->obey({.verb = PlayerVerb::Pause, .value = 0, .word = ""});
  EXPECT_EQ(redraw(std::nullopt, kMs), 0);
}

TEST_F(FilmScreenTest, TheShapeThatTheViewerChoseIsThatOfTheNextFilmToo) {
  make();
  screen_->setScene({}, {.width_mm = 160, .height_mm = 90, .depth_mm = 40}, false, 40 * kMs, clock_.now());
  screen_->obey({.verb = PlayerVerb::Aspect, .value = 0, .word = "4:3"});
  EXPECT_NEAR(screen_->stereo().stretch, 0.75, 1e-9);
  screen_->setScene({}, {.width_mm = 120, .height_mm = 90, .depth_mm = 40}, false, 40 * kMs, clock_.now());
  EXPECT_NEAR(screen_->stereo().stretch, 1.0, 1e-9);
}

TEST_F(FilmScreenTest, TheShapeThatTheViewerChoseIsTurnedWithTheFilm) {
  make();
  screen_->setScene({}, {.width_mm = 160, .height_mm = 120, .depth_mm = 40}, false, 40 * kMs, clock_.now());
  screen_->obey({.verb = PlayerVerb::Aspect, .value = 0, .word = "16:9"});
  EXPECT_NEAR(screen_->stereo().stretch, 4.0 / 3, 1e-9);
  screen_->setScene({}, {.width_mm = 120, .height_mm = 160, .depth_mm = 40}, true, 40 * kMs, clock_.now());
  EXPECT_NEAR(screen_->stereo().stretch, 3.0 / 4, 1e-9) << "9:16";
  screen_->obey({.verb = PlayerVerb::Aspect, .value = 0, .word = "film"});
  EXPECT_NEAR(screen_->stereo().stretch, 1, 1e-9);
}

TEST_F(FilmScreenTest, APictureThatWasTurnedIsNotCountedAgain) {
  make();
  ASSERT_TRUE(show());
  EXPECT_TRUE(screen_->showTurned({}, {}, {}, {}, clock_.now()));
  EXPECT_EQ(report().frames_shown, 1U);
  EXPECT_EQ(presented_, 2);
}

TEST_F(FilmScreenTest, AWindowThatTheViewerClosesIsNoFault) {
  profile_.close_after_frames = 1;
  make();
  ASSERT_TRUE(screen_->attend(clock_.now()));
  ASSERT_TRUE(show());
  const auto attended = screen_->attend(clock_.now());
  ASSERT_FALSE(attended);
  EXPECT_EQ(attended.error().code, ErrorCode::Cancelled);
  EXPECT_TRUE(journal_.written().faults.empty());
}

TEST_F(FilmScreenTest, APictureThatCannotBeDrawnIsRefusedAndTheNextOneIsShown) {
  display_ = makeOffscreenDisplay({}, clock_);
  FilmScreen screen(*display_, {.width = 16, .height = 16}, stereo_, osd_, clock_, journal_, files_);
  if (const auto opened = screen.open(stop_); !opened) GTEST_SKIP() << opened.error().message;
  const auto shown = [&](int bits) {
    const Frame picture = test::makeGrayFrame(4, 4, bits, MediaTime{}, [](int, int) { return 1; });
    return screen.show({.color = picture}, {}, {}, {}, {}, clock_.now());
  };
  const auto refused = shown(7);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Unsupported);
  const auto attended = screen.attend(clock_.now());
  EXPECT_TRUE(attended) << attended.error().message;
  screen.obey({.verb = PlayerVerb::SwapEyes, .value = 0, .word = ""});
  EXPECT_TRUE(screen.redraw({}, {}, MonotonicTime::max(), clock_.now())) << "it is tried once";
  EXPECT_TRUE(shown(8));
}

}  // namespace
}  // namespace relievo
