// SPDX-License-Identifier: Apache-2.0
// The script of a remote control: its grammar, and when its keys come.
#include "drivers/mock/scripted_remote.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "hal/key_names.h"

namespace relievo {
namespace {

TEST(ScriptedRemote, ReadsKeysWithAndWithoutPrefixAndComments) {
  const auto keys = parseKeyScript("# a film\n0.5 PLAYPAUSE\n\n  1.25\tKEY_FASTFORWARD # twice as fast\r\n2 stop", "s");
  ASSERT_TRUE(keys);
  ASSERT_EQ(keys->size(), 3u);
  EXPECT_EQ((*keys)[0].at, std::chrono::milliseconds(500));
  EXPECT_EQ((*keys)[0].code, KEY_PLAYPAUSE);
  EXPECT_EQ((*keys)[1].at, std::chrono::milliseconds(1250));
  EXPECT_EQ((*keys)[1].code, KEY_FASTFORWARD);
  EXPECT_EQ((*keys)[2].at, std::chrono::seconds(2));
  EXPECT_EQ((*keys)[2].code, KEY_STOP);
}

TEST(ScriptedRemote, AnEmptyScriptPressesNothing) {
  const auto keys = parseKeyScript("# nothing\n", "s");
  ASSERT_TRUE(keys);
  EXPECT_TRUE(keys->empty());
}

class ScriptedRemoteWrong : public testing::TestWithParam<const char*> {};
TEST_P(ScriptedRemoteWrong, IsRefusedAndItsLineIsNamed) {
  const auto keys = parseKeyScript(GetParam(), "keys.txt");
  ASSERT_FALSE(keys);
  EXPECT_EQ(keys.error().error.code, ErrorCode::InvalidArgument);
  EXPECT_TRUE(keys.error().thing.starts_with("keys.txt:2")) << keys.error().thing;
}
INSTANTIATE_TEST_SUITE_P(Lines, ScriptedRemoteWrong,
                         testing::Values("1 PLAY\nPLAY 2\n", "1 PLAY\n2\n", "1 PLAY\n2 PLAZ\n", "1 PLAY\n-2 PLAY\n",
                                         "1 PLAY\n0.5 PLAY\n", "1 PLAY\n2 PLAY PAUSE\n", "1 PLAY\nnan PLAY\n",
                                         "1 PLAY\n2s PLAY\n", "1 PLAY\n2 KEY_\n"));

TEST(ScriptedRemote, AWrongNameIsToldWithTheNearestRightOne) {
  for (const auto& [line, thing] : {std::pair{"2 fast forward", "k:1: fast forward (FASTFORWARD?)"},
                                    {"2 3D mode", "k:1: 3D mode (3D_MODE?)"},
                                    {"2 play/pause", "k:1: play/pause (PLAYPAUSE?)"},
                                    {"2 KEY_PLAZ", "k:1: KEY_PLAZ (PLAY?)"},
                                    {"2 crocodile", "k:1: crocodile"}}) {
    const auto keys = parseKeyScript(line, "k");
    ASSERT_FALSE(keys) << line;
    EXPECT_EQ(keys.error().thing, thing);
  }
}

TEST(ScriptedRemote, AMissingFileIsNotFound) {
  const auto keys = loadKeyScript("/nonexistent/keys.txt");
  ASSERT_FALSE(keys);
  EXPECT_EQ(keys.error().error.code, ErrorCode::NotFound);
}

TEST(ScriptedRemote, PressesEachKeyOnceWhenItsTimeHasCome) {
  ManualClock clock(MonotonicTime(std::chrono::hours(5)));
  const auto remote = makeScriptedRemote(
      {{std::chrono::seconds(1), KEY_OK, std::chrono::seconds(2)}, {std::chrono::seconds(1), KEY_UP}}, clock);
  ASSERT_TRUE(remote->open());
  clock.advance(std::chrono::milliseconds(999));
  EXPECT_FALSE(remote->poll(clock.now()).value());
  clock.advance(std::chrono::milliseconds(2));
  const auto first = remote->poll(clock.now()).value();
  const auto second = remote->poll(clock.now()).value();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->code, KEY_OK);
  EXPECT_EQ(first->action, KeyEvent::Action::Press);
  EXPECT_EQ(first->time, MonotonicTime(std::chrono::hours(5) + std::chrono::seconds(1)));
  EXPECT_EQ(second->code, KEY_UP);
  EXPECT_FALSE(remote->poll(clock.now()).value());

  // Each is released after its own time.
  clock.advance(std::chrono::seconds(1));
  const auto third = remote->poll(clock.now()).value();
  ASSERT_TRUE(third);
  EXPECT_EQ(third->code, KEY_UP);
  EXPECT_EQ(third->action, KeyEvent::Action::Release);
  EXPECT_FALSE(remote->poll(clock.now()).value());
  clock.advance(std::chrono::seconds(1));
  const auto fourth = remote->poll(clock.now()).value();
  ASSERT_TRUE(fourth);
  EXPECT_EQ(fourth->code, KEY_OK);
  EXPECT_EQ(fourth->time, MonotonicTime(std::chrono::hours(5) + std::chrono::seconds(3)));
  EXPECT_FALSE(remote->poll(clock.now()).value());
}

TEST(ScriptedRemote, AKeyMayBeHeldDown) {
  const auto keys = parseKeyScript("1 OK 1.5\n2 5\n3 5 0.2\n", "s");
  ASSERT_TRUE(keys);
  ASSERT_EQ(keys->size(), 3u);
  EXPECT_EQ((*keys)[0].code, KEY_OK);
  EXPECT_EQ((*keys)[0].held, std::chrono::milliseconds(1500));
  EXPECT_EQ((*keys)[1].code, KEY_5);
  EXPECT_EQ((*keys)[1].held, ScriptedKey{}.held);
  EXPECT_EQ((*keys)[2].code, KEY_5);
  EXPECT_EQ((*keys)[2].held, std::chrono::milliseconds(200));
}

TEST(KeyNames, AreThoseOfTheKernel) {
  EXPECT_EQ(keyCode("KEY_PLAY"), KEY_PLAY);
  EXPECT_EQ(keyCode("numeric_7"), KEY_NUMERIC_7);
  EXPECT_EQ(keyCode("7"), KEY_7);
  EXPECT_EQ(keyCode("KEY_KEY_PLAY"), std::nullopt);
  EXPECT_EQ(keyCode("PLA"), std::nullopt);
  EXPECT_EQ(keyCode(""), std::nullopt);
}

}  // namespace
}  // namespace relievo
