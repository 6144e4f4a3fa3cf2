// SPDX-License-Identifier: Apache-2.0
// The service's files: systemd takes them, the program understands them, and they give what it needs and little more.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "app/player/setup/options.h"
#include "drivers/force/watchdog.h"
#include "platform/cyclic_thread.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using test::contentOf;
using testing::Contains;

const std::string kFolder = RELIEVO_SOURCE_DIR "/toolchain/service/";

// What follows "key=" in the unit, line by line.
std::vector<std::string> values(const std::string& key) {
  std::istringstream lines(contentOf(kFolder + "relievo.service"));
  std::vector<std::string> found;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(key + "=")) found.push_back(line.substr(key.size() + 1));
  }
  return found;
}

std::expected<Options, int> parse(const std::string& line) {
  std::istringstream stream(line);
  const std::vector<std::string> words(std::istream_iterator<std::string>(stream), {});
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  return parseOptions(static_cast<int>(argv.size()), argv.data(),
                      {"kms[:CARD] window offscreen[:FILE] mock", "falcon sim[:HAND] pointer replay:FILE mock none",
                       "evdev keys window script:FILE none", "alsa[:DEVICE] null none"});
}

TEST(ServiceUnit, GrantsThePriorityThatTheHapticTaskAndItsWatchdogAskFor) {
  ASSERT_EQ(values("LimitRTPRIO").size(), 1U);
  EXPECT_GE(std::stoi(values("LimitRTPRIO")[0]), CyclicConfig{}.priority);
  EXPECT_GE(std::stoi(values("LimitRTPRIO")[0]), Watchdog::kWatchPriority);
  EXPECT_THAT(values("RestrictRealtime"), testing::IsEmpty());
}

TEST(ServiceUnit, StartsAPlayerThatWaitsOnASocketInItsOwnFolder) {
  ASSERT_EQ(values("ExecStart").size(), 1U);
  const auto options = parse(values("ExecStart")[0] + " --config " + kFolder + "relievo.toml");
  ASSERT_TRUE(options);
  EXPECT_EQ(options->play.control_path, "/run/" + values("RuntimeDirectory").at(0) + "/control");
  EXPECT_TRUE(options->play.player.stays);
  EXPECT_EQ(options->play.display, "kms");
  EXPECT_EQ(options->play.haptic, "falcon");
}

TEST(ServiceUnit, ItsUserIsTheOneThatSysusersMakes) {
  EXPECT_THAT(contentOf(kFolder + "relievo.sysusers"), testing::HasSubstr("\nu " + values("User").at(0) + " "));
  EXPECT_THAT(values("Type"), Contains("notify"));
}

TEST(ServiceUnit, SystemdTakesItAndFindsItWellGuarded) {
  if (std::system("systemd-analyze --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "there is no systemd-analyze";
  const test::TemporaryFolder folder;
  std::string unit = contentOf(kFolder + "relievo.service");
  const std::string installed = "/usr/bin/relievo";  // a program that is there for sure
  for (std::size_t at = unit.find(installed); at != std::string::npos; at = unit.find(installed, at)) {
    unit.replace(at, installed.size(), "/bin/true");
  }
  std::ofstream(folder / "relievo.service") << unit;
  const std::string file = folder / "relievo.service", said = folder / "said.txt";
  EXPECT_EQ(std::system(("systemd-analyze verify " + file + " >" + said + " 2>&1").c_str()), 0) << contentOf(said);
  EXPECT_EQ(contentOf(said), "");
  // Of 10, lower is better.
  EXPECT_EQ(
      std::system(("systemd-analyze security --offline=true --threshold=20 " + file + " >" + said + " 2>&1").c_str()),
      0)
      << contentOf(said);
}

}  // namespace
}  // namespace relievo
