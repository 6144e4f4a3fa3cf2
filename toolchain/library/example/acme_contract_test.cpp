// SPDX-License-Identifier: Apache-2.0
// Acme's arm under the contract of every haptic device, on a fake wire; its axes and units.
#include <gtest/gtest.h>

#include <mutex>

#include "acme.h"
#include "tests/contract/suite/haptic_device.h"

namespace {

using relievo::HapticDeviceContract;
using relievo::ManualClock;
using relievo::Result;
using Axes = std::array<std::int16_t, 3>;

class Board {
 public:
  Axes counts{100, 200, 300};
  int exchanges_left = -1;  // until it is unplugged; -1: never

  void drive(const Axes& milliamps) {
    const std::lock_guard guard(lock_);
    milliamps_ = milliamps;
  }
  Axes milliamps() {
    const std::lock_guard guard(lock_);
    return milliamps_;
  }
  bool pushes() { return milliamps() != Axes{}; }

 private:
  std::mutex lock_;
  Axes milliamps_{};
};

class FakeWire final : public acme::Wire {
 public:
  explicit FakeWire(std::shared_ptr<Board> board) : board_(std::move(board)) {}
  Result<void> open() override { return {}; }
  void close() noexcept override {}
  Result<Axes> counts() RELIEVO_RT override {
    if (board_->exchanges_left == 0) return relievo::fail(relievo::ErrorCode::Lost, "the arm was unplugged");
    if (board_->exchanges_left > 0) --board_->exchanges_left;
    return board_->counts;
  }
  Result<void> drive(const Axes& milliamps) RELIEVO_RT override {
    board_->drive(milliamps);
    return {};
  }

 private:
  std::shared_ptr<Board> board_;
};

relievo::test::HapticRig arm(ManualClock& clock, int exchanges_left) {
  auto board = std::make_shared<Board>();
  board->exchanges_left = exchanges_left;
  auto device = acme::makeArm(std::make_unique<FakeWire>(board), clock, false);
  return {board, std::move(device), [board] { return board->pushes(); }};
}

const relievo::test::HapticBackend kArm{
    "acme", [](ManualClock& clock) { return arm(clock, -1); },
    [](ManualClock& clock) { return arm(clock, 1); }};  // the one exchange is that of `home`
INSTANTIATE_TEST_SUITE_P(Backends, HapticDeviceContract, testing::Values(kArm), relievo::test::kBackendName);

TEST(AcmeArm, ConvertsItsAxesAndUnits) {
  ManualClock clock;
  const auto board = std::make_shared<Board>();
  const auto device = acme::makeArm(std::make_unique<FakeWire>(board), clock, false);
  ASSERT_TRUE(device->open() && device->home() && device->start());
  board->counts = {200, 250, 0};  // 2 mm left, 1 mm toward the user, 6 mm down
  EXPECT_EQ(device->read().value().position_mm, glm::dvec3(-2, -56, 31));
  ASSERT_TRUE(device->write({1, 2, -3}));
  EXPECT_EQ(board->milliamps(), (Axes{-250, -750, 500}));
}

// Nobody reads or writes any more, and nobody stops it.
TEST(AcmeArm, LetsGoWhenItsTaskHangs) {
  relievo::MonotonicClock clock;
  const auto board = std::make_shared<Board>();
  const auto device = acme::makeArm(std::make_unique<FakeWire>(board), clock);
  ASSERT_TRUE(device->open() && device->home() && device->start());
  ASSERT_TRUE(device->write({1, 0, 0}));
  for (int i = 0; i < 10000 && board->pushes(); ++i) clock.sleepUntil(clock.now() + std::chrono::milliseconds(1));
  EXPECT_FALSE(board->pushes());
}

}  // namespace
