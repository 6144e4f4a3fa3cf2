// SPDX-License-Identifier: Apache-2.0
// The program on a whole screen, in a guest: the screen is off at first, then shows the picture, and is then unplugged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "platform/clock.h"
#include "tests/support/device/uinput_remote.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/control_client.h"
#include "tests/support/machine/guest_screen.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

class PlayerScreen : public testing::Test {
 protected:
  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << test::kNoGuest;
    test::makeClip(folder_ / "film.mkv",
                   {{.pix_fmt = "yuv420p",
                     .fps_num = 5,
                     .frames = 20,
                     .sample = [](int component, int, int, int) { return component == 0 ? 180U : 128U; },
                     .tags = {{"title", "color"}}},
                    {.pix_fmt = "gray",
                     .fps_num = 5,
                     .frames = 20,
                     .sample = [](int, int, int, int) { return 128U; },
                     .tags = {{"title", "depth"}}}});
  }
  [[nodiscard]] std::string textOf(const std::string& name) const { return test::contentOf(folder_ / name); }
  void wait(Duration time) { clock_.sleepUntil(clock_.now() + time); }
  // There is no time limit: while the player waits for the host to read its files, the guest's clock runs as fast as it
  // can. If the player never gets there, the whole guest is stopped from outside.
  bool waitFor(test::Process& player, const std::function<bool()>& so) {
    while (!so()) {
      if (!player.isRunning()) return false;
      wait(250ms);
    }
    return true;
  }
  bool waitForWords(test::Process& player, const char* words) {
    return waitFor(player, [&] { return textOf("said.txt").find(words) != std::string::npos; });
  }
  // What Kodi's users press on a remote control, and what the player then says of itself.
  void pressEachKeyOfTheRemote(test::Process& player) {
    const struct {
      unsigned key;
      const char* what;
      json value;
    } keys[] = {
        {KEY_PLAYPAUSE, "state", "paused"},  {KEY_NUMERIC_5, "position_s", 2.0}, {KEY_NUMERIC_0, "position_s", 0.0},
        {KEY_VOLUMEUP, "volume", 105.0},     {KEY_VOLUMEDOWN, "volume", 100.0},  {KEY_MUTE, "muted", true},
        {KEY_3D_MODE, "stereo", "sbs"},      {KEY_BLUE, "stereo", "tab"},        {KEY_GREEN, "depth_strength", 0.9},
        {KEY_YELLOW, "depth_strength", 1.0}, {KEY_RED, "loop", false},           {KEY_RED, "loop", true},
        {KEY_SLOW, "position_s", 0.2},       {KEY_OK, "state", "playing"},       {KEY_SLOW, "rate", 0.5},
        {KEY_FASTFORWARD, "rate", 1.0},      {KEY_PLAY, "state", "playing"},     {KEY_BACK, "state", "idle"}};
    std::vector<unsigned> all;
    for (const auto& each : keys) all.push_back(each.key);
    test::UinputRemote remote(all);
    test::ControlClient control(folder_ / "control", std::chrono::seconds(600));
    wait(1500ms);  // new devices are searched for every second
    for (const auto& [key, what, value] : keys) {
      remote.press(key, 1);
      wait(50ms);
      remote.press(key, 0);
      json last;
      EXPECT_TRUE(waitFor(player, [&, tries = 0]() mutable {
        last = control.ask("status")[what];
        return last == value || ++tries > 40;
      })) << textOf("said.txt");
      EXPECT_EQ(last, value) << what << " after key " << key;
    }
  }
  // The film's gray, in the middle of the screen of the size that was asked for.
  bool waitForPicture(test::Process& player) {
    return waitFor(player, [&] {
      const test::ScreenDump dump = screen_->dump();
      const auto [red, green, blue] = dump.at(dump.width / 2 + 40, dump.height / 2);
      return dump.width == 640 && red > 100 && red == green && green == blue;
    });
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<test::GuestScreen> screen_ = test::GuestScreen::find("virtio");
  MonotonicClock clock_;
};

TEST_F(PlayerScreen, ItStartsWithoutAScreenAndPlaysOnWhileItIsAway) {
  screen_->plug(false);
  test::Process player({std::string(RELIEVO_BIN_DIR) + "/relievo", "play", folder_ / "film.mkv", "--loop", "--display",
                        "kms:" + screen_->card(), "--size", "640x480", "--stereo", "mono", "--haptic", "none",
                        "--report", folder_ / "r.json", "--control", folder_ / "control"},
                       folder_ / "said.txt");
  EXPECT_TRUE(waitForWords(player, "no screen is connected")) << textOf("said.txt");
  screen_->plug(true);
  EXPECT_TRUE(waitForPicture(player)) << textOf("said.txt");
  screen_->plug(false);
  EXPECT_TRUE(waitForWords(player, "display lost")) << textOf("said.txt");
  wait(2s);
  EXPECT_TRUE(player.isRunning()) << textOf("said.txt");
  screen_->plug(true);
  EXPECT_TRUE(waitForPicture(player)) << textOf("said.txt");
  pressEachKeyOfTheRemote(player);
  player.send(SIGINT);
  EXPECT_EQ(player.wait(), 0) << textOf("said.txt");

  const json report = json::parse(textOf("r.json"), nullptr, false);
  std::vector<std::string> faults;
  for (const json& fault : report["faults"]) faults.push_back(fault["what"]);
  EXPECT_THAT(faults, testing::Contains(testing::StartsWith("display: no screen is connected")));
  EXPECT_THAT(faults, testing::Contains("display lost"));
  EXPECT_THAT(faults, testing::Contains("display back"));
  EXPECT_EQ(report["video"]["surface"], (json{640, 480}));
  EXPECT_GT(report["video"]["frames_shown"].get<int>(), 0);
  bool given_back = false;
  for (int i = 0; i < 40 && !given_back; ++i) {
    given_back = screen_->dump().width != 640;
    wait(250ms);
  }
  EXPECT_TRUE(given_back) << "the screen";
}

TEST_F(PlayerScreen, DevicesListsIt) {
  const auto listed = test::runProgram("relievo devices", folder_ / "");
  EXPECT_EQ(listed.exit_code, 0);
  EXPECT_THAT(listed.out, testing::HasSubstr("display kms:" + screen_->card()));
  EXPECT_THAT(listed.out, testing::HasSubstr("there  Virtual-1: 1280x800 at "));
}

}  // namespace
}  // namespace relievo
