// SPDX-License-Identifier: Apache-2.0
// Moves, also on a file system that refuses every flag of renameat2: a filter of system calls stands in for one.
#include "platform/files/move.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>

#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

// From now on renameat2 ends with EINVAL if it is called with flags.
bool refuseFlags() {
  constexpr unsigned kNumber = offsetof(seccomp_data, nr), kFlags = offsetof(seccomp_data, args) + 4 * 8;
  std::array<sock_filter, 6> filter{
      {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kNumber), BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_renameat2, 0, 3),
       BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kFlags), BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0, 1, 0),
       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EINVAL), BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)}};
  const sock_fprog program{.len = filter.size(), .filter = filter.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

class Moves : public testing::TestWithParam<bool> {
 protected:
  // In a process of its own, with or without the flags.
  static void inProcess(const std::function<bool()>& works) {
    const auto run = [&] { ::_exit((!GetParam() || refuseFlags()) && works() ? 0 : 1); };
    EXPECT_EXIT(run(), testing::ExitedWithCode(0), "");
  }
  [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }
  void fill(const std::string& name) const { std::ofstream(at(name)) << name; }
  [[nodiscard]] std::string in(const std::string& name) const { return test::contentOf(at(name)); }

  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(FileSystem, Moves, testing::Bool(),
                         [](const auto& test) { return test.param ? "WithoutFlags" : "WithFlags"; });

TEST_P(Moves, TheFilterRefusesTheFlags) {
  fill("a");
  const auto flagged = [&] {
    const bool moved = ::renameat2(AT_FDCWD, at("a").c_str(), AT_FDCWD, at("b").c_str(), RENAME_NOREPLACE) == 0;
    return moved || errno == EINVAL;
  };
  inProcess(flagged);
  EXPECT_EQ(fs::exists(at("b")), !GetParam());
}

TEST_P(Moves, AFileGetsANewName) {
  fill("a");
  inProcess([&] { return moveToNew(at("a"), at("b")) == 0; });
  EXPECT_EQ(in("b"), "a");
  EXPECT_FALSE(fs::exists(at("a")));
}

TEST_P(Moves, AFolderGetsANewName) {
  fs::create_directory(at("made"));
  fill("made/a");
  inProcess([&] { return moveToNew(at("made"), at("film")) == 0; });
  EXPECT_EQ(in("film/a"), "made/a");
  EXPECT_FALSE(fs::exists(at("made")));
}

TEST_P(Moves, WhatIsThereStays) {
  for (const char* name : {"a", "b"}) fill(name);
  inProcess([&] { return moveToNew(at("a"), at("b")) == EEXIST; });
  EXPECT_EQ(in("a") + in("b"), "ab");
  EXPECT_EQ(moveToNew(at("none"), at("c")), ENOENT);
  EXPECT_FALSE(fs::exists(at("c")));
}

TEST_P(Moves, FoldersAreExchanged) {
  for (const char* name : {"new", "old"}) {
    fs::create_directory(at(name));
    fill(std::string(name) + "/" + name);
  }
  inProcess([&] { return exchange(at("new"), at("old")) == 0; });
  EXPECT_EQ(in("old/new") + in("new/old"), "new/newold/old");
  inProcess([&] { return exchange(at("none"), at("old")) == ENOENT; });
  EXPECT_EQ(in("old/new"), "new/new");
}

}  // namespace
}  // namespace relievo
