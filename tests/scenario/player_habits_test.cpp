// SPDX-License-Identifier: Apache-2.0
// What users of mpv and Kodi do without reading anything, in one run of the program in a window: real keys, a real
// mouse and a real drop on an X server of the test's own; judged by the player's state and by the picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/control_client.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/until.h"
#include "tests/support/machine/x_screen.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::StartsWith;

constexpr int kWidth = 320, kHeight = 240;
constexpr double kRow = kHeight / 720.0;  // of the display over the picture

// A gray picture; its depth is that of a wall in the middle.
void makeFilm(const std::string& path, int seconds, const std::vector<test::ClipSound>& sounds = {}) {
  const auto even = [](unsigned luma) {
    return [luma](int component, int, int, int) { return component == 0 ? luma : 128U; };
  };
  test::ClipTrack color{.pix_fmt = "yuv420p", .fps_num = 5, .frames = 5 * seconds, .tags = {{"title", "color"}}};
  test::ClipTrack depth{.pix_fmt = "gray", .fps_num = 5, .frames = 5 * seconds, .tags = {{"title", "depth"}}};
  color.sample = even(180);
  depth.sample = even(128);
  test::makeClip(path, {color, depth}, {}, sounds);
}

class PlayerHabits : public testing::Test {
 protected:
  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << test::kNoXServer;
    ::setenv("XDG_PICTURES_DIR", (folder_ / "").c_str(), 1);
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    ::setenv("ALSA_CONFIG_PATH", (folder_ / "asound.conf").c_str(), 1);
    std::ofstream(folder_ / "asound.conf") << "pcm.hear { type file slave.pcm nowhere file \"" << folder_ / "sound.raw"
                                           << "\" format raw }\npcm.nowhere { type null }\n";
    std::ofstream(folder_ / "keys.toml") << "[always]\nK = \"depth -0.1\"\n";
    makeFilm(folder_ / "quiet.mkv", 20);
    makeFilm(folder_ / "dropped.mkv", 20);
    makeFilmOfTracks();
  }
  // 100 s, two sound tracks, chapters at 0, 30 and 60 s, and beside it subtitles of two languages, a line a second.
  void makeFilmOfTracks() {
    makeFilm(folder_ / "bare.mkv", 100, {{.length = 100s}, {.length = 100s}});
    std::ofstream chapters(folder_ / "chapters.txt");
    chapters << ";FFMETADATA1\n";
    for (const int begin : {0, 30, 60}) {
      chapters << "[CHAPTER]\nTIMEBASE=1/1\nSTART=" << begin << "\nEND=" << begin + 30 << "\ntitle=" << begin << "\n";
    }
    chapters.close();
    for (const char* language : {"de", "en"}) {
      std::ofstream words(folder_ / ("film." + std::string(language) + ".srt"));
      for (int k = 0; k < 100; ++k) {
        const std::string minute =
            "00:0" + std::to_string(k / 60) + ":" + (k % 60 < 10 ? "0" : "") + std::to_string(k % 60);
        words << k + 1 << "\n" << minute << ",000 --> " << minute << ",990\nWORDS " << language << "\n\n";
      }
    }
    const std::string mux = "ffmpeg -v error -i " + folder_ / "bare.mkv" + " -i " + folder_ / "chapters.txt" +
                            " -map 0 -map_chapters 1 -c copy -metadata:s:a:0 language=eng -metadata:s:a:1 language=deu "
                            "-metadata title='A film' " +
                            folder_ / "film.mkv";
    ASSERT_EQ(std::system(mux.c_str()), 0);  // NOLINT(bugprone-command-processor): the test's command
  }
  void play() {
    player_ = std::make_unique<test::Process>(
        std::vector<std::string>{RELIEVO_BIN_DIR "/relievo", folder_ / "quiet.mkv", folder_ / "film.mkv", "--size",
                                 "320x240", "--haptic", "none", "--audio", "alsa:hear", "--keys", folder_ / "keys.toml",
                                 "--volume", "100", "--control", folder_ / "control"},
        folder_ / "said.txt");
    control_ = std::make_unique<test::ControlClient>(folder_ / "control");
    show("quiet.mkv - relievo");
  }
  void show(const std::string& title) {
    window_ = screen_->find(title);
    ASSERT_NE(window_, 0u) << title << "\n" << said();
    place_ = screen_->place(window_).value_or(test::XScreen::Place{});
    screen_->focus(window_);
  }
  [[nodiscard]] std::string said() const {
    const std::ifstream file(folder_ / "said.txt");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  [[nodiscard]] json status() { return control_->ask("status"); }
  // A key, "Shift_L+slash", and what the player then says of itself.
  void press(const std::string& keys) const {
    const std::size_t plus = keys.find('+');
    if (plus == std::string::npos) screen_->tap(keys.c_str());
    else screen_->tapWith(keys.substr(0, plus).c_str(), keys.substr(plus + 1).c_str());
  }
  void click(unsigned button) const { screen_->button(button, true), screen_->button(button, false); }
  void expectAfter(const std::string& keys, const char* what, const json& value) {
    press(keys);
    json last;
    const auto is = [&] {
      last = status()[what];
      if (value.is_number() && last.is_number()) return std::abs(last.get<double>() - value.get<double>()) < 0.25e-1;
      return last == value;
    };
    EXPECT_TRUE(test::until(is)) << keys << ": " << what << " is " << last << " instead of " << value;
  }
  void expectPlace(const std::string& keys, double seconds) {
    press(keys);
    double last = 0;
    const auto is = [&] {
      const json now = status();
      last = now["position_s"].get<double>();
      return now["state"] == "paused" && std::abs(last - seconds) < 0.21;
    };
    EXPECT_TRUE(test::until(is)) << keys << ": at " << last << " s instead of " << seconds;
  }
  using Color = std::array<int, 3>;
  [[nodiscard]] Color at(int x, int y) const { return screen_->pixel(place_.x + x, place_.y + y); }
  static bool isAccent(const Color& color) { return color[0] > color[2] + 50; }
  static bool isFilm(const Color& color) { return color[0] > 100 && color[0] == color[1] && color[1] == color[2]; }
  // A white pixel of subtitles: between these rows of the window.
  [[nodiscard]] bool hasWords(int from, int to) const {
    const auto pixels = screen_->pixels(place_.x + kWidth / 4, place_.y + from, kWidth / 2, to - from);
    return std::ranges::any_of(pixels, [](const Color& color) { return color[0] > 235; });
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<test::XScreen> screen_ = test::XScreen::start();
  std::unique_ptr<test::Process> player_;
  std::unique_ptr<test::ControlClient> control_;
  unsigned long window_ = 0;
  test::XScreen::Place place_;

  void aQuietFilmLeavesTheSoundCardToOthers();
  void theNextFilmHasSound();
  void pauseStepAndSeek();
  void chapters();
  void soundAndVolume();
  void subtitles();
  void picture();
  void pages();
  void mouseOnThePage();
  void speedAndLoop();
  void aFileIsDropped();
};

void PlayerHabits::aQuietFilmLeavesTheSoundCardToOthers() {
  EXPECT_TRUE(test::until([&] { return status()["state"] == "playing"; })) << said();
  EXPECT_FALSE(player_->holds(folder_ / "sound.raw"));
  EXPECT_TRUE(test::until([&] { return isFilm(at(40, 120)); }));
}

void PlayerHabits::theNextFilmHasSound() {
  press("n");
  EXPECT_TRUE(test::until([&] { return player_->holds(folder_ / "sound.raw"); })) << said();
  show("A film - relievo");
  EXPECT_TRUE(test::until([&] { return status()["state"] == "playing"; }));
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
  EXPECT_TRUE(test::until([&] { return isAccent(at(20, static_cast<int>(85 * kRow))); })) << "the level's bar";
  expectAfter("9", "volume", 100);
  expectAfter("m", "muted", true);
  expectAfter("F8", "muted", false);  // Kodi's
  screen_->moveMouse(place_.x + 160, place_.y + 80);
  for (const unsigned wheel : {4U, 5U}) {
    click(wheel);
    EXPECT_TRUE(test::until([&] { return status()["volume"] == (wheel == 4 ? 105 : 100); })) << "the wheel";
  }
  EXPECT_THAT(status()["audio"].get<std::string>(), StartsWith("1 of 2"));
  expectAfter("Shift_L+3", "audio", "2 of 2, deu");  // #
  expectAfter("Control_L+equal", "audio_delay_s", 0.1);
  expectAfter("Control_L+minus", "audio_delay_s", 0);
}

void PlayerHabits::subtitles() {
  expectAfter("v", "subtitles", "off");
  EXPECT_TRUE(test::until([&] { return !hasWords(150, 185); }));
  expectAfter("v", "subtitles", "1 of 2, de, film.de.srt");
  EXPECT_TRUE(test::until([&] { return hasWords(150, 185); })) << "above the bar of the paused film";
  expectAfter("t", "subtitles", "off");                      // Kodi's
  expectAfter("j", "subtitles", "1 of 2, de, film.de.srt");  // what was hidden, before the next
  expectAfter("j", "subtitles", "2 of 2, en, film.en.srt");
  EXPECT_TRUE(test::until([&] { return hasWords(150, 185); }));
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
  EXPECT_TRUE(test::until([&] { return at(kWidth - 30, 4)[0] < 30; })) << "black above a wide picture";
  for (const char* word : {"4:3", "2.35:1", "film"}) expectAfter("a", "aspect", word);
  expectAfter("e", "zoom", 1.1);
  expectAfter("w", "zoom", 1);
  expectAfter("r", "rotation", 90);
  EXPECT_TRUE(test::until([&] { return at(10, 120)[0] < 30 && isFilm(at(160, 120)); }))
      << "black beside a tall picture";
  for (const int degrees : {180, 270, 0}) expectAfter("r", "rotation", degrees);
  EXPECT_TRUE(test::until([&] { return isFilm(at(10, 120)); }));
  expectAfter("Tab", "stereo", "sbs");
  expectAfter("y", "swap_eyes", true);
  expectAfter("k", "depth_strength", 0.9);  // of the viewer's own table
  EXPECT_EQ(control_->ask("layout mono")["ok"], true);
  press("s");
  EXPECT_TRUE(test::until([&] { return std::filesystem::exists(folder_ / "relievo-film-0001.png"); }));
  expectAfter("backslash", "full_screen", true);  // Kodi's
  expectAfter("backslash", "full_screen", false);
  EXPECT_TRUE(test::until([&] { return screen_->place(window_).value_or(test::XScreen::Place{}).width == kWidth; }));
  show("A film - relievo");
  for (int k = 0; k < 2; ++k) click(1);
  EXPECT_TRUE(test::until([&] { return status()["full_screen"] == true; })) << "a double click";
  expectAfter("Escape", "full_screen", false);
  EXPECT_TRUE(test::until([&] { return screen_->place(window_).value_or(test::XScreen::Place{}).width == kWidth; }));
  show("A film - relievo");
}

void PlayerHabits::pages() {
  const auto covered = [&] { return at(kWidth - 4, 4)[0] < 60; };
  // In a small window the keys are several pages, which their own key turns and then leaves.
  const auto leaves = [&](const std::string& key) {
    for (int presses = 0; presses < 20; ++presses) {
      press(key);
      for (int tries = 0; tries < 50; ++tries) {
        if (!covered()) return true;
        std::this_thread::sleep_for(10ms);
      }
      if (key == "Escape") return false;
    }
    return false;
  };
  for (const char* away : {"Shift_L+slash", "Escape", "h"}) {
    press(std::string(away) == "Escape" ? "F1" : "Shift_L+slash");
    EXPECT_TRUE(test::until(covered)) << "the page of keys";
    EXPECT_TRUE(leaves(away)) << away;
  }
  EXPECT_EQ(status()["state"], "paused") << "no key of the page has ended the film";
  mouseOnThePage();
  const auto figures = [&] { return at(265, static_cast<int>(200 * kRow))[0] < 120; };  // the ground of their page
  press("i");
  EXPECT_TRUE(test::until(figures)) << "statistics";
  press("i");
  EXPECT_TRUE(test::until([&] { return !figures(); }));
}

// The wheel turns the pages, a click closes them; the sound stays as it is.
void PlayerHabits::mouseOnThePage() {
  const auto shown = [&] { return screen_->pixels(place_.x, place_.y, kWidth, kHeight); };
  screen_->moveMouse(place_.x + 160, place_.y + 80);
  press("F1");
  EXPECT_TRUE(test::until([&] { return at(kWidth - 4, 4)[0] < 60; }));
  const auto first = shown();
  for (const unsigned wheel : {5U, 4U}) {
    click(wheel);
    EXPECT_TRUE(test::until([&] { return (shown() == first) == (wheel == 4); })) << wheel;
    EXPECT_EQ(status()["volume"], 100);
  }
  click(1);
  EXPECT_TRUE(test::until([&] { return isFilm(at(kWidth - 4, 4)); })) << "a click";
  EXPECT_EQ(status()["state"], "paused");
}

void PlayerHabits::speedAndLoop() {
  expectAfter("space", "state", "playing");
  expectAfter("bracketleft", "rate", 0.5);
  expectAfter("bracketright", "rate", 1);
  expectAfter("bracketright", "rate", 2);
  expectAfter("BackSpace", "rate", 1);
  EXPECT_TRUE(test::until([&] { return status()["state"] == "playing"; }));
  press("l");
  EXPECT_TRUE(test::until([&] { return status()["loop_from_s"].is_number(); }));
  std::this_thread::sleep_for(300ms);  // its end lies after its beginning
  press("l");
  EXPECT_TRUE(test::until([&] { return status()["loop_to_s"].is_number(); }));
  const auto seconds = [&](const char* what) {
    const json value = status()[what];
    return value.is_number() ? value.get<double>() : 0.0;
  };
  const double from = seconds("loop_from_s"), to = seconds("loop_to_s");
  EXPECT_GT(to, from);
  EXPECT_TRUE(test::until([&] { return seconds("position_s") < to - 0.1; })) << "again from its beginning";
  expectAfter("l", "loop_from_s", nullptr);
}

void PlayerHabits::aFileIsDropped() {
  ASSERT_TRUE(screen_->drop(window_, folder_ / "dropped.mkv"));
  EXPECT_TRUE(test::until([&] { return status()["source"] == folder_ / "dropped.mkv"; })) << status();
  show("dropped.mkv - relievo");
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

}  // namespace
}  // namespace relievo
