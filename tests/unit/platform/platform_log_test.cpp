// SPDX-License-Identifier: Apache-2.0
// Log lines: their form, their level, and that lines of different threads do not mix.
#include "platform/log.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "platform/told_count.h"

namespace relievo {
namespace {

template <class Act>
std::string printedBy(Act act) {
  testing::internal::CaptureStderr();
  act();
  return testing::internal::GetCapturedStderr();
}

class LevelGuard {
 public:
  explicit LevelGuard(LogLevel level) { setLogLevel(level); }
  ~LevelGuard() { setLogLevel(LogLevel::Info); }
};

TEST(Log, PrintsOneLineWithItsArea) {
  EXPECT_EQ(printedBy([] { log(LogLevel::Info, "media", "%d frames in %s", 25, "x.mkv"); }),
            "relievo: media: 25 frames in x.mkv\n");
}

TEST(Log, OfManyEventsTheFirstTenthAndHundredthAreTold) {
  std::vector<int> told;
  for (int count = 1; count <= 2000; ++count) {
    if (isTold(static_cast<std::uint64_t>(count))) told.push_back(count);
  }
  EXPECT_EQ(told, (std::vector<int>{1, 10, 100, 1000}));
}

TEST(Log, NamesTheProgram) {
  setLogProgram("relievo-lab");
  const std::string line = printedBy([] { log(LogLevel::Info, "media", "open"); });
  setLogProgram("relievo");
  EXPECT_EQ(line, "relievo-lab: media: open\n");
}

TEST(Log, LeavesOutWhatIsAboveItsLevel) {
  EXPECT_EQ(printedBy([] { log(LogLevel::Debug, "a", "hidden at start"); }), "");
  const LevelGuard guard(LogLevel::Warning);
  EXPECT_EQ(printedBy([] {
              log(LogLevel::Info, "a", "hidden");
              log(LogLevel::Warning, "a", "shown");
              log(LogLevel::Error, "a", "shown too");
            }),
            "relievo: a: shown\nrelievo: a: shown too\n");
}

TEST(Log, ALineTakesThePlaceOfTheStatusLineOnce) {
  EXPECT_EQ(printedBy([] {
              showStatusLine("playing 0:01");
              showStatusLine("playing 0:02");
              log(LogLevel::Warning, "a", "one");
              log(LogLevel::Warning, "a", "two");
              showStatusLine("playing 0:03");
              showStatusLine({});
              showStatusLine({});
            }),
            "\r\033[Kplaying 0:01\r\033[Kplaying 0:02\r\033[Krelievo: a: one\nrelievo: a: two\n"
            "\r\033[Kplaying 0:03\r\033[K");
}

TEST(Log, MakesOneLineOfATextWithLineBreaks) {
  EXPECT_EQ(printedBy([] { log(LogLevel::Info, "a", "one\ntwo\tthree\x1b[2J\r\n"); }),
            "relievo: a: one two three [2J\n");
  EXPECT_EQ(printedBy([] {
              log(LogLevel::Info, "a",
                  "gr\xc3\xb6\xc3\x9f"
                  "er");
            }),
            "relievo: a: gr\xc3\xb6\xc3\x9f"
            "er\n");
}

TEST(Log, CutsOffAnEndlessText) {
  const std::string text(10'000, 'x');
  const std::string line = printedBy([&] { log(LogLevel::Info, "a", "%s", text.c_str()); });
  EXPECT_LE(line.size(), 1024u);
  EXPECT_GT(line.size(), 1000u);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const std::string area = printedBy([&] { log(LogLevel::Info, text.c_str(), "%s", "y"); });
  EXPECT_LE(area.size(), 1024u);
  EXPECT_EQ(area.find('\n'), area.size() - 1);
}

TEST(Log, LeavesErrnoAsItWas) {
  int kept = 0;
  printedBy([&] {
    errno = ENODEV;
    log(LogLevel::Info, "a", "%s", "b");
    kept = errno;
  });
  EXPECT_EQ(kept, ENODEV);
}

TEST(Log, KeepsTheLinesOfTwoThreadsApart) {
  constexpr int kLines = 2000;
  const std::string all = printedBy([] {
    const auto write = [](const char* area, char letter) {
      const std::string text(100, letter);
      for (int i = 0; i < kLines; ++i) log(LogLevel::Info, area, "%s", text.c_str());
    };
    std::thread first(write, "first", '1');
    std::thread second(write, "second", '2');
    first.join();
    second.join();
  });
  const std::string first = "relievo: first: " + std::string(100, '1');
  const std::string second = "relievo: second: " + std::string(100, '2');
  std::istringstream lines(all);
  std::string line;
  int of_first = 0;
  int of_second = 0;
  while (std::getline(lines, line)) {
    of_first += line == first;
    of_second += line == second;
    ASSERT_TRUE(line == first || line == second) << line;
  }
  EXPECT_EQ(of_first, kLines);
  EXPECT_EQ(of_second, kLines);
}

TEST(RingLog, PrintsItsRecordsInOrderWithTheNumbersThatAreGiven) {
  RingLog ring("haptic");
  ring.push({.level = LogLevel::Warning, .text = "force limited, N:", .a = 12.5, .b = 10});
  ring.push({.level = LogLevel::Info, .text = "ticks missed:", .a = 0});
  ring.push({.level = LogLevel::Info, .text = "device lost"});
  ring.push({.level = LogLevel::Debug, .text = "hidden"});
  EXPECT_EQ(printedBy([&] { ring.drain(); }),
            "relievo: haptic: force limited, N: 12.5 10\n"
            "relievo: haptic: ticks missed: 0\n"
            "relievo: haptic: device lost\n");
  EXPECT_EQ(printedBy([&] { ring.drain(); }), "");
}

TEST(RingLog, SaysHowManyRecordsWereLostAndSaysItOnce) {
  const LevelGuard guard(LogLevel::Warning);
  RingLog ring("a");
  for (int i = 0; i < 256 + 3; ++i) ring.push({.level = LogLevel::Error, .text = "b"});
  EXPECT_THAT(printedBy([&] { ring.drain(); }),
              testing::EndsWith("relievo: a: 3 log lines dropped: they came faster than they were printed\n"));
  EXPECT_EQ(printedBy([&] { ring.drain(); }), "");
}

// Records below the level take no room in the ring.
TEST(RingLog, TakesWhatItsAreasLevelLetsThrough) {
  const LevelGuard guard(LogLevel::Error);
  setLogLevel("haptic", LogLevel::Debug);
  RingLog haptic("haptic"), other("play");
  for (int i = 0; i < 1000; ++i) other.push({.level = LogLevel::Debug, .text = "b"});
  haptic.push({.level = LogLevel::Debug, .text = "fine"});
  EXPECT_EQ(printedBy([&] { haptic.drain(); }), "relievo: haptic: fine\n");
  EXPECT_EQ(printedBy([&] { other.drain(); }), "");
}

TEST(Log, AnAreaHasALevelOfItsOwnUntilAllAreSet) {
  const LevelGuard guard(LogLevel::Warning);
  setLogLevel("play", LogLevel::Debug);
  setLogLevel("no such area", LogLevel::Debug);
  const auto speak = [] {
    log(LogLevel::Debug, "play", "p");
    log(LogLevel::Info, "media", "m");
    log(LogLevel::Info, "no such area", "n");
    log(LogLevel::Warning, "film.mkv", "f");
  };
  EXPECT_EQ(printedBy(speak), "relievo: play: p\nrelievo: film.mkv: f\n");
  setLogLevel(LogLevel::Error);
  EXPECT_EQ(printedBy(speak), "");
}

// The configuration could not set the level of an area that is missing in the list.
TEST(Log, EveryAreaThatTheSourcesNameIsInTheList) {
  namespace fs = std::filesystem;
  const std::regex named(R"re((?:log\(LogLevel::(?:Warning|Info|Debug), |RingLog \w+[{(])"([a-z ]+)")re");
  int found = 0;
  for (const char* top : {"platform", "hal", "drivers", "app"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(RELIEVO_SOURCE_DIR) / top)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      const std::string words = text.str();
      for (std::sregex_iterator it(words.begin(), words.end(), named), end; it != end; ++it, ++found) {
        const std::string area = (*it)[1];
        EXPECT_TRUE(area == "progress" || std::ranges::find(kLogAreas, area) != kLogAreas.end())
            << entry.path() << ": " << area;
      }
    }
  }
  EXPECT_GE(found, 8);
}

}  // namespace
}  // namespace relievo
