// SPDX-License-Identifier: Apache-2.0
// What users of mpv and Kodi press on a box: a keyboard and a remote control that the kernel makes (uinput), and a
// whole screen. From the list of films to the end, judged by the player's state and by what the screen shows. In
// toolchain/guest --screens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>

#include "platform/clock.h"
#include "tests/scenario/habits/habit_films.h"
#include "tests/support/device/uinput_remote.h"
#include "tests/support/files.h"
#include "tests/support/machine/control_client.h"
#include "tests/support/machine/guest_screen.h"
#include "tests/support/machine/process.h"

namespace relievo::test {
namespace {

using nlohmann::json;
using Keys = std::vector<unsigned>;

// Pressed one after the other, and let go of together.
struct Row {
  Keys keys;
  const char* what;  // the player says of itself
  json value;
};
constexpr unsigned kShift = KEY_LEFTSHIFT, kCtrl = KEY_LEFTCTRL;

const std::vector<Row> kTime{
    {{KEY_SPACE}, "state", "paused"},
    {{KEY_HOME}, "position_s", 0.0},
    {{KEY_RIGHT}, "position_s", 5.0},
    {{KEY_UP}, "position_s", 65.0},
    {{KEY_LEFT}, "position_s", 60.0},
    {{KEY_DOWN}, "position_s", 0.0},
    {{KEY_FORWARD}, "position_s", 10.0},
    {{KEY_REWIND}, "position_s", 0.0},
    {{kShift, KEY_RIGHT}, "position_s", 1.0},
    {{KEY_5}, "position_s", 50.0},
    {{KEY_DOT}, "position_s", 50.2},
    {{KEY_COMMA}, "position_s", 50.0},
    {{KEY_PAGEUP}, "chapter", "3 of 3, 60"},
    {{KEY_PAGEDOWN}, "chapter", "2 of 3, 30"},
    {{kShift, KEY_2}, "chapter", "3 of 3, 60"},
    {{kShift, KEY_1}, "chapter", "2 of 3, 30"},
};
const std::vector<Row> kSpeed{
    {{KEY_LEFTBRACE}, "rate", 0.5},
    {{KEY_RIGHTBRACE}, "rate", 1.0},
    {{KEY_RIGHTBRACE}, "rate", 2.0},
    {{KEY_BACKSPACE}, "rate", 1.0},
};
const std::vector<Row> kSound{
    {{KEY_0}, "volume", 105.0},
    {{KEY_9}, "volume", 100.0},
    {{KEY_VOLUMEUP}, "volume", 105.0},
    {{KEY_VOLUMEDOWN}, "volume", 100.0},
    {{KEY_M}, "muted", true},
    {{KEY_F8}, "muted", false},
    {{KEY_MUTE}, "muted", true},
    {{KEY_MUTE}, "muted", false},
    {{kShift, KEY_3}, "audio", "2 of 2, deu"},
    {{KEY_AUDIO}, "audio", "1 of 2, eng"},
    {{kCtrl, KEY_EQUAL}, "audio_delay_s", 0.1},
    {{kCtrl, KEY_MINUS}, "audio_delay_s", 0.0},
};
const std::vector<Row> kWords{
    {{KEY_Z}, "subtitle_delay_s", -0.1},
    {{KEY_X}, "subtitle_delay_s", 0.0},
    {{kShift, KEY_G}, "subtitle_size", 1.1},
    {{kShift, KEY_F}, "subtitle_size", 1.0},
    {{KEY_SUBTITLE}, "subtitles", "2 of 2, en, film.en.srt"},
    {{kShift, KEY_J}, "subtitles", "1 of 2, de, film.de.srt"},
    {{KEY_T}, "subtitles", "off"},
};
const std::vector<Row> kPicture{
    {{KEY_E}, "zoom", 1.1},
    {{KEY_W}, "zoom", 1.0},
    {{KEY_3D_MODE}, "stereo", "sbs"},
    {{KEY_TAB}, "stereo", "tab"},
    {{KEY_Y}, "swap_eyes", true},
    {{KEY_GREEN}, "depth_strength", 0.9},
    {{KEY_F3}, "depth_strength", 1.0},
    {{KEY_RED}, "loop", true},
    {{kShift, KEY_L}, "loop", false},
};

class BoxHabits : public testing::Test {
 protected:
  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << kNoGuest;
    ::setenv("XDG_PICTURES_DIR", (folder_ / "").c_str(), 1);
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    makeFilmOfTracks(folder_);
    std::filesystem::rename(folder_ / "bare.mkv", folder_ / "zz.mkv");
    Keys all;
    for (unsigned key = KEY_ESC; key <= KEY_F12; ++key) all.push_back(key);
    for (const unsigned key : {KEY_HOME, KEY_UP, KEY_PAGEUP, KEY_LEFT, KEY_RIGHT, KEY_DOWN, KEY_PAGEDOWN, KEY_INFO,
                               KEY_OK, KEY_BACK, KEY_HELP, KEY_PLAYPAUSE, KEY_NEXT, KEY_PREVIOUS, KEY_RIGHTSHIFT}) {
      all.push_back(key);
    }
    for (const auto* rows : {&kTime, &kSpeed, &kSound, &kWords, &kPicture}) {
      for (const Row& row : *rows) all.insert(all.end(), row.keys.begin(), row.keys.end());
    }
    remote_.emplace(all);
    wait(1500ms);  // so that the player finds it at its start
  }
  void wait(Duration time) { clock_.sleepUntil(clock_.now() + time); }
  [[nodiscard]] std::string said() const { return contentOf(folder_ / "said.txt"); }
  // While the guest waits for the host, its clock runs as fast as it can, so the number of tries is no time.
  bool waitFor(const std::function<bool()>& so, int tries = 60) {
    for (; tries > 0 && player_->isRunning(); --tries) {
      if (so()) return true;
      wait(250ms);
    }
    return false;
  }
  void play() {
    player_ = std::make_unique<Process>(
        std::vector<std::string>{RELIEVO_BIN_DIR "/relievo", "--display", "kms:" + screen_->card(), "--size", "640x480",
                                 "--haptic", "none", "--audio", "null", "--volume", "100", "--films", folder_ / "",
                                 "--control", folder_ / "control"},
        folder_ / "said.txt");
    control_ = std::make_unique<ControlClient>(folder_ / "control", std::chrono::seconds(600));
  }
  void press(const Keys& keys) {
    for (const unsigned key : keys) remote_->press(key, 1);
    wait(50ms);
    for (const unsigned key : std::views::reverse(keys)) remote_->press(key, 0);
  }
  void expectAfter(const Row& row) {
    press(row.keys);
    json last;
    const bool place = std::string(row.what) == "position_s";
    const auto is = [&] {
      const json status = control_->ask("status");
      last = status[row.what];
      if (place && status["state"] != "paused") return false;
      if (!last.is_number() || !row.value.is_number()) return last == row.value;
      return std::abs(last.get<double>() - row.value.get<double>()) < (place ? 0.21 : 0.025);
    };
    EXPECT_TRUE(waitFor(is)) << row.what << " after key " << row.keys.back() << " is " << last << ", not " << row.value
                             << "\n"
                             << said();
  }
  void expectAll(const std::vector<Row>& rows) {
    for (const Row& row : rows) expectAfter(row);
  }
  // What the screen shows at a place becomes so.
  using Color = std::array<int, 3>;
  bool shows(int x, int y, const std::function<bool(const Color&)>& so) {
    return waitFor([&] {
      const ScreenDump dump = screen_->dump();
      return dump.width == 640 && so(dump.at(x, y));
    });
  }
  static bool isFilm(const Color& color) {
    return color[0] > 100 && color[0] < 220 && color[0] == color[1] && color[1] == color[2];
  }
  static bool isDark(const Color& color) { return color[0] < 60; }
  // White letters between these rows.
  bool showsWords(int from, int to, bool any) {
    return waitFor([&] {
      const ScreenDump dump = screen_->dump();
      bool found = false;
      for (int y = from; y < to && !found; ++y) {
        for (int x = 160; x < 480 && !found; ++x) found = dump.at(x, y)[0] > 235;
      }
      return found == any;
    });
  }

  void theListOfFilms();
  void time();
  void words();
  void picture();
  void pages();
  void anotherFilm();

  TemporaryFolder folder_;
  std::unique_ptr<GuestScreen> screen_ = GuestScreen::find("virtio");
  std::optional<UinputRemote> remote_;
  std::unique_ptr<Process> player_;
  std::unique_ptr<ControlClient> control_;
  MonotonicClock clock_;
};

void BoxHabits::theListOfFilms() {
  const auto selected = [&](int number) {
    return waitFor([&] {
      const json list = control_->ask("status")["list"];
      return list.is_object() && list["count"] == 2 && list["selected"] == number;
    });
  };
  EXPECT_TRUE(selected(1)) << control_->ask("status") << said();
  press({KEY_DOWN});
  EXPECT_TRUE(selected(2));
  press({KEY_UP});
  EXPECT_TRUE(selected(1));
  expectAfter({{KEY_OK}, "state", "playing"});
  EXPECT_EQ(control_->ask("status")["title"], "A film");
  EXPECT_TRUE(shows(20, 240, isFilm)) << said();
}

void BoxHabits::time() {
  expectAll(kTime);
  expectAfter({{KEY_PLAYPAUSE}, "state", "playing"});
  expectAll(kSpeed);
  EXPECT_TRUE(waitFor([&] { return control_->ask("status")["state"] == "playing"; }));
  press({KEY_L});
  EXPECT_TRUE(waitFor([&] { return control_->ask("status")["loop_from_s"].is_number(); }));
  wait(1s);
  press({KEY_L});
  EXPECT_TRUE(waitFor([&] { return control_->ask("status")["loop_to_s"].is_number(); }));
  expectAfter({{KEY_L}, "loop_from_s", nullptr});
  expectAfter({{KEY_P}, "state", "paused"});
}

void BoxHabits::words() {
  expectAfter({{KEY_V}, "subtitles", "off"});
  EXPECT_TRUE(showsWords(290, 370, false));
  expectAfter({{KEY_V}, "subtitles", "1 of 2, de, film.de.srt"});
  EXPECT_TRUE(showsWords(290, 370, true)) << "above the bar of the paused film";
  expectAll(kWords);
}

void BoxHabits::picture() {
  EXPECT_TRUE(shows(620, 8, isFilm));
  expectAfter({{KEY_A}, "aspect", "16:9"});
  EXPECT_TRUE(shows(620, 8, isDark)) << "black above a wide picture";
  for (const char* word : {"4:3", "2.35:1", "film"}) expectAfter({{KEY_A}, "aspect", word});
  expectAfter({{KEY_R}, "rotation", 90});
  EXPECT_TRUE(shows(20, 240, isDark)) << "black beside a tall picture";
  EXPECT_TRUE(shows(320, 240, isFilm));
  for (const int degrees : {180, 270, 0}) expectAfter({{KEY_R}, "rotation", degrees});
  expectAll(kPicture);
  EXPECT_EQ(control_->ask("layout mono")["ok"], true);
  press({KEY_S});
  EXPECT_TRUE(waitFor([&] { return std::filesystem::exists(folder_ / "relievo-film-0001.png"); })) << said();
}

void BoxHabits::pages() {
  for (const Keys& keys : {Keys{KEY_H}, Keys{kShift, KEY_SLASH}, Keys{KEY_F1}, Keys{KEY_HELP}}) {
    press(keys);
    EXPECT_TRUE(shows(632, 8, isDark)) << "the page of keys after key " << keys.back();
    press({KEY_BACK});
    EXPECT_TRUE(shows(632, 8, isFilm));
  }
  press({KEY_I});
  EXPECT_TRUE(shows(530, 133, [](const Color& color) { return color[0] < 120; })) << "statistics";
  press({KEY_I});
  EXPECT_TRUE(shows(530, 133, isFilm));
  EXPECT_EQ(control_->ask("status")["state"], "paused") << "no key of a page has ended the film";
}

void BoxHabits::anotherFilm() {
  for (const Keys& keys : {Keys{kShift, KEY_DOT}, Keys{KEY_N}, Keys{KEY_NEXT}}) {
    press(keys);
    EXPECT_TRUE(waitFor([&] { return control_->ask("status")["source"] == folder_ / "zz.mkv"; })) << keys.back();
    press(keys.size() > 1 ? Keys{kShift, KEY_COMMA} : keys[0] == KEY_N ? Keys{KEY_B} : Keys{KEY_PREVIOUS});
    EXPECT_TRUE(waitFor([&] { return control_->ask("status")["source"] == folder_ / "film.mkv"; })) << keys.back();
  }
  expectAfter({{KEY_BACK}, "state", "browsing"});
}

TEST_F(BoxHabits, OfMpvAndKodiAreAllThereOnAKeyboardAndARemote) {
  play();
  theListOfFilms();
  time();
  expectAll(kSound);
  words();
  picture();
  pages();
  anotherFilm();
  press({KEY_Q});
  EXPECT_EQ(player_->wait(), 0) << said();
}

}  // namespace
}  // namespace relievo::test
