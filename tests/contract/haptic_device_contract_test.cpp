// SPDX-License-Identifier: Apache-2.0
// Every haptic device under the contract; the guard itself; tests that need the fault switches of a mock.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "drivers/falcon/falcon.h"
#include "drivers/gamepad/gamepad.h"
#include "drivers/inverse3/inverse3.h"
#include "drivers/mock/mock.h"
#include "drivers/pointer/pointer.h"
#include "drivers/polhem/polhem.h"
#include "drivers/replay/replay.h"
#include "drivers/sample/sample.h"
#include "drivers/sim/sim.h"
#include "tests/contract/suite/haptic_device.h"
#include "tests/support/device/fake_mouse.h"
#include "tests/support/device/fake_pad.h"
#include "tests/support/device/falcon_model.h"
#include "tests/support/device/inverse3_service.h"
#include "tests/support/device/model_port.h"
#include "tests/support/device/polhem_model.h"

namespace relievo {
namespace {

using Rig = test::HapticRig;
using State = HapticDevice::State;
constexpr Duration kTick = std::chrono::milliseconds(1);
constexpr double kPeakN = 8.5;

Rig mock(MockHapticProfile profile, ManualClock& clock) {
  profile.capabilities.peak_force_n = kPeakN;
  auto bench = std::make_shared<MockHapticBench>();
  auto device = makeMockHaptic(std::move(profile), clock, bench);
  return {bench, std::move(device), [bench] { return bench->force() != glm::dvec3(0); }};
}

// A free mass: it moves when it is pushed, and otherwise its damping stops it within some milliseconds. To observe it,
// the device is brought back to Running.
Rig sim(ManualClock& clock) {
  DeviceProfile profile;
  profile.damping_n_s_per_mm = 0.075;  // 1 N moves it by 13 um a tick
  profile.coulomb_friction_n = 0;
  profile.encoder_step_mm = 0;
  profile.delay_ticks = 0;
  profile.peak_force_n = kPeakN;
  profile.hand = {.mass_kg = 0, .stiffness_n_per_mm = 0, .damping_n_s_per_mm = 0};
  Rig rig{nullptr, makeSimHaptic(profile, HandPath({{0.0, {0, 0, 20}}}), clock), nullptr};
  rig.pushes = [&device = *rig.device, &clock] {
    const bool running = (device.state() != State::Closed || device.open()) &&
                         (device.state() != State::Opened || device.home()) &&
                         (device.state() != State::Ready || device.start());
    EXPECT_TRUE(running);
    const auto before = device.read();
    clock.advance(kTick);
    const auto after = device.read();
    return !before || !after || glm::distance(before->position_mm, after->position_mm) > 1e-3;
  };
  return rig;
}

// The real driver on a model of the device.
Rig falcon(ManualClock& clock, bool loses) {
  struct Bench {
    test::FalconModel model{{}};
    test::Cable cable;
  };
  auto bench = std::make_shared<Bench>();
  bench->model.runFirmware();
  auto device = makeFalcon({.watchdog_thread = false},
                           std::make_unique<test::ModelPort>(bench->model, bench->cable, clock), clock);
  if (loses) {
    bench->cable.comes_back = true;
    bench->model.grip = [bench = bench.get()](double t_s) {
      // Homed, then gone with the first exchange after that.
      if (bench->model.last().green) bench->cable.plugged = false;
      return glm::dvec3(0, 0, 120 + 45 * std::sin(6.283 * t_s));
    };
  }
  return {bench, std::move(device), [bench] { return bench->model.last().motors != relievo::falcon::Words{}; },
          [bench] { return bench->cable.model_allocations; }, 600};
}

// A pad that rumbles, or a wheel.
Rig gamepad(ManualClock& clock, const PadFacts& facts, bool loses) {
  auto pad = std::make_shared<test::FakePad>();
  pad->facts = facts;
  pad->comes_back = true;
  pad->goes_when_started = loses;
  auto device = makeGamepad(std::make_unique<test::FakePadPort>(pad), clock, {.effect_thread = false});
  return {pad, std::move(device), [pad] { return pad->pushes(); }};
}

// A mouse.
Rig pointer(ManualClock& clock, bool loses) {
  auto mouse = std::make_shared<test::FakeMouse>();
  mouse->comes_back = true;
  mouse->goes_when_started = loses;
  return {mouse, makePointer(std::make_unique<test::FakeMousePort>(mouse), clock), [] { return false; }};
}

Rig pointerOverWindow(ManualClock& clock) {
  auto window = std::make_shared<WindowInput>();
  window->open = true;
  return {window, makePointer(window, clock), [] { return false; }};
}

Rig replay() {
  const auto recording = Recording::parse("t_s,x_mm,y_mm,z_mm\n0,1,2,3\n0.001,1,2,2.9\n", "recording");
  return {nullptr, makeReplay(recording.value()), [] { return false; }};
}

// Like the Falcon, but calibrated in the middle of the workspace, so that it is inside from the first tick on.
Rig polhem(ManualClock& clock, bool loses) {
  using relievo::polhem::Description;
  using relievo::polhem::Milliamps;
  Description arm = relievo::polhem::kWoodenHaptics2019;
  arm.calibrate_enc = test::PolhemModel::countsAt({0, 0, 0}, arm);
  struct Bench {
    explicit Bench(const Description& arm) : model(arm) {}
    test::PolhemModel model;
    test::Cable cable;
  };
  auto bench = std::make_shared<Bench>(arm);
  auto device = makePolhem({.description = arm, .watchdog_thread = false},
                           std::make_unique<test::ModelPort>(bench->model, bench->cable, clock), clock);
  if (loses) {
    bench->cable.comes_back = true;
    bench->model.grip = [bench = bench.get()](double) {
      // Calibrated in the first exchange, gone with the second.
      if (bench->cable.exchanging && bench->cable.exchanges == 2) bench->cable.plugged = false;
      return glm::dvec3(0);
    };
  }
  return {bench, std::move(device), [bench, &clock] { return bench->model.milliamps(clock.now()) != Milliamps{}; },
          [bench] { return bench->cable.model_allocations; }, 600};
}

// The driver on an emulator of the maker's service.
Rig inverse3(ManualClock& clock, bool loses) {
  static int arms = 0;
  auto service = std::make_shared<test::Inverse3Service>(test::Inverse3Service::Version::V3_5);
  service->id = "arm" + std::to_string(++arms);  // one arm is one device's
  auto wire = std::make_unique<test::EmulatedWire>(*service, clock);
  auto& own = *wire;
  auto device = makeInverse3({.watchdog_thread = false}, std::move(wire), clock);
  if (loses) {
    service->comes_back = true;
    own.before_each = [service = service.get(), device = device.get()] {
      if (device->state() == State::Running && service->connections() == 1) service->running = false;
    };
  }
  return {service, std::move(device), [service] { return service->pushes(); }, [&own] { return own.allocations; }, 600};
}

// The sample driver on a fake wire.
struct SampleWire {
  glm::dvec3 force_n{0};
  bool loses = false;  // is lost at the first exchange
};
class FakeSamplePort final : public SamplePort {
 public:
  explicit FakeSamplePort(std::shared_ptr<SampleWire> wire) : wire_(std::move(wire)) {}
  Result<void> open() override { return {}; }
  void close() noexcept override {}
  Result<glm::dvec3> readPosition() RELIEVO_RT override {
    if (wire_->loses) return fail(ErrorCode::Lost, "unplugged");
    return glm::dvec3(1, 2, 3);
  }
  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    wire_->force_n = force_n;
    return {};
  }

 private:
  std::shared_ptr<SampleWire> wire_;
};
Rig sample(ManualClock& clock, bool loses) {
  auto wire = std::make_shared<SampleWire>();
  wire->loses = loses;
  auto device = makeSampleHaptic(std::make_unique<FakeSamplePort>(wire), clock);
  return {wire, std::move(device), [wire] { return wire->force_n != glm::dvec3(0); }};
}

const test::HapticBackend kBackends[] = {
    {"falcon", [](ManualClock& clock) { return falcon(clock, false); },
     [](ManualClock& clock) { return falcon(clock, true); }},
    {"gamepad", [](ManualClock& clock) { return gamepad(clock, test::xboxPad(), false); },
     [](ManualClock& clock) { return gamepad(clock, test::xboxPad(), true); }},
    {"wheel", [](ManualClock& clock) { return gamepad(clock, test::wheel(), false); }, nullptr},
    {"inverse3", [](ManualClock& clock) { return inverse3(clock, false); },
     [](ManualClock& clock) { return inverse3(clock, true); }},
    {"mock", [](ManualClock& clock) { return mock({}, clock); },
     [](ManualClock& clock) {
       MockHapticProfile profile;
       profile.lose_after_ticks = 0;
       return mock(profile, clock);
     }},
    {"pointer", [](ManualClock& clock) { return pointer(clock, false); },
     [](ManualClock& clock) { return pointer(clock, true); }, false},
    {"pointer_over_a_window", pointerOverWindow, nullptr, false},
    {"replay", [](ManualClock&) { return replay(); }, nullptr, false},
    {"polhem", [](ManualClock& clock) { return polhem(clock, false); },
     [](ManualClock& clock) { return polhem(clock, true); }},
    {"sim", sim, nullptr},
    {"sample", [](ManualClock& clock) { return sample(clock, false); },
     [](ManualClock& clock) { return sample(clock, true); }},
};

INSTANTIATE_TEST_SUITE_P(Backends, HapticDeviceContract, testing::ValuesIn(kBackends), test::kBackendName);

// ---- the guard itself
// ------------------------------------------------------------------------------------------------

// Records the calls of its private functions.
class Recorder final : public HapticDevice {
 public:
  explicit Recorder(std::string& asked) : asked_(asked) {}
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override { return {}; }

 private:
  Result<void> openDevice() override { return note("open "); }
  Result<void> homeDevice() override { return note("home "); }
  Result<void> startDevice() override { return note("start "); }
  Result<HapticSample> readSample() RELIEVO_RT override { return HapticSample{}; }
  Result<void> writeForce(const glm::dvec3&) RELIEVO_RT override { return {}; }
  void stopDevice() noexcept override { (void)note("stop "); }
  void closeDevice() noexcept override { (void)note("close "); }
  Result<void> note(const char* verb) {
    asked_ += verb;
    return {};
  }
  std::string& asked_;
};

TEST(HapticDeviceGuard, StopsADeviceThatIsClosedWhileItRuns) {
  std::string asked;
  Recorder device(asked);
  ASSERT_TRUE(device.open() && device.home() && device.start());
  device.close();
  device.close();
  device.stop();
  EXPECT_EQ(asked, "open home start stop close ");
}

// ---- tests that need the fault switches of a mock
// ------------------------------------------------------------------

struct MockBench {
  explicit MockBench(MockHapticProfile profile) : device(makeMockHaptic(std::move(profile), clock, bench)) {}
  void run() { ASSERT_TRUE(device->open() && device->home() && device->start()); }

  ManualClock clock;
  std::shared_ptr<MockHapticBench> bench = std::make_shared<MockHapticBench>();
  std::unique_ptr<HapticDevice> device;
};

TEST(MockHaptic, LosesItsForceWithTheCableInReadWriteAndHome) {
  MockBench reading({}), writing({}), homing({});
  for (MockBench* each : {&reading, &writing}) {
    each->run();
    ASSERT_TRUE(each->device->write({0, 0, 1}));
    each->bench->unplugged = true;
  }
  EXPECT_EQ(reading.device->read().error().code, ErrorCode::Lost);
  EXPECT_EQ(writing.device->write({0, 0, 2}).error().code, ErrorCode::Lost);
  ASSERT_TRUE(homing.device->open());
  homing.bench->unplugged = true;
  EXPECT_EQ(homing.device->home().error().code, ErrorCode::Lost);
  for (MockBench* each : {&reading, &writing, &homing}) {
    EXPECT_EQ(each->device->state(), State::Lost);
    EXPECT_EQ(each->bench->force(), glm::dvec3(0));
  }
  reading.device->close();
  EXPECT_EQ(reading.device->open().error().code, ErrorCode::NotFound) << "still unplugged";
  EXPECT_EQ(reading.device->state(), State::Closed);
  reading.bench->unplugged = false;
  EXPECT_TRUE(reading.device->open());
}

TEST(MockHaptic, AFailedHomingLeavesItWithoutAZero) {
  MockBench never({.fail_homing_after = 0}), once({.fail_homing_after = 1});
  ASSERT_TRUE(never.device->open());
  EXPECT_EQ(never.device->home().error().code, ErrorCode::Timeout);
  EXPECT_EQ(never.device->state(), State::Opened);
  ASSERT_TRUE(once.device->open() && once.device->home());
  EXPECT_EQ(once.device->home().error().code, ErrorCode::Timeout);
  EXPECT_EQ(once.device->state(), State::Opened) << "it was Ready, but its zero is not known any more";
  EXPECT_EQ(once.device->start().error().code, ErrorCode::InvalidState);
}

TEST(MockHaptic, AGlitchIsOneErrorAndNoMore) {
  MockBench bench({.glitch_after_ticks = 2});
  bench.run();
  EXPECT_TRUE(bench.device->read() && bench.device->read());
  EXPECT_EQ(bench.device->read().error().code, ErrorCode::Io);
  EXPECT_EQ(bench.device->state(), State::Running);
  EXPECT_TRUE(bench.device->read());
}

TEST(MockHaptic, ADeviceThatRefusesForcesSaysSo) {
  MockBench bench({.refuses_force = true});
  bench.run();
  EXPECT_EQ(bench.device->write({0, 0, 1}).error().code, ErrorCode::Io);
  EXPECT_EQ(bench.device->state(), State::Running);
  EXPECT_EQ(bench.bench->force(), glm::dvec3(0));
}

TEST(MockHaptic, AFailedOpeningLeavesItClosed) {
  MockBench bench({.fail_open = ErrorCode::PermissionDenied});
  EXPECT_EQ(bench.device->open().error().code, ErrorCode::PermissionDenied);
  EXPECT_EQ(bench.device->state(), State::Closed);
}

TEST(MockHaptic, MovesAsItsProfileSays) {
  MockBench path({.path_mm = {{1, 0, 0}, {2, 0, 0}}}), timed({.position_mm = [](double t) { return glm::dvec3(t); }});
  path.run(), timed.run();
  for (const double x : {1.0, 2.0, 2.0}) EXPECT_EQ(path.device->read()->position_mm.x, x);
  timed.clock.advance(std::chrono::milliseconds(250));
  EXPECT_EQ(timed.device->read()->position_mm, glm::dvec3(0.25));
}

TEST(MockHaptic, DoesNotPushWhenDestroyed) {
  MockBench bench({});
  bench.run();
  ASSERT_TRUE(bench.device->write({0, 0, 1}));
  EXPECT_EQ(bench.bench->force(), glm::dvec3(0, 0, 1));
  bench.device.reset();
  EXPECT_EQ(bench.bench->force(), glm::dvec3(0));
}

}  // namespace
}  // namespace relievo
