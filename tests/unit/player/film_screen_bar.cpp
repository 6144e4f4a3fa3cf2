// SPDX-License-Identifier: Apache-2.0
// The mouse over the bar of the screen.
#include "tests/unit/player/film_screen_stage.h"

namespace relievo {
namespace {

// The display is 1280 x 720: the bar is 1200 long and begins at 40; its middle is 664 down.
class FilmScreenBar : public test::FilmScreenStage {
 protected:
  static constexpr double kOnIt = 664.0 / 720, kAbove = 0.4;

  void showBar() {
    stereo_ = {.layout = StereoLayout::Mono};
    make();
    EXPECT_TRUE(show());
    screen_->wake(clock_.now());
    screen_->write({.duration_s = 100}, MonotonicTime::max(), clock_.now());
  }
};

TEST_F(FilmScreenBar, APressOnTheBarHoldsItUntilTheButtonIsReleased) {
  showBar();
  const auto at = [&](double x, double down, bool pressed) {
    return screen_->barAt({.across = x / 1280, .down = down, .pressed = pressed}, clock_.now());
  };
  EXPECT_EQ(at(340, kAbove, true), std::nullopt) << "a press on the picture";
  EXPECT_EQ(at(340, kAbove, false), std::nullopt);
  EXPECT_NEAR(at(340, kOnIt, false).value_or(-1), 0.25, 1e-9);
  EXPECT_NEAR(at(340, kOnIt, true).value_or(-1), 0.25, 1e-9);
  EXPECT_NEAR(at(940, kAbove, true).value_or(-1), 0.75, 1e-9) << "dragged, above it";
  EXPECT_EQ(at(940, kAbove, false), std::nullopt);
  EXPECT_EQ(at(940, kAbove, true), std::nullopt) << "another press";
}

// A notch of the wheel is told with the button up.
TEST_F(FilmScreenBar, TheWheelOverTheBarDoesNotReleaseIt) {
  showBar();
  const SurfaceMouse wheel{.across = 0.5, .down = kOnIt, .notches = 1};
  const SurfaceMouse above{.across = 0.5, .down = kAbove, .notches = 1};
  EXPECT_TRUE(screen_->isOverBar(wheel));
  EXPECT_FALSE(screen_->isOverBar(above));
  EXPECT_TRUE(screen_->barAt({.across = 0.5, .down = kOnIt, .pressed = true}, clock_.now()));
  EXPECT_TRUE(screen_->isOverBar(above)) << "it is held";
  EXPECT_TRUE(screen_->barAt({.across = 0.5, .down = kAbove, .pressed = true}, clock_.now())) << "still";
}

// The only button ends at the right margin; its word is in the title's place, since there is no title.
TEST_F(FilmScreenBar, AButtonOfTheBarIsUnderTheMouseOnlyWhileTheBarIsShown) {
  stereo_ = {.layout = StereoLayout::Mono};
  make();
  EXPECT_TRUE(show());
  const SurfaceMouse on{.across = 1225.0 / 1280, .down = 600.0 / 720}, beside{.across = 0.5, .down = 600.0 / 720};
  EXPECT_EQ(screen_->buttonAt(on), std::nullopt);
  screen_->wake(clock_.now());
  screen_->write({.duration_s = 100, .buttons = {PlayerVerb::FullScreen}}, MonotonicTime::max(), clock_.now());
  EXPECT_EQ(screen_->buttonAt(on), PlayerVerb::FullScreen);
  EXPECT_EQ(screen_->buttonAt(beside), std::nullopt);
  EXPECT_EQ(screen_->barAt(on, clock_.now()), std::nullopt) << "no place of the film";
  EXPECT_TRUE(screen_->isOverBar(beside)) << "the wheel over the words is the volume, too";
}

TEST_F(FilmScreenBar, AFilmWithoutALengthHasABarForTheWheel) {
  stereo_ = {.layout = StereoLayout::Mono};
  make();
  EXPECT_TRUE(show());
  screen_->wake(clock_.now());
  const SurfaceMouse mouse{.across = 0.5, .down = 664.0 / 720, .notches = 1};
  EXPECT_FALSE(screen_->isOverBar(mouse)) << "it is not shown yet";
  screen_->write({}, MonotonicTime::max(), clock_.now());
  EXPECT_TRUE(screen_->isOverBar(mouse));
  EXPECT_EQ(screen_->barAt({.across = 0.5, .down = kOnIt}, clock_.now()), std::nullopt);
}

}  // namespace
}  // namespace relievo
