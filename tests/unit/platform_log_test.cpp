// SPDX-License-Identifier: Apache-2.0
// A line is a line: its form, its level, and that threads do not write into each other's.
#include "platform/log.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <sstream>
#include <string>
#include <thread>

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
  RingLog ring;
  ring.push({.level = LogLevel::Warning, .area = "haptics", .text = "force limited, N:", .a = 12.5, .b = 10});
  ring.push({.level = LogLevel::Info, .area = "haptics", .text = "ticks missed:", .a = 0});
  ring.push({.level = LogLevel::Info, .area = "haptics", .text = "device lost"});
  ring.push({.level = LogLevel::Debug, .area = "haptics", .text = "hidden"});
  EXPECT_EQ(printedBy([&] { ring.drain(); }),
            "relievo: haptics: force limited, N: 12.5 10\n"
            "relievo: haptics: ticks missed: 0\n"
            "relievo: haptics: device lost\n");
  EXPECT_EQ(printedBy([&] { ring.drain(); }), "");
}

TEST(RingLog, SaysHowManyRecordsWereLostAndSaysItOnce) {
  const LevelGuard guard(LogLevel::Warning);
  RingLog ring;
  for (int i = 0; i < 256 + 3; ++i) ring.push({.level = LogLevel::Debug, .area = "a", .text = "b"});
  EXPECT_EQ(printedBy([&] { ring.drain(); }), "relievo: log: 3 lines lost: they came faster than they were printed\n");
  EXPECT_EQ(printedBy([&] { ring.drain(); }), "");
}

}  // namespace
}  // namespace relievo
