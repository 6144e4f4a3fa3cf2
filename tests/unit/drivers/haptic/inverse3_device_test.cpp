// SPDX-License-Identifier: Apache-2.0
// The Inverse3 on an emulator of its service in simulated time: positions, forces, faults, and the ways to lose it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>

#include "drivers/inverse3/inverse3.h"
#include "platform/allocation_counter.h"
#include "tests/support/device/inverse3_service.h"
#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::Inverse3Service;
using State = HapticDevice::State;
using Version = Inverse3Service::Version;

constexpr Duration kTick = 1ms;

// An emulator, and the driver on it.
struct Bench {
  explicit Bench(Version version, unsigned seed = 1) : service(version, seed) {
    auto own = std::make_unique<test::EmulatedWire>(service, clock);
    wire = own.get();
    device = makeInverse3({.watchdog_thread = false}, std::move(own), clock);
  }
  [[nodiscard]] Result<void> bringUp() {
    for (auto verb : {&HapticDevice::open, &HapticDevice::home, &HapticDevice::start}) {
      if (auto done = ((*device).*verb)(); !done) return done;
    }
    return {};
  }
  Result<HapticSample> tick(const glm::dvec3& force_n = {}) {
    auto sample = device->read();
    if (sample) {
      if (auto written = device->write(force_n); !written) return std::unexpected(written.error());
    }
    clock.advance(kTick);
    return sample;
  }
  // Pushes until the force has faded in.
  void push(const glm::dvec3& force_n) {
    for (int i = 0; i < 600; ++i) ASSERT_TRUE(tick(force_n));
  }

  ManualClock clock{MonotonicTime(1h)};
  Inverse3Service service;
  test::EmulatedWire* wire = nullptr;
  std::unique_ptr<HapticDevice> device;
};

class Inverse3Device : public testing::TestWithParam<Version> {
 protected:
  Bench bench{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Versions, Inverse3Device, testing::Values(Version::V3_1, Version::V3_5), [](const auto& test) {
  return std::string(test.param == Version::V3_1 ? "before_3_5" : "from_3_5");
});

TEST_P(Inverse3Device, TheFingerIsWhereTheHandIs) {
  bench.service.hand = [](double t_s) {
    return glm::dvec3(40 * std::sin(2 * t_s), 30 * std::cos(3 * t_s), 20 * std::sin(5 * t_s));
  };
  ASSERT_TRUE(bench.bringUp());
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(bench.tick());
  for (int i = 0; i < 2000; ++i) {
    const double answered_s = toSeconds(bench.clock.now() - MonotonicTime(1h)) - 0.001;
    const auto sample = bench.tick();
    ASSERT_TRUE(sample);
    EXPECT_LT(glm::distance(sample->position_mm, bench.service.hand(answered_s)), 1e-4) << i;
  }
  EXPECT_EQ(bench.service.error(), "");
  EXPECT_EQ(bench.service.profile(), GetParam() == Version::V3_5 ? "relievo" : "");
}

TEST_P(Inverse3Device, OneMessageIsExchangedATick) {
  ASSERT_TRUE(bench.bringUp());
  const int before = bench.service.messages();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench.tick());
  EXPECT_EQ(bench.service.messages(), before + 100);
}

TEST_P(Inverse3Device, TheForceIsTheOneAskedForOnceItHasFadedIn) {
  ASSERT_TRUE(bench.bringUp());
  const glm::dvec3 wanted(1, -2, 3);
  double before = 0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(bench.tick(wanted));
    const double now = glm::length(bench.service.force());
    EXPECT_LE(now, glm::length(wanted) * (i + 2) / 500.0 + 1e-3) << "at no tick more than its share of half a second";
    EXPECT_GE(now, before);
    before = now;
  }
  ASSERT_TRUE(bench.tick(wanted));
  EXPECT_LT(glm::distance(bench.service.force(), wanted), 2e-4);
  EXPECT_EQ(bench.service.error(), "");
}

TEST_P(Inverse3Device, TheGripsButtonsAreBits) {
  ASSERT_TRUE(bench.bringUp());
  const auto buttons = [&] {
    EXPECT_TRUE(bench.tick());
    return bench.tick()->buttons;
  };
  EXPECT_EQ(buttons(), 0U);
  bench.service.button_a = true;
  EXPECT_EQ(buttons(), 1U);
  bench.service.button_b = true;
  EXPECT_EQ(buttons(), 3U);
  bench.service.button_a = false;
  EXPECT_EQ(buttons(), 2U) << "the clutch";
  bench.service.wired_button = true;
  EXPECT_EQ(buttons(), 3U);
}

TEST_P(Inverse3Device, ServicesThatFragmentAndPingAreUnderstood) {
  bench.service.faults = {.pings = 0.3, .fragments = 0.3};
  bench.service.hand = [](double t_s) { return glm::dvec3(50 * std::sin(t_s), 0, 0); };
  for (const std::size_t most : {65536U, 3000U, 2000U}) {
    bench.wire->most_bytes = most;
    ASSERT_TRUE(bench.bringUp());
    double last = 0;
    for (int i = 0; i < 1000; ++i) {
      const auto sample = bench.tick({0, 0, 1});
      ASSERT_TRUE(sample);
      last = sample->position_mm.x;
    }
    const double now_s = toSeconds(bench.clock.now() - MonotonicTime(1h));
    EXPECT_NEAR(last, 50 * std::sin(now_s), 50 * 0.02) << most;
    bench.device->close();
  }
  EXPECT_GT(bench.service.pongs(), 500);
  EXPECT_EQ(bench.service.error(), "");
}

TEST_P(Inverse3Device, AnAnswerTooManyDoesNoHarm) {
  bench.service.faults = {.repeats = 0.3};
  bench.service.hand = [](double t_s) { return glm::dvec3(50 * std::sin(t_s), 0, 0); };
  ASSERT_TRUE(bench.bringUp());
  for (int i = 0; i < 1000; ++i) {
    const double answered_s = toSeconds(bench.clock.now() - MonotonicTime(1h)) - 0.001;
    const auto sample = bench.tick({0, 0, 1});
    ASSERT_TRUE(sample);
    ASSERT_NEAR(sample->position_mm.x, 50 * std::sin(answered_s), i < 10 ? 1 : 0.06) << "at most one tick old";
  }
}

TEST_P(Inverse3Device, HomingWaitsUntilTheDeviceIsReady) {
  bench.service.ready = false;
  ASSERT_TRUE(bench.device->open());
  int verbs = 0;
  bench.wire->verbs_left = 1000;
  bench.wire->at_zero = [&] { verbs = bench.service.messages(), bench.service.ready = true; };
  ASSERT_TRUE(bench.device->home());
  EXPECT_GT(verbs, 100);
  EXPECT_FALSE(bench.service.pushes());
}

TEST_P(Inverse3Device, OpeningAndHomingEndSoonWhenTheyAreCalledOff) {
  bench.service.ready = false;
  for (int moment = 1; moment < 60; ++moment) {
    bench.wire->verbs_left = moment;
    bench.wire->at_zero = [&] { bench.device->cancel(); };
    const MonotonicTime before = bench.clock.now();
    auto lived = bench.device->open();
    if (lived) lived = bench.device->home();
    ASSERT_FALSE(lived);
    EXPECT_EQ(lived.error().code, ErrorCode::Cancelled) << moment;
    EXPECT_LT(bench.clock.now() - before, 200ms);
    bench.device->close();
  }
}

TEST_P(Inverse3Device, WhatIsMissingIsSaid) {
  using testing::HasSubstr;
  const auto refusal = [this] {
    const auto opened = bench.device->open();
    bench.device->close();
    return opened ? std::string("none") : std::string(opened.error().message);
  };
  bench.service.plugged = false;
  EXPECT_THAT(refusal(), HasSubstr("finds no Inverse3"));
  bench.service.plugged = true;
  bench.service.powered = false;
  EXPECT_THAT(refusal(), HasSubstr("no power"));
  bench.service.powered = true;
  EXPECT_EQ(refusal(), "none");
  bench.service.running = false;
  EXPECT_EQ(bench.device->open().error().code, ErrorCode::NotFound);
}

TEST(Inverse3Versions, AnotherVersionIsRefused) {
  Bench bench(Version::V9);
  const auto opened = bench.device->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("3.1 to 3.5"));
  EXPECT_FALSE(bench.service.connected());
}

TEST(Inverse3Versions, TheOlderMessagesAreToldByTheirNameAndLeadToTheOtherPort) {
  Bench bench(Version::V3_0);
  const auto opened = bench.device->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  EXPECT_THAT(opened.error().message, testing::AllOf(testing::HasSubstr("3.0"), testing::HasSubstr("port 10001")));
  EXPECT_FALSE(bench.service.connected());
}

// ---- loss and return

TEST_P(Inverse3Device, AServiceThatDiesIsLostAtOnceAndIsFoundAgain) {
  ASSERT_TRUE(bench.bringUp());
  bench.push({0, 0, 3});
  bench.service.running = false;
  bench.service.disconnect();
  const auto lost = bench.device->read();
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, ErrorCode::Lost);
  EXPECT_EQ(bench.device->state(), State::Lost);
  bench.device->close();
  EXPECT_EQ(bench.device->open().error().code, ErrorCode::NotFound);
  bench.service.running = true;
  ASSERT_TRUE(bench.bringUp());
  bench.push({0, 0, 3});
  EXPECT_NEAR(bench.service.force().z, 3, 1e-3);
}

TEST_P(Inverse3Device, AnUnpluggedDeviceIsLostAndSaidSo) {
  ASSERT_TRUE(bench.bringUp());
  bench.push({0, 0, 3});
  bench.service.plugged = false;
  const MonotonicTime pulled = bench.clock.now();
  Result<HapticSample> read;
  while (read && bench.clock.now() - pulled < 1s) read = bench.tick({0, 0, 3});
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::Lost);
  EXPECT_THAT(read.error().message, testing::HasSubstr("unplugged"));
  EXPECT_LE(bench.clock.now() - pulled, 10ms);
  bench.device->close();
  bench.service.plugged = true;
  EXPECT_TRUE(bench.bringUp());
}

// It answers nothing more, but the connection stands: zero is sent after 20 ms, and after 100 ms it is lost.
TEST_P(Inverse3Device, ASilentServiceGetsNoForceAndIsLost) {
  ASSERT_TRUE(bench.bringUp());
  bench.push({0, 0, 3});
  bench.service.faults.drops = 1;
  const MonotonicTime silent = bench.clock.now();
  Result<HapticSample> read;
  while (read && bench.clock.now() - silent < 1s) {
    read = bench.tick({0, 0, 3});
    EXPECT_FALSE(bench.service.pushes() && bench.clock.now() - silent > 30ms);
  }
  EXPECT_EQ(read.error().code, ErrorCode::Lost);
  EXPECT_LE(bench.clock.now() - silent, 110ms);
}

TEST_P(Inverse3Device, ForcesThatNoLongerComeEndWithin20Ms) {
  ASSERT_TRUE(bench.bringUp());
  bench.push({0, 0, 3});
  for (int i = 0; i < 22; ++i) {
    ASSERT_TRUE(bench.device->read());
    bench.clock.advance(kTick);
  }
  EXPECT_FALSE(bench.service.pushes());
}

// The zero cannot be sent: the connection ends instead.
TEST_P(Inverse3Device, AConnectionThatTakesNothingIsCut) {
  ASSERT_TRUE(bench.bringUp());
  bench.push({0, 0, 3});
  ASSERT_TRUE(bench.service.pushes());
  bench.service.deaf = true;
  bench.device->stop();
  EXPECT_FALSE(bench.service.connected());
  EXPECT_FALSE(bench.service.pushes());
}

TEST_P(Inverse3Device, ATickAllocatesNothing) {
  bench.service.faults = {.pings = 0.2, .fragments = 0.2};
  ASSERT_TRUE(bench.bringUp());
  const auto own = [this] { return threadAllocations() - bench.wire->allocations; };
  const std::uint64_t before = own();
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(bench.tick({0, 0, 1}));
  EXPECT_EQ(own(), before);
}

// ---- everything at once

// Counts positions that the hand did not have in the last 20 ms, forces sent on such a position, and forces that the
// device has applied for longer than that.
class Watch {
 public:
  explicit Watch(Bench& bench) : bench_(bench) {
    bench.service.on_force = [this](const glm::dvec3& force_n, MonotonicTime now) {
      most_n_ = std::max(most_n_, glm::length(force_n));
      if (force_n == glm::dvec3(0)) return;
      ++pushing_;
      if (!bench_.service.stalled(now) && !wasThere(last_, now)) ++blind_;
    };
  }
  ~Watch() { bench_.service.on_force = nullptr; }  // the device sends its last force when it is closed
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  // After the device was brought up: its first position may be older.
  void begin(const glm::dvec3& position_mm) { last_ = position_mm; }
  // After each reading.
  void look(const glm::dvec3& position_mm) {
    const MonotonicTime now = bench_.clock.now();
    if (bench_.service.pushes() && !bench_.service.stalled(now) && now - bench_.service.forceSince() > kOld) ++held_;
    if (position_mm == last_) return;
    last_ = position_mm;
    ++moved_;
    if (!wasThere(position_mm, now)) ++wrong_;
  }
  [[nodiscard]] glm::dvec3 handAt(MonotonicTime time) const {
    return bench_.service.hand(toSeconds(time - MonotonicTime(1h)));
  }

  // Whether the hand was at that place within the last 20 ms, to a millimetre.
  [[nodiscard]] bool wasThere(const glm::dvec3& position_mm, MonotonicTime now) const {
    for (Duration ago{0}; ago <= kOld; ago += 500us) {
      if (glm::distance(position_mm, handAt(now - ago)) < 1) return true;
    }
    return false;
  }

  [[nodiscard]] int wrong() const { return wrong_; }
  [[nodiscard]] int held() const { return held_; }
  [[nodiscard]] int blind() const { return blind_; }
  [[nodiscard]] int moved() const { return moved_; }
  [[nodiscard]] int pushing() const { return pushing_; }
  [[nodiscard]] double mostN() const { return most_n_; }

 private:
  static constexpr Duration kOld = 20ms;
  Bench& bench_;
  glm::dvec3 last_{0};
  int wrong_ = 0, held_ = 0, blind_ = 0, moved_ = 0, pushing_ = 0;
  double most_n_ = 0;
};

// A million exchanges in every way that a service can fail. The hand moves at up to 0.5 m/s.
TEST_P(Inverse3Device, AMillionExchangesWithFaultsTakeNoWrongPositionAndHoldNoForce) {
  const int exchanges = kMemorySanitizer || kRealtimeSanitizer ? 50'000 : 500'000;  // of each version
  bench.service.hand = [](double t_s) {
    return glm::dvec3(60 * std::sin(5 * t_s), 50 * std::sin(3 * t_s), 40 * std::sin(7 * t_s));
  };
  Watch watch(bench);
  const test::ServiceFaults calm{.pings = 0.01, .fragments = 0.01, .most_delay = 2ms};
  const test::ServiceFaults rough{.drops = 0.002,
                                  .holds_back = 0.01,
                                  .garbles = 0.01,
                                  .misplaces = 0.01,
                                  .pings = 0.02,
                                  .fragments = 0.02,
                                  .breaks_frames = 0.0005,
                                  .hangs_up = 0.0005,
                                  .stalls = 0.001,
                                  .restarts = 0.0003,
                                  .most_delay = 4ms};
  int lost = 0, back = 0;
  for (int i = 0; bench.service.messages() < exchanges; ++i) {
    bench.service.faults = i / 2000 % 2 == 0 ? rough : calm;
    if (bench.device->state() != State::Running) {
      bench.device->close();
      bench.clock.advance(10ms);
      if (!bench.bringUp()) continue;
      ++back;
      if (const auto first = bench.tick()) watch.begin(first->position_mm);
    }
    if (const auto sample = bench.device->read()) {
      watch.look(sample->position_mm);
      static_cast<void>(bench.device->write({3, -4, 8}));
    } else {
      ++lost;
    }
    bench.clock.advance(kTick);
  }
  EXPECT_EQ(watch.wrong(), 0) << "of " << watch.moved();
  EXPECT_EQ(watch.held(), 0);
  EXPECT_EQ(watch.blind(), 0) << "of " << watch.pushing();
  EXPECT_LE(watch.mostN(), 10);
  EXPECT_EQ(bench.service.error(), "");
  EXPECT_GT(watch.moved(), exchanges / 2);
  EXPECT_GT(watch.pushing(), exchanges / 4);
  EXPECT_GT(lost, exchanges / 5000);
  EXPECT_GE(back + 1, lost);
  EXPECT_GT(bench.service.faultsDone(), exchanges / 50);
}

}  // namespace
}  // namespace relievo
