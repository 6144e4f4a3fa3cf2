// SPDX-License-Identifier: Apache-2.0
// The Inverse3 through its service: services that die, fall silent or send what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/machine/sanitizers.h"
#include "tests/unit/drivers/haptic/inverse3_bench.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;
using State = HapticDevice::State;

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

// The service stops answering, but keeps the connection: the driver sends zero force after 20 ms, and after 100 ms the
// device counts as lost.
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

// It answers, but with places where no hand can be.
TEST_P(Inverse3Device, AnswersWithoutAPositionAreLostAfterTheSameTimeAtEachRate) {
  for (const double asked_hz : {500.0, 1000.0, 4000.0}) {
    SCOPED_TRACE(asked_hz);
    Bench one(GetParam());
    ASSERT_TRUE(one.device->setRate(asked_hz));
    const Duration tick = fromSeconds(1 / one.device->capabilities().rate_hz);
    ASSERT_TRUE(one.bringUp());
    one.service.faults.misplaces = 1;
    const MonotonicTime since = one.clock.now();
    while (one.device->read() && one.clock.now() - since < 1s) {
      ASSERT_TRUE(one.device->write({0, 0, 3}));
      one.clock.advance(tick);
    }
    EXPECT_GE(one.clock.now() - since, 95ms);
    EXPECT_LE(one.clock.now() - since, 110ms);
  }
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
  const ServiceFaults calm{.pings = 0.01, .fragments = 0.01, .most_delay = 2ms};
  const ServiceFaults rough{.drops = 0.002,
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
}  // namespace relievo::test
