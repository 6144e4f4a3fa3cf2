// SPDX-License-Identifier: Apache-2.0
// Keys that are held, released and combined.
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <string>

#include "app/player/control/key_table.h"
#include "hal/key_names.h"
#include "tests/support/command_words.h"

namespace relievo {
namespace {

using test::wordsOf;
using Action = KeyEvent::Action;
using State = PlayerState;

class KeyReaderTest : public testing::Test {
 protected:
  std::string words(const std::optional<PlayerCommand>& command) { return command ? wordsOf(*command) : "-"; }
  std::string take(int code, Action action, int ms, State state = State::Playing) {
    return words(reader_.take({static_cast<std::uint16_t>(code), action, at(ms)}, state));
  }
  std::string held(int ms) { return words(reader_.held(at(ms))); }
  static MonotonicTime at(int ms) { return MonotonicTime(std::chrono::milliseconds(ms)); }

  KeyReader reader_{KeyTable::usual()};
};

TEST_F(KeyReaderTest, AHeldKeySeeksOnAndDoesNothingElse) {
  EXPECT_EQ(take(KEY_RIGHT, Action::Press, 0), "seek +5");
  EXPECT_EQ(take(KEY_RIGHT, Action::Repeat, 500), "seek +5");
  EXPECT_EQ(take(KEY_RIGHT, Action::Release, 700), "-");
  EXPECT_EQ(take(KEY_PLAYPAUSE, Action::Press, 800), "play-pause");
  EXPECT_EQ(take(KEY_PLAYPAUSE, Action::Repeat, 1300), "-");
  EXPECT_EQ(take(KEY_3D_MODE, Action::Repeat, 1400), "-");
  EXPECT_EQ(held(5000), "-");
}

TEST_F(KeyReaderTest, ShiftAndCtrlMakeAnotherKeyWhereTheTableHasIt) {
  EXPECT_EQ(take(KEY_LEFTSHIFT, Action::Press, 0), "-");
  EXPECT_EQ(take(KEY_G, Action::Press, 100), "subtitle-size +0.1");
  EXPECT_EQ(take(KEY_F, Action::Press, 150), "subtitle-size -0.1");
  EXPECT_EQ(take(KEY_1, Action::Press, 200), "chapter -1");
  EXPECT_EQ(take(KEY_Q, Action::Press, 250), "quit") << "it has no row of its own";
  EXPECT_EQ(take(KEY_LEFTSHIFT, Action::Release, 300), "-");
  EXPECT_EQ(take(KEY_1, Action::Press, 400), "seek 10%");
  EXPECT_EQ(take(KEY_F, Action::Press, 450), "full-screen");
  EXPECT_EQ(take(KEY_RIGHTCTRL, Action::Press, 500), "-");
  EXPECT_EQ(take(KEY_KPPLUS, Action::Press, 550), "audio-delay +0.1");
  EXPECT_EQ(take(KEY_KPPLUS, Action::Repeat, 900), "audio-delay +0.1");
  EXPECT_EQ(take(KEY_W, Action::Press, 910), "quit");
  EXPECT_EQ(take(KEY_RIGHTCTRL, Action::Release, 950), "-");
  EXPECT_EQ(take(KEY_KPPLUS, Action::Press, 990), "volume +5");
}

// As mpv's input.conf: there Z, W, P and L are not z, w, p and l, and the arrows take small steps.
TEST_F(KeyReaderTest, KeysWithShiftAreMpvs) {
  EXPECT_EQ(take(KEY_RIGHTSHIFT, Action::Press, 0), "-");
  EXPECT_EQ(take(KEY_Z, Action::Press, 10), "subtitle-delay +0.1");
  EXPECT_EQ(take(KEY_W, Action::Press, 20), "zoom +0.1");
  EXPECT_EQ(take(KEY_P, Action::Press, 30), "info");
  EXPECT_EQ(take(KEY_L, Action::Press, 40), "loop");
  EXPECT_EQ(take(KEY_RIGHT, Action::Press, 50), "seek +1");
  EXPECT_EQ(take(KEY_LEFT, Action::Press, 60), "seek -1");
  EXPECT_EQ(take(KEY_UP, Action::Press, 70), "seek +5");
  EXPECT_EQ(take(KEY_DOWN, Action::Press, 80), "seek -5");
  EXPECT_EQ(take(KEY_PAGEUP, Action::Press, 90), "seek +600");
  EXPECT_EQ(take(KEY_PAGEDOWN, Action::Press, 100), "seek -600");
}

// The window and the terminal hear signs; the kernel's events are positions.
TEST_F(KeyReaderTest, ASignThatShiftMakesInTheUsaIsItsKey) {
  EXPECT_EQ(take(KEY_COMMA, Action::Press, 0), "step-back");
  EXPECT_EQ(take(KEY_LEFTSHIFT, Action::Press, 10), "-");
  EXPECT_EQ(take(KEY_3, Action::Press, 20), "audio");         // #
  EXPECT_EQ(take(KEY_SLASH, Action::Press, 30), "keys");      // ?
  EXPECT_EQ(take(KEY_COMMA, Action::Press, 40), "previous");  // <
  EXPECT_EQ(take(KEY_DOT, Action::Press, 50), "next");        // >
  EXPECT_EQ(take(KEY_7, Action::Press, 70), "-") << "& is not 7";
  const auto own = KeyTable::parse("[always]\nSHIFT_3 = \"mute\"\n", "keys");
  ASSERT_TRUE(own);
  reader_ = KeyReader(*own);
  EXPECT_EQ(take(KEY_RIGHTSHIFT, Action::Press, 80), "-");
  EXPECT_EQ(take(KEY_3, Action::Press, 90), "mute") << "the viewer's own row";
}

// On most keyboards + is on = with Shift.
TEST_F(KeyReaderTest, CtrlAndShiftAreCtrlWhereTheTableHasNoRowForBoth) {
  EXPECT_EQ(take(KEY_LEFTCTRL, Action::Press, 0), "-");
  EXPECT_EQ(take(KEY_LEFTSHIFT, Action::Press, 10), "-");
  EXPECT_EQ(take(KEY_EQUAL, Action::Press, 20), "audio-delay +0.1");
}

TEST_F(KeyReaderTest, AKeyWithTwoMeaningsIsObeyedWhenItIsLetGoOf) {
  EXPECT_EQ(take(KEY_OK, Action::Press, 0), "-");
  EXPECT_EQ(held(599), "-");
  EXPECT_EQ(take(KEY_OK, Action::Release, 599), "play-pause");
  EXPECT_EQ(held(5000), "-");
}

TEST_F(KeyReaderTest, HeldLongEnoughItMeansTheOtherOnce) {
  EXPECT_EQ(take(KEY_OK, Action::Press, 0), "-");
  EXPECT_EQ(take(KEY_OK, Action::Repeat, 500), "-");
  EXPECT_EQ(held(600), "info");
  EXPECT_EQ(take(KEY_OK, Action::Repeat, 650), "-");
  EXPECT_EQ(held(700), "-");
  EXPECT_EQ(take(KEY_OK, Action::Release, 800), "-");
}

TEST_F(KeyReaderTest, AnotherKeyEndsAHold) {
  EXPECT_EQ(take(KEY_OK, Action::Press, 0), "-");
  EXPECT_EQ(take(KEY_LEFT, Action::Press, 100), "seek -5");
  EXPECT_EQ(held(900), "-");
  EXPECT_EQ(take(KEY_OK, Action::Release, 950), "-");
}

TEST_F(KeyReaderTest, TheReleaseOfAnotherKeyLeavesAHoldAsItIs) {
  EXPECT_EQ(take(KEY_RIGHT, Action::Press, 0), "seek +5");
  EXPECT_EQ(take(KEY_OK, Action::Press, 100), "-");
  EXPECT_EQ(take(KEY_RIGHT, Action::Release, 200), "-");
  EXPECT_EQ(held(699), "-");
  EXPECT_EQ(held(700), "info") << "OK is still held";
}

TEST_F(KeyReaderTest, AKeyThatIsHeldForItsOtherMeaningDoesNotRepeatTheFirst) {
  auto table = KeyTable::parse("[always]\nRIGHT = { press = \"seek +10\", hold = \"info\" }", "k");
  ASSERT_TRUE(table);
  KeyReader reader(std::move(*table));
  EXPECT_FALSE(reader.take({KEY_RIGHT, Action::Press, at(0)}, State::Playing));
  EXPECT_FALSE(reader.take({KEY_RIGHT, Action::Repeat, at(500)}, State::Playing));
  EXPECT_EQ(words(reader.held(at(600))), "info");
}

// The picture may stop while the key is down: it means what it meant when it was pressed.
TEST_F(KeyReaderTest, AKeyMeansWhatItMeantWhenItWasPressed) {
  auto table = KeyTable::parse("[playing]\nRED = { press = \"stop\", hold = \"info\" }", "k");
  ASSERT_TRUE(table);
  KeyReader reader(std::move(*table));
  EXPECT_FALSE(reader.take({KEY_RED, Action::Press, at(0)}, State::Playing));
  EXPECT_EQ(words(reader.take({KEY_RED, Action::Release, at(100)}, State::Paused)), "stop");
}

}  // namespace
}  // namespace relievo
