// SPDX-License-Identifier: Apache-2.0
// The contract of every haptic device: states, and no force unless one is requested.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "drivers/falcon/falcon.h"
#include "drivers/gamepad/gamepad.h"
#include "drivers/inverse3/inverse3.h"
#include "drivers/mock/mock.h"
#include "drivers/pointer/pointer.h"
#include "drivers/polhem/polhem.h"
#include "drivers/replay/replay.h"
#include "drivers/sample/sample.h"
#include "drivers/sim/sim.h"
#include "platform/allocation_counter.h"
#include "tests/contract/state_table.h"
#include "tests/support/device/fake_mouse.h"
#include "tests/support/device/fake_pad.h"
#include "tests/support/device/falcon_model.h"
#include "tests/support/device/inverse3_service.h"
#include "tests/support/device/model_port.h"
#include "tests/support/device/polhem_model.h"

namespace relievo {
namespace {

using State = HapticDevice::State;
constexpr Duration kTick = std::chrono::milliseconds(1);
constexpr double kPeakN = 8.5;

// A device under test, a way to observe whether it pushes, and the number of the test's own allocations.
struct Rig {
  std::shared_ptr<void> bench;
  std::unique_ptr<HapticDevice> device;
  std::function<bool()> pushes;
  std::function<std::uint64_t()> allocations = [] { return std::uint64_t{0}; };
  int ticks_to_push = 1;  // until the force has faded in
};

struct Backend {
  const char* name;
  std::function<Rig(ManualClock&)> make;
  std::function<Rig(ManualClock&)> make_losing;  // Lost at the first read; null if it cannot be lost
  bool has_motors = true;                        // false: no force is ever observed
};

void PrintTo(const Backend& backend, std::ostream* out) {
  *out << backend.name;
}

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
  auto service = std::make_shared<test::Inverse3Service>(test::Inverse3Service::Version::V3_5);
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

const Backend kBackends[] = {
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

class HapticDeviceContract : public testing::TestWithParam<Backend> {
 protected:
  // Returns a device in that state, or none if this back end cannot reach it.
  Rig bring(State state) {
    const auto& make = state == State::Lost ? GetParam().make_losing : GetParam().make;
    if (make == nullptr) return {};
    Rig rig = make(clock_);
    benches_.push_back(rig.bench);
    HapticDevice& device = *rig.device;
    if (state == State::Closed) return rig;
    EXPECT_TRUE(device.open());
    if (state == State::Opened) return rig;
    EXPECT_TRUE(device.home());
    if (state == State::Ready) return rig;
    EXPECT_TRUE(device.start());
    EXPECT_TRUE(state != State::Lost || device.read().error().code == ErrorCode::Lost);
    return rig;
  }
  // Running, and pushing 1 N to the right.
  Rig pushing() {
    Rig rig = bring(State::Running);
    for (int i = 0; i < rig.ticks_to_push; ++i) {
      if (i > 0) clock_.advance(kTick);
      EXPECT_TRUE(rig.device->read());
      EXPECT_TRUE(rig.device->write({1, 0, 0}));
    }
    return rig;
  }

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  std::vector<std::shared_ptr<void>> benches_;  // must outlive the returned devices
};
INSTANTIATE_TEST_SUITE_P(Backends, HapticDeviceContract, testing::ValuesIn(kBackends),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(HapticDeviceContract, EveryVerbInEveryState) {
  const std::vector<test::Verb<HapticDevice>> verbs = {
      {"open", [](HapticDevice& d) { return test::answerOf(d.open()); }},
      {"home", [](HapticDevice& d) { return test::answerOf(d.home()); }},
      {"start", [](HapticDevice& d) { return test::answerOf(d.start()); }},
      {"read", [](HapticDevice& d) { return test::answerOf(d.read()); }},
      {"write", [](HapticDevice& d) { return test::answerOf(d.write({0, 0, 1})); }},
      {"stop", [](HapticDevice& d) { return d.stop(), test::Answer{}; }},
      {"close", [](HapticDevice& d) { return d.close(), test::Answer{}; }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {
      // from           open           home          start           read            write         stop close
      {State::Closed, {State::Opened, no, no, no, no, State::Closed, State::Closed}},
      {State::Opened, {no, State::Ready, no, no, no, State::Opened, State::Closed}},
      {State::Ready, {no, State::Ready, State::Running, no, no, State::Ready, State::Closed}},
      {State::Running, {no, no, no, State::Running, State::Running, State::Ready, State::Closed}},
      {State::Lost, {no, no, no, no, no, State::Lost, State::Closed}},
  };
  test::expectStateTable(verbs, table, [&](State state) { return std::move(bring(state).device); });
}

TEST_P(HapticDeviceContract, CapabilitiesAreSensibleAndStayTheSame) {
  const Rig rig = bring(State::Opened);
  HapticDevice& device = *rig.device;
  const HapticCapabilities first = device.capabilities();
  EXPECT_STRNE(first.name, "");
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(first.workspace_min_mm[axis], first.workspace_max_mm[axis]);
  EXPECT_GT(first.peak_force_n, 0);
  EXPECT_GT(first.continuous_force_n, 0);
  EXPECT_LE(first.continuous_force_n, first.peak_force_n);
  EXPECT_GT(first.max_stiffness_n_per_mm, 0);
  EXPECT_GT(first.rate_hz, 0);

  const auto expectSame = [&] {
    const HapticCapabilities now = device.capabilities();
    EXPECT_STREQ(now.name, first.name);
    EXPECT_EQ(now.workspace_min_mm, first.workspace_min_mm);
    EXPECT_EQ(now.workspace_max_mm, first.workspace_max_mm);
    EXPECT_EQ(now.peak_force_n, first.peak_force_n);
    EXPECT_EQ(now.continuous_force_n, first.continuous_force_n);
    EXPECT_EQ(now.max_stiffness_n_per_mm, first.max_stiffness_n_per_mm);
    EXPECT_EQ(now.rate_hz, first.rate_hz);
  };
  ASSERT_TRUE(device.home());
  expectSame();
  ASSERT_TRUE(device.start());
  ASSERT_TRUE(device.read());
  ASSERT_TRUE(device.write({0, 0, 1}));
  expectSame();
  device.stop();
  expectSame();
}

TEST_P(HapticDeviceContract, ARateIsTakenOrTheMostThatItCan) {
  const Rig usual = bring(State::Opened);
  const HapticCapabilities own = usual.device->capabilities();
  EXPECT_EQ(usual.device->setRate(500).error().code, ErrorCode::InvalidState);
  for (const double hz : {500.0, 1000.0, 4000.0, 8000.0}) {
    const Rig rig = bring(State::Closed);
    HapticDevice& device = *rig.device;
    const auto rate = device.setRate(hz);
    ASSERT_TRUE(rate);
    EXPECT_TRUE(*rate == hz || *rate >= own.rate_hz) << hz << ": " << *rate;
    EXPECT_EQ(device.capabilities().rate_hz, *rate);
    if (*rate < own.rate_hz) {
      EXPECT_LE(device.capabilities().max_stiffness_n_per_mm, own.max_stiffness_n_per_mm);
    }
    ASSERT_TRUE(device.open() && device.home() && device.start());
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(device.read());
      ASSERT_TRUE(device.write({0, 0, 1}));
      clock_.advance(fromSeconds(1 / *rate));
    }
    EXPECT_EQ(device.capabilities().rate_hz, *rate);
  }
}

TEST_P(HapticDeviceContract, TheFingerIsInsideTheWorkspace) {
  const Rig rig = bring(State::Running);
  const HapticCapabilities capabilities = rig.device->capabilities();
  for (int i = 0; i < 100; ++i) {
    const auto sample = rig.device->read();
    ASSERT_TRUE(sample);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(sample->position_mm[axis], capabilities.workspace_min_mm[axis]);
      ASSERT_LE(sample->position_mm[axis], capabilities.workspace_max_mm[axis]);
    }
    clock_.advance(kTick);
  }
}

TEST_P(HapticDeviceContract, AForceArrives) {
  if (!GetParam().has_motors) GTEST_SKIP() << "this back end has no motors";
  EXPECT_TRUE(pushing().pushes());
}

TEST_P(HapticDeviceContract, ExactlyThePeakIsAllowedInAnyDirection) {
  const Rig rig = bring(State::Running);
  const double peak_n = rig.device->capabilities().peak_force_n;
  for (const glm::dvec3& direction : {glm::dvec3(1, 0, 0), glm::dvec3(2, -3, 6) / 7.0, glm::dvec3(-1, 4, -8) / 9.0}) {
    EXPECT_TRUE(rig.device->write(peak_n * direction));
  }
}

TEST_P(HapticDeviceContract, AForceThatIsNoneOrTooMuchIsRefusedAndZeroIsSent) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double peak_n = bring(State::Closed).device->capabilities().peak_force_n;
  for (const glm::dvec3& force : {glm::dvec3(nan, 0, 0), glm::dvec3(0, nan, 0), glm::dvec3(0, 0, nan),
                                  glm::dvec3(infinity, 0, 0), glm::dvec3(0, 0, -infinity), glm::dvec3(1e200, 0, 0),
                                  glm::dvec3(0, peak_n * 1.001, 0), glm::dvec3(0.6 * peak_n)}) {
    SCOPED_TRACE(testing::Message() << force.x << ", " << force.y << ", " << force.z);
    const Rig rig = pushing();
    const auto written = rig.device->write(force);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(rig.device->state(), State::Running);
    EXPECT_FALSE(rig.pushes());
    EXPECT_TRUE(rig.device->write({1, 0, 0})) << "the next one goes through";
  }
}

TEST_P(HapticDeviceContract, DoesNotPushBeforeTheFirstForce) {
  const Rig rig = bring(State::Running);
  ASSERT_TRUE(rig.device->read());
  EXPECT_FALSE(rig.pushes());
}

TEST_P(HapticDeviceContract, DoesNotPushAfterStop) {
  const Rig rig = pushing();
  rig.device->stop();
  EXPECT_FALSE(rig.pushes());
}

TEST_P(HapticDeviceContract, DoesNotPushAfterClose) {
  const Rig rig = pushing();
  rig.device->close();
  EXPECT_FALSE(rig.pushes());
}

TEST_P(HapticDeviceContract, DoesNotPushWhenForcesNoLongerCome) {
  const Rig rig = pushing();
  for (int i = 0; i < 2; ++i) {  // in the second second a moving mass comes to rest
    clock_.advance(std::chrono::seconds(1));
    ASSERT_TRUE(rig.device->read());
  }
  EXPECT_FALSE(rig.pushes());
}

TEST_P(HapticDeviceContract, IsAsNewAfterCloseAndOpen) {
  const Rig rig = pushing();
  rig.device->close();
  ASSERT_TRUE(rig.device->open());
  EXPECT_EQ(rig.device->state(), State::Opened);
  ASSERT_TRUE(rig.device->home() && rig.device->start());
  EXPECT_TRUE(rig.device->read());
}

TEST_P(HapticDeviceContract, AnExchangeAllocatesNothing) {
  const Rig rig = bring(State::Running);
  ASSERT_TRUE(rig.device->read());
  const auto own = [&rig] { return threadAllocations() - rig.allocations(); };
  const std::uint64_t before = own();
  for (int i = 0; i < 10; ++i) {
    (void)rig.device->read();
    (void)rig.device->write({0, 0, 1});
    (void)rig.device->write({0, 0, 1000});
    clock_.advance(kTick);
  }
  EXPECT_EQ(own(), before);
}

TEST_P(HapticDeviceContract, ALostDeviceIsLostUntilClosedAndPushesNobody) {
  if (GetParam().make_losing == nullptr) GTEST_SKIP() << "this back end cannot be lost";
  const Rig rig = bring(State::Lost);
  EXPECT_FALSE(rig.pushes());
  EXPECT_EQ(rig.device->read().error().code, ErrorCode::InvalidState);
  rig.device->close();
  EXPECT_TRUE(rig.device->open());
}

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
