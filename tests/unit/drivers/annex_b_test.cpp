// SPDX-License-Identifier: Apache-2.0
// Converts packets, byte by byte, from containers' form to the form for hardware.
#include "drivers/v4l2/annex_b.h"

#include <gtest/gtest.h>

namespace relievo::v4l2 {
namespace {

using Bytes = std::vector<std::uint8_t>;

AnnexB formOf(const std::string& codec, const Bytes& extradata) {
  StreamInfo stream;
  stream.codec = codec;
  stream.extradata = extradata;
  auto form = AnnexB::make(stream);
  EXPECT_TRUE(form);
  return form.value_or(AnnexB());
}
std::optional<Bytes> written(const AnnexB& form, const Bytes& packet, bool keyframe, bool with_parameters,
                             std::size_t room = 64) {
  Bytes out(room);
  const auto bytes =
      form.write({.data = packet.data(), .bytes = packet.size(), .keyframe = keyframe}, with_parameters, out);
  if (!bytes) return std::nullopt;
  out.resize(*bytes);
  return out;
}

// Lengths of two bytes; a sequence set of five, a picture set of two.
const Bytes kAvc{1, 100, 0, 30, 0xfd, 0xe1, 0, 5, 0x67, 100, 0, 30, 0xac, 1, 0, 2, 0x68, 0xee};
const Bytes kAvcSets{0, 0, 0, 1, 0x67, 100, 0, 30, 0xac, 0, 0, 0, 1, 0x68, 0xee};

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(AnnexB, LengthsBecomeStartCodesAndKeyFramesBringTheirParameters) {
  const AnnexB form = formOf("h264", kAvc);
  const Bytes packet{0, 2, 0x41, 7, 0, 1, 9}, units{0, 0, 0, 1, 0x41, 7, 0, 0, 0, 1, 9};
  EXPECT_EQ(written(form, packet, false, false), units);
  EXPECT_EQ(written(form, packet, true, false), kAvcSets + units);
  EXPECT_EQ(written(form, packet, false, true), kAvcSets + units);
}

TEST(AnnexB, WhatHasStartCodesStaysAsItIs) {
  const AnnexB form = formOf("h264", kAvcSets);
  const Bytes packet{0, 0, 1, 0x65, 1, 2};
  EXPECT_EQ(written(form, packet, true, false), packet) << "its key frames have parameters of their own";
  EXPECT_EQ(written(form, packet, true, true), kAvcSets + packet) << "repeated where decoding begins";
  const Bytes own = Bytes{0, 0, 1, 0x67, 77, 0, 30, 0xff, 0x80} + packet;
  EXPECT_EQ(written(form, own, true, true), own) << "unless it has its own, which may be others";
  EXPECT_EQ(written(formOf("fwht", {1, 2, 3, 4, 5}), packet, true, true), packet);
}

TEST(AnnexB, ACamerasKeyPicturesAreToldFromOthers) {
  const Bytes slice{0, 0, 1, 0x41, 7}, key{0, 0, 1, 0x65, 1, 2}, delimiter{0, 0, 0, 1, 9, 0xf0};
  EXPECT_TRUE(isAvcKey(key));
  EXPECT_TRUE(isAvcKey(delimiter + key));
  EXPECT_TRUE(isAvcKey(delimiter + kAvcSets + slice)) << "a picture that is refreshed by parts";
  EXPECT_FALSE(isAvcKey(slice));
  EXPECT_FALSE(isAvcKey(delimiter + slice + key)) << "no key slice comes behind another";
  EXPECT_FALSE(isAvcKey(delimiter));
  EXPECT_FALSE(isAvcKey({}));
}

TEST(AnnexB, DamagedAndLargePacketsAreRefused) {
  const AnnexB form = formOf("h264", kAvc);
  EXPECT_FALSE(written(form, {0, 9, 0x41}, false, false)) << "shorter than it says";
  EXPECT_FALSE(written(form, {0}, false, false));
  EXPECT_FALSE(written(form, {0, 2, 0x41, 7}, false, false, 5)) << "one byte short of its six";
  EXPECT_TRUE(written(form, {0, 2, 0x41, 7}, false, false, 6));
}

TEST(AnnexB, ADescriptionThatIsCutOffIsCorrupt) {
  for (std::size_t bytes = 4; bytes < kAvc.size(); ++bytes) {
    StreamInfo stream;
    stream.codec = "h264";
    stream.extradata.assign(kAvc.begin(), kAvc.begin() + static_cast<std::ptrdiff_t>(bytes));
    const auto form = AnnexB::make(stream);
    ASSERT_FALSE(form) << bytes;
    EXPECT_EQ(form.error().code, ErrorCode::Corrupt);
  }
}

TEST(AnnexB, ReadsTheSetsOfHevc) {
  Bytes description(21, 0);
  description[0] = 1;
  const Bytes set{0x42, 1, 1, 1, 0x60, 0, 0};
  // Lengths of four bytes; one kind of set, one set.
  const AnnexB form = formOf("hevc", description + Bytes{3, 1, 33, 0, 1, 0, 7} + set);
  const Bytes code{0, 0, 0, 1}, packet{0, 0, 0, 1, 0x26};
  EXPECT_EQ(written(form, packet, true, false), code + set + packet) << "a length of 1 and a start code look the same";
  EXPECT_TRUE(form.profile()->plain);
}

struct ProfileCase {
  const char* name;
  Bytes set;
  int profile;
  bool plain;
};

// The beginning of sequence sets, encoded by hand from 7.3.2.1.1 of ISO/IEC 14496-10 and 7.3.2.2 of 23008-2.
TEST(AnnexB, TellsPlainPicturesFromOthers) {
  const ProfileCase avc[] = {
      {"Baseline", {0x67, 66, 0, 30, 0xff}, 66, true},
      {"High, 4:2:0: 1 010 1 1", {0x67, 100, 0, 30, 0xac}, 100, true},
      {"High, 4:0:0: 1 1 1 1", {0x67, 100, 0, 30, 0xf0}, 100, false},
      {"High 10: 1 010 011 011", {0x67, 110, 0, 30, 0xa6, 0xc0}, 110, false},
      {"High 4:2:2: 1 011 1 1", {0x67, 122, 0, 30, 0xbc}, 122, false},
      {"High, level 0: a byte keeps a start code out", {0x67, 100, 0, 0, 3, 0xac}, 100, true},
  };
  for (const ProfileCase& each : avc) {
    const auto told = formOf("h264", Bytes{0, 0, 1} + each.set + Bytes{0x80, 0x80}).profile();
    ASSERT_TRUE(told) << each.name;
    EXPECT_EQ(told->profile, each.profile) << each.name;
    EXPECT_EQ(told->plain, each.plain) << each.name;
  }
  EXPECT_TRUE(formOf("hevc", {0, 0, 1, 0x42, 1, 1, 1, 0x60}).profile()->plain) << "Main";
  EXPECT_FALSE(formOf("hevc", {0, 0, 1, 0x42, 1, 1, 2, 0x20}).profile()->plain) << "Main 10";
  EXPECT_FALSE(formOf("h264", {}).profile()) << "the stream does not state it";
  EXPECT_FALSE(formOf("h264", {0, 0, 1, 0x68, 1, 2, 3, 4, 5}).profile());
}

}  // namespace
}  // namespace relievo::v4l2
