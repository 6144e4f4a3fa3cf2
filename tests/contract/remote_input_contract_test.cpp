// SPDX-License-Identifier: Apache-2.0
// Every remote control under the contract, and what is special to the terminal and the window.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <stdexcept>
#include <string_view>

#include "drivers/mock/scripted_remote.h"
#include "drivers/sample/sample.h"
#include "drivers/terminal/joined_remote.h"
#include "drivers/terminal/terminal.h"
#include "drivers/terminal/terminal_keys.h"
#include "drivers/window/window_remote.h"
#include "hal/key_names.h"
#include "platform/unique_fd.h"
#include "tests/contract/suite/remote_input.h"

namespace relievo {
namespace {

using Remote = test::RemoteRig;
using namespace std::chrono_literals;

struct Terminal {
  Terminal() {
    int out = -1, in = -1;
    if (::openpty(&out, &in, nullptr, nullptr, nullptr) != 0) throw std::runtime_error("no pseudo-terminal");
    outside.reset(out);
    inside.reset(in);
  }
  void type(std::string_view text) const {
    ASSERT_EQ(::write(outside.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
    pollfd wait{.fd = inside.get(), .events = POLLIN, .revents = 0};
    ASSERT_EQ(::poll(&wait, 1, 5000), 1) << "the kernel delivers it by itself";
  }
  UniqueFd outside, inside;
};

// The receiver's wire.
struct Wire {
  Wire() {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    out.reset(ends[0]), in.reset(ends[1]);
  }
  UniqueFd out, in;
};

const test::RemoteBackend kBackends[] = {
    {"script", [](ManualClock& clock) { return Remote{makeScriptedRemote({{1s, KEY_OK}}, clock), [] {}}; }},
    {"window",
     [](ManualClock& clock) {
       const auto window = std::make_shared<WindowInput>();
       return Remote{makeWindowRemote(window),
                     [window, &clock] { EXPECT_TRUE(window->keys.tryPush({.code = KEY_OK, .time = clock.now()})); }};
     }},
    {"keys",
     [](ManualClock&) {
       const auto terminal = std::make_shared<Terminal>();
       return Remote{makeTerminalRemote(terminal->inside.get()), [terminal] { terminal->type("\r"); }, KEY_ENTER};
     }},
    {"joined",
     [](ManualClock&) {
       const auto terminal = std::make_shared<Terminal>();
       auto window = makeWindowRemote(std::make_shared<WindowInput>());
       return Remote{makeJoinedRemote(std::move(window), makeTerminalRemote(terminal->inside.get())),
                     [terminal] { terminal->type("\r"); }, KEY_ENTER};
     }},
    {"sample",
     [](ManualClock&) {
       const auto wire = std::make_shared<Wire>();
       return Remote{makeSampleRemote(wire->out.get()), [wire] { EXPECT_EQ(::write(wire->in.get(), "?O", 2), 2); }};
     }},
};

INSTANTIATE_TEST_SUITE_P(Backends, RemoteInputContract, testing::ValuesIn(kBackends), test::kBackendName);

std::vector<std::uint16_t> keysOf(std::string_view bytes) {
  std::vector<std::uint16_t> codes;
  while (!bytes.empty()) {
    if (const auto code = takeTerminalKey(bytes)) codes.push_back(*code);
  }
  return codes;
}

TEST(TerminalKeys, AreThoseOfTheKernel) {
  using Keys = std::vector<std::uint16_t>;
  EXPECT_EQ(keysOf("pP 7."), (Keys{KEY_P, KEY_P | kWithShift, KEY_SPACE, KEY_7, KEY_DOT}));
  EXPECT_EQ(keysOf("!@:"), (Keys{KEY_1 | kWithShift, KEY_2 | kWithShift, KEY_SEMICOLON | kWithShift}));
  EXPECT_EQ(keysOf("\x1b[A\x1b[B\x1b[C\x1b[D\x1bOC"), (Keys{KEY_UP, KEY_DOWN, KEY_RIGHT, KEY_LEFT, KEY_RIGHT}));
  EXPECT_EQ(keysOf("\x1b[5~\x1b[6~\x1b[H\x1b[4~"), (Keys{KEY_PAGEUP, KEY_PAGEDOWN, KEY_HOME, KEY_END}));
  EXPECT_EQ(keysOf("\x1b"), (Keys{KEY_ESC}));
  EXPECT_EQ(keysOf("\x1b\x1b[A"), (Keys{KEY_ESC, KEY_UP}));
  EXPECT_EQ(keysOf("[]#?<>+"),
            (Keys{KEY_LEFTBRACE, KEY_RIGHTBRACE, KEY_NUMERIC_POUND, KEY_QUESTION, KEY_PREVIOUS, KEY_NEXT, KEY_KPPLUS}));
  EXPECT_EQ(keysOf("\x1bOP\x1bOR\x1b[15~\x1b[23~"), (Keys{KEY_F1, KEY_F3, KEY_F5, KEY_F11}));
  EXPECT_EQ(keysOf("\x1b[1;2C\x1b[1;5D\x1b[5;2~\x1b[1;2P"),
            (Keys{KEY_RIGHT | kWithShift, KEY_LEFT | kWithCtrl, KEY_PAGEUP | kWithShift, KEY_F1 | kWithShift}));
  EXPECT_EQ(keysOf("\x1b[1;C\x1b[1;1C\x1b[1;0C\x1b[1;99999C"), (Keys{KEY_RIGHT, KEY_RIGHT, KEY_RIGHT}))
      << "no modifier";
  EXPECT_EQ(keysOf("\x1b[[A\x1b[[EA\x1b[["), (Keys{KEY_F1, KEY_F5, KEY_A | kWithShift}));
  // Unknown sequences do not swallow the keys after them.
  EXPECT_EQ(keysOf("\x1b[1;9Xq\x1b[1;3C\x1b[1;9C\x1b[200~\xc3\xa4s\x01"), (Keys{KEY_Q, KEY_S}));
  EXPECT_EQ(keysOf("\x17"), (Keys{KEY_W | kWithCtrl}));
  EXPECT_EQ(keysOf("\x1b[12"), (Keys{}));
}

TEST(TerminalRemote, TheTerminalIsAsItWasAfterwards) {
  const Terminal terminal;
  termios before{}, open{}, after{};
  ASSERT_EQ(::tcgetattr(terminal.inside.get(), &before), 0);
  const auto remote = makeTerminalRemote(terminal.inside.get());
  ASSERT_TRUE(remote->open());
  ASSERT_EQ(::tcgetattr(terminal.inside.get(), &open), 0);
  EXPECT_EQ(open.c_lflag & (ICANON | ECHO), 0U);
  EXPECT_NE(open.c_lflag & ISIG, 0U) << "Ctrl-C stays";
  remote->close();
  ASSERT_EQ(::tcgetattr(terminal.inside.get(), &after), 0);
  EXPECT_EQ(after.c_lflag, before.c_lflag);
}

TEST(TerminalRemote, WhatIsNoTerminalIsRefused) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const UniqueFd out(ends[0]), in(ends[1]);
  EXPECT_EQ(makeTerminalRemote(out.get())->open().error().code, ErrorCode::Unsupported);
}

TEST(TerminalRemote, AfterAHangUpThereAreNoMoreKeys) {
  Terminal terminal;
  const auto remote = makeTerminalRemote(terminal.inside.get());
  ASSERT_TRUE(remote->open());
  terminal.outside.reset();
  const auto key = remote->poll(MonotonicTime(1h));
  EXPECT_TRUE(key && !*key);
}

TEST(JoinedRemote, HasTheKeysOfBothAndDoesWithoutTheSecond) {
  const Terminal terminal;
  const auto window = std::make_shared<WindowInput>();
  const auto both = makeJoinedRemote(makeWindowRemote(window), makeTerminalRemote(terminal.inside.get()));
  ASSERT_TRUE(both->open());
  terminal.type("q");
  ASSERT_TRUE(window->keys.tryPush({.code = KEY_SPACE}));
  std::vector<std::uint16_t> codes;
  while (const auto key = both->poll(MonotonicTime(1h)).value()) {
    if (key->action == KeyEvent::Action::Press) codes.push_back(key->code);
  }
  EXPECT_EQ(codes, (std::vector<std::uint16_t>{KEY_SPACE, KEY_Q}));

  const UniqueFd nothing(::open("/dev/null", O_RDONLY));
  const auto one = makeJoinedRemote(makeWindowRemote(window), makeTerminalRemote(nothing.get()));
  ASSERT_TRUE(one->open());
  ASSERT_TRUE(window->keys.tryPush({.code = KEY_F}));
  EXPECT_EQ(one->poll(MonotonicTime(1h)).value().value().code, KEY_F);
  EXPECT_FALSE(one->poll(MonotonicTime(1h)).value());
}

// A console, into which the keyboard types that evdev reads as well.
TEST(RemoteAtTerminal, TheTerminalsKeysAreForNobody) {
  const Terminal terminal;
  const auto window = std::make_shared<WindowInput>();
  const auto remote = makeRemoteAtTerminal(makeWindowRemote(window), makeTerminalRemote(terminal.inside.get()));
  ASSERT_TRUE(remote->open());
  ASSERT_TRUE(window->keys.tryPush({.code = KEY_SPACE}));
  terminal.type("reboot\r");
  EXPECT_EQ(remote->poll(MonotonicTime(1h)).value()->code, KEY_SPACE);
  EXPECT_FALSE(remote->poll(MonotonicTime(1h)).value());
  pollfd shell{.fd = terminal.inside.get(), .events = POLLIN, .revents = 0};
  EXPECT_EQ(::poll(&shell, 1, 0), 0) << "they do not fill the terminal, which would keep Ctrl-C out";
  terminal.type("reboot\r");
  remote->close();
  EXPECT_EQ(::poll(&shell, 1, 0), 0) << "nothing is left for the shell";
}

TEST(RemoteAtTerminal, TheTerminalsKeysAreTakenWhereTheOthersMayNotBeRead) {
  const Terminal terminal;
  const UniqueFd nothing(::open("/dev/null", O_RDONLY));
  const auto refused = [&] { return makeTerminalRemote(nothing.get()); };
  const auto remote = makeRemoteAtTerminal(refused(), makeTerminalRemote(terminal.inside.get()));
  ASSERT_TRUE(remote->open());
  terminal.type("q");
  EXPECT_EQ(remote->poll(MonotonicTime(1h)).value()->code, KEY_Q);
  EXPECT_FALSE(makeRemoteAtTerminal(refused(), refused())->open());
}

TEST(WindowRemote, WhatWasPressedBeforeItListenedIsNotMeantForIt) {
  const auto window = std::make_shared<WindowInput>();
  const auto remote = makeWindowRemote(window);
  for (std::uint16_t key = 0; key < WindowInput::kMostKeys; ++key) ASSERT_TRUE(window->keys.tryPush({.code = KEY_OK}));
  EXPECT_FALSE(window->keys.tryPush({.code = KEY_OK})) << "full: nobody listens";
  ASSERT_TRUE(remote->open());
  EXPECT_FALSE(remote->poll({}).value());
  ASSERT_TRUE(window->keys.tryPush({.code = KEY_UP, .action = KeyEvent::Action::Release}));
  const auto key = remote->poll({}).value();
  ASSERT_TRUE(key);
  EXPECT_EQ(key->code, KEY_UP);
  EXPECT_EQ(key->action, KeyEvent::Action::Release);
}

}  // namespace
}  // namespace relievo
