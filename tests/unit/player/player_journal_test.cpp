// SPDX-License-Identifier: Apache-2.0
// What the journal keeps, and what it tells at once.
#include "app/player/journal.h"

#include <gtest/gtest.h>

#include <vector>

#include "platform/log.h"

namespace relievo {
namespace {

TEST(Journal, TellsEachFaultAndWhichAreNew) {
  setLogLevel(LogLevel::Error);
  ManualClock clock;
  clock.sleepUntil(clock.now() + std::chrono::seconds(5));
  std::vector<FaultEntry> heard;
  std::vector<bool> fresh;
  Journal journal(clock, [&](const FaultEntry& fault, MonotonicTime, bool is_fresh) {
    heard.push_back(fault);
    fresh.push_back(is_fresh);
  });
  journal.begin();
  clock.sleepUntil(clock.now() + std::chrono::seconds(2));
  journal.note("display lost", "it is tried again");
  journal.note("display lost", "it is tried again");
  journal.noteQuietly("haptic: memory not locked", "ticks may come late");  // another part has logged it
  journal.noteStop("film: no such file");
  EXPECT_EQ(fresh, (std::vector<bool>{true, false, false}));
  ASSERT_EQ(heard.size(), 3U);
  EXPECT_EQ(heard[0].time_s, 2);
  EXPECT_EQ(heard[0].sentence(), "display lost; it is tried again");
  EXPECT_EQ(heard[2].done, "stopped");
  const auto& faults = journal.written().faults;
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_EQ(faults[0].count, 2U);
  EXPECT_EQ(faults[1].what, "haptic: memory not locked");
}

TEST(Journal, AFaultMayHaveHappenedBeforeItIsNoted) {
  setLogLevel(LogLevel::Error);
  ManualClock clock;
  Journal journal(clock);
  const MonotonicTime then = clock.now() + std::chrono::seconds(1);
  clock.sleepUntil(then + std::chrono::seconds(1));
  journal.note("haptic device lost", "force zero", then);
  EXPECT_EQ(journal.written().faults.at(0).time_s, 1);
}

TEST(Journal, AListIsNoFilm) {
  const ManualClock clock;
  Journal journal(clock);
  journal.filmAsked("list.m3u");
  journal.filmIsList();
  journal.filmAsked("a.mkv");
  EXPECT_EQ(journal.written().films, std::vector<std::string>{"a.mkv"});
  EXPECT_TRUE(journal.written().opened.contains("list.m3u")) << "no output may replace it";
}

TEST(Journal, OfFilmsThatFollowEachOtherForMonthsTheFirstAreKept) {
  const ManualClock clock;
  Journal journal(clock);
  for (int i = 0; i < 2000; ++i) journal.filmAsked("a.mkv");
  EXPECT_EQ(journal.written().films.size(), 1000U);
  journal.filmAsked("list.m3u");
  journal.filmIsList();
  EXPECT_EQ(journal.written().films.size(), 1000U);
  journal.filmAsked("b.mkv", "depth.mkv");
  journal.filmAsked("http://127.0.0.1/c.mkv");
  EXPECT_EQ(journal.written().opened, (std::set<std::string>{"a.mkv", "b.mkv", "depth.mkv", "list.m3u"}))
      << "no output may replace one of them";
}

}  // namespace
}  // namespace relievo
