// SPDX-License-Identifier: Apache-2.0
// The Inverse3 through its service: position, force, buttons, opening and homing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "platform/allocation_counter.h"
#include "tests/unit/drivers/haptic/inverse3_bench.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;

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

TEST_P(Inverse3Device, AMinverseReachesLessFar) {
  for (const auto& [type, reach_mm] : {std::pair("inverse3x", 100.0), {"minverse", 40.0}, {"inverse3", 100.0}}) {
    bench.service.type = type;
    ASSERT_TRUE(bench.bringUp());
    ASSERT_TRUE(bench.tick());
    EXPECT_EQ(bench.device->capabilities().workspace_min_mm, glm::dvec3(-reach_mm)) << type;
    EXPECT_EQ(bench.device->capabilities().workspace_max_mm, glm::dvec3(reach_mm)) << type;
    bench.device->close();
  }
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

// By whatever names the fingers reach it.
TEST_P(Inverse3Device, AnArmIsOneFingerAlone) {
  ASSERT_TRUE(bench.bringUp());
  Bench other(GetParam());
  const auto opened = other.device->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::NotFound);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("already a finger"));
  EXPECT_FALSE(other.service.connected());

  other.service.listed_before = other.service.id;
  other.service.id = "04BA";
  for (int time = 0; time < 2; ++time) {
    ASSERT_TRUE(other.bringUp()) << time;
    other.push({0, 0, 1});
    EXPECT_NEAR(other.service.force().z, 1, 1e-3);
    EXPECT_EQ(other.service.error(), "");
    EXPECT_LT(glm::length(other.device->read()->position_mm), 1e-3);
    other.device->close();
    bench.device->close();  // the second time it keeps to its arm, although the first one is free
  }
  other.service.id = other.service.listed_before;
  other.service.listed_before = "";
  EXPECT_TRUE(other.device->open());
}

// The emulator lists a wired grip before a wireless one, and the other's arm before its own.
TEST_P(Inverse3Device, OfTwoFingersEachHasTheGripAtItsArmsPlace) {
  ASSERT_TRUE(bench.bringUp());
  Bench other(GetParam());
  other.service.listed_before = bench.service.id;
  other.service.id = "04BA";
  ASSERT_TRUE(other.bringUp());
  const auto buttons = [&] {
    EXPECT_TRUE(other.tick());
    return other.tick()->buttons;
  };
  other.service.wired_button = true;
  EXPECT_EQ(buttons(), 0U) << "the other finger's";
  other.service.button_b = true;
  EXPECT_EQ(buttons(), 2U);
  bench.device->close();
  EXPECT_EQ(buttons(), 3U) << "a finger alone has any grip";
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

TEST_P(Inverse3Device, ATickAllocatesNothing) {
  bench.service.faults = {.pings = 0.2, .fragments = 0.2};
  ASSERT_TRUE(bench.bringUp());
  const auto own = [this] { return threadAllocations() - bench.wire->allocations; };
  const std::uint64_t before = own();
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(bench.tick({0, 0, 1}));
  EXPECT_EQ(own(), before);
}

}  // namespace
}  // namespace relievo::test
