// SPDX-License-Identifier: Apache-2.0
// A line of jobs: in order, few at a time, until the first failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <expected>
#include <numeric>
#include <thread>
#include <vector>

#include "app/author/package/work_line.h"

namespace relievo {
namespace {

using Answer = std::expected<void, int>;
using Line = WorkLine<Answer>;

TEST(AuthorWorkLine, DoesEveryJobInOrder) {
  std::vector<int> done;
  Line line;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(line.add([&done, i] {
      done.push_back(i);
      return Answer{};
    }));
  }
  ASSERT_TRUE(line.finish());
  std::vector<int> all(100);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(done, all);
}

// An owner that uses kBuffers in turn never fills one that a job still reads.
TEST(AuthorWorkLine, HoldsNoMoreThanItsBuffers) {
  std::atomic<int> inside{0}, most{0};
  Line line;
  for (int i = 0; i < 200; ++i) {
    const int now = ++inside;  // the one that is being filled, too
    most = std::max(most.load(), now);
    ASSERT_TRUE(line.add([&inside] {
      std::this_thread::yield();
      --inside;
      return Answer{};
    }));
  }
  ASSERT_TRUE(line.finish());
  EXPECT_EQ(inside, 0);
  EXPECT_LE(most, static_cast<int>(Line::kBuffers));
}

TEST(AuthorWorkLine, StopsAtTheFirstFailureAndTellsIt) {
  std::atomic<int> done{0};
  Line line;
  ASSERT_TRUE(line.add([] { return Answer{std::unexpected(7)}; }));
  static_cast<void>(line.add([&done] {
    ++done;
    return Answer{};
  }));
  const Answer end = line.finish();
  ASSERT_FALSE(end);
  EXPECT_EQ(end.error(), 7);
  const Answer later = line.add([] { return Answer{}; });
  ASSERT_FALSE(later);
  EXPECT_EQ(later.error(), 7);
  EXPECT_EQ(done, 0);
}

}  // namespace
}  // namespace relievo
