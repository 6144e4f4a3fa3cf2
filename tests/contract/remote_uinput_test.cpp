// SPDX-License-Identifier: Apache-2.0
// A remote control that the kernel creates and removes (uinput). toolchain/guest runs this in a virtual machine.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "drivers/evdev/evdev.h"
#include "platform/clock.h"
#include "tests/support/device/uinput_remote.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

const std::vector<unsigned> kKeys{KEY_LEFT, KEY_RIGHT, KEY_OK, KEY_PLAYPAUSE};

class RemoteUinput : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::UinputRemote::available()) GTEST_SKIP() << test::kNoUinput;
  }
  // The next key, in at most ten seconds.
  std::optional<KeyEvent> next() {
    for (const MonotonicTime until = clock_.now() + 10s; clock_.now() < until; clock_.sleepUntil(clock_.now() + 5ms)) {
      const auto key = remote_->poll(clock_.now());
      EXPECT_TRUE(key) << key.error().message;
      if (!key || *key) return key.value_or(std::nullopt);
    }
    return std::nullopt;
  }
  void expectNext(std::uint16_t code, KeyEvent::Action action) {
    const auto key = next();
    ASSERT_TRUE(key);
    EXPECT_EQ(key->code, code);
    EXPECT_EQ(key->action, action);
  }

  MonotonicClock clock_;
  std::unique_ptr<RemoteInput> remote_ = makeEvdevRemote();
};

TEST_F(RemoteUinput, IsHeardWheneverItComesAndHoldsNothingWhenItGoes) {
  ASSERT_TRUE(remote_->open());
  {
    test::UinputRemote late(kKeys);
    EXPECT_FALSE(remote_->poll(clock_.now()).value());
    clock_.sleepUntil(clock_.now() + 1500ms);  // new devices are searched for every second
    EXPECT_FALSE(remote_->poll(clock_.now()).value());
    late.press(KEY_PLAYPAUSE, 1);
    expectNext(KEY_PLAYPAUSE, KeyEvent::Action::Press);
    late.press(KEY_PLAYPAUSE, 0);
    expectNext(KEY_PLAYPAUSE, KeyEvent::Action::Release);
    late.press(KEY_RIGHT, 1);
    expectNext(KEY_RIGHT, KeyEvent::Action::Press);
    expectNext(KEY_RIGHT, KeyEvent::Action::Repeat);
  }
  std::optional<KeyEvent> last;
  do last = next();
  while (last && last->action == KeyEvent::Action::Repeat);  // until its removal is noticed
  ASSERT_TRUE(last);
  EXPECT_EQ(last->code, KEY_RIGHT);
  EXPECT_EQ(last->action, KeyEvent::Action::Release);
  EXPECT_FALSE(remote_->poll(clock_.now()).value());
}

// The player gets the keys; a login console in the background does not.
TEST_F(RemoteUinput, IsGrabbedUntilItIsClosed) {
  test::UinputRemote there(kKeys);
  clock_.sleepUntil(clock_.now() + 100ms);
  ASSERT_TRUE(remote_->open());
  auto another = makeEvdevRemote();
  ASSERT_TRUE(another->open());
  there.press(KEY_OK, 1);
  expectNext(KEY_OK, KeyEvent::Action::Press);
  EXPECT_FALSE(another->poll(clock_.now()).value());
  remote_->close();
  clock_.sleepUntil(clock_.now() + 1500ms);
  (void)another->poll(clock_.now());
  there.press(KEY_OK, 0);
  there.press(KEY_LEFT, 1);
  remote_.swap(another);
  expectNext(KEY_LEFT, KeyEvent::Action::Press);
}

}  // namespace
}  // namespace relievo
