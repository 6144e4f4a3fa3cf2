// SPDX-License-Identifier: Apache-2.0
// The appliance in use. toolchain/appliance-check runs this test inside the virtual machine, beside the service. The
// test plays the part of the screen, the Falcon and the remote control, and causes faults.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>
#include <linux/cec.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>

#include "drivers/falcon/link.h"
#include "platform/clock.h"
#include "tests/support/device/usb/vhci_usb.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/slope.h"
#include "tests/support/machine/control_client.h"
#include "tests/support/machine/guest_screen.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::ControlClient;
using Json = ControlClient::Json;

constexpr const char* kControl = "/run/relievo/control";
constexpr const char* kProcesses = "/sys/fs/cgroup/system.slice/relievo.service/cgroup.procs";
constexpr auto kPatience = 60s;  // of virtual time
constexpr const char* kSlope = "/srv/films/slope.mkv";
// The same film drawn twice; the one outside has come through a file of half the colour resolution: 2.3 and 6.0 of 255.
constexpr double kSameMean = 4, kSameSquare = 10;
constexpr int kWidth = 320;          // of its screen
constexpr Duration kWatchdog = 10s;  // the service's WatchdogSec=

// What is plugged into the box, from the first test to the last.
struct Room {
  test::FalconModel falcon{{}};
  std::unique_ptr<test::VhciUsb> cable;
  std::unique_ptr<test::GuestScreen> screen = test::GuestScreen::find("virtio");
  std::unique_ptr<libevdev_uinput, decltype(&libevdev_uinput_destroy)> remote{nullptr, libevdev_uinput_destroy};
  MonotonicClock clock;

  Room() {
    falcon.runFirmware();
    falcon.grip = [this, homing = falcon.grip](double t_s) { return falcon.homed() ? place(t_s) : homing(t_s); };
    cable = std::make_unique<test::VhciUsb>(falcon, falcon::kUsbId);
    libevdev* const keys = libevdev_new();
    libevdev_set_name(keys, "infra-red");
    libevdev_enable_event_code(keys, EV_KEY, KEY_PLAYPAUSE, nullptr);
    libevdev_uinput* made = nullptr;
    libevdev_uinput_create_from_device(keys, LIBEVDEV_UINPUT_OPEN_MANAGED, &made);
    libevdev_free(keys);
    remote.reset(made);
  }
  // What the hand does once the Falcon is homed: it goes slowly in circles, far above everything or pressed in. A
  // finger that is in the relief when a film begins is free until it has come out.
  void press(bool in) {
    const std::lock_guard guard(cable->lock());
    pressed_ = in;
  }
  bool pushes() {
    const std::lock_guard guard(cable->lock());
    return falcon.pushes(clock.now());
  }

 private:
  glm::dvec3 place(double t_s) {
    constexpr double kMmPerS = 100, kLifted = 150, kPressed = 118,
                     kRadPerS = 0.2;  // the finger is drawn anew as it moves
    const double way = kMmPerS * (t_s - placed_s_);
    placed_s_ = t_s;
    z_mm_ += std::clamp((pressed_ ? kPressed : kLifted) - z_mm_, -way, way);
    return {6 * std::sin(kRadPerS * t_s), 6 * std::cos(kRadPerS * t_s), z_mm_};
  }
  bool pressed_ = false;
  double z_mm_ = 150, placed_s_ = 0;
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
  static bool plays(ControlClient& box, const std::string& film) {
    const Json status = box.ask("status");
    return status["state"] == "playing" && status["source"] == film;
  }
  // The slope plays, is seen and pushes.
  static void expectTheSlope(ControlClient& box) {
    ASSERT_TRUE(box.connected());
    room_->press(false);
    ASSERT_EQ(box.ask(std::string("open ") + kSlope)["ok"], true);
    EXPECT_TRUE(within(kPatience, [&] { return plays(box, kSlope); })) << "no film";
    room_->press(true);
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
    const auto [red, green, blue] = dump.at(dump.width * 5 / 8, dump.height * 3 / 8);
    return dump.width == kWidth && red > 60 && red == green && green == blue;
  }
  // How much the screen differs from a picture, above the text, in levels of 255: on average, and in the worst square
  // of 20 pixels. Eight squares are left out, since each eye's picture of the finger may cover some.
  struct Distance {
    double mean = 255, square = 255;
  };
  static Distance distance(const test::ScreenDump& a, const test::ScreenDump& b) {
    constexpr int kSide = 20, kRows = 180;
    if (a.width != kWidth || a.width != b.width || a.height != b.height || a.height < kRows) return {};
    const int across = (a.width + kSide - 1) / kSide;
    const std::size_t bytes = static_cast<std::size_t>(a.width) * kRows * 3;
    std::vector<double> squares(static_cast<std::size_t>(across) * kRows / kSide);
    double sum = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      const int pixel = static_cast<int>(i / 3), difference = std::abs(a.rgb[i] - b.rgb[i]);
      squares[pixel / a.width / kSide * across + pixel % a.width / kSide] += difference;
      sum += difference;
    }
    std::ranges::sort(squares, std::greater());
    return {sum / static_cast<double>(bytes), squares[8] / (3 * kSide * kSide)};
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
  room_->press(true);
  EXPECT_TRUE(within(kPatience, [] { return room_->pushes(); })) << "no force";
  note("until it is felt", room_->clock.now() - MonotonicTime{});
  // A place of the film that toolchain/appliance-check has had drawn off screen, outside the box.
  const test::ScreenDump there = test::readPixels(std::string(std::getenv("RELIEVO_SCREENS")) + "/host.ppm");
  ASSERT_EQ(box.ask("pause")["ok"], true);
  ASSERT_EQ(box.ask("seek 2")["ok"], true);
  Distance apart;
  for (int looks = 0; looks < 40 && (apart.mean > kSameMean || apart.square > kSameSquare); ++looks) {
    pass(250ms);
    apart = distance(room_->screen->dump(), there);
  }
  std::printf("   from the picture outside the box: mean %.2f of 255, worst square %.2f\n", apart.mean, apart.square);
  EXPECT_LE(apart.mean, kSameMean);
  EXPECT_LE(apart.square, kSameSquare);
}

TEST_F(Appliance, TheMotorsPushOutOfTheSlopeAlongItsNormal) {
  test::makeSlope(kSlope, 5);
  ::chmod(kSlope, 0644);
  ControlClient box(kControl, kPatience);
  expectTheSlope(box);
  pass(600ms);  // the force has faded in, which takes 500
  constexpr double kMmPerCol = 160.0 / test::kSlopeCols;
  const double z = 40.0 / 65535.0;
  const glm::dvec3 normal =
      glm::normalize(glm::dvec3(-test::kSlopePerCol * z / kMmPerCol, test::kSlopePerRow * z / kMmPerCol, 1.0));
  double least = 1e9, most = 0, worst = 1;
  for (int i = 0; i < 500; ++i) {
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
  EXPECT_GT(worst, std::cos(3 / 57.3));
}

TEST_F(Appliance, AKeyOfTheRemotePausesAndPlays) {
  ASSERT_NE(room_->remote, nullptr);
  ControlClient box(kControl, kPatience);
  for (const char* state : {"paused", "playing"}) {
    for (const int value : {1, 0}) {
      libevdev_uinput_write_event(room_->remote.get(), EV_KEY, KEY_PLAYPAUSE, value);
      libevdev_uinput_write_event(room_->remote.get(), EV_SYN, SYN_REPORT, 0);
      pass(50ms);
    }
    EXPECT_TRUE(within(5s, [&] { return box.ask("status")["state"] == state; })) << state;
  }
}

// The kernel's virtual adapters are a television and a box that is plugged into it.
class Cec {
 public:
  Cec(const char* path, std::uint32_t flags, std::uint8_t type, std::uint8_t device)
      : fd_(::open(path, O_RDWR | O_CLOEXEC)) {
    cec_log_addrs addresses{};
    ::ioctl(fd_.get(), CEC_ADAP_S_LOG_ADDRS, &addresses);  // none, so that it may be set
    addresses = {};
    addresses.cec_version = CEC_OP_CEC_VERSION_1_4;
    addresses.num_log_addrs = 1;
    addresses.vendor_id = CEC_VENDOR_ID_NONE;
    addresses.flags = flags;
    addresses.log_addr_type[0] = type;
    addresses.primary_device_type[0] = device;
    ready_ = ::ioctl(fd_.get(), CEC_ADAP_S_LOG_ADDRS, &addresses) == 0;
    address_ = addresses.log_addr[0];
  }
  [[nodiscard]] bool ready() const { return ready_; }
  [[nodiscard]] std::uint8_t address() const { return address_; }
  bool send(std::uint8_t to, std::initializer_list<std::uint8_t> bytes) const {
    cec_msg message{};
    message.msg[message.len++] = static_cast<std::uint8_t>(address_ << 4 | to);
    for (const std::uint8_t byte : bytes) message.msg[message.len++] = byte;
    return ::ioctl(fd_.get(), CEC_TRANSMIT, &message) == 0 && (message.tx_status & CEC_TX_STATUS_OK) != 0;
  }

 private:
  UniqueFd fd_;
  bool ready_ = false;
  std::uint8_t address_ = 0;
};

TEST_F(Appliance, AKeyOfTheTelevisionPausesAndPlays) {
  const Cec television("/dev/cec0", 0, CEC_LOG_ADDR_TYPE_TV, CEC_OP_PRIM_DEVTYPE_TV);
  const Cec plug("/dev/cec1", CEC_LOG_ADDRS_FL_ALLOW_RC_PASSTHRU, CEC_LOG_ADDR_TYPE_PLAYBACK,
                 CEC_OP_PRIM_DEVTYPE_PLAYBACK);
  ASSERT_TRUE(television.ready());
  ASSERT_TRUE(plug.ready());
  ControlClient box(kControl, kPatience);
  constexpr std::uint8_t kPlay = 0x44, kPause = 0x46;  // HDMI 1.4, CEC table 30
  for (const auto& [key, state] : {std::pair{kPause, "paused"}, {kPlay, "playing"}}) {
    EXPECT_TRUE(television.send(plug.address(), {CEC_MSG_USER_CONTROL_PRESSED, key}));
    pass(100ms);
    EXPECT_TRUE(television.send(plug.address(), {CEC_MSG_USER_CONTROL_RELEASED}));
    EXPECT_TRUE(within(5s, [&] { return box.ask("status")["state"] == state; })) << state;
  }
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
    pass(1s);
  }
  expectTheSlope(box);
  EXPECT_EQ(service(), before) << "it was started anew";
}

// Signals end it without a chance to react, or it hangs, which only the watchdog of the service manager notices.
TEST_F(Appliance, KilledOrHungItLetsGoAndComesBack) {
  for (const int number : {SIGKILL, SIGSTOP, SIGSEGV}) {
    SCOPED_TRACE(::strsignal(number));
    ASSERT_TRUE(within(kPatience, [] { return room_->pushes(); }));
    const pid_t before = service();
    const MonotonicTime ended = room_->clock.now();
    ::kill(before, number);
    EXPECT_TRUE(within(kWatchdog, [] { return !room_->pushes(); })) << "the motors still push";
    note((std::string("zero force after ") + ::strsignal(number)).c_str(), room_->clock.now() - ended);
    EXPECT_TRUE(within(kPatience, [&] { return service() != 0 && service() != before; })) << "it is not started again";
    ControlClient box(kControl, kPatience);
    expectTheSlope(box);
    note("until the picture is back", room_->clock.now() - ended);
  }
}

}  // namespace
}  // namespace relievo
