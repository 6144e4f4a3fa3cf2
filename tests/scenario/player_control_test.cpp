// SPDX-License-Identifier: Apache-2.0
// The player and what is outside it, on real sockets in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "app/player/control/player_control.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/control_client.h"
#include "tests/support/machine/notify_socket.h"

namespace relievo {
namespace {

using nlohmann::json;
using test::ControlClient;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::chrono::milliseconds kNow{0};

// A program sends its lines at given times of the film, counted from the start of touch. The simulated hand triggers
// the sending, because it is asked for its position at every tick.
class PlayerAndPrograms : public testing::Test {
 protected:
  void SetUp() override {
    bench_.sources["film"] = PlayerBench::film(250);  // 10 s
    bench_.haptic.position_mm = [this](double now_s) {
      while (!sayings_.empty() && sayings_.begin()->first <= now_s) {
        first_->say(sayings_.begin()->second);
        sayings_.erase(sayings_.begin());
      }
      return glm::dvec3(0, 0, 25 - 10 * std::min(now_s, 1.0));  // down into the relief, and there it stays
    };
  }
  void at(double time_s, const std::string& words) { sayings_.emplace(time_s, words); }

  // Plays the film and keeps all that each of two programs receives. Both are connected from the first round on. The
  // player has no reader thread, so that the film is read ahead by then.
  void play(const std::vector<std::string>& before = {}) {
    auto socket = ControlSocket::listen(folder_ / "control");
    ASSERT_TRUE(socket);
    PlayerControl control(std::move(*socket), [this](std::string_view device, std::string_view fault) -> Result<void> {
      if (device != "haptic") return fail(ErrorCode::InvalidArgument, "no such device");
      bench_.hand->unplugged = fault == "unplug";
      return {};
    });
    bench_.control = &control;
    first_.emplace(folder_ / "control");
    ControlClient second(folder_ / "control");
    for (const std::string& words : before) first_->say(words);
    const auto played = bench_.run();
    ASSERT_TRUE(played) << played.error().thing << ": " << played.error().error.message;
    while (auto line = first_->next(kNow)) heard_.push_back(std::move(*line));
    while (auto line = second.next(kNow)) overheard_.push_back(std::move(*line));
  }
  [[nodiscard]] static std::vector<json> events(const std::vector<json>& lines, const std::string& kind) {
    std::vector<json> found;
    std::ranges::copy_if(lines, std::back_inserter(found), [&](const json& j) { return j.value("event", "") == kind; });
    return found;
  }
  [[nodiscard]] std::vector<json> answers() const {
    std::vector<json> found;
    std::ranges::copy_if(heard_, std::back_inserter(found), [](const json& j) { return j.contains("ok"); });
    return found;
  }
  [[nodiscard]] static std::string states(const std::vector<json>& lines) {
    std::string text;
    for (const json& each : events(lines, "state")) {
      text += (text.empty() ? "" : " ") + each["state"].get<std::string>();
    }
    return text;
  }

  test::TemporaryFolder folder_;
  PlayerBench bench_;
  std::multimap<double, std::string> sayings_;
  std::optional<ControlClient> first_;
  std::vector<json> heard_, overheard_;
};

TEST_F(PlayerAndPrograms, AreToldEveryStateWhoeverAsked) {
  at(1, "pause");
  at(2, "play");
  at(3, "seek 8");
  play();
  const std::string all = "paused playing seeking buffering playing ended idle";
  EXPECT_EQ(states(heard_), all);
  EXPECT_EQ(states(overheard_), all);
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing " + all);
  EXPECT_THAT(answers(), testing::Each(json{{"ok", true}}));
  EXPECT_EQ(answers().size(), 3U);
  const auto paused = events(heard_, "state")[0];
  EXPECT_NEAR(paused["time_s"].get<double>(), 1.0, 0.1);
}

TEST_F(PlayerAndPrograms, AStatusTellsWhatIsGoingOn) {
  at(2, "pause");
  at(3, "status");
  at(3.5, "play");
  play();
  ASSERT_EQ(answers().size(), 3U);
  const json status = answers()[1];
  EXPECT_EQ(status["state"], "paused");
  EXPECT_EQ(status["source"], "film");
  EXPECT_NEAR(status["position_s"].get<double>(), 2.0, 0.1);
  EXPECT_EQ(status["duration_s"], 10.0);
  EXPECT_EQ(status["stereo"], "sbs");
  EXPECT_EQ(status["haptic"], "mock");
  EXPECT_EQ(status["has_depth"], true);
  EXPECT_EQ(status["rate"], 1.0);
  EXPECT_EQ(status["loop"], false);
  EXPECT_EQ(status["film"], 1);
  EXPECT_EQ(status["films"], 1);
}

TEST_F(PlayerAndPrograms, AProgramCanSetWhatAKeyOnlyTurns) {
  at(1, "layout tab:full");
  at(1, "loop on");
  at(1, "loop on");
  at(1.5, "faster");
  at(2, "status");
  at(2, "loop off");
  at(2, "layout mono");
  at(2, "play");
  at(2.5, "status");
  play();
  const auto all = answers();
  const json before = all[4], after = all[8];
  EXPECT_EQ(before["stereo"], "tab:full");
  EXPECT_EQ(before["loop"], true);
  EXPECT_EQ(before["rate"], 2.0);
  EXPECT_EQ(after["stereo"], "mono");
  EXPECT_EQ(after["loop"], false);
  EXPECT_EQ(after["rate"], 1.0);
}

TEST_F(PlayerAndPrograms, MetricsComeOnceASecondToWhoeverWantsThem) {
  at(5.5, "metrics off");
  play({"metrics on"});
  const auto metrics = events(heard_, "metrics");
  EXPECT_EQ(metrics.size(), 6U);  // at 0, 1, .. 5
  EXPECT_THAT(events(overheard_, "metrics"), testing::IsEmpty());
  for (std::size_t i = 1; i < metrics.size(); ++i) {
    EXPECT_NEAR(metrics[i]["wall_s"].get<double>() - metrics[i - 1]["wall_s"].get<double>(), 1.0, 0.01);
    EXPECT_NEAR(metrics[i]["haptic"]["ticks"].get<double>(), 1000.0 * static_cast<double>(i), 100) << i;
    EXPECT_NEAR(metrics[i]["video"]["frames_shown"].get<double>(), 25.0 * static_cast<double>(i), 3) << i;
  }
  for (const char* part : {"update_ns", "wakeup_ns"}) {
    for (const char* figure : {"p50", "p99", "p999", "max"}) {
      EXPECT_TRUE(metrics.back()["haptic"][part][figure].is_number());
    }
  }
  EXPECT_GT(metrics.back()["force"]["max_n"].get<double>(), 0.0);
}

TEST_F(PlayerAndPrograms, FaultsGoInAndComeOutAsEvents) {
  at(1, "fault toaster unplug");
  at(2, "fault haptic unplug");
  play();
  ASSERT_EQ(answers().size(), 2U);
  EXPECT_EQ(answers()[0], (json{{"ok", false}, {"error", "no such device"}}));
  EXPECT_EQ(answers()[1], (json{{"ok", true}}));
  const auto faults = events(overheard_, "fault");
  ASSERT_GE(faults.size(), 1U);
  EXPECT_EQ(faults[0]["what"], "haptic device lost");
  EXPECT_THAT(faults[0]["done"].get<std::string>(), HasSubstr("zero force"));
  EXPECT_EQ(bench_.hand->force(), glm::dvec3(0));
}

// A program that speaks while a picture is being shown waits for no second one, whatever others ask for meanwhile.
TEST_F(PlayerAndPrograms, AnAnswerWaitsForOneRefreshAtMost) {
  bench_.config.stays = true;
  int asked = 0;
  bool silent = false;
  std::vector<int> late;  // pictures that were shown while the one before them had brought no answer
  std::optional<ControlClient> other;
  bench_.display.shown = [&] {
    if (!other) return void(other.emplace(folder_ / "control"));  // let in by the next one
    while (auto line = other->next(kNow)) silent = silent && !line->contains("ok");
    if (silent) late.push_back(asked);
    static constexpr std::array kWords{"step",   "step",      "info", "swap-eyes", "play",
                                       "seek 5", "swap-eyes", "step", "stop",      "open film"};
    first_->say(kWords[static_cast<std::size_t>(asked) % kWords.size()]);
    other->say("status");
    silent = true;
    if (++asked == 40) first_->say("quit");
  };
  play();
  EXPECT_GE(asked, 40);
  EXPECT_THAT(late, testing::IsEmpty());
}

TEST_F(PlayerAndPrograms, EveryWordIsHeard) {
  const std::vector<std::string> words = {"pause",  "play",      "play-pause", "play-pause", "step",       "play",
                                          "layout", "swap-eyes", "depth -0.1", "screen +2",  "info",       "info",
                                          "faster", "slower",    "seek +1",    "seek -1",    "seek 5",     "seek 50%",
                                          "play",   "loop",      "loop",       "status",     "metrics off"};
  double time_s = 0.2;
  for (const std::string& each : words) at(time_s += 0.1, each);
  at(time_s + 1, "stop");
  play();
  EXPECT_EQ(answers().size(), words.size() + 1);
  for (const json& answer : answers()) EXPECT_EQ(answer["ok"], true) << answer;
  EXPECT_EQ(bench_.report.states.back(), PlayerState::Idle);
}

TEST_F(PlayerAndPrograms, WithoutAFilmItWaitsForOne) {
  bench_.config.source.url = "";
  bench_.config.stays = true;
  at(1, "quit");
  play({"status", "open film"});
  EXPECT_EQ(answers()[0]["state"], "idle");
  EXPECT_TRUE(answers()[0]["source"].is_null());
  EXPECT_EQ(states(heard_), "opening buffering playing idle");
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing idle");
}

TEST_F(PlayerAndPrograms, AFilmIsOpenedByItsAddressAndBeginsWhereItIsSoughtMeanwhile) {
  bench_.sources["/a film"] = PlayerBench::film(250);
  bench_.config.source.url = "";
  bench_.config.stays = true;
  at(0.5, "status");
  at(1, "quit");
  play({"open file:///a%20film", "seek +3", "seek +2"});
  ASSERT_EQ(answers().size(), 5U);
  for (const json& answer : answers()) EXPECT_EQ(answer["ok"], true) << answer;
  EXPECT_NEAR(answers()[3]["position_s"].get<double>(), 5.5, 0.1);
  EXPECT_THAT(bench_.report.films, ElementsAre("/a film"));
}

TEST_F(PlayerAndPrograms, WhatCannotBeDoneIsRefused) {
  bench_.config.source.url = "";
  bench_.config.stays = true;
  bench_.sources["film"].tracks.pop_back();
  for (const char* words : {"audio 5", "subtitles 4", "depth +0.1", "chapter +1"}) at(0.5, words);
  at(1, "seek 8");
  at(1, "step");
  at(2, "quit");
  play({"open film", "step", "chapter +1", "seek 50%"});
  std::vector<std::string> refused;
  for (const json& answer : answers()) refused.push_back(answer.value("error", ""));
  const std::string opening = "the film is still being opened";
  EXPECT_THAT(refused, ElementsAre("", opening, opening, opening, "there is no sound track 5; the film has 0",
                                   "there is no subtitle track 4; the film has 0", "this film has no depth to change",
                                   "this film has no chapters", "", "there is no picture to step from yet", ""));
}

TEST_F(PlayerAndPrograms, AStatusTellsNothingOfTheFilmBeforeWhileTheNextOneOpens) {
  bench_.config.source.url = "list.m3u";
  bench_.texts["list.m3u"] = "film\nother\n";
  bench_.sources["./film"] = PlayerBench::film(250);  // 10 s
  bench_.sources["./other"] = PlayerBench::film(50);  // 2 s
  at(1, "next");
  at(1, "status");    // in the same round: the source has not been opened yet
  at(1.5, "status");  // counted anew, from the touch of the second film
  play();
  ASSERT_EQ(answers().size(), 3U);
  const json opening = answers()[1], open = answers()[2];
  EXPECT_EQ(opening["state"], "opening");
  EXPECT_EQ(opening["source"], "./other");
  EXPECT_EQ(opening["position_s"], 0.0);
  EXPECT_TRUE(opening["duration_s"].is_null()) << opening;
  EXPECT_EQ(opening["has_depth"], false);
  EXPECT_EQ(open["duration_s"], 2.0);
  EXPECT_EQ(open["has_depth"], true);
}

TEST_F(PlayerAndPrograms, APartWithinAPictureIsNotRepeated) {
  bench_.config.duration = std::chrono::seconds(20);
  at(1.010, "ab-loop");
  at(1.020, "ab-loop");
  at(5, "ab-loop");
  at(5.5, "ab-loop");
  at(6.8, "ab-loop");
  play();
  const std::string again = " seeking buffering playing", thrice = again + again + again;
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing" + thrice + thrice + " ended idle");
}

TEST_F(PlayerAndPrograms, AFilmThatAListMayNotNameIsPassedOver) {
  bench_.config.source.url = "list.m3u";
  bench_.config.stays = true;
  bench_.texts["list.m3u"] = "film\nconcat:a|b\nother\n";
  bench_.sources["./film"] = PlayerBench::film(250);
  bench_.sources["./other"] = PlayerBench::film(50);
  at(1, "next");
  at(2, "quit");
  play();
  EXPECT_THAT(bench_.report.films, ElementsAre("./film", "concat:a|b", "./other"));
  EXPECT_GT(bench_.report.frames_shown, 40U);
}

TEST_F(PlayerAndPrograms, NonsenseIsAnsweredAndDoesNoHarm) {
  at(1, "dance");
  play({"", std::string(5000, 'x')});
  ASSERT_EQ(answers().size(), 3U);
  for (const json& answer : answers()) EXPECT_EQ(answer["ok"], false);
  EXPECT_THAT(answers()[1]["error"].get<std::string>(), HasSubstr("too long"));
  EXPECT_EQ(bench_.report.frames_shown, 250U);
}

// A device that fails at every tick must not send a thousand lines a second.
TEST_F(PlayerAndPrograms, TheSameFaultRunningIsToldOnce) {
  bench_.haptic.refuses_force = true;
  play();
  EXPECT_LE(events(heard_, "fault").size(), 4U);
  EXPECT_GT(bench_.faults("haptic exchange failed"), 1000U);
}

TEST_F(PlayerAndPrograms, TheServiceManagerIsToldAtEachTurn) {
  const test::NotifySocket systemd(folder_ / "notify", std::chrono::seconds(2));
  ASSERT_TRUE(systemd.bound());
  std::vector<std::string> messages;
  const auto read = [&] { std::ranges::move(systemd.all(), std::back_inserter(messages)); };
  const auto hand = bench_.haptic.position_mm;
  bench_.haptic.position_mm = [&](double now_s) {
    read();
    return hand(now_s);
  };
  play();
  read();
  ASSERT_GE(messages.size(), 4U);
  EXPECT_EQ(messages.front(), "READY=1");
  EXPECT_EQ(messages.back(), "STOPPING=1");
  EXPECT_THAT(messages, testing::Contains("STATUS=playing film"));
  // At half the interval, from 0 to 10 s.
  EXPECT_NEAR(static_cast<double>(std::ranges::count(messages, "WATCHDOG=1")), 10.5, 0.6);
}

TEST_F(PlayerAndPrograms, AServiceManagerThatDoesNotReadHoldsNothingUp) {
  const test::NotifySocket systemd(folder_ / "notify", std::chrono::milliseconds(10));
  ASSERT_TRUE(systemd.bound());
  play();
  EXPECT_EQ(bench_.report.frames_shown, 250U);
  EXPECT_LT(systemd.all().size(), 1000U) << "the rest found no room";
}

}  // namespace
}  // namespace relievo
