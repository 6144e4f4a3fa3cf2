// SPDX-License-Identifier: Apache-2.0
// A film whose pictures the viewer turns, in simulated time.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <cmath>
#include <utility>
#include <vector>

#include "tests/scenario/film/player_transport.h"

namespace relievo {
namespace {

// 32 x 24 pixels whose left half stands 31 mm high and whose right half is flat: in a box of 160 x 120 mm, or turned of
// 160 x 213 mm. The finger taps at 20 mm to the right and 30 mm up, down to 15 mm.
class PlayerTurn : public PlayerTransport {
 protected:
  PlayerTurn() {
    const auto height = [](int, int, int column, int) { return static_cast<std::uint16_t>(column < 16 ? 200 : 10); };
    bench_.sources["film"].tracks[1].sample = height;
    bench_.haptic.position_mm = [](double t) { return glm::dvec3(20, 30, t < 1.5 ? 60 : 37 + 22 * std::cos(6 * t)); };
  }
  void hasPictures(int count) {
    for (auto& track : bench_.sources["film"].tracks) track.frames = count;
  }
  void expectAfter(int presses, bool touched, double height_mm) {
    bench_.keys.clear();
    for (int i = 0; i < presses; ++i) bench_.press(0.5 + 0.2 * i, KEY_R);
    playsWell();
    EXPECT_EQ(bench_.report.haptic.contact_ticks > 100, touched) << bench_.report.haptic.contact_ticks;
    EXPECT_NEAR(bench_.report.volume.width_mm, 160, 1e-9);
    EXPECT_NEAR(bench_.report.volume.height_mm, height_mm, 1e-9);
    EXPECT_EQ(bench_.report.frames_shown, 100U) << "a turn is no new picture";
  }
  // When the screen was told of the film, and its shape at that time.
  void noteShapes() {
    bench_.display.announced = [this](const AnnouncedFilm& film) {
      shapes_.emplace_back(toSeconds(bench_.clock.now().time_since_epoch()),
                           static_cast<double>(film.width) / film.height);
    };
  }
  void expectTurnedAt(double seconds, std::size_t time, double shape) const {
    ASSERT_GT(shapes_.size(), time);
    EXPECT_NEAR(shapes_[time].first, seconds, 0.1);
    EXPECT_NEAR(shapes_[time].second, shape, 0.05);
  }
  void playsTurned() {
    playsWell();
    EXPECT_GT(bench_.report.haptic.contact_ticks, 100U);
    EXPECT_NEAR(bench_.report.volume.height_mm, 160 * 32 / 24.0, 1e-9);
  }

  std::vector<std::pair<double, double>> shapes_;
};

TEST_F(PlayerTurn, TheFingerFeelsThePictureAsItIsTurned) {
  expectAfter(0, false, 120);
  expectAfter(1, true, 160 * 32 / 24.0);   // the left half is above
  expectAfter(2, true, 120);               // to the right
  expectAfter(3, false, 160 * 32 / 24.0);  // below
  expectAfter(4, false, 120);
}

TEST_F(PlayerTurn, APausedFilmIsTurnedAtOnce) {
  bench_.press(0.3, KEY_PAUSE);
  bench_.press(3.5, KEY_STOP);
  bench_.press(0.5, KEY_R);
  playsTurned();
}

// A box of the viewer's own is turned with the picture, and the next film is not.
TEST_F(PlayerTurn, LastsForAFilm) {
  aList();
  std::vector<AnnouncedFilm> told;
  bench_.display.announced = [&](const AnnouncedFilm& film) { told.push_back(film); };
  bench_.config.volume = DisplayVolume{160, 80, 40};
  bench_.press(0.5, KEY_R);
  playsWell();
  EXPECT_EQ(told, (std::vector<AnnouncedFilm>{{"a", 48, 24}, {"a", 16, 32}, {"b", 48, 24}, {"c", 48, 24}}));
}

// A pause, a seek and a turn before its picture has come.
TEST_F(PlayerTurn, WorksWhileAFilmIsSought) {
  hasPictures(400);
  bench_.press(0.5, KEY_RIGHT);
  bench_.press(0.5, KEY_R);
  bench_.press(4.0, KEY_STOP);
  playsTurned();
}

// The source is away from 10 s on; the seek waits, too.
TEST_F(PlayerTurn, WhileAFilmWaitsForItsSourceItsPictureIsTurnedAtOnce) {
  hasPictures(1000);
  bench_.sources["film"].remote = true;
  bench_.sources["film"].lose_after_packets = 500;
  MockMediaProfile away = bench_.sources["film"];
  away.fail_open = ErrorCode::Io;
  bench_.found_again = {away};
  noteShapes();
  bench_.press(15.0, KEY_R);
  bench_.press(20.0, KEY_LEFT);
  bench_.press(24.0, KEY_R);
  bench_.press(30.0, KEY_STOP);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing buffering seeking buffering idle");
  expectTurnedAt(15, 1, 0.75);
  expectTurnedAt(24, 2, 4.0 / 3);
  EXPECT_EQ(bench_.report.frames_shown, 249U) << "those before";
}

// A photo, which stands; then paused.
TEST_F(PlayerTurn, OfAPhotoIsShownAtOnce) {
  hasPictures(1);
  noteShapes();
  bench_.press(2.0, KEY_R);
  bench_.press(3.0, KEY_PAUSE);
  bench_.press(4.0, KEY_R);
  bench_.press(5.0, KEY_STOP);
  playsWell();
  expectTurnedAt(2, 1, 0.75);
  expectTurnedAt(4, 2, 4.0 / 3);
  EXPECT_EQ(bench_.report.frames_shown, 1U);
}

TEST_F(PlayerTurn, ALiveFilmGoesOnTurned) {
  bench_.sources["film"].live = true;
  bench_.press(0.5, KEY_R);
  playsTurned();
  EXPECT_GT(bench_.report.media_s, 3.5);
}

TEST_F(PlayerTurn, OfTwoViewsIsRefused) {
  bench_.config.source.packing = Packing::StereoSideBySide;
  expectAfter(0, false, 160 * 24 / 32.0);
  std::vector<AnnouncedFilm> told;
  bench_.display.announced = [&](const AnnouncedFilm& film) { told.push_back(film); };
  bench_.press(0.5, KEY_R);
  playsWell();
  EXPECT_EQ(told.size(), 1U);
}

}  // namespace
}  // namespace relievo
