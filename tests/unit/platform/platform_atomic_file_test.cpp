// SPDX-License-Identifier: Apache-2.0
// A file exists whole or not at all.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "platform/atomic_file.h"
#include "platform/files/litter.h"
#include "platform/unique_fd.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using test::contentOf;

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const char* name) const { return folder_ / name; }
  [[nodiscard]] std::ptrdiff_t filesInFolder() const {
    return std::distance(fs::directory_iterator(at("")), fs::directory_iterator{});
  }

  test::TemporaryFolder folder_;
};

TEST_F(AtomicFileTest, AppearsWithItsWholeTextOnCommit) {
  auto file = AtomicFile::create(at("a.json"));
  ASSERT_TRUE(file);
  file->write("one ");
  file->write("two");
  EXPECT_FALSE(fs::exists(at("a.json")));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(contentOf(at("a.json")), "one two");
  EXPECT_EQ(filesInFolder(), 1);
}

TEST_F(AtomicFileTest, LeavesNothingAndTouchesNothingWithoutACommit) {
  std::ofstream(at("a.json")) << "old";
  {
    auto file = AtomicFile::create(at("a.json"));
    ASSERT_TRUE(file);
    file->write("new");
  }
  EXPECT_EQ(contentOf(at("a.json")), "old");
  EXPECT_EQ(filesInFolder(), 1);
}

TEST_F(AtomicFileTest, ReplacesAFileAndKeepsItsMode) {
  std::ofstream(at("a.json")) << "old";
  ASSERT_EQ(::chmod(at("a.json").c_str(), 0640), 0);
  auto file = AtomicFile::create(at("a.json"));
  ASSERT_TRUE(file);
  file->write("new");
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(contentOf(at("a.json")), "new");
  struct stat status{};
  ASSERT_EQ(::stat(at("a.json").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST_F(AtomicFileTest, WritesWhereALinkPointsAndLeavesTheLink) {
  std::ofstream(at("real.json")) << "old";
  fs::create_symlink(at("real.json"), at("link.json"));
  auto file = AtomicFile::create(at("link.json"));
  ASSERT_TRUE(file);
  file->write("new");
  ASSERT_TRUE(file->commit());
  EXPECT_TRUE(fs::is_symlink(at("link.json")));
  EXPECT_EQ(contentOf(at("real.json")), "new");
}

TEST_F(AtomicFileTest, WritesWhereALinkPointsThatHasNoFileYet) {
  fs::create_directory(at("elsewhere"));
  fs::create_symlink("elsewhere/second.json", at("first.json"));
  fs::create_symlink("real.json", at("elsewhere/second.json"));
  auto file = AtomicFile::create(at("first.json"), Existing::Keep);
  ASSERT_TRUE(file);
  file->write("new");
  ASSERT_TRUE(file->commit());
  EXPECT_TRUE(fs::is_symlink(at("first.json")) && fs::is_symlink(at("elsewhere/second.json")));
  EXPECT_EQ(contentOf(at("elsewhere/real.json")), "new");
  EXPECT_EQ(placeOf(at("first.json")), fs::canonical(at("elsewhere/real.json")).string());
}

TEST_F(AtomicFileTest, RefusesALinkThatLeadsBackToItselfBeforehand) {
  fs::create_symlink("round.json", at("a.json"));
  fs::create_symlink("a.json", at("round.json"));
  for (const Existing existing : {Existing::Keep, Existing::Replace}) {
    const auto file = AtomicFile::create(at("a.json"), existing);
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().os_error, ELOOP);
    EXPECT_THAT(file.error().message, testing::HasSubstr("leads back to itself"));
  }
  EXPECT_TRUE(fs::is_symlink(at("a.json")));
}

TEST_F(AtomicFileTest, RefusesANameThatIsTooLongBeforehand) {
  const auto file = AtomicFile::create(at("") + std::string(256, 'x'));
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().os_error, ENAMETOOLONG);
  EXPECT_THAT(file.error().message, testing::HasSubstr("choose a shorter one"));
}

// 252 bytes and ".ab", so that no mark fits behind it; the cut would fall into the last character.
TEST_F(AtomicFileTest, ReplacesAFileOfTheLongestName) {
  std::string name;
  while (name.size() < 252) name += "\xe6\xb5\xae";
  const std::string path = at("") + name + ".ab";
  std::ofstream(path) << "old";
  std::ofstream(litterPattern(path)) << "left by a killed writer";
  EXPECT_EQ(filesInFolder(), 2);
  EXPECT_EQ(fs::path(litterPattern(path)).filename().string(), name.substr(0, 225) + ".relievo-tmp-XXXXXX");
  auto file = AtomicFile::create(path);
  ASSERT_TRUE(file);
  file->write("new");
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(contentOf(path), "new");
  EXPECT_EQ(filesInFolder(), 1);
}

// In a process with mounts of its own; its file system's threads must begin there.
[[noreturn]] void createOverAMount(const std::string& real, const std::string& mounted) {
  constexpr int kRefused = 0, kTaken = 1, kMayNotMount = 0;
  const bool mine = ::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0;
  if (!mine || ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) ::_exit(kMayNotMount);
  if (::mount(real.c_str(), mounted.c_str(), nullptr, MS_BIND, nullptr) != 0) ::_exit(kMayNotMount);
  const auto file = AtomicFile::create(mounted);
  ::_exit(!file && file.error().os_error == EBUSY ? kRefused : kTaken);
}
TEST_F(AtomicFileTest, RefusesAFileThatIsMountedByItselfBeforehand) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  std::ofstream(at("real.json")) << "old";
  std::ofstream(at("mounted.json")).close();
  EXPECT_EXIT(createOverAMount(at("real.json"), at("mounted.json")), testing::ExitedWithCode(0), "");
}

TEST_F(AtomicFileTest, SaysBeforehandThatAPathCannotBeWritten) {
  EXPECT_FALSE(AtomicFile::create(at("missing/a.json")));
  EXPECT_FALSE(AtomicFile::create(at("")));
  EXPECT_FALSE(AtomicFile::create(""));
  EXPECT_EQ(filesInFolder(), 0);
}

TEST_F(AtomicFileTest, AnotherWriterMayFillItAtPlacesOfItsOwn) {
  std::ofstream(at("film.mkv")) << "old";
  auto file = AtomicFile::create(at("film.mkv"));
  ASSERT_TRUE(file);
  const std::array<std::uint8_t, 2> end{'e', 'w'}, begin{'n', 'e'};
  ASSERT_TRUE(file->output().write(1, end));
  ASSERT_TRUE(file->output().write(0, begin));
  std::array<std::uint8_t, 8> whole{};
  EXPECT_EQ(file->output().read(1, whole), 2u);
  EXPECT_EQ(whole[1], 'w');
  EXPECT_EQ(contentOf(at("film.mkv")), "old");
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(contentOf(at("film.mkv")), "new");
  EXPECT_EQ(filesInFolder(), 1);
}

// An unnamed file disappears with its process, however that ends.
TEST_F(AtomicFileTest, HasNoNameUntilTheCommit) {
  const UniqueFd nameless(::open(at("").c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600));
  if (!nameless.valid()) GTEST_SKIP() << "this file system has no files without a name";
  auto file = AtomicFile::create(at("a.json"));
  ASSERT_TRUE(file);
  file->write("new");
  EXPECT_EQ(filesInFolder(), 0);
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(contentOf(at("a.json")), "new");
  struct stat status{};
  ASSERT_EQ(::stat(at("a.json").c_str(), &status), 0);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  EXPECT_EQ(status.st_mode & 0777, 0666u & ~mask);
}

TEST_F(AtomicFileTest, OfTwoWritersThatReplaceNothingTheFirstOneWins) {
  auto first = AtomicFile::create(at("a.json"), Existing::Keep);
  auto second = AtomicFile::create(at("a.json"), Existing::Keep);
  ASSERT_TRUE(first && second);
  first->write("first");
  second->write("second");
  ASSERT_TRUE(first->commit());
  const auto late = second->commit();
  ASSERT_FALSE(late);
  EXPECT_THAT(late.error().message, testing::HasSubstr("another program created this file meanwhile"));
  EXPECT_EQ(contentOf(at("a.json")), "first");
  EXPECT_EQ(filesInFolder(), 1);
}

TEST_F(AtomicFileTest, IsPutBesideAFileThatStaysUnderTheFirstFreeName) {
  for (const char* name : {"a.json", "a-2.json"}) std::ofstream(at(name)) << name;
  for (const char* expected : {"a-3.json", "a-4.json", "new.json"}) {
    auto file = AtomicFile::create(at(std::string(expected).starts_with("a") ? "a.json" : "new.json"));
    ASSERT_TRUE(file);
    file->write("text");
    file->setExisting(Existing::Beside);
    ASSERT_TRUE(file->commit());
    EXPECT_EQ(file->path(), at(expected));
    EXPECT_EQ(contentOf(at(expected)), "text");
  }
  for (const char* name : {"a.json", "a-2.json"}) EXPECT_EQ(contentOf(at(name)), name);
  EXPECT_EQ(filesInFolder(), 5);
}

TEST_F(AtomicFileTest, RemovesWhatAKilledWriterHasLeftAndNothingElse) {
  const UniqueFd held(::open(at("a.json.relievo-tmp-111111").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600));
  holdLitter(held.get());
  for (const char* name : {"a.json.relievo-tmp-222222", "a.json.backup", "b.json.relievo-tmp-222222"}) {
    std::ofstream(at(name)) << "left";
  }
  const auto of_others = {"a.json.relievo-notes/diary.txt", "a.json.relievo-tmp-notes1/diary.txt",
                          "a.json.relievo-tmp-backup1/diary.txt", "a.json.relievo-tmp-333333/diary.txt"};
  for (const char* name : of_others) {
    fs::create_directories(fs::path(at(name)).parent_path());
    std::ofstream(at(name)) << "of the user";
  }
  ASSERT_TRUE(AtomicFile::create(at("a.json")));
  EXPECT_FALSE(fs::exists(at("a.json.relievo-tmp-222222")));
  for (const char* name : of_others) EXPECT_TRUE(fs::exists(at(name))) << name;
  EXPECT_TRUE(fs::exists(at("a.json.relievo-tmp-111111"))) << "its writer is alive";
  EXPECT_TRUE(fs::exists(at("a.json.backup")) && fs::exists(at("b.json.relievo-tmp-222222")));
}

TEST_F(AtomicFileTest, SaysThatTheFolderIsNotThere) {
  const auto file = AtomicFile::create(at("nowhere/a.json"));
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, ErrorCode::NotFound);
  EXPECT_EQ(file.error().os_error, ENOENT);
}

TEST_F(AtomicFileTest, WritesIntoADeviceWithoutReplacingIt) {
  auto file = AtomicFile::create("/dev/null");
  ASSERT_TRUE(file);
  file->write("gone");
  EXPECT_TRUE(file->commit());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, RefusesAPipeThatNobodyReadsASocketAndADisk) {
  const auto why = [&](const char* name) { return AtomicFile::create(at(name)).error().message; };
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  EXPECT_THAT(why("pipe"), testing::HasSubstr("no program reads this pipe"));
  const UniqueFd reader(::open(at("pipe").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  EXPECT_TRUE(AtomicFile::create(at("pipe")));
  ASSERT_EQ(::mknod(at("socket").c_str(), S_IFSOCK | 0600, 0), 0);
  EXPECT_THAT(why("socket"), testing::HasSubstr("is a socket"));
  constexpr unsigned kNoDriver = 240;  // for experiments
  if (::mknod(at("disk").c_str(), S_IFBLK | 0600, makedev(kNoDriver, 0)) != 0) GTEST_SKIP() << "no right to make one";
  EXPECT_THAT(why("disk"), testing::HasSubstr("is a disk"));
}

TEST_F(AtomicFileTest, TellsThatTheDiskIsFull) {
  if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  auto file = AtomicFile::create("/dev/full");
  ASSERT_TRUE(file);
  file->write("does not fit");
  const auto committed = file->commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().code, ErrorCode::Io);
  EXPECT_EQ(committed.error().os_error, ENOSPC);
}

}  // namespace
}  // namespace relievo
