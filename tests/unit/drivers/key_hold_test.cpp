// SPDX-License-Identifier: Apache-2.0
// Whatever a remote sends for a held key becomes a press, repeats at a constant rate and a release.
#include "drivers/evdev/key_hold.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <string>
#include <vector>

namespace relievo {
namespace {

struct Raw {
  int ms;
  std::uint16_t code;
  int value;
};

// One letter per event: P press, r repeat, R release, with the key's code if it is not the first key.
std::string heard(const std::vector<Raw>& sent, int until_ms, int poll_every_ms = 5) {
  KeyHold keys;
  std::string words;
  std::size_t next = 0;
  for (int ms = 0; ms <= until_ms; ms += poll_every_ms) {
    const MonotonicTime now(std::chrono::milliseconds(ms) + std::chrono::hours(1));
    for (; next < sent.size() && sent[next].ms <= ms; ++next) keys.take(sent[next].code, sent[next].value, now);
    while (const auto event = keys.poll(now)) {
      words += event->action == KeyEvent::Action::Press ? 'P' : event->action == KeyEvent::Action::Repeat ? 'r' : 'R';
      if (event->code != KEY_RIGHT) words += std::to_string(event->code);
    }
  }
  return words;
}

TEST(KeyHold, ATapIsAPressAndARelease) {
  EXPECT_EQ(heard({{0, KEY_RIGHT, 1}, {80, KEY_RIGHT, 0}}, 2000), "PR");
  EXPECT_EQ(heard({{0, KEY_RIGHT, 1}, {80, KEY_RIGHT, 0}, {160, KEY_RIGHT, 1}, {240, KEY_RIGHT, 0}}, 2000), "PRPR");
}

// 500, 650, 800, 950 ms.
TEST(KeyHold, AKeyThatIsHeldRepeatsAtItsOwnPaceWhateverTheKernels) {
  EXPECT_EQ(heard({{0, KEY_RIGHT, 1}, {10, KEY_RIGHT, 0}, {20, KEY_RIGHT, 1}, {1020, KEY_RIGHT, 0}}, 3000), "PRPrrrrR")
      << "known to send releases";
  std::vector<Raw> sent{{0, KEY_RIGHT, 1}};
  for (int ms = 250; ms < 1000; ms += 33) sent.push_back({ms, KEY_RIGHT, 2});
  sent.push_back({1000, KEY_RIGHT, 0});
  EXPECT_EQ(heard(sent, 3000), "PrrrrR");
}

TEST(KeyHold, PressesAgainAndAgainAreOneThatIsHeld) {
  std::vector<Raw> sent;
  for (int ms = 0; ms <= 900; ms += 300) sent.push_back({ms, KEY_RIGHT, 1});
  sent.push_back({1000, KEY_RIGHT, 0});
  EXPECT_EQ(heard(sent, 3000), "PrrrrR");
  sent.pop_back();  // without a release: released 550 ms after the last event, at 1450
  EXPECT_EQ(heard(sent, 5000), "PrrrrrrrR");
}

TEST(KeyHold, ATapWithoutAReleaseIsNotHeldForever) {
  EXPECT_EQ(heard({{0, KEY_RIGHT, 1}}, 10'000), "PrR") << "silent from 550 ms on";
}

TEST(KeyHold, AnotherKeyEndsTheFirst) {
  EXPECT_EQ(heard({{0, KEY_RIGHT, 1}, {100, KEY_LEFT, 1}, {150, KEY_RIGHT, 2}, {200, KEY_RIGHT, 0}, {300, KEY_LEFT, 0}},
                  2000),
            "PRP105R105");
}

// Shift and Right, then Ctrl alone, as a keyboard sends them.
TEST(KeyHold, ShiftAndCtrlStayBesideTheKey) {
  EXPECT_EQ(heard({{0, KEY_LEFTSHIFT, 1},
                   {250, KEY_LEFTSHIFT, 2},
                   {300, KEY_RIGHT, 1},
                   {850, KEY_RIGHT, 0},
                   {900, KEY_LEFTSHIFT, 0},
                   {1000, KEY_RIGHT, 1},
                   {1010, KEY_RIGHTCTRL, 1},
                   {1020, KEY_RIGHT, 0},
                   {3000, KEY_RIGHTCTRL, 0}},
                  4000),
            "P42PrRR42PP97RR97");
}

TEST(KeyHold, WhoLooksAwayGetsOneRepeatForAll) {
  EXPECT_EQ(heard({{0, KEY_RIGHT, 1}, {0, KEY_RIGHT, 0}, {5, KEY_RIGHT, 1}, {6000, KEY_RIGHT, 0}}, 6000, 2000),
            "PRPrR");
}

TEST(KeyHold, MoreThanItHoldsIsDropped) {
  std::vector<Raw> sent;
  for (int i = 0; i < 40; ++i) {
    sent.push_back({0, KEY_RIGHT, 1});
    sent.push_back({0, KEY_RIGHT, 0});
  }
  EXPECT_EQ(heard(sent, 1000).size(), 32U);
}

TEST(KeyHold, NothingIsHeldByARemoteThatHasGone) {
  KeyHold keys;
  const MonotonicTime start(std::chrono::hours(1));
  keys.take(KEY_RIGHT, 1, start);
  keys.take(KEY_LEFTCTRL, 1, start);
  keys.letGo(start);
  for (const auto action : {KeyEvent::Action::Press, KeyEvent::Action::Release}) {
    for (const int code : {KEY_RIGHT, KEY_LEFTCTRL}) {
      const auto event = keys.poll(start);
      ASSERT_TRUE(event);
      EXPECT_EQ(event->code, code);
      EXPECT_EQ(event->action, action);
    }
  }
  EXPECT_FALSE(keys.poll(start + std::chrono::seconds(9)));
}

}  // namespace
}  // namespace relievo
