// SPDX-License-Identifier: Apache-2.0
// Numbers below 0 in a file of depth: a terrain's heights, or the way to say that nothing is there.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

#include "tests/support/film/clip_maker.h"
#include "tests/unit/drivers/decoded_film.h"

namespace relievo {
namespace {

template <class Value>
std::string npyOf(const char* type, const std::function<double(int c, int r)>& number) {
  std::string head = std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (10, 20), }\n";
  std::string file = std::string("\x93NUMPY\x01") + '\0' + static_cast<char>(head.size()) + '\0' + head;
  for (int i = 0; i < 200; ++i) {
    const auto value = static_cast<Value>(number(i % 20, i / 20));
    file.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return file;
}

Frame readOf(const std::string& file) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "z.npy", std::ios::binary) << file;
  const test::DecodedFilm film = test::decodeFilm(folder / "z.npy");
  return film.frames.empty() ? Frame{} : film.frames.front();
}

std::uint32_t codeIn(const Frame& frame, int c, int r) {
  return test::sampleAt(frame, 0, c, r);
}

TEST(NumbersBelowZero, AreLiftedWhereOthersAreAbove) {
  const auto terrain = [](int c, int) { return 100.0 * (c - 5) + 7; };
  const auto nowhere = [&](int c, int r) { return r == 2 ? std::nan("") : terrain(c, r) / 1000; };
  for (const auto& [file, scale] :
       {std::pair{npyOf<float>("<f4", terrain), 1.0}, std::pair{npyOf<std::int16_t>("<i2", terrain), 1.0},
        std::pair{npyOf<float>("<f4", nowhere), 1e-3}}) {
    const Frame frame = readOf(file);
    ASSERT_FALSE(frame.empty());
    ASSERT_NE(frame.value_at_zero, 0);
    for (int c = 0; c < 20; ++c) {
      const double number = frame.value_at_zero + frame.value_per_code * codeIn(frame, c, 4);
      EXPECT_NEAR(number, scale * terrain(c, 4), 0.51 * frame.value_per_code) << c;
    }
    EXPECT_EQ(codeIn(frame, 3, 2) == 0, scale < 1) << "a hole";
    EXPECT_LT(frame.value_per_code, scale * 1900 / 16000) << "a quarter of the codes at least";
  }
}

TEST(NumbersBelowZero, AreNotLiftedByWhatSaysNothingThere) {
  const Frame frame = readOf(npyOf<float>("<f4", [](int c, int r) {
    return c == 0 ? -9999.0 : c == 19 ? 32767.0 : 5.0 * (c - 9) + 0.1 * r;
  }));
  ASSERT_NE(frame.value_at_zero, 0);
  EXPECT_LT(frame.value_per_code, 0.01);
  EXPECT_EQ(codeIn(frame, 0, 3), 0U);
  EXPECT_EQ(codeIn(frame, 19, 3), 0U);
  EXPECT_NEAR(frame.value_at_zero + frame.value_per_code * codeIn(frame, 1, 3), -39.7, 0.01);
}

TEST(NumbersBelowZero, ThatSayNothingThereAreHoles) {
  const Frame constant = readOf(npyOf<float>("<f4", [](int c, int r) { return c < 10 ? -1.0 : r + 1; }));
  EXPECT_EQ(constant.value_at_zero, 0);
  EXPECT_EQ(codeIn(constant, 3, 3), 0U);
  EXPECT_GT(codeIn(constant, 13, 3), 0U);
  // A constant, and what a filter has made of it.
  const Frame mixed = readOf(npyOf<float>("<f4", [](int c, int r) { return c < 9 ? -1.0 : c < 10 ? -.1 * r : r + 1; }));
  EXPECT_EQ(mixed.value_at_zero, 0);
  // Disparities of the right view: all of them are turned.
  const Frame turned = readOf(npyOf<float>("<f4", [](int c, int r) { return -10 - c - r; }));
  EXPECT_EQ(turned.value_at_zero, 0);
  EXPECT_LT(turned.value_per_code, 0);
  // Wrong distances, far from 0.
  const Frame wrong = readOf(npyOf<float>("<f4", [](int c, int r) { return c < 2 ? -3.0 - r : 2.0 + c + r; }));
  EXPECT_EQ(wrong.value_at_zero, 0);
  EXPECT_EQ(codeIn(wrong, 1, 3), 0U);
  // A few that a filter has left.
  const Frame few = readOf(npyOf<float>("<f4", [](int c, int r) { return c == 3 && r < 3 ? -1.0 - r : 5.0; }));
  EXPECT_EQ(few.value_at_zero, 0);
  EXPECT_EQ(codeIn(few, 3, 1), 0U);
}

// Dictionaries of robots' grasps, and colour with depth in one array.
TEST(Npy, WhatHoldsDepthInAnotherWaySaysHowToTakeItOut) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& type, const std::string& shape) {
    std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
    header.resize(117, ' ');
    std::ofstream(folder / "z.npy", std::ios::binary)
        << std::string("\x93NUMPY\x01\0", 8) << static_cast<char>(header.size() + 1) << '\0' << header << '\n'
        << ", 4)" << std::string(512, 'x');
    const auto opened = drivers::makeMediaSource(folder / "z.npy")->open(folder / "z.npy");
    return opened ? std::string() : std::string(opened.error().message);
  };
  EXPECT_NE(refusal("|O", "").find("allow_pickle=True"), std::string::npos);
  EXPECT_NE(refusal("<f4", "240, 320, 4").find("a[..., 3]"), std::string::npos);
  EXPECT_NE(refusal("<c8", "4, 16").find("rows x columns"), std::string::npos);
}

}  // namespace
}  // namespace relievo
