// SPDX-License-Identifier: Apache-2.0
// Haptic devices over USB at 500 Hz: positions of a fast hand, and the same seconds for fade, watchdog and silence.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/support/device/model_port.h"
#include "tests/support/device/usb/usb_kinds.h"

namespace relievo {
namespace {

using test::UsbKind;
constexpr Duration kTick = std::chrono::milliseconds(2);

class UsbRate : public testing::TestWithParam<UsbKind> {
 protected:
  void SetUp() override {
    ASSERT_EQ(device_->setRate(500).value(), 500);
    ASSERT_TRUE(device_->open() && device_->home());
    clock_.advance(std::chrono::milliseconds(100));
    ASSERT_TRUE(device_->start());
    clock_.advance(kTick);
    for (int i = 0; i < 3; ++i) (void)tick({});
  }
  Result<HapticSample> tick(const glm::dvec3& force_n) {
    auto sample = device_->read();
    EXPECT_TRUE(!sample || device_->write(force_n));
    clock_.advance(kTick);
    return sample;
  }
  double felt() { return bench_.model->forceAt(GetParam().rest_mm, clock_.now()).z; }

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  test::Cable cable_;
  test::UsbBench bench_ = GetParam().make();
  std::unique_ptr<HapticDevice> device_ =
      bench_.driver(std::make_unique<test::ModelPort>(*bench_.model, cable_, clock_), clock_);
};
INSTANTIATE_TEST_SUITE_P(Kinds, UsbRate, testing::ValuesIn(test::usbKinds().begin(), test::usbKinds().end()),
                         [](const auto& test) { return std::string(test.param.name); });

// 5 mm to either side at 22 Hz: up to 95 m/s^2, which is 0.38 mm and 10 counts in a tick of 2 ms. In a tick of 1 ms it
// would be 3 counts.
TEST_P(UsbRate, AHandThatAcceleratesAsFastAsAHandCanIsFollowedWithinACount) {
  bench_.model->grip = [](double t_s) { return GetParam().rest_mm + glm::dvec3(5 * std::sin(138 * t_s), 0, 0); };
  for (int i = 0; i < 20; ++i) (void)tick({});
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 answered = bench_.model->gripNow(clock_.now() - kTick + GetParam().answers_in);
    const auto sample = tick({});
    ASSERT_TRUE(sample);
    worst = std::max(worst, glm::distance(sample->position_mm, answered));
  }
  EXPECT_LT(worst, 0.1);
}

// 3 N, after half a second of fading in; 1.5 N after a quarter.
TEST_P(UsbRate, TheForceFadesInWithinHalfASecond) {
  device_->stop();
  ASSERT_TRUE(device_->start());
  for (int i = 0; i < 125; ++i) (void)tick({0, 0, 3});
  EXPECT_NEAR(felt(), 1.5, 0.1);
  for (int i = 0; i < 130; ++i) (void)tick({0, 0, 3});
  EXPECT_NEAR(felt(), 3, 0.1);
}

TEST_P(UsbRate, AForceThatNobodyRenewsEndsAfterTwentyMilliseconds) {
  for (int i = 0; i < 300; ++i) (void)tick({0, 0, 3});
  clock_.advance(std::chrono::milliseconds(16));  // 18 ms after the last force
  ASSERT_TRUE(device_->read());
  EXPECT_TRUE(bench_.model->pushes(clock_.now()));
  clock_.advance(std::chrono::milliseconds(4));
  ASSERT_TRUE(device_->read());
  EXPECT_FALSE(bench_.model->pushes(clock_.now()));
}

TEST_P(UsbRate, ADeviceThatSaysNothingForATenthOfASecondIsLost) {
  bench_.model->silence();
  int ticks = 0;
  while (device_->state() == HapticDevice::State::Running && ticks < 500) (void)tick({}), ++ticks;
  EXPECT_NEAR(ticks, 51, 1);
}

// The stiffness was found at 1 kHz: half the rate halves it.
TEST_P(UsbRate, RendersHalfTheStiffnessAndNoHigherRateThanItsOwn) {
  EXPECT_EQ(device_->capabilities().rate_hz, 500);
  const double at_500 = device_->capabilities().max_stiffness_n_per_mm;
  device_->close();
  EXPECT_EQ(device_->setRate(4000).value(), 1000);
  EXPECT_NEAR(at_500, 0.5 * device_->capabilities().max_stiffness_n_per_mm, 1e-12);
}

}  // namespace
}  // namespace relievo
