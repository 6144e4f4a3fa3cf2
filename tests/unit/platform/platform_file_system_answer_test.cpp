// SPDX-License-Identifier: Apache-2.0
// A call that the file system never answers blocks a thread of its own; its caller goes on.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <future>
#include <numeric>
#include <thread>
#include <vector>

#include "platform/files/answered_file.h"
#include "platform/files/answered_place.h"
#include "platform/files/file_system_answer.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/failing_disk.h"
#include "tests/support/machine/no_threads.h"

namespace relievo {
namespace {

constexpr Duration kShort = std::chrono::milliseconds(30), kLong = std::chrono::hours(1);

// A question about a file that is not answered until it is released.
class Stall {
 public:
  ~Stall() { release(); }
  [[nodiscard]] std::function<void()> question() {
    return [released = released_, done = done_] {
      released.wait();
      done->set_value();
    };
  }
  void release() {
    if (!std::exchange(open_, true)) gate_.set_value();
  }
  void awaitEnd() { done_->get_future().wait(); }

 private:
  bool open_ = false;
  std::promise<void> gate_;
  std::shared_future<void> released_ = gate_.get_future().share();
  std::shared_ptr<std::promise<void>> done_ = std::make_shared<std::promise<void>>();
};

TEST(FileSystemAnswers, RunOnAnotherThreadAndAreWaitedFor) {
  FileSystemAnswers answers(kLong);
  std::thread::id where;
  ASSERT_TRUE(answers.ask("/a", [&where] { where = std::this_thread::get_id(); }));
  EXPECT_NE(where, std::thread::id());
  EXPECT_NE(where, std::this_thread::get_id());
}

TEST(FileSystemAnswers, AreGivenUpAfterThePatience) {
  FileSystemAnswers answers(kShort);
  Stall stall;
  const auto asked = answers.ask("/a", stall.question());
  ASSERT_FALSE(asked);
  EXPECT_EQ(asked.error().code, ErrorCode::Timeout);
  EXPECT_STREQ(asked.error().message, "the file system does not answer within 10 s; check the mount");
}

TEST(FileSystemAnswers, OfTheSamePlaceAreRefusedAtOnceUntilItAnswers) {
  FileSystemAnswers answers(kShort);
  Stall stall;
  ASSERT_FALSE(answers.ask("/nowhere/a", stall.question()));
  const auto asked = std::make_shared<std::atomic<int>>(0);  // a question that was given up may still be asked later
  EXPECT_FALSE(answers.ask("/nowhere/a/b", [asked] { ++*asked; }));
  EXPECT_EQ(*asked, 0);
  // No mount, so another file may well be elsewhere.
  while (!answers.ask("/nowhere/another", [asked] { ++*asked; })) std::this_thread::yield();
  const int before = *asked;
  EXPECT_GE(before, 1);
  stall.release();
  stall.awaitEnd();
  while (!answers.ask("/nowhere/a/b", [asked] { ++*asked; })) std::this_thread::yield();
  EXPECT_GT(*asked, before);
}

TEST(FileSystemAnswers, EndAtOnceWhereTheFlagIsSet) {
  FileSystemAnswers answers(kLong);
  Stall stall;
  std::atomic<bool> stop = false;
  const CancelsAnswers cancels(stop);
  std::jthread later([&stop] { stop = true; });
  const auto asked = answers.ask("/a", stall.question());
  ASSERT_FALSE(asked);
  EXPECT_EQ(asked.error().code, ErrorCode::Cancelled);
}

// A silent disk takes the grace from what is asked about the same thing, not from the next.
TEST(FileSystemAnswers, HaveTheirGraceAnewUnderAnotherFlag) {
  FileSystemAnswers answers(kLong);
  const std::atomic<bool> stop = true;
  const CancelsAnswers cancels(stop);
  Stall stall;
  EXPECT_FALSE(answers.ask("/silent", stall.question()));
  EXPECT_FALSE(answers.ask("/a", [] {}));
  {
    const CancelsAnswers next(stop);
    EXPECT_TRUE(answers.ask("/b", [] {}));
  }
  EXPECT_FALSE(answers.ask("/c", [] {}));
}

TEST(FileSystemAnswers, AreNotEndedByAnotherThreadsFlag) {
  FileSystemAnswers answers(kLong);
  const std::atomic<bool> stop = true;
  std::jthread([&stop] { const CancelsAnswers cancels(stop); }).join();
  EXPECT_TRUE(answers.ask("/a", [] {}));
}

TEST(FileSystemAnswers, ComeAlthoughManyOthersDoNot) {
  FileSystemAnswers answers(std::chrono::milliseconds(1));
  std::vector<Stall> stalls(20);
  for (std::size_t i = 0; i < stalls.size(); ++i) {
    EXPECT_FALSE(answers.ask("/nowhere/" + std::to_string(i), stalls[i].question()));
  }
  while (!answers.ask("/nowhere/last", [] {})) std::this_thread::yield();
}

TEST(FileSystemAnswers, AreRefusedWhenTooManyThreadsWait) {
  FileSystemAnswers answers(std::chrono::milliseconds(1));
  std::vector<Stall> stalls(70);
  const auto begun = std::make_shared<std::atomic<int>>(0);  // a thread may begin after the test has ended
  for (std::size_t i = 0; i < stalls.size(); ++i) {
    EXPECT_FALSE(answers.ask("/nowhere/" + std::to_string(i), [begun, wait = stalls[i].question()] {
      ++*begun;
      wait();
    }));
  }
  EXPECT_LE(*begun, 64);
}

TEST(FileSystemAnswers, AreRefusedWhereNoThreadCanBeStarted) {
  FileSystemAnswers answers(kLong);
  const auto asked = std::make_shared<std::atomic<int>>(0), left = std::make_shared<std::atomic<int>>(0);
  {
    const test::NoThreads none;
    const auto refused = answers.ask("/a", [asked] { ++*asked; });
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::Exhausted);
    answers.leave([left] { ++*left; });
  }
  ASSERT_TRUE(answers.ask("/a", [] {}));
  EXPECT_EQ(*asked, 0) << "its caller has gone";
  EXPECT_EQ(*left, 1) << "later";
}

class AnsweredFileTest : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const char* name) const { return folder_ / name; }
  test::TemporaryFolder folder_;
};

TEST_F(AnsweredFileTest, GivesTheBytesOfAnyPart) {
  std::vector<std::uint8_t> bytes(3'000'000);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  std::ofstream(at("a"), std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), 3'000'000);
  const auto file = AnsweredFile::open(at("a"));
  ASSERT_TRUE(file);
  EXPECT_EQ(file->bytes(), 3'000'000u);
  std::vector<std::uint8_t> all(4'000'000);
  ASSERT_EQ(file->read(0, all), 3'000'000u);
  all.resize(bytes.size());
  EXPECT_EQ(all, bytes);
  std::vector<std::uint8_t> end(10);
  EXPECT_EQ(file->read(2'999'997, end), 3u);
  EXPECT_EQ(end[2], bytes.back());
  EXPECT_EQ(file->read(3'000'000, end), 0u);
}

TEST_F(AnsweredFileTest, DoesNotTakeWhatIsNotInMemoryForTheEnd) {
  std::ofstream(at("a")) << "abc";
  const auto file = AnsweredFile::open(at("a"));
  ASSERT_TRUE(file);
  std::vector<std::uint8_t> all(4);
  test::memory_looks_ended = true;
  EXPECT_EQ(file->read(0, all), 3u);
  test::memory_looks_ended = false;
}

TEST_F(AnsweredFileTest, ReadsFilesOfTheKernel) {
  const auto file = AnsweredFile::open("/proc/self/comm");
  ASSERT_TRUE(file);
  std::vector<std::uint8_t> name(64);
  EXPECT_GT(file->read(0, name).value_or(0), 3u);
}

TEST_F(AnsweredFileTest, RefusesWhatIsNoFile) {
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  EXPECT_EQ(AnsweredFile::open(at("pipe")).error().code, ErrorCode::Unsupported);
  EXPECT_EQ(AnsweredFile::open("/dev/zero").error().code, ErrorCode::Unsupported);
  EXPECT_EQ(AnsweredFile::open(at("")).error().os_error, EISDIR);
  EXPECT_EQ(AnsweredFile::open(at("none")).error().code, ErrorCode::NotFound);
  EXPECT_EQ(AnsweredFile::open(at("none")).error().os_error, ENOENT);
}

TEST_F(AnsweredFileTest, TellsWhatIsInAFolder) {
  std::ofstream(at("a")) << "a";
  ASSERT_EQ(::mkdir(at("b").c_str(), 0700), 0);
  ASSERT_EQ(::symlink("a", at("link").c_str()), 0);
  ASSERT_EQ(::symlink("none", at("dead").c_str()), 0);
  std::string told;
  auto entries = entriesOf(at(""));
  std::ranges::sort(entries, {}, &FolderEntry::name);
  for (const auto& [name, kind] : entries) told += name + "=" + "fdo"[static_cast<int>(kind)] + " ";
  EXPECT_EQ(told, "a=f b=d dead=o link=f ");
  EXPECT_TRUE(isRegularFile(at("link")));
  EXPECT_FALSE(isRegularFile(at("b")));
  EXPECT_TRUE(isFolder(at("b")));
  EXPECT_FALSE(isThere(at("dead")));
  EXPECT_FALSE(isThere(""));
  EXPECT_TRUE(entriesOf(at("none")).empty());
}

}  // namespace
}  // namespace relievo
