// SPDX-License-Identifier: Apache-2.0
// What a block is marked with, as the kernel reports it.
#include "platform/memory/huge_pages.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>

#include "tests/support/machine/huge_page_marks.h"

namespace relievo {
namespace {

constexpr std::size_t kBytes = 4 * kHugePagesFrom;

class Mapping {
 public:
  Mapping()
      : base_(static_cast<unsigned char*>(
            ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))) {}
  ~Mapping() { ::munmap(base_, kBytes); }
  [[nodiscard]] unsigned char* at(std::size_t byte) const { return base_ + byte; }

 private:
  unsigned char* base_;
};

TEST(HugePages, ABigBlockIsMarkedFromItsFirstByteToItsLast) {
  if (!test::marksHugePages()) GTEST_SKIP() << "this kernel has no huge pages to ask for";
  const Mapping mapping;
  constexpr std::size_t kBegin = kHugePagesFrom + 100;
  askForHugePages(mapping.at(kBegin), kHugePagesFrom + 5000);
  EXPECT_TRUE(test::isMarkedForHugePages(mapping.at(kBegin)));
  EXPECT_TRUE(test::isMarkedForHugePages(mapping.at(kBegin + kHugePagesFrom + 4999)));
  EXPECT_FALSE(test::isMarkedForHugePages(mapping.at(0)));
  EXPECT_FALSE(test::isMarkedForHugePages(mapping.at(kBytes - 1)));
}

TEST(HugePages, ASmallBlockIsLeftAsItIs) {
  const Mapping mapping;
  askForHugePages(mapping.at(0), kHugePagesFrom - 1);
  EXPECT_FALSE(test::isMarkedForHugePages(mapping.at(0)));
}

TEST(HugePages, ContentsAndErrnoStayEvenWhereNothingCanBeMarked) {
  const Mapping mapping;
  std::fill_n(mapping.at(0), kBytes, static_cast<unsigned char>(7));
  errno = ENOTTY;
  askForHugePages(mapping.at(0), kBytes);
  EXPECT_EQ(std::count(mapping.at(0), mapping.at(kBytes), static_cast<unsigned char>(7)),
            static_cast<std::ptrdiff_t>(kBytes));
  ::munmap(mapping.at(kHugePagesFrom), kHugePagesFrom);  // a hole: the system refuses the request
  askForHugePages(mapping.at(0), kBytes);
  EXPECT_EQ(errno, ENOTTY);
  EXPECT_EQ(*mapping.at(0), 7);
}

}  // namespace
}  // namespace relievo
