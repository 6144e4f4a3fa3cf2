// SPDX-License-Identifier: Apache-2.0
// Numbers below 0 in a file of depth: a terrain's heights, or the way to say that nothing is there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/film/clip_maker.h"
#include "tests/unit/drivers/decoded_film.h"

namespace relievo {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// What is said while a picture of 20 x 10 floats is read.
std::string saidOf(const std::function<float(int c, int r)>& number) {
  const test::TemporaryFolder folder;
  std::string head = "{'descr': '<f4', 'fortran_order': False, 'shape': (10, 20), }\n";
  std::string file = std::string("\x93NUMPY\x01") + '\0' + static_cast<char>(head.size()) + '\0' + head;
  for (int i = 0; i < 200; ++i) {
    const float value = number(i % 20, i / 20);
    file.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::ofstream(folder / "z.npy", std::ios::binary) << file;
  testing::internal::CaptureStderr();
  EXPECT_EQ(test::decodeFilm(folder / "z.npy").frames.size(), 1U);
  return testing::internal::GetCapturedStderr();
}

TEST(NumbersBelowZero, OfATerrainAreTold) {
  const std::string said = saidOf([](int c, int) { return static_cast<float>(100 * (c - 5)); });
  EXPECT_THAT(said, HasSubstr("25 % of the numbers are below 0 (down to -500) and become holes"));
  EXPECT_THAT(said, HasSubstr("--as heights"));
}

TEST(NumbersBelowZero, ThatSayNothingThereAreNotTold) {
  EXPECT_THAT(saidOf([](int c, int r) { return c < 10 ? -1.0F : static_cast<float>(r + 1); }), IsEmpty());
  // Disparities of the right view: all of them are turned.
  EXPECT_THAT(saidOf([](int c, int r) { return static_cast<float>(-10 - c - r); }), IsEmpty());
  // A few that a filter has left.
  EXPECT_THAT(saidOf([](int c, int r) { return c == 3 && r < 3 ? -1.0F - static_cast<float>(r) : 5.0F; }), IsEmpty());
}

}  // namespace
}  // namespace relievo
