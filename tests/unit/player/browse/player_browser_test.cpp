// SPDX-License-Identifier: Apache-2.0
// The player with its list of films, in simulated time: the films lie in a real folder, what is in them does not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/player/control/player_control.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/control_client.h"

namespace relievo {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class PlayerWithAList : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "Videos");
    film("a.mkv", 100);
    film("b.mkv", 100);
    bench_.config.source.url = "";
    bench_.config.browser = BrowserConfig{.folders = {videos()}, .stick_roots = {}};
    bench_.config.resume_path = folder_ / "resume.json";
  }
  [[nodiscard]] std::string videos() const { return folder_ / "Videos"; }
  void film(const std::string& name, int frames) {
    std::ofstream(videos() + "/" + name) << "x";
    bench_.sources[videos() + "/" + name] = PlayerBench::film(frames);
  }
  void play() {
    const auto played = bench_.run();
    ASSERT_TRUE(played) << played.error().thing << ": " << played.error().error.message;
  }

  // The answers that a program on the control socket gets to these lines while the list of films is shown.
  std::vector<json> answersTo(std::initializer_list<const char*> sayings) {
    std::vector<json> answers;
    auto socket = ControlSocket::listen(folder_ / "control");
    if (!socket) return answers;
    PlayerControl control(std::move(*socket), [](std::string_view, std::string_view) { return Result<void>{}; });
    bench_.control = &control;
    test::ControlClient client(folder_ / "control");
    for (const char* words : sayings) client.say(words);
    play();
    while (auto line = client.next(std::chrono::milliseconds(0))) {
      if (line->contains("ok")) answers.push_back(*line);
    }
    bench_.control = nullptr;
    return answers;
  }

  test::TemporaryFolder folder_;
  PlayerBench bench_;
};

TEST_F(PlayerWithAList, ShowsItPlaysTheChosenFilmAndComesBackAtItsEnd) {
  bench_.press(1, KEY_DOWN);
  bench_.press(1.2, KEY_DOWN);  // there is no third
  bench_.press(2, KEY_ENTER);
  bench_.press(10, KEY_Q);
  play();
  EXPECT_EQ(bench_.states(), "boot idle browsing opening buffering playing ended idle browsing idle");
  EXPECT_THAT(bench_.report.films, ElementsAre(videos() + "/b.mkv"));
  EXPECT_EQ(bench_.report.frames_shown, 100u);
}

TEST_F(PlayerWithAList, BackReturnsToItAndTheFilmGoesOnWhereItWasLeft) {
  bench_.press(1, KEY_OK);
  bench_.press(4, KEY_BACK);
  bench_.press(5, KEY_OK);
  bench_.press(6, KEY_ESC);
  bench_.press(7, KEY_Q);
  play();
  EXPECT_EQ(bench_.states(),
            "boot idle browsing opening buffering playing idle browsing "
            "opening buffering seeking buffering playing idle browsing idle");
  EXPECT_THAT(bench_.report.films, ElementsAre(videos() + "/a.mkv", videos() + "/a.mkv"));
}

// The first OK closes the page; the second plays, and BACK then has a film to leave.
TEST_F(PlayerWithAList, AKeyOnItsPageOfKeysOnlyClosesThePage) {
  bench_.press(0.5, KEY_HELP);
  bench_.press(1, KEY_OK);
  bench_.press(1.5, KEY_OK);
  bench_.press(2, KEY_BACK);
  bench_.press(3, KEY_Q);
  play();
  EXPECT_EQ(bench_.states(), "boot idle browsing opening buffering playing idle browsing idle");
}

TEST_F(PlayerWithAList, NextAndPreviousPlayItsFilms) {
  bench_.press(1, KEY_OK);
  bench_.press(2, KEY_N);
  bench_.press(3, KEY_N);  // there is no third
  bench_.press(3.5, KEY_B);
  bench_.press(5, KEY_Q);
  play();
  EXPECT_THAT(bench_.report.films, ElementsAre(videos() + "/a.mkv", videos() + "/b.mkv", videos() + "/a.mkv"));
}

TEST_F(PlayerWithAList, AFilmThatCannotBePlayedLeadsBackToIt) {
  bench_.sources[videos() + "/a.mkv"].fail_open = ErrorCode::Corrupt;
  bench_.press(1, KEY_OK);
  bench_.press(2, KEY_Q);
  play();
  EXPECT_EQ(bench_.states(), "boot idle browsing opening fault idle browsing idle");
  EXPECT_EQ(bench_.faults("a.mkv"), 1u);
}

TEST_F(PlayerWithAList, AFilmOfTheCommandLineEndsTheProgramWithoutOne) {
  bench_.config.source.url = videos() + "/a.mkv";
  play();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing ended idle");
}

TEST_F(PlayerWithAList, ABoxPlaysItsFilmAndThenShowsIt) {
  bench_.config.source.url = videos() + "/a.mkv";
  bench_.config.stays = true;
  bench_.press(8, KEY_Q);
  play();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing ended idle browsing idle");
}

TEST_F(PlayerWithAList, PowerPutsABoxToRestAndBackWakesIt) {
  bench_.config.stays = true;
  bench_.press(1, KEY_POWER);
  bench_.press(2, KEY_BACK);
  bench_.press(3, KEY_Q);
  play();
  EXPECT_EQ(bench_.states(), "boot idle browsing idle browsing idle");
}

TEST_F(PlayerWithAList, ProgramsSeeItAndChooseFromIt) {
  const auto answers = answersTo({"select +1", "status", "select 1", "choose", "status", "back", "quit"});
  ASSERT_EQ(answers.size(), 7u);
  const json list = answers[1]["list"];
  EXPECT_EQ(answers[1]["state"], "browsing");
  EXPECT_EQ(list["selected"], 2);
  EXPECT_EQ(list["count"], 2);
  EXPECT_EQ(list["films"][0],
            (json{{"section", "Videos"}, {"title", "a"}, {"source", videos() + "/a.mkv"}, {"left_s", nullptr}}));
  EXPECT_EQ(answers[4]["state"], "opening");
  EXPECT_EQ(answers[4]["film"], 1);
  EXPECT_EQ(answers[4]["films"], 2);
  EXPECT_TRUE(answers[4]["list"].is_null());
  EXPECT_EQ(bench_.states(), "boot idle browsing opening idle browsing idle");
}

TEST_F(PlayerWithAList, ProgramsAreToldWhatCannotBeDoneAndWhy) {
  const auto answers = answersTo({"select x", "select 99", "pause", "seek +5", "select last", "status", "choose",
                                  "select 1", "next", "previous", "back", "quit"});
  ASSERT_EQ(answers.size(), 12u);
  const auto why = [&](std::size_t line) { return answers[line].value("error", ""); };
  EXPECT_EQ(why(0), "\"select\" takes +N|-N|N|last, not \"x\"");
  EXPECT_EQ(why(1), "there is no film 99; the list has 2");
  EXPECT_EQ(why(2), "no film is open; choose one");
  EXPECT_EQ(why(3), "no film is open; choose one");
  EXPECT_EQ(answers[4], (json{{"ok", true}}));
  EXPECT_EQ(answers[5]["list"]["selected"], 2);
  EXPECT_EQ(why(7), "the list of films is not shown") << "a film is played";
  EXPECT_EQ(why(8), "this is the last film of the list");
  for (const std::size_t line : {0, 1, 2, 3, 7, 8}) EXPECT_EQ(answers[line]["ok"], false) << line;
}

TEST_F(PlayerWithAList, EndGoesToTheLastFilmAndHomeToTheFirst) {
  film("c.mkv", 100);
  bench_.press(1, KEY_END);
  bench_.press(1.2, KEY_HOME);
  bench_.press(1.6, KEY_END);
  bench_.press(2, KEY_ENTER);
  bench_.press(10, KEY_Q);
  play();
  EXPECT_THAT(bench_.report.films, ElementsAre(videos() + "/c.mkv"));
}

TEST(BrowserAlone, SaysWhatToDoWithoutFilms) {
  Browser browser({.folders = {"/absent/films"}, .stick_roots = {}}, {}, {}, false);
  browser.open({}, MonotonicTime{});
  EXPECT_EQ(browser.view().message,
            "There is no folder /absent/films: make it and put films in it, or name another (--films)");
}

TEST_F(PlayerWithAList, AnEmptyListInAWindowOffersToDropAFilm) {
  const std::string empty = folder_ / "empty";
  std::filesystem::create_directory(empty);
  for (const bool window : {false, true}) {
    Browser browser({.folders = {empty}, .stick_roots = {}, .takes_drops = window}, {}, {}, false);
    browser.open({}, MonotonicTime{});
    EXPECT_EQ(browser.view().message, "No films yet: put films in " + empty + " or plug in a USB stick" +
                                          (window ? ", or drop a film here" : ""));
  }
}

TEST_F(PlayerWithAList, FilmsThatWereLeftComeFirst) {
  Browser browser(*bench_.config.browser, {}, {}, false);
  browser.open({{videos() + "/gone.mkv", 3.0}, {videos() + "/b.mkv", 2.5}, {"https://example.org/c.mkv", 60.0}},
               MonotonicTime{});
  const auto& sections = browser.shelf().sections();
  ASSERT_EQ(sections.size(), 2u);
  EXPECT_EQ(sections[0].name, "Recent");
  ASSERT_EQ(sections[0].films.size(), 2u) << "not the one that has gone";
  EXPECT_EQ(sections[0].films[0].url, videos() + "/b.mkv");
  EXPECT_EQ(sections[0].films[0].left_s, 2.5);
  EXPECT_EQ(sections[0].films[1].title, "c");
  EXPECT_EQ(sections[1].films[1].left_s, 2.5) << "the same film in its folder";
}

// Folders are read before it is known which films were left.
TEST_F(PlayerWithAList, TheFirstFilmIsSelectedUntilTheViewerSelectsAnother) {
  Browser browser(*bench_.config.browser, {}, {}, false);
  browser.open({}, MonotonicTime{});
  browser.open({{videos() + "/b.mkv", 2.5}}, MonotonicTime{});
  EXPECT_EQ(browser.shelf().selected(), 0u);
  browser.selectBy(1);
  browser.open({}, MonotonicTime{});
  EXPECT_EQ(browser.shelf().film(browser.shelf().selected()).title, "a");
}

// The stick is taken away at the touch's 25th tick. In a name space of mounts of its own, where a user may mount.
TEST_F(PlayerWithAList, AFilmWhoseStickIsTakenAwayLeadsBackToIt) {
  const std::string root = std::filesystem::canonical(videos()).parent_path(), stick = root + "/STICK";
  std::filesystem::create_directory(stick);
  const auto user = ::getuid();
  if (::unshare(CLONE_NEWNS) != 0) {
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) GTEST_SKIP() << "this system lets no test mount";
    std::ofstream("/proc/self/uid_map") << "0 " << user << " 1";
  }
  ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
  if (::mount("none", stick.c_str(), "tmpfs", 0, nullptr) != 0) GTEST_SKIP() << "this system lets no test mount";
  std::ofstream(stick + "/s.mkv") << "x";
  bench_.sources[stick + "/s.mkv"] = PlayerBench::film(250);
  bench_.config.browser = BrowserConfig{.folders = {root + "/none"}, .stick_roots = {root}};
  int ticks = 0;
  bench_.haptic.position_mm = [&](double) {
    if (++ticks == 25) ::umount(stick.c_str());
    return glm::dvec3(0, 0, 50);
  };
  bench_.press(1, KEY_OK);
  bench_.press(4, KEY_Q);
  play();
  EXPECT_EQ(bench_.states(), "boot idle browsing opening buffering playing fault idle browsing idle");
  EXPECT_EQ(bench_.faults(stick + ": it was unplugged"), 1u);
}

}  // namespace
}  // namespace relievo
