// SPDX-License-Identifier: Apache-2.0
// Parses command lines for the tests of the player's options.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/player/setup/options.h"

namespace relievo::test {

using testing::HasSubstr;
using testing::StartsWith;

struct Parsed {
  std::expected<Options, int> options;
  std::string out, err;
};

inline Parsed parse(const std::vector<const char*>& arguments, const Machine& machine = {}) {
  std::vector<const char*> words{"relievo"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  auto options = parseOptions(
      static_cast<int>(words.size()), words.data(),
      {"kms[:CARD] window offscreen[:FILE] mock", "falcon inverse3 gamepad sim[:HAND] pointer replay:FILE mock none",
       "evdev keys window script:FILE none", "alsa[:DEVICE] null none", "v4l2 gstreamer[:ELEMENT] ffmpeg"},
      machine);
  std::string out = testing::internal::GetCapturedStdout();
  std::string err = testing::internal::GetCapturedStderr();
  return {std::move(options), std::move(out), std::move(err)};
}

inline void expectRefused(const std::vector<const char*>& words, const char* part) {
  const Parsed parsed = parse(words);
  ASSERT_FALSE(parsed.options) << (words.empty() ? "" : words.back());
  EXPECT_EQ(parsed.options.error(), 2);
  EXPECT_THAT(parsed.err, StartsWith("relievo: "));
  EXPECT_THAT(parsed.err, HasSubstr(part));
  EXPECT_EQ(std::count(parsed.err.begin(), parsed.err.end(), '\n'), 1) << parsed.err;
}

inline Machine machineWith(bool desktop, bool screen, const std::string& haptic = "", bool terminal = false) {
  return {.desktop = [=] { return desktop; },
          .screen = [=] { return screen; },
          .haptic = [=] { return haptic; },
          .terminal = [=] { return terminal; }};
}

inline std::string devicesOf(const PlayOptions& play) {
  return play.display.text() + " " + play.haptic.text() + " " + play.remote.text() + " " + play.audio.text();
}

}  // namespace relievo::test
