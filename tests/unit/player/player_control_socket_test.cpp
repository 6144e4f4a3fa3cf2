// SPDX-License-Identifier: Apache-2.0
// The control socket: whom it lets in, how much it buffers for each program, and that it waits for none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "app/player/control/control_socket.h"
#include "platform/log.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/control_client.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;
using test::ControlClient;
using testing::HasSubstr;

class ControlSocketTest : public testing::Test {
 protected:
  void SetUp() override {
    setLogLevel(LogLevel::Error);
    socket_ = listen();
    ASSERT_NE(socket_, nullptr);
  }
  void TearDown() override { setLogLevel(LogLevel::Info); }

  [[nodiscard]] std::string path() const { return folder_ / "control"; }
  [[nodiscard]] std::unique_ptr<ControlSocket> listen() const {
    auto made = ControlSocket::listen(path());
    EXPECT_TRUE(made) << made.error().thing << made.error().error.message;
    return made ? std::move(*made) : nullptr;
  }
  // All lines that have come by now.
  std::vector<std::string> lines() {
    std::vector<std::string> all;
    for (int i = 0; i < 4; ++i) {
      socket_->attend("full");
      while (const auto line = socket_->next()) all.push_back(line->too_long ? "(too long)" : line->text);
    }
    return all;
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<ControlSocket> socket_;
};

TEST_F(ControlSocketTest, AFileOfItsFirstNameIsLeftAlone) {
  socket_.reset();
  const std::string first = path() + "~";
  std::ofstream(first) << "a film";
  const auto made = ControlSocket::listen(path());
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().thing, first);
  EXPECT_EQ(test::contentOf(first), "a film");
}

TEST_F(ControlSocketTest, IsOfTheUserAloneAndGoesWithItsOwner) {
  EXPECT_EQ(fs::status(path()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / ""), {}), 1) << "nothing else is left";
  socket_.reset();
  EXPECT_FALSE(fs::exists(path()));
}

TEST_F(ControlSocketTest, HasItsModeWhateverTheUmaskIs) {
  socket_.reset();
  const mode_t before = ::umask(0);
  socket_ = listen();
  ::umask(before);
  EXPECT_EQ(fs::status(path()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(ControlSocketTest, RefusesAPathOnWhichSomebodyListens) {
  const auto second = ControlSocket::listen(path());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().error.code, ErrorCode::InvalidState);
  EXPECT_TRUE(ControlClient(path()).connected()) << "the first one stays";
}

TEST_F(ControlSocketTest, ReplacesOneThatNobodyListensOnAndNothingElse) {
  fs::create_hard_link(path(), folder_ / "stale");  // as a crash leaves one
  socket_.reset();
  fs::rename(folder_ / "stale", path());
  socket_ = listen();
  EXPECT_TRUE(ControlClient(path()).connected());

  std::ofstream(folder_ / "notes.txt") << "mine";
  const auto onto_file = ControlSocket::listen(folder_ / "notes.txt");
  ASSERT_FALSE(onto_file);
  EXPECT_EQ(fs::file_size(folder_ / "notes.txt"), 4U);
  EXPECT_FALSE(ControlSocket::listen(folder_ / std::string(100, 'x')));
  EXPECT_FALSE(ControlSocket::listen(folder_ / "nowhere/control"));
  EXPECT_FALSE(ControlSocket::listen(""));
}

TEST_F(ControlSocketTest, LeavesAnothersSocketInItsPlace) {
  fs::remove(path());
  const auto other = listen();
  socket_.reset();
  EXPECT_TRUE(fs::exists(path()));
}

TEST_F(ControlSocketTest, PutsLinesTogetherHoweverTheyCome) {
  const ControlClient client(path());
  client.sendBytes("on");
  EXPECT_THAT(lines(), testing::IsEmpty());
  client.sendBytes("e\ntwo\nth");
  EXPECT_THAT(lines(), testing::ElementsAre("one", "two"));
  client.sendBytes("ree\n");
  EXPECT_THAT(lines(), testing::ElementsAre("three"));
}

TEST_F(ControlSocketTest, TheLastLineCountsWithoutItsEndAndIsAnswered) {
  ControlClient client(path());
  client.sendBytes("one\ntwo");
  client.closeSide();
  socket_->attend("full");
  socket_->attend("full");
  int answered = 0;
  for (int i = 0; i < 3; ++i) {
    while (const auto line = socket_->next()) answered += socket_->send(line->client, "\"" + line->text + "\"");
    socket_->attend("full");
  }
  EXPECT_EQ(answered, 2);
  EXPECT_EQ(client.next(std::chrono::seconds(5)), "one");
  EXPECT_EQ(client.next(std::chrono::seconds(5)), "two");
  EXPECT_TRUE(client.isLetGo());
}

TEST_F(ControlSocketTest, ALineThatIsTooLongIsOneFaultAndNoMore) {
  const ControlClient client(path());
  const std::string most(ControlSocket::kMostLine, 'a');
  client.sendBytes(most + "\n");
  EXPECT_THAT(lines(), testing::ElementsAre(most));
  client.sendBytes(most + "b");
  EXPECT_THAT(lines(), testing::ElementsAre("(too long)"));
  client.sendBytes(most + most + most);
  EXPECT_THAT(lines(), testing::IsEmpty());
  client.sendBytes("end of it\nnext\n");
  auto after = lines();
  for (const auto& more : lines()) after.push_back(more);
  EXPECT_THAT(after, testing::ElementsAre("next"));
}

TEST_F(ControlSocketTest, ANinthTakesThePlaceOfTheOneThatWasSilentLongest) {
  std::vector<std::unique_ptr<ControlClient>> clients;
  for (std::size_t i = 0; i < ControlSocket::kMostClients; ++i) {
    clients.push_back(std::make_unique<ControlClient>(path()));
    socket_->attend("full");
  }
  clients[0]->sendBytes("one\n");
  EXPECT_THAT(lines(), testing::ElementsAre("one"));
  clients.push_back(std::make_unique<ControlClient>(path()));
  clients.back()->sendBytes("nine\n");
  socket_->attend("\"full\"");
  EXPECT_THAT(lines(), testing::ElementsAre("nine"));
  EXPECT_EQ(clients[1]->next(std::chrono::seconds(5)), "full");
  EXPECT_TRUE(clients[1]->isLetGo());
  clients.erase(clients.begin() + 1);
  socket_->sendToAll("\"hello\"");
  for (auto& client : clients) EXPECT_EQ(client->next(std::chrono::seconds(5)), "hello");
}

TEST_F(ControlSocketTest, OfManyThatComeAtOnceEightAreLetInAndTheOthersAreTold) {
  std::array<ControlClient, 8> idle{ControlClient(path()), ControlClient(path()), ControlClient(path()),
                                    ControlClient(path()), ControlClient(path()), ControlClient(path()),
                                    ControlClient(path()), ControlClient(path())};
  socket_->attend("full");
  idle[7].sendBytes("x\n");
  std::vector<std::unique_ptr<ControlClient>> crowd;
  for (int i = 0; i < 8; ++i) crowd.push_back(std::make_unique<ControlClient>(path()));
  socket_->attend("\"full\"");
  EXPECT_EQ(socket_->next().value().text, "x") << "what has just been asked is answered";
  socket_->sendToAll("\"hello\"");
  for (int i = 0; i < 7; ++i) EXPECT_EQ(crowd[i]->next(std::chrono::seconds(5)), "hello");
  EXPECT_EQ(crowd[7]->next(std::chrono::seconds(5)), "full");
  EXPECT_EQ(idle[7].next(std::chrono::seconds(5)), "hello");
}

// A round without a film takes 20 ms.
TEST_F(ControlSocketTest, AllThatWaitAreLetInInOneRound) {
  std::array<ControlClient, 3> clients{ControlClient(path()), ControlClient(path()), ControlClient(path())};
  socket_->attend("full");
  socket_->sendToAll("\"hello\"");
  for (ControlClient& client : clients) EXPECT_EQ(client.next(std::chrono::seconds(5)), "hello");
}

TEST_F(ControlSocketTest, OneThatDoesNotReadIsLetGoAndTheOthersNeverKnow) {
  ControlClient slow(path()), quick(path());
  socket_->attend("full");
  socket_->attend("full");
  const std::string line = "\"" + std::string(8000, 'x') + "\"";
  int read = 0;
  for (int i = 0; i < 200; ++i) {  // 1.6 MB: more than the kernel and the socket hold for one
    socket_->sendToAll(line);
    socket_->attend("full");
    read += quick.next(std::chrono::seconds(5)).has_value();
  }
  EXPECT_EQ(read, 200);
  EXPECT_TRUE(slow.isLetGo());
  socket_->sendToAll("\"still there\"");
  EXPECT_EQ(quick.next(std::chrono::seconds(5)), "still there");
}

TEST_F(ControlSocketTest, AnAnswerToOneThatHasGoneIsNoHarm) {
  ControlSocket::ClientId id = 0;
  {
    const ControlClient client(path());
    client.sendBytes("x\n");
    socket_->attend("full");
    socket_->attend("full");
    id = socket_->next().value().client;
  }
  for (int i = 0; i < 3; ++i) {
    socket_->send(id, "y");
    socket_->attend("full");
  }
  EXPECT_FALSE(socket_->send(id, "y"));
}

}  // namespace
}  // namespace relievo
