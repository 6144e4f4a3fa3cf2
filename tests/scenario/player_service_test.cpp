// SPDX-License-Identifier: Apache-2.0
// The program as a service: told what to do by other programs, watched by systemd, ended by a signal in any state.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/control_client.h"
#include "tests/support/machine/notify_socket.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ControlClient;
using testing::HasSubstr;
using namespace std::chrono_literals;

class PlayerService : public testing::Test {
 protected:
  void SetUp() override {
    test::makeClip(at("film.mkv"), {{.pix_fmt = "yuv420p", .frames = 90}, {.pix_fmt = "gray16le", .frames = 90}});
  }
  [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::vector<std::string> words(const std::vector<std::string>& more = {},
                                               const std::string& devices = "mock") const {
    std::vector<std::string> all{std::string(RELIEVO_BIN_DIR) + "/relievo",
                                 "play",
                                 "--display",
                                 devices == "mock" ? "mock" : "offscreen",
                                 "--haptic",
                                 devices,
                                 "--control",
                                 at("control")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  test::TemporaryFolder folder_;
};

TEST_F(PlayerService, IsToldWhatToPlayAndTellsWhatHappens) {
  test::Process player(words({"--loop"}), at("said.txt"));
  ControlClient program(at("control")), other(at("control"));
  ASSERT_TRUE(program.connected() && other.connected());
  EXPECT_EQ(fs::status(at("control")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(program.ask("status")["state"], "idle");
  EXPECT_EQ(program.ask("open " + at("film.mkv"))["ok"], true);
  EXPECT_TRUE(other.untilState("playing"));
  EXPECT_EQ(program.ask("metrics on")["ok"], true);
  EXPECT_TRUE(program.until([](const json& j) { return j.value("event", "") == "metrics"; }));

  EXPECT_EQ(program.ask("fault haptic unplug")["ok"], true);
  EXPECT_TRUE(other.until([](const json& j) { return j.value("what", "") == "haptic device lost"; }));
  EXPECT_EQ(program.ask("fault haptic plug")["ok"], true);
  EXPECT_TRUE(other.until([](const json& j) { return j.value("what", "") == "haptic device back"; }));
  EXPECT_EQ(program.ask("fault haptic glitch")["ok"], true);
  EXPECT_EQ(program.ask("fault display unplug")["ok"], true);
  EXPECT_TRUE(other.until([](const json& j) { return j.value("what", "") == "display lost"; }));
  EXPECT_EQ(program.ask("fault display plug")["ok"], true);
  EXPECT_TRUE(other.until([](const json& j) { return j.value("what", "") == "display back"; }));
  EXPECT_THAT(program.ask("fault toaster plug")["error"].get<std::string>(), HasSubstr("haptic unplug|plug|glitch"));

  EXPECT_EQ(program.ask("pause")["ok"], true);
  EXPECT_TRUE(other.untilState("paused"));
  program.say("quit");
  EXPECT_EQ(player.wait(), 0);
  EXPECT_FALSE(fs::exists(at("control")));
}

TEST_F(PlayerService, AfterTheFilmThatItBeganWithItWaitsForTheNext) {
  test::Process player(words({at("film.mkv")}), at("said.txt"));
  ControlClient program(at("control"));
  EXPECT_TRUE(program.untilState("ended"));
  EXPECT_TRUE(program.untilState("idle"));
  EXPECT_EQ(program.ask("open " + at("film.mkv"))["ok"], true);
  EXPECT_TRUE(program.untilState("playing"));
  program.say("quit");
  EXPECT_EQ(player.wait(), 0);
}

// Which film that will be is not known when the player starts.
TEST_F(PlayerService, AnOutputOntoAFilmThatAProgramOpensLeavesTheFilm) {
  test::makeClip(at("next.mkv"), {{.pix_fmt = "yuv420p", .frames = 9}, {.pix_fmt = "gray16le", .frames = 9}});
  fs::create_hard_link(at("film.mkv"), at("run.json"));
  fs::create_hard_link(at("next.mkv"), at("hand.csv"));
  const std::string film = test::contentOf(at("film.mkv")), next = test::contentOf(at("next.mkv"));
  test::Process player(words({"--report", at("run.json"), "--record", at("hand.csv")}), at("said.txt"));
  ControlClient program(at("control"));
  for (const char* name : {"next.mkv", "film.mkv"}) {
    EXPECT_EQ(program.ask("open " + at(name))["ok"], true);
    EXPECT_TRUE(program.untilState("playing"));
  }
  program.say("quit");
  EXPECT_EQ(player.wait(), 2);
  EXPECT_EQ(test::contentOf(at("run.json")), film);
  EXPECT_EQ(test::contentOf(at("hand.csv")), next);
  const std::string said = test::contentOf(at("said.txt"));
  EXPECT_THAT(said, HasSubstr("run-2.json was written in place of " + at("run.json") + ": that is also a film"));
  EXPECT_THAT(said, HasSubstr("hand-2.csv was written in place of " + at("hand.csv") + ": that is also a film"));
  EXPECT_THAT(test::contentOf(at("run-2.json")), HasSubstr("\"states\""));
  EXPECT_THAT(test::contentOf(at("hand-2.csv")), HasSubstr("hip_x_mm"));
}

// Those of the run before lie there already.
TEST_F(PlayerService, AReportAmongTheFilmsOfAFolderThatIsOpenedIsReplaced) {
  fs::create_directory(at("rec"));
  fs::rename(at("film.mkv"), at("rec/film.mkv"));
  for (const char* name : {"rec/run.json", "rec/hand.csv"}) std::ofstream(at(name)) << "the run before";
  test::Process player(words({"--report", at("rec/run.json"), "--record", at("rec/hand.csv")}), at("said.txt"));
  ControlClient program(at("control"));
  EXPECT_EQ(program.ask("open " + at("rec"))["ok"], true);
  EXPECT_TRUE(program.untilState("playing"));
  program.say("quit");
  EXPECT_EQ(player.wait(), 0) << test::contentOf(at("said.txt"));
  EXPECT_THAT(test::contentOf(at("rec/run.json")), HasSubstr("\"states\""));
  EXPECT_THAT(test::contentOf(at("rec/hand.csv")), HasSubstr("hip_x_mm"));
}

TEST_F(PlayerService, AFaultIsForMocksAlone) {
  test::Process player(words({}, "none"), at("said.txt"));
  ControlClient program(at("control"));
  EXPECT_THAT(program.ask("fault haptic unplug")["error"].get<std::string>(), HasSubstr("no mock"));
  EXPECT_THAT(program.ask("fault display unplug")["error"].get<std::string>(), HasSubstr("no mock"));
}

TEST_F(PlayerService, AProgramThatFloodsItAndDoesNotReadIsLetGoAndTheFilmGoesOn) {
  test::Process player(words({at("film.mkv"), "--loop"}), at("said.txt"));
  ControlClient flood(at("control")), program(at("control"));
  std::thread flooding([&] {
    const std::string line = "{\"do\":\"status\"}\n";
    while (flood.sendBytes(line)) {
    }
  });
  flooding.join();  // its connection was closed
  const double before = program.ask("status")["position_s"];
  EXPECT_TRUE(program.until([&, asked = false](const json& j) mutable {
    if (j.contains("position_s") && j["position_s"] != before) return true;
    program.say("status");
    return asked;
  }));
}

TEST_F(PlayerService, OnlyOneListensAndACrashLeavesNothingInTheWay) {
  {
    test::Process first(words(), at("said.txt"));
    ControlClient program(at("control"));
    ASSERT_TRUE(program.connected());
    test::Process second(words(), at("second.txt"));
    EXPECT_EQ(second.wait(), 1);
    EXPECT_EQ(program.ask("status")["state"], "idle");
    first.send(SIGKILL);
    EXPECT_EQ(first.wait(), -SIGKILL);
  }
  EXPECT_TRUE(fs::exists(at("control")));
  test::Process third(words(), at("said.txt"));
  ControlClient program(at("control"));
  EXPECT_EQ(program.ask("status")["state"], "idle");
}

TEST_F(PlayerService, TellsSystemdThatItIsReadyAliveAndStopping) {
  const test::NotifySocket systemd(at("notify"), 200ms);
  ASSERT_TRUE(systemd.bound());
  test::Process player(words({at("film.mkv"), "--loop"}), at("said.txt"));
  EXPECT_EQ(systemd.next(30s), "READY=1");
  bool playing = false;
  for (int alive = 0; alive < 3 || !playing;) {
    const std::string message = systemd.next(30s);
    ASSERT_NE(message, "");
    alive += message == "WATCHDOG=1";
    playing = playing || message == "STATUS=playing film.mkv";
  }
  player.send(SIGSTOP);  // hung
  std::this_thread::sleep_for(50ms);
  (void)systemd.all();
  EXPECT_EQ(systemd.next(1s), "") << "five times the pause between two signs of life";
  player.send(SIGCONT);
  player.send(SIGTERM);
  std::string last;
  for (std::string each = systemd.next(30s); !each.empty(); each = systemd.next(2s)) last = each;
  EXPECT_EQ(last, "STOPPING=1");
  EXPECT_EQ(player.wait(), 0);
}

// A server that takes a connection, sends the beginning of a film, and then nothing more.
class StalledServer {
 public:
  explicit StalledServer(std::string head) : head_(std::move(head)) {
    fd_.reset(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{.sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}};
    socklen_t size = sizeof address;
    ::bind(fd_.get(), reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(fd_.get(), 8);
    ::getsockname(fd_.get(), reinterpret_cast<sockaddr*>(&address), &size);
    url = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/film.mkv";
    thread_ = std::jthread([this](const std::stop_token& done) { serve(done); });
  }
  std::string url;

 private:
  void serve(const std::stop_token& done) {
    while (!done.stop_requested()) {
      pollfd polled{.fd = fd_.get(), .events = POLLIN};
      if (::poll(&polled, 1, 20) <= 0) continue;
      UniqueFd& client = clients_.emplace_back(::accept(fd_.get(), nullptr, nullptr));
      ::send(client.get(), head_.data(), head_.size(), MSG_NOSIGNAL);
    }
  }
  const std::string head_;
  UniqueFd fd_;
  std::vector<UniqueFd> clients_;
  std::jthread thread_;
};

TEST_F(PlayerService, ASignalEndsItInWhateverStateItIs) {
  std::ifstream film(at("film.mkv"), std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(film), {});
  const std::string ok = "HTTP/1.1 200 OK\r\nContent-Length: " + std::to_string(bytes.size()) + "\r\n\r\n";
  StalledServer silent(""), breaking_off(ok + bytes.substr(0, bytes.size() / 2));
  const struct {
    const char* state;
    std::string source;
    const char* then;
  } cases[] = {{"idle", "", ""},
               {"opening", silent.url, ""},
               {"buffering", breaking_off.url, ""},
               {"playing", at("film.mkv"), ""},
               {"paused", at("film.mkv"), "pause"}};
  for (const auto& each : cases) {
    test::Process player(words({"--loop"}), at("said.txt"));
    ControlClient program(at("control"));
    ASSERT_TRUE(program.connected());
    EXPECT_EQ(program.ask("status")["state"], "idle");
    if (!each.source.empty()) program.say("open " + each.source);
    if (*each.then != 0) {
      EXPECT_TRUE(program.untilState("playing"));
      program.say(each.then);
    }
    if (each.state != std::string("idle")) {
      EXPECT_TRUE(program.untilState(each.state)) << each.state;
    }
    player.send(SIGTERM);
    EXPECT_EQ(player.wait(), 0) << each.state;
    EXPECT_FALSE(fs::exists(at("control"))) << each.state;
  }
}

}  // namespace
}  // namespace relievo
