// SPDX-License-Identifier: Apache-2.0
// The judge of a scenario, and what feeds its film to the finger.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "app/lab/film/made_film.h"
#include "app/lab/film/memory_feed.h"
#include "app/lab/finger/touch_stage.h"
#include "app/lab/scenario/judge.h"
#include "app/lab/scenario/material_theory.h"
#include "app/lab/scenario/scenario_tools.h"

namespace relievo {
namespace {

StageTick tickAt(double t, const glm::dvec3& hip, const glm::dvec3& sent) {
  return {.t_s = t, .hip_mm = hip, .sent_n = sent, .exchanged = true};
}

TEST(Judge, SeesWhatIsNotWithinBounds) {
  const auto passes = [](const std::vector<StageTick>& ticks) {
    Judge judge;
    judge.bounds(ticks, 0.5);
    return judge.verdict().pass;
  };
  const glm::dvec3 rest(0), nan(std::nan(""));
  EXPECT_TRUE(passes({tickAt(0, rest, {0, 0, 1}), tickAt(0.001, rest, {0, 0, 1.05})}));
  EXPECT_FALSE(passes({tickAt(0, rest, {0, 0, 1}), tickAt(0.001, rest, {0, 0, 1.06})})) << "60 N/s";
  EXPECT_TRUE(passes({tickAt(0, rest, {0, 0, 1}), tickAt(0.001, {0, 0, -1}, {0, 0, 1.5})})) << "the hand's own";
  EXPECT_TRUE(passes({tickAt(0, rest, {0, 0, 1}), tickAt(0.02, rest, {0, 0, 2})})) << "20 ms: 1 N";
  EXPECT_FALSE(passes({tickAt(0, rest, {0, 0, 10.1})}));
  EXPECT_FALSE(passes({tickAt(0, rest, nan), tickAt(0.001, rest, rest)}));
  EXPECT_TRUE(passes({tickAt(0, rest, rest), tickAt(0.001, nan, rest), tickAt(0.002, rest, rest)}));
}

TEST(Judge, TheFirstDemandThatIsNotMetDecides) {
  Judge judge;
  judge.atMost(1, {2, "mm"}, "first");
  EXPECT_EQ(judge.verdict().why, "first");
  judge.atLeast(1, {2, "N"}, "second");
  judge.atMost(9, {2, "s"}, "third");
  EXPECT_FALSE(judge.verdict().pass);
  EXPECT_EQ(judge.verdict().why, "second");
  EXPECT_EQ(judge.verdict().limit.value, 2);
  Judge none;
  none.atMost(std::nan(""), {2, "mm"}, "no number");
  EXPECT_FALSE(none.verdict().pass);
}

TEST(MaterialTheory, ExplainsAFailureUpToItsOwnLimitAndNoOther) {
  const auto explains = [](const char* material, const char* scenario, const Verdict& verdict) {
    const auto theory = theoryOf(material, scenario, verdict);
    return theory && theory->explains;
  };
  const Limit percent{5, "%"}, slew{50, "N/s"}, least{95, "%"};
  EXPECT_TRUE(explains("friction", "rise-free", {false, 34.9, percent, ""}));
  EXPECT_FALSE(explains("friction", "rise-free", {false, 35.1, percent, ""}));
  EXPECT_FALSE(explains("friction", "rise-free", {false, 60, slew, ""})) << "another demand decided";
  EXPECT_FALSE(explains("friction", "rise-contact", {false, 20, percent, ""}));
  EXPECT_FALSE(explains("texture", "rise-free", {false, 20, percent, ""}));
  EXPECT_TRUE(explains("stiffer", "fast-hip", {false, 90.9, least, ""}));
  EXPECT_FALSE(explains("stiffer", "fast-hip", {false, 90, least, ""}));
  EXPECT_FALSE(theoryOf("friction", "rise-free", {true, 1, percent, ""}).has_value()) << "it needs none";
  EXPECT_FALSE(explains("friction", "rise-free", {false, std::nan(""), percent, ""}));
}

TEST(MemoryFeed, HoldsTwoFramesBeforeAndFourAfterThePresentOne) {
  const auto film = makeFilm(scenario::plane(20, 0, 0), {}, 0.5);
  MemoryFeed feed(film);
  SurfaceWindow window;
  ASSERT_TRUE(feed.update(mediaTime(0.21), 0, 0, window));
  ASSERT_EQ(window.count, 7);
  EXPECT_EQ(window.frames[0].time, mediaTime(4.0 / 30));
  EXPECT_EQ(window.frames[6].time, mediaTime(10.0 / 30));
  EXPECT_FALSE(feed.update(mediaTime(0.22), 0, 0, window));
  EXPECT_TRUE(feed.update(mediaTime(0.22), 0, 1, window)) << "another epoch";
  EXPECT_EQ(window.epoch, 1U);
}

TEST(MemoryFeed, AFrameThatComesLateTakesItsPlace) {
  const auto film = makeFilm(scenario::plane(20, 0, 0), {}, 0.5);
  MemoryFeed feed(film, [](std::size_t i, double t) { return i != 7 || t >= 0.21; });
  SurfaceWindow window;
  ASSERT_TRUE(feed.update(mediaTime(0.20), 0.20, 0, window));
  EXPECT_EQ(window.frames[3].time, mediaTime(8.0 / 30));
  ASSERT_TRUE(feed.update(mediaTime(0.21), 0.21, 0, window));
  EXPECT_EQ(window.frames[3].time, mediaTime(7.0 / 30));
}

}  // namespace
}  // namespace relievo
