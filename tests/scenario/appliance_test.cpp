// SPDX-License-Identifier: Apache-2.0
// The box as it stands in somebody's room: toolchain/appliance-check runs this inside, beside the service, as its
// screen, its Falcon, its remote control and its bad luck.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>
#include <signal.h>
#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>

#include "drivers/falcon/link.h"
#include "platform/clock.h"
#include "tests/support/clip_maker.h"
#include "tests/support/control_client.h"
#include "tests/support/guest_screen.h"
#include "tests/support/slope.h"
#include "tests/support/vhci_usb.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::ControlClient;
using Json = ControlClient::Json;

constexpr const char* kControl = "/run/relievo/control";
constexpr const char* kProcesses = "/sys/fs/cgroup/system.slice/relievo.service/cgroup.procs";
constexpr auto kPatience = 120s;  // of virtual time: the shaders alone take 22 s of it
constexpr const char* kSlope = "/srv/films/slope.mkv";
constexpr Duration kWatchdog = 120s;  // WatchdogSec= as toolchain/appliance-check sets it

// What is plugged into the box, from the first test to the last.
struct Room {
  test::FalconModel falcon{{}};
  std::unique_ptr<test::VhciUsb> cable;
  std::unique_ptr<test::GuestScreen> screen = test::GuestScreen::find("virtio");
  MonotonicClock clock;

  Room() {
    falcon.runFirmware();
    test::circle(falcon);
    cable = std::make_unique<test::VhciUsb>(falcon, falcon::kUsbId);
  }
  bool pushes() {
    const std::lock_guard guard(cable->lock());
    return falcon.pushes(clock.now());
  }
};

class Appliance : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!test::VhciUsb::available()) return;
    room_ = std::make_unique<Room>();
  }
  static void TearDownTestSuite() { room_.reset(); }
  void SetUp() override {
    if (room_ == nullptr || room_->screen == nullptr) GTEST_SKIP() << "run it by toolchain/appliance-check";
  }

  template <class Wanted>
  static bool within(Duration time, Wanted&& wanted) {
    const MonotonicTime end = room_->clock.now() + time;
    while (!wanted()) {
      if (room_->clock.now() > end) return false;
      room_->clock.sleepUntil(room_->clock.now() + 1ms);
    }
    return true;
  }
  static void pass(Duration time) { room_->clock.sleepUntil(room_->clock.now() + time); }
  static pid_t service() {
    std::ifstream file(kProcesses);
    pid_t pid = 0;
    file >> pid;
    return pid;
  }
  // The slope plays, is seen and pushes.
  static void expectTheSlope(ControlClient& box) {
    ASSERT_TRUE(box.connected());
    ASSERT_EQ(box.ask(std::string("open ") + kSlope)["ok"], true);
    EXPECT_TRUE(within(kPatience, [] { return room_->pushes(); })) << "no force";
    int looks = 0;  // the time that QEMU takes for one does not count
    while (looks < 40 && !showsTheSlope()) {
      pass(250ms);
      ++looks;
    }
    EXPECT_LT(looks, 40) << "no picture";
  }
  // Its picture is one of gray: in the middle of the screen, beside the finger, there is nothing else.
  static bool showsTheSlope() {
    const test::ScreenDump dump = room_->screen->dump();
    const auto [red, green, blue] = dump.at(dump.width / 2 + 80, dump.height / 2 - 60);
    return dump.width == 640 && red > 60 && red == green && green == blue;
  }
  static void note(const char* what, Duration time) { std::printf("   %-46s %8.3f s\n", what, toSeconds(time)); }

  static std::unique_ptr<Room> room_;
};
std::unique_ptr<Room> Appliance::room_;

TEST_F(Appliance, FromPowerOnToAPictureThatCanBeTouched) {
  ControlClient box(kControl, kPatience);
  ASSERT_TRUE(box.connected());
  EXPECT_TRUE(within(kPatience, [&] { return box.ask("status")["state"] == "playing"; }));
  note("from the kernel's start to the film", room_->clock.now() - MonotonicTime{});
  EXPECT_TRUE(within(kPatience, [] {
    const std::lock_guard guard(room_->cable->lock());
    return room_->falcon.homed();
  }));
  // A place of the film that the host can draw as well.
  ASSERT_EQ(box.ask("pause")["ok"], true);
  ASSERT_EQ(box.ask("seek 2")["ok"], true);
  pass(3s);
  const test::ScreenDump dump = room_->screen->dump();
  EXPECT_EQ(dump.width, 640);
  EXPECT_EQ(dump.height, 480);
}

TEST_F(Appliance, TheMotorsPushOutOfTheSlopeAlongItsNormal) {
  test::makeSlope(kSlope);
  ::chmod(kSlope, 0644);
  ControlClient box(kControl, kPatience);
  expectTheSlope(box);
  pass(3s);  // pressed in, and the force faded in
  constexpr double kMmPerCol = 160.0 / test::kSlopeCols;
  const double z = 40.0 / 65535.0;
  const glm::dvec3 normal =
      glm::normalize(glm::dvec3(-test::kSlopePerCol * z / kMmPerCol, test::kSlopePerRow * z / kMmPerCol, 1.0));
  double least = 1e9, most = 0, worst = 1;
  for (int i = 0; i < 2000; ++i) {
    pass(1ms);
    const std::lock_guard guard(room_->cable->lock());
    const MonotonicTime now = room_->clock.now();
    const glm::dvec3 force = room_->falcon.forceAt(room_->falcon.gripNow(now), now);
    least = std::min(least, glm::length(force));
    most = std::max(most, glm::length(force));
    if (glm::length(force) > 0.1) worst = std::min(worst, glm::dot(glm::normalize(force), normal));
  }
  std::printf("   force %.2f to %.2f N, off the normal by at most %.1f degrees\n", least, most,
              std::acos(worst) * 57.3);
  EXPECT_GT(least, 0.5);
  EXPECT_LT(most, 10.5);
  EXPECT_GT(worst, std::cos(12 / 57.3));
}

TEST_F(Appliance, AKeyOfTheRemotePausesAndPlays) {
  libevdev* const codes = libevdev_new();
  libevdev_set_name(codes, "infra-red");
  libevdev_enable_event_code(codes, EV_KEY, KEY_PLAYPAUSE, nullptr);
  libevdev_uinput* remote = nullptr;
  ASSERT_EQ(libevdev_uinput_create_from_device(codes, LIBEVDEV_UINPUT_OPEN_MANAGED, &remote), 0);
  libevdev_free(codes);
  pass(3s);  // until the player has found it
  ControlClient box(kControl, kPatience);
  for (const char* state : {"paused", "playing"}) {
    for (const int value : {1, 0}) {
      libevdev_uinput_write_event(remote, EV_KEY, KEY_PLAYPAUSE, value);
      libevdev_uinput_write_event(remote, EV_SYN, SYN_REPORT, 0);
      pass(50ms);
    }
    EXPECT_TRUE(within(5s, [&] { return box.ask("status")["state"] == state; })) << state;
  }
  libevdev_uinput_destroy(remote);
}

TEST_F(Appliance, GarbageCostsTheFilmAndNothingElse) {
  const pid_t before = service();
  std::mt19937 random(7);
  std::string noise(200'000, '\0');
  for (char& byte : noise) byte = static_cast<char>(random());
  std::ofstream("/srv/films/noise.mkv", std::ios::binary) << noise;
  std::ifstream whole(kSlope, std::ios::binary);
  std::string spoilt{std::istreambuf_iterator<char>(whole), {}};
  for (std::size_t i = 2000; i < spoilt.size(); i += 97) spoilt[i] = noise[i % noise.size()];
  std::ofstream("/srv/films/spoilt.mkv", std::ios::binary) << spoilt;
  ControlClient box(kControl, kPatience), flood(kControl);
  flood.sendBytes(noise.substr(0, 4000));
  ASSERT_TRUE(within(kPatience, [] { return room_->pushes(); }));
  for (const char* film : {"/srv/films/noise.mkv", "/srv/films/spoilt.mkv"}) {
    const MonotonicTime opened = room_->clock.now();
    EXPECT_EQ(box.ask(std::string("open ") + film)["ok"], true);
    EXPECT_TRUE(within(kWatchdog, [] { return !room_->pushes(); })) << film;
    note(film, room_->clock.now() - opened);
    pass(2s);
  }
  expectTheSlope(box);
  EXPECT_EQ(service(), before) << "it was started anew";
}

// By whatever ends it without a word, and by what only the service manager's watchdog sees.
TEST_F(Appliance, KilledOrHungItLetsGoAndComesBack) {
  for (const int number : {SIGKILL, SIGSTOP, SIGSEGV}) {
    SCOPED_TRACE(::strsignal(number));
    ASSERT_TRUE(within(kPatience, [] { return room_->pushes(); }));
    const pid_t before = service();
    const MonotonicTime ended = room_->clock.now();
    ::kill(before, number);
    EXPECT_TRUE(within(kWatchdog + 1s, [] { return !room_->pushes(); })) << "the motors still push";
    note((std::string("zero force after ") + ::strsignal(number)).c_str(), room_->clock.now() - ended);
    EXPECT_TRUE(within(kPatience, [&] { return service() != 0 && service() != before; })) << "it is not started again";
    ControlClient box(kControl, kPatience);
    expectTheSlope(box);
    note("until the picture is back", room_->clock.now() - ended);
  }
}

}  // namespace
}  // namespace relievo
