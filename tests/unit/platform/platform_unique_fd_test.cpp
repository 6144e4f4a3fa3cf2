// SPDX-License-Identifier: Apache-2.0
// A descriptor is closed once, by its last owner.
#include "platform/unique_fd.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <array>

namespace relievo {
namespace {

bool isOpen(int fd) {
  return ::fcntl(fd, F_GETFD) != -1;
}

int opened() {
  const int fd = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  EXPECT_GE(fd, 0);
  return fd;
}

TEST(UniqueFd, OwnsNothingAtFirst) {
  const UniqueFd fd;
  EXPECT_FALSE(fd.valid());
  EXPECT_EQ(fd.get(), -1);
}

TEST(UniqueFd, ClosesWhenItGoes) {
  const int raw = opened();
  {
    const UniqueFd fd(raw);
    EXPECT_TRUE(fd.valid());
    EXPECT_TRUE(isOpen(raw));
  }
  EXPECT_FALSE(isOpen(raw));
}

// A second close would hit the descriptor that has taken the number since.
TEST(UniqueFd, ClosesOnlyOnce) {
  const int raw = opened();
  UniqueFd fd(raw);
  fd.reset();
  EXPECT_FALSE(fd.valid());
  const UniqueFd other(opened());
  ASSERT_EQ(other.get(), raw) << "the kernel gives the lowest free number";
  fd.reset();
  {
    const UniqueFd gone = std::move(fd);
  }
  EXPECT_TRUE(isOpen(raw));
}

TEST(UniqueFd, MovesItsDescriptorOn) {
  const int raw = opened();
  UniqueFd first(raw);
  UniqueFd second(std::move(first));
  EXPECT_FALSE(first.valid());
  EXPECT_EQ(second.get(), raw);
  EXPECT_TRUE(isOpen(raw));
}

TEST(UniqueFd, ClosesItsOwnWhenItIsGivenAnother) {
  const int kept = opened();
  const int dropped = opened();
  UniqueFd target(dropped);
  UniqueFd source(kept);
  target = std::move(source);
  EXPECT_FALSE(isOpen(dropped));
  EXPECT_EQ(target.get(), kept);
  EXPECT_TRUE(isOpen(kept));
}

TEST(UniqueFd, SurvivesBeingMovedToItself) {
  const int raw = opened();
  UniqueFd fd(raw);
  UniqueFd& same = fd;
  fd = std::move(same);
  EXPECT_EQ(fd.get(), raw);
  EXPECT_TRUE(isOpen(raw));
}

TEST(UniqueFd, LeavesAReleasedDescriptorOpen) {
  const int raw = opened();
  {
    UniqueFd fd(raw);
    EXPECT_EQ(fd.release(), raw);
    EXPECT_FALSE(fd.valid());
  }
  EXPECT_TRUE(isOpen(raw));
  ::close(raw);
}

}  // namespace
}  // namespace relievo
