// SPDX-License-Identifier: Apache-2.0
// Mounts of removable media: how the kernel lists them, and that they are noticed as they come and go.
#include "app/player/browse/sticks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// The lines are those of proc(5).
TEST(Sticks, AreTheMountPointsBelowTheirRoots) {
  constexpr const char* kMounts =
      "22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw\n"
      "90 22 8:17 / /media/anna/MY\\040STICK rw,nosuid shared:50 - vfat /dev/sdb1 rw\n"
      "91 22 8:33 / /run/media/anna/B rw - exfat /dev/sdc1 rw\n"
      "92 22 8:49 / /mnt rw - ext4 /dev/sdd1 rw\n"
      "93 22 8:65 / /mediatheque rw - ext4 /dev/sde1 rw\n"
      "94 22 8:17 / /media/anna/MY\\040STICK rw - vfat /dev/sdb1 rw\n"
      "95 22 0:5 / /home/anna/media rw - tmpfs tmpfs rw\n"
      "short line\n";
  EXPECT_THAT(sticksIn(kMounts, stickRoots()), ElementsAre("/media/anna/MY STICK", "/mnt", "/run/media/anna/B"));
  EXPECT_THAT(sticksIn("", stickRoots()), IsEmpty());
  EXPECT_THAT(sticksIn("1 2 3:4 / /mnt/a\\04", stickRoots()), ElementsAre("/mnt/a\\04"));
}

// In name spaces of its own, where a user may mount.
class MountedSticks : public testing::Test {
 protected:
  void SetUp() override {
    if (::unshare(CLONE_NEWNS) != 0 && !unshareUser()) GTEST_SKIP() << "this system lets no test mount";
    ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    std::filesystem::create_directory(stick_);
    if (::mount("none", stick_.c_str(), "tmpfs", 0, nullptr) != 0) GTEST_SKIP() << "this system lets no test mount";
    ::umount(stick_.c_str());
  }
  static bool unshareUser() {
    const auto user = ::getuid();
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    std::ofstream("/proc/self/uid_map") << "0 " << user << " 1";
    return true;
  }
  test::TemporaryFolder folder_;
  const std::string root_ = std::filesystem::canonical(std::filesystem::path(folder_ / "x").parent_path());
  const std::string stick_ = root_ + "/STICK";
};

TEST_F(MountedSticks, AreNoticedAsTheyComeAndGo) {
  StickWatch watch({root_});
  EXPECT_FALSE(watch.changed());
  EXPECT_THAT(watch.sticks(), IsEmpty());
  ASSERT_EQ(::mount("none", stick_.c_str(), "tmpfs", 0, nullptr), 0);
  EXPECT_TRUE(watch.changed());
  EXPECT_THAT(watch.sticks(), ElementsAre(stick_));
  EXPECT_FALSE(watch.changed());
  ASSERT_EQ(::umount(stick_.c_str()), 0);
  EXPECT_TRUE(watch.changed());
  EXPECT_THAT(watch.sticks(), IsEmpty());
}

TEST_F(MountedSticks, OneThatIsThereAtTheStartIsNews) {
  ASSERT_EQ(::mount("none", stick_.c_str(), "tmpfs", 0, nullptr), 0);
  StickWatch watch({root_});
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
  ::umount(stick_.c_str());
}

}  // namespace
}  // namespace relievo
