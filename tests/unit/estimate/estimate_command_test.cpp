// SPDX-License-Identifier: Apache-2.0
// Commands of the shell in the place of an estimator: a picture of 2 x 2 has as many bytes as depth of 3 x 2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "app/estimate/depth_command.h"
#include "app/estimate/raw_picture.h"

namespace relievo {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

struct Trial {
  std::atomic<bool> stop{false};
  std::chrono::nanoseconds patience = std::chrono::minutes(1);
  int cols = 2, rows = 2, depth_cols = 3, depth_rows = 2;

  [[nodiscard]] Outcome<std::unique_ptr<DepthCommand>> start(const std::string& command) const {
    return DepthCommand::start({command, cols, rows, depth_cols, depth_rows, patience}, stop);
  }
  // Byte i of picture k.
  static std::uint8_t byteOf(int k, std::size_t i) {
    return static_cast<std::uint8_t>(31 * k + 7 * static_cast<int>(i));
  }
  [[nodiscard]] RawPicture picture(int k) const {
    RawPicture picture(cols, rows);
    for (std::size_t i = 0; i < picture.bytes.size(); ++i) picture.bytes[i] = byteOf(k, i);
    return picture;
  }
  // Reads an answer wherever there is one, as a film does.
  [[nodiscard]] Outcome<std::vector<DepthEstimate>> all(const std::string& command, int pictures) const {
    auto started = start(command);
    if (!started) return std::unexpected(started.error());
    std::vector<DepthEstimate> answers;
    for (int given = 0;;) {
      auto answer = (*started)->take();
      if (!answer) return std::unexpected(answer.error());
      if (*answer) {
        answers.push_back(std::move(**answer));
      } else if (given < pictures) {
        if (auto done = (*started)->give(picture(given++)); !done) return std::unexpected(done.error());
        if (given == pictures) (*started)->end();
      } else {
        return answers;
      }
    }
  }
  [[nodiscard]] std::string failureOf(const std::string& command, int pictures = 4) const {
    const auto answers = all(command, pictures);
    if (answers) return "no failure";
    return answers.error().thing + ": " + answers.error().error.message;
  }
};

void expectEchoes(const Trial& trial, const std::string& command, int pictures) {
  const auto answers = trial.all(command, pictures);
  ASSERT_TRUE(answers.has_value()) << answers.error().thing;
  ASSERT_THAT(*answers, SizeIs(pictures));
  for (int k = 0; k < pictures; ++k) {
    const DepthEstimate& answer = (*answers)[static_cast<std::size_t>(k)];
    ASSERT_THAT(answer.values, SizeIs(static_cast<std::size_t>(trial.depth_cols * trial.depth_rows)));
    for (const std::size_t i : {std::size_t{0}, answer.values.size() - 1}) {
      const int code = Trial::byteOf(k, 2 * i) + 256 * Trial::byteOf(k, 2 * i + 1);  // the low byte comes first
      ASSERT_EQ(answer.values[i], static_cast<float>(code)) << k << " " << i;
    }
  }
}

TEST(DepthCommand, AnswersEachPictureInOrder) {
  expectEchoes({}, "cat", 20);
}

TEST(DepthCommand, MayAnswerLate) {
  expectEchoes({}, "dd bs=48 iflag=fullblock 2>/dev/null", 11);  // four at a time, the rest at the end
  expectEchoes({}, "kept=$(mktemp); cat >$kept; cat $kept; rm $kept", 60);
}

TEST(DepthCommand, PicturesLargerThanThePipesPassBothWays) {
  expectEchoes({.cols = 1280, .rows = 720, .depth_cols = 1280, .depth_rows = 1080}, "cat", 6);
}

TEST(DepthCommand, KnowsTheSizes) {
  expectEchoes({}, "[ $RELIEVO_WIDTH,$RELIEVO_HEIGHT,$RELIEVO_DEPTH_WIDTH,$RELIEVO_DEPTH_HEIGHT = 2,2,3,2 ] && cat", 2);
}

TEST(DepthCommand, OneLineTellsHowItEndedEarly) {
  const Trial trial;
  EXPECT_THAT(trial.failureOf("head -c 18; echo first >&2; echo no more >&2; exit 3"),
              AllOf(HasSubstr("ended with exit code 3 after 1 depth pictures and 6 of 12 bytes (no more): "),
                    HasSubstr("one depth picture of 16 bits for each picture")));
  EXPECT_THAT(trial.failureOf("head -c 12"), HasSubstr("ended with exit code 0 after 1 depth pictures: "));
  EXPECT_THAT(trial.failureOf("head -c 12; kill -9 $$"), HasSubstr("was ended by signal 9 after 1 depth"));
  EXPECT_THAT(trial.failureOf("relievo-no-such-program"), AllOf(HasSubstr("exit code 127"), HasSubstr("not found")));
}

TEST(DepthCommand, FailsIfTheCommandSaysThatItFailed) {
  EXPECT_THAT(Trial{}.failureOf("cat; echo out of memory >&2; exit 5"),
              HasSubstr("ended with exit code 5 (out of memory): the depth command failed"));
}

TEST(DepthCommand, RefusesMoreThanWasAskedFor) {
  EXPECT_THAT(Trial{}.failureOf("cat; echo"), HasSubstr("wrote more than was asked for"));
  EXPECT_THAT(Trial{}.failureOf("cat /dev/zero"), HasSubstr("wrote more than was asked for"));
}

TEST(DepthCommand, IsGivenUpIfItStallsOrIsTooLate) {
  const Trial trial{.patience = std::chrono::milliseconds(100)};
  const Trial answering{.patience = std::chrono::seconds(3)};  // a busy machine may be long in coming to an answer
  testing::internal::CaptureStderr();
  EXPECT_THAT(trial.failureOf("sleep 1000"), HasSubstr("has read and written nothing for 0.1 s"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::EndsWith("media: waiting for \"sleep 1000\", which reads and writes nothing (up to 0.1 s)\n"));
  EXPECT_THAT(trial.failureOf("cat >/dev/null; sleep 1000"), HasSubstr("has read and written nothing"));
  EXPECT_THAT(answering.failureOf("cat; exec >&-; exec sleep 1000"), HasSubstr("does not end after its last picture"));
  EXPECT_THAT(answering.failureOf("kept=$(mktemp); cat >$kept; cat $kept; rm $kept", 80),
              HasSubstr("has read 64 pictures more than it has answered"));
}

TEST(DepthCommand, IsNamedByItsBeginningWhereItIsLong) {
  const Trial trial{.patience = std::chrono::milliseconds(100)};
  testing::internal::CaptureStderr();
  EXPECT_THAT(trial.failureOf("sleep 1000 # " + std::string(100, 'x')), HasSubstr("xx..: has read"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("xx..\", which reads and writes nothing"));
}

// True if the process is gone, or has ended and waits for its new parent to collect it; a killed one needs a moment.
bool isGone(pid_t pid) {
  std::string number, name, state;
  for (int tries = 0; tries < 2000; ++tries) {
    if (::kill(pid, 0) != 0) return true;
    std::ifstream("/proc/" + std::to_string(pid) + "/stat") >> number >> name >> state;
    if (state == "Z" || state.empty()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

TEST(DepthCommand, NothingOfItIsLeftBehind) {
  const std::string words = Trial{}.failureOf("sleep 1000 >&- & echo $! >&2; exit 3");
  const pid_t below = std::stoi(words.substr(words.find('(') + 1));
  ASSERT_GT(below, 1);
  EXPECT_TRUE(isGone(below)) << words;
}

TEST(DepthCommand, StopEndsTheWait) {
  Trial trial;
  const auto started = trial.start("sleep 1000");
  ASSERT_TRUE(started.has_value());
  ASSERT_TRUE((*started)->give(trial.picture(0)).has_value());
  (*started)->end();
  trial.stop = true;
  const auto answer = (*started)->take();
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().error.code, ErrorCode::Cancelled);
}

// BT.601 in limited range, by hand: Y' = 16 + 65.481 R + 128.553 G + 24.966 B.
TEST(RawPicture, ReadsColourByItsMatrixAndRange) {
  const std::array<std::uint8_t, 2> luma{81, 235}, blue{90, 128}, red{240, 128};
  Frame frame;
  frame.width = 2;
  frame.height = 1;
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Limited;
  frame.matrix = ColorMatrix::Bt601;
  frame.plane_count = 3;
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i].plane = i;
  frame.planes = {Plane{luma.data(), 2}, Plane{blue.data(), 2}, Plane{red.data(), 2}};
  const RawPicture picture = rawOf(frame);
  ASSERT_THAT(picture.bytes, SizeIs(6));
  const std::array<int, 6> expected{254, 0, 0, 255, 255, 255};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(picture.bytes[i], expected[i], 1) << i;
}

TEST(DepthCommand, ALongMessageStaysALine) {
  const std::string told = Trial().failureOf("printf '%5000s\\n' x | tr ' ' y >&2; exit 1");
  EXPECT_THAT(told, HasSubstr("(yyyy"));
  EXPECT_LT(told.size(), 500U);
}

// The pipe is held by the command and by what it has started, until they have ended.
TEST(ChildProcess, EndsWithThisProgramHoweverThatEnds) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);  // NOLINT(android-cloexec-pipe): they are to have it
  const pid_t program = ::fork();
  if (program == 0) {
    ::close(ends[0]);
    const auto child = ChildProcess::start("trap '' TERM; (trap '' HUP TERM; sleep 40) & echo; sleep 40", {});
    pollfd begun{child->output.get(), POLLIN, 0};
    ::poll(&begun, 1, -1);
    ::kill(::getpid(), SIGKILL);
  }
  ::close(ends[1]);
  ::waitpid(program, nullptr, 0);
  pollfd held{ends[0], POLLIN, 0};
  EXPECT_EQ(::poll(&held, 1, 30'000), 1) << "a part of it is still there";
  ::close(ends[0]);
}

}  // namespace
}  // namespace relievo
