// SPDX-License-Identifier: Apache-2.0
// Numbers in texts: exactly as many as are wanted, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <span>

#include "platform/text/number_in.h"

namespace relievo {
namespace {

using testing::ElementsAre;

bool isRow(std::string_view text) {
  std::array<double, 3> numbers{};
  return readNumbers(text, ',', std::span(numbers));
}

TEST(Numbers, AreReadFromARow) {
  std::array<double, 3> numbers{};
  ASSERT_TRUE(readNumbers("0.5,-2,1e3", ',', std::span(numbers)));
  EXPECT_THAT(numbers, ElementsAre(0.5, -2, 1000));
}

TEST(Numbers, AreRefusedIfTheRowHasFewerOrMoreOrWords) {
  for (const char* row : {"", "1", "1,2", "1,2,", ",1,2", "1,,3", "1,2,3,", "1,2,3,4", "1, 2,3", "1,2,x", "1,2,3 "})
    EXPECT_FALSE(isRow(row)) << row;
  EXPECT_FALSE(isRow("1,inf,3"));
  EXPECT_FALSE(isRow("1,2,nan"));
}

TEST(Numbers, AreWholeWhereWholeOnesAreWanted) {
  std::array<int, 2> size{};
  ASSERT_TRUE(readNumbers("1280x720", 'x', std::span(size)));
  EXPECT_THAT(size, ElementsAre(1280, 720));
  for (const char* word : {"1280.0x720", "1e3x720", "1280x720.5", "99999999999x1", "1280,720"})
    EXPECT_FALSE(readNumbers(word, 'x', std::span(size))) << word;
}

}  // namespace
}  // namespace relievo
