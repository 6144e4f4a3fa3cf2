// SPDX-License-Identifier: Apache-2.0
// Writing never waits for ever, and the first error stays.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <vector>

#include "platform/files/answered_output.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

TEST(AnsweredOutput, HasEachByteAtItsPlace) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "a";
  AnsweredOutput file(UniqueFd(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)), path);
  std::vector<std::uint8_t> large(3 << 20);
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::uint8_t>(i * 7 / 1000);
  const std::array<std::uint8_t, 2> head{250, 251};
  ASSERT_TRUE(file.write(5, large));
  ASSERT_TRUE(file.write(0, head));
  EXPECT_EQ(file.bytes(), large.size() + 5);
  ASSERT_TRUE(file.sync());
  std::array<std::uint8_t, 8> got{};
  ASSERT_EQ(file.read(0, got), 8u);
  EXPECT_EQ(got, (std::array<std::uint8_t, 8>{250, 251, 0, 0, 0, large[0], large[1], large[2]}));
  ASSERT_EQ(file.read(large.size(), got), 5u) << "to the end";
  EXPECT_EQ(got[4], large.back());
}

TEST(AnsweredOutput, KeepsTheFirstError) {
  AnsweredOutput file(UniqueFd(::open("/dev/full", O_WRONLY | O_CLOEXEC)), "/dev/full");
  const std::array<std::uint8_t, 3> bytes{1, 2, 3};
  EXPECT_TRUE(file.write(0, bytes)) << "on another thread";
  for (int i = 0; i < 2; ++i) {
    const auto flushed = file.flush();
    ASSERT_FALSE(flushed);
    EXPECT_EQ(flushed.error().code, ErrorCode::Io);
    EXPECT_EQ(flushed.error().os_error, ENOSPC);
  }
  EXPECT_FALSE(file.write(3, bytes));
  EXPECT_EQ(file.error()->os_error, ENOSPC);
}

TEST(AnsweredOutput, AWaitEndsOnRequest) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  const UniqueFd reader(ends[0]);  // reads nothing
  AnsweredOutput file{UniqueFd(ends[1]), "a pipe"};
  const std::atomic<bool> stop{true};
  file.cancelBy(&stop);
  const std::vector<std::uint8_t> more_than_it_holds(1 << 20);
  EXPECT_TRUE(file.write(0, more_than_it_holds)) << "waits for nothing";
  EXPECT_EQ(file.flush().error().code, ErrorCode::Cancelled);
  EXPECT_EQ(file.write(0, more_than_it_holds).error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace relievo
