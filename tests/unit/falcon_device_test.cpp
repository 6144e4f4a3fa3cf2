// SPDX-License-Identifier: Apache-2.0
// The Falcon's driver on a model of the device, in simulated time: loading, homing, exchange, and every way to fail.
#include "drivers/falcon/falcon.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <random>

#include "tests/support/falcon_model.h"
#include "tests/support/model_port.h"

namespace relievo {
namespace {

using test::Cable;
using test::FalconFaults;
using test::FalconModel;
using State = HapticDevice::State;

constexpr Duration kTick = std::chrono::milliseconds(1);

std::vector<std::uint8_t> image() {
  std::vector<std::uint8_t> bytes(2000);
  std::mt19937 random(7);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

class FalconDevice : public testing::Test {
 protected:
  FalconDevice() {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    path_ = std::filesystem::temp_directory_path() / ("relievo-firmware-" + name + ".bin");
    const auto bytes = image();
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  ~FalconDevice() override { std::filesystem::remove(path_); }

  std::unique_ptr<HapticDevice> make(FalconModel& model, std::string firmware = {}) {
    return makeFalcon({.firmware_path = std::move(firmware), .watchdog_thread = false},
                      std::make_unique<test::ModelPort>(model, cable_, clock_), clock_);
  }
  // Running, with the grip where the model has it.
  std::unique_ptr<HapticDevice> run(FalconModel& model) {
    model.runFirmware();
    auto device = make(model);
    EXPECT_TRUE(device->open() && device->home() && device->start());
    clock_.advance(kTick);
    return device;
  }
  void fadeIn(HapticDevice& device) {
    for (int i = 0; i < 600; ++i) tick(device, {});
  }
  Result<HapticSample> tick(HapticDevice& device, const glm::dvec3& force_n) {
    auto sample = device.read();
    EXPECT_TRUE(!sample || device.write(force_n));
    clock_.advance(kTick);
    return sample;
  }

  std::filesystem::path path_;
  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  Cable cable_;
  HapticDevice* device_ = nullptr;  // for a model that acts on its driver
};

TEST_F(FalconDevice, UsesFirmwareThatRunsAlready) {
  FalconModel model(image());
  model.runFirmware();
  const auto device = make(model);
  ASSERT_TRUE(device->open());
  EXPECT_EQ(model.loads(), 0);
}

TEST_F(FalconDevice, LoadsItsFirmware) {
  FalconModel model(image());
  const auto device = make(model, path_);
  const auto opened = device->open();
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(model.running());
  EXPECT_EQ(model.loads(), 1);
}

TEST_F(FalconDevice, LoadsItAlsoWhenTheFirstTriesFailInEachWayThatUsersReport) {
  const FalconFaults ways[] = {
      {.silent_loads = 2}, {.wrong_echo_loads = 2},
      {.dead_loads = 2},   {.leading_zero = true},
      {.most_payload = 3}, {.silent_loads = 1, .wrong_echo_loads = 1, .dead_loads = 1, .leading_zero = true}};
  for (const FalconFaults& faults : ways) {
    FalconModel model(image(), faults);
    const auto device = make(model, path_);
    const auto opened = device->open();
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(model.running());
    EXPECT_EQ(model.loads(), 1 + faults.silent_loads + faults.wrong_echo_loads + faults.dead_loads);
  }
}

TEST_F(FalconDevice, GivesUpOnADeviceThatNeverTakesIt) {
  FalconModel silent(image(), {.silent_loads = 1000}), dead(image(), {.dead_loads = 1000});
  EXPECT_EQ(make(silent, path_)->open().error().code, ErrorCode::Timeout);
  EXPECT_EQ(make(dead, path_)->open().error().code, ErrorCode::Corrupt);
  EXPECT_FALSE(cable_.open);
}

TEST_F(FalconDevice, GivesUpOnALineThatNeverStopsToBreak) {
  FalconModel model(image(), {.broken_line = true});
  EXPECT_EQ(make(model, path_)->open().error().code, ErrorCode::Timeout);
  EXPECT_EQ(make(model)->open().error().code, ErrorCode::NotFound) << "no firmware answers";
}

TEST_F(FalconDevice, SaysWhatIsWrongWithTheFirmwaresFile) {
  FalconModel model(image());
  EXPECT_EQ(make(model)->open().error().code, ErrorCode::NotFound);
  EXPECT_EQ(make(model, "/nowhere/firmware.bin")->open().error().code, ErrorCode::NotFound);
  std::ofstream(path_, std::ios::trunc);
  EXPECT_EQ(make(model, path_)->open().error().code, ErrorCode::Corrupt);
  EXPECT_EQ(model.loads(), 0);
}

TEST_F(FalconDevice, HomesWithoutForceAndRedThenRunsGreen) {
  FalconModel model(image());
  model.runFirmware();
  const auto device = make(model);
  ASSERT_TRUE(device->open() && device->home());
  EXPECT_TRUE(model.homed());
  for (const auto& words : model.history()) EXPECT_EQ(words, (falcon::Words{}));
  ASSERT_TRUE(device->start());
  EXPECT_TRUE(model.last().green);
  EXPECT_FALSE(model.last().red || model.last().homing);
}

TEST_F(FalconDevice, AHomingThatNobodyHelpsEndsWhenItIsCalledOff) {
  FalconModel model(image());
  model.runFirmware();
  model.grip = [&](double t_s) {
    if (t_s > 3) device_->cancel();
    return glm::dvec3(0, 0, 115);
  };
  auto device = make(model);
  device_ = device.get();
  ASSERT_TRUE(device->open());
  EXPECT_EQ(device->home().error().code, ErrorCode::Cancelled);
  EXPECT_FALSE(model.homed());
  device->close();
  EXPECT_TRUE(device->open()) << "closing forgets the call";
}

TEST_F(FalconDevice, ThePositionIsTheGripsWithinACount) {
  FalconModel model(image());
  const auto device = run(model);
  model.grip = [](double t_s) {
    return glm::dvec3(30 * std::sin(2 * t_s), 25 * std::sin(3 * t_s + 1), 120 + 30 * std::sin(1.3 * t_s));
  };
  for (int i = 0; i < 20; ++i) (void)tick(*device, {});
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 answered = model.gripNow(clock_.now() - kTick);  // when the last command was answered
    const auto sample = tick(*device, {});
    ASSERT_TRUE(sample);
    worst = std::max(worst, glm::distance(sample->position_mm, answered));
  }
  EXPECT_LT(worst, 0.1) << "half a count of each leg";
}

TEST_F(FalconDevice, TheForceReachesTheMotorsWithinACount) {
  FalconModel model(image());
  const auto device = run(model);
  fadeIn(*device);
  const glm::dvec3 at = device->read()->position_mm;
  for (const glm::dvec3& force :
       {glm::dvec3(2, 0, 0), glm::dvec3(0, -3, 0), glm::dvec3(1, 1, -2), glm::dvec3(0, 0, 5)}) {
    (void)tick(*device, force);
    const auto exact = -falcon::kDefaultCountsPerNm * 1e-3 * falcon::torquesOf(force, *falcon::inverse(at));
    for (std::size_t leg = 0; leg < 3; ++leg) {
      EXPECT_NEAR(model.last().motors[leg], exact[static_cast<int>(leg)], 0.51) << leg;
    }
    EXPECT_LT(glm::distance(FalconModel::forceOf(model.last().motors, at, falcon::kDefaultCountsPerNm), force), 0.003);
  }
}

TEST_F(FalconDevice, TheForceFadesInAfterStart) {
  FalconModel model(image());
  const auto device = run(model);
  double before = 0;
  for (int i = 0; i < 500; ++i) {
    const auto at = tick(*device, {0, 0, 4})->position_mm;
    const double felt = FalconModel::forceOf(model.last().motors, at, falcon::kDefaultCountsPerNm).z;
    ASSERT_LE(felt - before, 0.05) << "4 N in half a second are 8 mN a tick, and a word's rounding";
    before = felt;
  }
  EXPECT_NEAR(before, 4, 0.05);
}

TEST_F(FalconDevice, ATickAllocatesNothing) {
  FalconModel model(image());
  const auto device = run(model);
  const auto own = [&] { return threadAllocations() - cable_.model_allocations; };
  const auto before = own();
  for (int i = 0; i < 1000; ++i) {
    (void)device->read();
    (void)device->write({0, 0, 1});
    clock_.advance(kTick);
  }
  EXPECT_EQ(own(), before);
}

// No checksum guards a packet. What is asked: a position that was never there is not taken for one (0.25 mm is the
// gate's slack, see EncoderGate), and no force beyond the limit goes out.
TEST_F(FalconDevice, CorruptSplitAndLostPacketsMakeNoWrongPositionAndNoWildForce) {
  std::mt19937 random(99);
  bool spoiling = false;
  int spoiled = 0;
  const auto below = [&random](unsigned n) { return random() % n; };
  FalconFaults faults;
  faults.spoil = [&](std::vector<std::uint8_t>& bytes) {
    if (!spoiling || below(4) != 0) return;
    ++spoiled;
    switch (below(4)) {
      case 0:  // another byte
        bytes[below(16)] = static_cast<std::uint8_t>(random());
        break;
      case 1:  // another nibble, as a packet may well have it
        bytes[1 + below(12)] = static_cast<std::uint8_t>('A' + below(16));
        break;
      case 2:  // a part is lost
        bytes.erase(bytes.begin() + below(15), bytes.end());
        break;
      default:  // something comes before it
        bytes.insert(bytes.begin(), {'<', 'A', '>', static_cast<std::uint8_t>(random())});
    }
  };
  FalconModel model(image(), faults);
  const auto device = run(model);
  fadeIn(*device);
  model.grip = [](double t_s) {
    return glm::dvec3(20 * std::sin(4 * t_s), 20 * std::sin(5 * t_s), 120 + 20 * std::sin(3 * t_s));
  };
  for (int i = 0; i < 50; ++i) (void)tick(*device, {});
  spoiling = true;
  double worst = 0;
  int held = 0;
  for (int i = 0; i < 10'000; ++i) {
    const glm::dvec3 answered = model.gripNow(clock_.now() - kTick);
    const auto sample = tick(*device, {0, 0, 8});
    ASSERT_TRUE(sample) << sample.error().message;
    const double off = glm::distance(sample->position_mm, answered);
    // A tick without a good word shows an older place: up to 0.2 mm a tick at this speed.
    held += off > 0.15 ? 1 : 0;
    worst = std::max(worst, off);
    for (const std::int16_t word : model.last().motors) ASSERT_LE(std::abs(word), falcon::kMostWord);
  }
  EXPECT_GT(spoiled, 2000);
  EXPECT_LT(worst, 1.0);
  EXPECT_LT(held, 3500);
}

TEST_F(FalconDevice, IsLostWhenItSaysNothingAnyMore) {
  FalconModel model(image());
  const auto device = run(model);
  model.powerOn();
  int ticks = 0;
  while (device->state() == State::Running && ticks < 1000) (void)tick(*device, {0, 0, 1}), ++ticks;
  EXPECT_EQ(device->state(), State::Lost);
  EXPECT_NEAR(ticks, 101, 2);
}

TEST_F(FalconDevice, AForceThatNobodyRenewsEnds) {
  FalconModel model(image());
  const auto device = run(model);
  fadeIn(*device);
  (void)tick(*device, {0, 0, 3});
  EXPECT_NE(model.last().motors, (falcon::Words{}));
  clock_.advance(std::chrono::milliseconds(18));
  ASSERT_TRUE(device->read());
  EXPECT_NE(model.last().motors, (falcon::Words{})) << "one late tick is not yet a reason";
  clock_.advance(std::chrono::milliseconds(4));
  ASSERT_TRUE(device->read());
  EXPECT_EQ(model.last().motors, (falcon::Words{}));
  ASSERT_TRUE(device->write({0, 0, 3}));
  EXPECT_LT(FalconModel::forceOf(model.last().motors, {0, 0, 120}, falcon::kDefaultCountsPerNm).z, 0.3)
      << "it fades in anew";
}

TEST_F(FalconDevice, ForceIsZeroAfterStopCloseAndTheEnd) {
  FalconModel model(image());
  const auto push = [&](HapticDevice& device) {
    fadeIn(device);
    (void)tick(device, {0, 0, 3});
    EXPECT_NE(model.last().motors, (falcon::Words{}));
  };
  auto device = run(model);
  push(*device);
  device->stop();
  EXPECT_EQ(model.last().motors, (falcon::Words{}));
  ASSERT_TRUE(device->start());
  push(*device);
  device->close();
  EXPECT_EQ(model.last().motors, (falcon::Words{}));
  EXPECT_FALSE(cable_.open || cable_.exchanging);
  device.reset();
  device = run(model);
  push(*device);
  device.reset();
  EXPECT_EQ(model.last().motors, (falcon::Words{}));
}

// The cable is pulled at the first verb of the port, then at the second, and so on through the whole life; then it is
// plugged in and everything works.
TEST_F(FalconDevice, UnpluggedAtAnyMomentItIsCleanAndComesBack) {
  const auto live = [&](HapticDevice& device) -> Result<void> {
    if (auto opened = device.open(); !opened) return opened;
    if (auto homed = device.home(); !homed) return homed;
    if (auto started = device.start(); !started) return started;
    for (int i = 0; i < 30; ++i) {
      clock_.advance(kTick);
      if (auto sample = device.read(); !sample) return std::unexpected(sample.error());
      if (auto written = device.write({0, 0, 1}); !written) return written;
    }
    device.stop();
    return {};
  };
  int moment = 1;
  for (bool whole = false; !whole; ++moment) {
    FalconModel model(image());
    cable_ = Cable{.verbs_left = moment};
    const auto device = make(model, path_);
    const auto lived = live(*device);
    whole = lived.has_value();
    if (!whole) {
      ASSERT_FALSE(lived) << moment;
      ASSERT_TRUE(lived.error().code == ErrorCode::Lost || lived.error().code == ErrorCode::NotFound) << moment;
    }
    device->close();
    ASSERT_EQ(device->state(), State::Closed);
    ASSERT_FALSE(cable_.open || cable_.exchanging) << moment;
    // Every moment of the firmware's upload is like its neighbours: only some of them are tried again whole.
    if (moment % 7 != 0 && moment > 40) continue;
    cable_ = Cable{};
    model.powerOn();
    const auto again = live(*device);
    ASSERT_TRUE(again) << moment << ": " << again.error().message;
    device->close();
  }
  EXPECT_GT(moment, 300);
}

}  // namespace
}  // namespace relievo
