// SPDX-License-Identifier: Apache-2.0
// Remote controls on nodes of /dev/input that umockdev simulates.
#include <gtest/gtest.h>
#include <linux/input.h>

#include <array>
#include <memory>
#include <optional>

#include "drivers/evdev/evdev.h"
#include "drivers/evdev/event_nodes.h"
#include "tests/support/device/mocked_machine.h"
#include "tests/support/device/umockdev_mouse.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::UmockdevMouse;

class RemoteEvdev : public test::MockedMachine {
 protected:
  static void press(UmockdevMouse& remote, std::uint16_t key, int value) {
    remote.say(EV_KEY, key, value);
    remote.say(EV_SYN, SYN_REPORT, 0);
  }
  // Waits, since the kernel takes a moment to deliver an event; the remote's own time does not advance meanwhile.
  std::optional<KeyEvent> next(RemoteInput& remote) {
    MonotonicClock real;
    for (int i = 0; i < 3000; ++i) {
      const auto key = remote.poll(now_);
      EXPECT_TRUE(key) << key.error().message;
      if (!key || *key) return key.value_or(std::nullopt);
      real.sleepUntil(real.now() + 1ms);
    }
    return std::nullopt;
  }
  void expectNext(RemoteInput& remote, std::uint16_t code, KeyEvent::Action action) {
    const auto key = next(remote);
    ASSERT_TRUE(key);
    EXPECT_EQ(key->code, code);
    EXPECT_EQ(key->action, action);
  }

  MonotonicTime now_{1h};
};

TEST_F(RemoteEvdev, HearsEveryRemoteAndNoOtherDevice) {
  UmockdevMouse mouse(bed_, 0, UmockdevMouse::mouse()), first(bed_, 1, UmockdevMouse::remote());
  UmockdevMouse second(bed_, 12, UmockdevMouse::remote());
  const auto remote = makeEvdevRemote();
  ASSERT_TRUE(remote->open());
  EXPECT_TRUE(first.isGrabbed());
  EXPECT_TRUE(second.isGrabbed());
  EXPECT_FALSE(mouse.isGrabbed());
  EXPECT_FALSE(remote->poll(now_).value());
  press(first, KEY_OK, 1);
  expectNext(*remote, KEY_OK, KeyEvent::Action::Press);
  press(first, KEY_OK, 0);
  expectNext(*remote, KEY_OK, KeyEvent::Action::Release);
  press(second, KEY_RIGHT, 1);
  expectNext(*remote, KEY_RIGHT, KeyEvent::Action::Press);
  now_ += 500ms;
  expectNext(*remote, KEY_RIGHT, KeyEvent::Action::Repeat);
  EXPECT_FALSE(remote->poll(now_).value());
  EXPECT_EQ(first.unknownRequests() + second.unknownRequests() + mouse.unknownRequests(), 0);
}

TEST_F(RemoteEvdev, OneThatComesLaterIsHeardAndOneThatGoesHoldsNothing) {
  const auto remote = makeEvdevRemote();
  ASSERT_TRUE(remote->open()) << "a box without one waits";
  EXPECT_FALSE(remote->hasPad());
  EXPECT_FALSE(remote->poll(now_).value());
  {
    UmockdevMouse late(bed_, 4, UmockdevMouse::remote());
    EXPECT_FALSE(remote->poll(now_).value());
    EXPECT_FALSE(late.isGrabbed()) << "not looked for yet";
    now_ += 1s;
    EXPECT_FALSE(remote->poll(now_).value());
    EXPECT_TRUE(late.isGrabbed());
    press(late, KEY_LEFT, 1);
    expectNext(*remote, KEY_LEFT, KeyEvent::Action::Press);
    late.unplug();
    now_ += 1s;
    expectNext(*remote, KEY_LEFT, KeyEvent::Action::Release);
  }
  UmockdevMouse again(bed_, 5, UmockdevMouse::remote());
  now_ += 1s;
  EXPECT_FALSE(remote->poll(now_).value());
  press(again, KEY_PLAYPAUSE, 1);
  expectNext(*remote, KEY_PLAYPAUSE, KeyEvent::Action::Press);
}

// One node for keys and finger: what is the finger's gives no key, and the pad is not grabbed.
TEST_F(RemoteEvdev, APadIsARemoteExceptForTheFingersStickAndTriggers) {
  UmockdevMouse pad(bed_, 7, UmockdevMouse::pad());
  const auto remote = makeEvdevRemote();
  ASSERT_TRUE(remote->open());
  EXPECT_TRUE(remote->hasPad());
  EXPECT_FALSE(pad.isGrabbed());
  const auto turn = [&pad](int axis, int value) {
    pad.say(EV_ABS, static_cast<std::uint16_t>(axis), value);
    pad.say(EV_SYN, SYN_REPORT, 0);
  };
  for (const int axis : {ABS_X, ABS_Y, ABS_Z, ABS_RZ}) turn(axis, 255);
  turn(ABS_X, -32767);
  press(pad, BTN_THUMBL, 1);
  press(pad, BTN_THUMBL, 0);
  for (const std::uint16_t button : std::array<std::uint16_t, 5>{BTN_SOUTH, BTN_EAST, BTN_TR, BTN_START, BTN_MODE}) {
    press(pad, button, 1);
    expectNext(*remote, button, KeyEvent::Action::Press);
    press(pad, button, 0);
    expectNext(*remote, button, KeyEvent::Action::Release);
  }
  turn(ABS_HAT0Y, 1);
  expectNext(*remote, BTN_DPAD_DOWN, KeyEvent::Action::Press);
  now_ += 2s;
  expectNext(*remote, BTN_DPAD_DOWN, KeyEvent::Action::Repeat);
  turn(ABS_HAT0Y, -1);
  expectNext(*remote, BTN_DPAD_DOWN, KeyEvent::Action::Release);
  expectNext(*remote, BTN_DPAD_UP, KeyEvent::Action::Press);
  turn(ABS_HAT0Y, 0);
  expectNext(*remote, BTN_DPAD_UP, KeyEvent::Action::Release);
  turn(ABS_RY, -30000);
  expectNext(*remote, KEY_VOLUMEUP, KeyEvent::Action::Press);
  turn(ABS_RY, -16000);  // on its way back
  turn(ABS_RY, 100);
  expectNext(*remote, KEY_VOLUMEUP, KeyEvent::Action::Release);
  EXPECT_EQ(pad.unknownRequests(), 0);
}

// A box's remote control with a gamepad's buttons in one node.
TEST_F(RemoteEvdev, APadWithARemotesKeysGivesBoth) {
  auto codes = UmockdevMouse::pad();
  codes[EV_KEY].push_back(KEY_PLAYPAUSE);
  UmockdevMouse pad(bed_, 7, codes);
  const auto remote = makeEvdevRemote();
  ASSERT_TRUE(remote->open());
  press(pad, KEY_PLAYPAUSE, 1);
  expectNext(*remote, KEY_PLAYPAUSE, KeyEvent::Action::Press);
  press(pad, KEY_PLAYPAUSE, 0);
  expectNext(*remote, KEY_PLAYPAUSE, KeyEvent::Action::Release);
  press(pad, BTN_THUMBL, 1);  // the finger's
  press(pad, BTN_EAST, 1);
  expectNext(*remote, BTN_EAST, KeyEvent::Action::Press);
}

// As drivers/gamepad reads the same devices: a key that presses the finger in is no key of the remote.
TEST_F(RemoteEvdev, TheFingersKeyAndAWheelWithAPedalGiveNoKeys) {
  auto codes = UmockdevMouse::pad();
  codes[EV_ABS] = {ABS_X, ABS_Y, ABS_Z, ABS_RZ};  // the second stick
  UmockdevMouse shoulder(bed_, 7, codes);
  codes[EV_KEY] = {BTN_SOUTH, BTN_EAST};
  UmockdevMouse plain(bed_, 8, codes);
  UmockdevMouse wheel(bed_, 9, UmockdevMouse::pad());
  wheel.setRange(ABS_Y, 0, 255);
  const auto remote = makeEvdevRemote();
  ASSERT_TRUE(remote->open());
  const auto expectOnlyEast = [&](UmockdevMouse& pad, std::uint16_t presses) {
    press(pad, presses, 1);
    press(pad, presses, 0);
    press(pad, BTN_EAST, 1);
    expectNext(*remote, BTN_EAST, KeyEvent::Action::Press);
    press(pad, BTN_EAST, 0);
    expectNext(*remote, BTN_EAST, KeyEvent::Action::Release);
  };
  press(wheel, BTN_EAST, 1);
  expectOnlyEast(shoulder, BTN_TR);
  expectOnlyEast(plain, BTN_SOUTH);
  wheel.unplug();
  now_ += 1s;
  EXPECT_FALSE(remote->poll(now_).value());
}

// As hid-steam describes it: touched there, the left touchpad would be a d-pad that jumps through the film.
TEST_F(RemoteEvdev, ASteamDecksTouchpadIsNoDPad) {
  auto codes = UmockdevMouse::pad();
  codes[EV_ABS] = {ABS_X, ABS_Y, ABS_RX, ABS_RY, ABS_HAT0X, ABS_HAT0Y, ABS_HAT1X, ABS_HAT1Y, ABS_HAT2X, ABS_HAT2Y};
  UmockdevMouse deck(bed_, 7, codes);
  for (const unsigned trigger : {ABS_HAT2X, ABS_HAT2Y}) deck.setRange(trigger, 0, 32767);
  for (const unsigned axis : {ABS_HAT0X, ABS_HAT0Y}) deck.setRange(axis, -32767, 32767);
  const auto remote = makeEvdevRemote();
  ASSERT_TRUE(remote->open());
  deck.say(EV_ABS, ABS_HAT0X, -30000);
  deck.say(EV_ABS, ABS_HAT0Y, 30000);
  deck.say(EV_SYN, SYN_REPORT, 0);
  press(deck, BTN_TR, 1);  // its triggers press the finger in
  expectNext(*remote, BTN_TR, KeyEvent::Action::Press);
}

// An Xbox pad over Bluetooth, a Stadia pad and a Logitech F710 in its other mode.
TEST_F(RemoteEvdev, TheSecondStickOfAPadWithoutRxAndRyIsItsVolume) {
  auto codes = UmockdevMouse::pad();
  codes[EV_ABS] = {ABS_X, ABS_Y, ABS_Z, ABS_RZ, ABS_GAS, ABS_BRAKE, ABS_HAT0X, ABS_HAT0Y};
  UmockdevMouse pad(bed_, 7, codes);
  for (const unsigned axis : {ABS_X, ABS_Y, ABS_Z, ABS_RZ}) pad.setRange(axis, 0, 65535);
  const auto remote = makeEvdevRemote();
  ASSERT_TRUE(remote->open());
  const auto turn = [&pad](int place) {
    pad.say(EV_ABS, ABS_RZ, place);
    pad.say(EV_SYN, SYN_REPORT, 0);
  };
  turn(32768);
  turn(60000);
  expectNext(*remote, KEY_VOLUMEDOWN, KeyEvent::Action::Press);
  turn(32768);
  expectNext(*remote, KEY_VOLUMEDOWN, KeyEvent::Action::Release);
}

// The words of an Xbox pad, BTN_SOUTH to BTN_THUMBR, and of a keyboard, on a machine of 64 bits.
TEST(EventNodes, AKeyIsOneOfTheBitsThatSysfsLists) {
  if (sizeof(long) != 8) GTEST_SKIP() << "words of 32 bits";
  const char* const pad = "7cdb000000000000 0 0 0 0";
  EXPECT_TRUE(listsKey(pad, BTN_GAMEPAD));
  EXPECT_TRUE(listsKey(pad, BTN_THUMBR));
  EXPECT_FALSE(listsKey(pad, BTN_C));
  EXPECT_FALSE(listsKey(pad, KEY_ENTER));
  EXPECT_FALSE(listsKey(pad, BTN_TRIGGER_HAPPY));
  const char* const keyboard = "10000 402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe";
  EXPECT_TRUE(listsKey(keyboard, KEY_ENTER));
  EXPECT_FALSE(listsKey(keyboard, KEY_RESERVED));
  EXPECT_FALSE(listsKey(keyboard, BTN_GAMEPAD));
  EXPECT_FALSE(listsKey("", KEY_ENTER));
}

// Beside a window's keyboard: pads alone, and only while the window has the focus.
TEST_F(RemoteEvdev, OfAWindowThePadsAloneAreHeardWhileItHasTheFocus) {
  UmockdevMouse other(bed_, 1, UmockdevMouse::remote()), pad(bed_, 7, UmockdevMouse::pad());
  bool focused = false;
  const auto remote = makePadRemote([&focused] { return focused; });
  ASSERT_TRUE(remote->open());
  EXPECT_FALSE(other.isGrabbed());
  press(other, KEY_OK, 1);
  press(pad, BTN_SOUTH, 1);
  press(pad, BTN_SOUTH, 0);
  expectNext(*remote, BTN_SOUTH, KeyEvent::Action::Release);  // the press was dropped
  focused = true;
  press(pad, BTN_EAST, 1);
  expectNext(*remote, BTN_EAST, KeyEvent::Action::Press);
}

}  // namespace
}  // namespace relievo
