// SPDX-License-Identifier: Apache-2.0
// What users of mpv and Kodi do without reading anything, in one run of the program in a window: real keys, a real
// mouse and a real drop on an X server of the test's own; judged by the player's state and by the picture.
#include "tests/scenario/habits/player_habits.h"

namespace relievo::test {

using testing::StartsWith;

void PlayerHabits::aQuietFilmLeavesTheSoundCardToOthers() {
  EXPECT_TRUE(until([&] { return status()["state"] == "playing"; })) << said();
  EXPECT_FALSE(player_->holds(folder_ / "sound.raw"));
  EXPECT_TRUE(until([&] { return isFilm(at(40, 120)); }));
}

void PlayerHabits::theNextFilmHasSound() {
  press("n");
  EXPECT_TRUE(until([&] { return player_->holds(folder_ / "sound.raw"); })) << said();
  show("A film - relievo");
  EXPECT_TRUE(until([&] { return status()["state"] == "playing"; }));
}

void PlayerHabits::pauseStepAndSeek() {
  expectAfter("space", "state", "paused");
  expectPlace("Home", 0);
  expectPlace("Right", 5);
  expectPlace("Up", 65);
  expectPlace("Left", 60);
  expectPlace("Down", 0);
  expectPlace("5", 50);
  expectPlace("period", 50.2);
  expectPlace("comma", 50);
}

void PlayerHabits::chapters() {
  expectPlace("Prior", 60);
  EXPECT_EQ(status()["chapter"], "3 of 3, 60");
  expectPlace("Next", 30);
  EXPECT_EQ(status()["chapter"], "2 of 3, 30");
  expectPlace("Shift_L+2", 60);  // @
  expectPlace("Shift_L+1", 30);  // !
}

void PlayerHabits::soundAndVolume() {
  expectAfter("0", "volume", 105);
  EXPECT_TRUE(until([&] { return isAccent(at(20, static_cast<int>(85 * kRow))); })) << "the level's bar";
  expectAfter("9", "volume", 100);
  expectAfter("m", "muted", true);
  expectAfter("F8", "muted", false);  // Kodi's
  screen_->moveMouse(place_.x + 160, place_.y + 80);
  for (const unsigned wheel : {4U, 5U}) {
    click(wheel);
    EXPECT_TRUE(until([&] { return status()["volume"] == (wheel == 4 ? 105 : 100); })) << "the wheel";
  }
  EXPECT_THAT(status()["audio"].get<std::string>(), StartsWith("1 of 2"));
  expectAfter("Shift_L+3", "audio", "2 of 2, deu");  // #
  expectAfter("Control_L+equal", "audio_delay_s", 0.1);
  expectAfter("Control_L+minus", "audio_delay_s", 0);
}

void PlayerHabits::subtitles() {
  expectAfter("v", "subtitles", "off");
  EXPECT_TRUE(until([&] { return !hasWords(150, 185); }));
  expectAfter("v", "subtitles", "1 of 2, de, film.de.srt");
  EXPECT_TRUE(until([&] { return hasWords(150, 185); })) << "above the bar of the paused film";
  expectAfter("t", "subtitles", "off");                      // Kodi's
  expectAfter("j", "subtitles", "1 of 2, de, film.de.srt");  // what was hidden, before the next
  expectAfter("j", "subtitles", "2 of 2, en, film.en.srt");
  EXPECT_TRUE(until([&] { return hasWords(150, 185); }));
  expectAfter("z", "subtitle_delay_s", -0.1);
  expectAfter("x", "subtitle_delay_s", 0);
  expectAfter("Shift_L+g", "subtitle_size", 1.1);
  expectAfter("Shift_L+f", "subtitle_size", 1);
  expectAfter("j", "subtitles", "off");
  expectAfter("Shift_L+j", "subtitles", "2 of 2, en, film.en.srt");
  expectAfter("Shift_L+j", "subtitles", "1 of 2, de, film.de.srt");
  expectAfter("Shift_L+j", "subtitles", "off");
}

void PlayerHabits::picture() {
  EXPECT_TRUE(isFilm(at(kWidth - 30, 4)));
  expectAfter("a", "aspect", "16:9");
  EXPECT_TRUE(until([&] { return at(kWidth - 30, 4)[0] < 30; })) << "black above a wide picture";
  for (const char* word : {"4:3", "2.35:1", "film"}) expectAfter("a", "aspect", word);
  expectAfter("e", "zoom", 1.1);
  expectAfter("w", "zoom", 1);
  expectAfter("r", "rotation", 90);
  EXPECT_TRUE(until([&] { return at(10, 120)[0] < 30 && isFilm(at(160, 120)); })) << "black beside a tall picture";
  for (const int degrees : {180, 270, 0}) expectAfter("r", "rotation", degrees);
  EXPECT_TRUE(until([&] { return isFilm(at(10, 120)); }));
  expectAfter("Tab", "stereo", "sbs");
  expectAfter("y", "swap_eyes", true);
  expectAfter("k", "depth_strength", 0.9);  // of the viewer's own table
  EXPECT_EQ(control_->ask("layout mono")["ok"], true);
  press("s");
  EXPECT_TRUE(until([&] { return std::filesystem::exists(folder_ / "relievo-film-0001.png"); }));
  expectAfter("backslash", "full_screen", true);  // Kodi's
  expectAfter("backslash", "full_screen", false);
  EXPECT_TRUE(until([&] { return screen_->place(window_).value_or(XScreen::Place{}).width == kWidth; }));
  show("A film - relievo");
  for (int k = 0; k < 2; ++k) click(1);
  EXPECT_TRUE(until([&] { return status()["full_screen"] == true; })) << "a double click";
  expectAfter("Escape", "full_screen", false);
  EXPECT_TRUE(until([&] { return screen_->place(window_).value_or(XScreen::Place{}).width == kWidth; }));
  show("A film - relievo");
}

TEST_F(PlayerHabits, OfMpvAndKodiAreAllThere) {
  play();
  if (HasFatalFailure()) return;
  aQuietFilmLeavesTheSoundCardToOthers();
  theNextFilmHasSound();
  pauseStepAndSeek();
  chapters();
  soundAndVolume();
  subtitles();
  picture();
  pages();
  speedAndLoop();
  aFileIsDropped();
  press("q");
  EXPECT_EQ(player_->wait(), 0) << said();
}

}  // namespace relievo::test
