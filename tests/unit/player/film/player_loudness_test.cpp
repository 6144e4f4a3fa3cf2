// SPDX-License-Identifier: Apache-2.0
// Volume, mute, and what is remembered of them.
#include "app/player/sound/loudness.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

TEST(Loudness, TheFactorIsTheCubeOfTheShare) {
  Loudness loudness("", "alsa");
  EXPECT_EQ(loudness.gain(), 1);
  loudness.set(50);
  EXPECT_DOUBLE_EQ(loudness.gain(), 0.125);
  loudness.set(500);
  EXPECT_DOUBLE_EQ(loudness.percent(), 130);
  loudness.set(-5);
  EXPECT_EQ(loudness.gain(), 0);
}

TEST(Loudness, MutedIsSilentAndKeepsTheVolume) {
  Loudness loudness("", "alsa");
  loudness.set(80);
  loudness.mute(true);
  EXPECT_EQ(loudness.gain(), 0);
  loudness.mute(false);
  EXPECT_DOUBLE_EQ(loudness.percent(), 80);
}

TEST(Loudness, EachDeviceHasItsOwn) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "state/volume.json";
  FileWriter files(FileWriter::Where::AtOnce);
  {
    Loudness loudness(path, "alsa:hdmi");
    loudness.set(35);
    loudness.keep(files);
  }
  {
    Loudness other(path, "alsa");
    EXPECT_EQ(other.percent(), 100);
    other.set(70);
    other.keep(files);
  }
  EXPECT_EQ(Loudness(path, "alsa:hdmi").percent(), 35);
  EXPECT_EQ(Loudness(path, "alsa").percent(), 70);
}

TEST(Loudness, AnOutputMayHaveAnyName) {
  const test::TemporaryFolder folder;
  FileWriter files(FileWriter::Where::AtOnce);
  Loudness loudness(folder / "volume.json", "alsa:\xff");  // no UTF-8
  loudness.set(35);
  loudness.keep(files);
  EXPECT_TRUE(std::filesystem::exists(folder / "volume.json"));
}

TEST(Loudness, ABrokenFileCountsAsEmpty) {
  const test::TemporaryFolder folder;
  for (const char* text : {"", "[1]", "{\"alsa\": \"loud\"}", "{"}) {
    std::ofstream(folder / "volume.json") << text;
    EXPECT_EQ(Loudness(folder / "volume.json", "alsa").percent(), 100) << text;
  }
}

}  // namespace
}  // namespace relievo
