// SPDX-License-Identifier: Apache-2.0
// The author's changes to the transport stream from FFmpeg's muxer: the programme map marks the depth, and packets are
// sent in time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "app/author/package/place/ts_depth_signal.h"
#include "app/author/package/place/ts_pacer.h"

namespace relievo {
namespace {

using Packet = std::array<std::uint8_t, TsPacer::kPacket>;

// ISO/IEC 13818-1, annex A; the published check value of CRC-32/MPEG-2.
TEST(MpegChecksum, IsThatOfTheStandard) {
  const std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(mpegChecksum(digits), 0x0376e6e7u);
}

// A map of two H.264 streams, PIDs 0x100 and 0x101, as FFmpeg writes it; `descriptor` belongs to the second.
Packet mapPacket(const std::vector<std::uint8_t>& descriptor = {}) {
  Packet packet;
  packet.fill(0xff);
  std::vector<std::uint8_t> bytes{0x47, 0x50, 0x00, 0x10, 0,     // begins a unit of PID 0x1000; pointer 0
                                  0x02, 0xb0, 0,    0,    1,     // a map, its length, programme 1
                                  0xc1, 0,    0,    0xe1, 0x00,  // version 0; clock of PID 0x100
                                  0xf0, 0,                       // no descriptors of the programme
                                  0x1b, 0xe1, 0x00, 0xf0, 0,     // H.264 of PID 0x100
                                  0x1b, 0xe1, 0x01, 0xf0, static_cast<std::uint8_t>(descriptor.size())};
  bytes.insert(bytes.end(), descriptor.begin(), descriptor.end());
  bytes[7] = static_cast<std::uint8_t>(bytes.size() - 8 + 4);  // from after the length to the end of the checksum
  const std::uint32_t sum = mpegChecksum(std::span(bytes).subspan(5));
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(sum >> shift));
  std::copy(bytes.begin(), bytes.end(), packet.begin());
  return packet;
}

// The checksum over a whole section with its own checksum is 0.
std::uint32_t checkOf(const Packet& packet) {
  return mpegChecksum(std::span(packet).subspan(5, std::size_t{3} + packet[7]));
}

TEST(TsDepthSignal, GivesTheDepthItsTypeAndDescriptor) {
  Packet packet = mapPacket();
  ASSERT_EQ(checkOf(packet), 0u);
  TsDepthSignal(VideoCodec::H264).rewrite(packet);
  EXPECT_EQ(packet[7], 23 + 10);  // was 9 + 2 x 5 + 4
  EXPECT_EQ(packet[17], 0x1b);    // the colour
  EXPECT_EQ(packet[22], 0x1e);
  EXPECT_EQ(packet[26], 10);    // bytes of descriptors
  EXPECT_EQ(packet[27], 0x2f);  // auxiliary_video_stream_descriptor
  EXPECT_EQ(packet[28], 8);
  EXPECT_EQ(packet[29], 0x1b);
  EXPECT_EQ(checkOf(packet), 0u);
  EXPECT_EQ(packet[5 + 3 + 33], 0xff);  // what follows is still stuffing
}

TEST(TsDepthSignal, KeepsOtherDescriptors) {
  Packet packet = mapPacket({0x05, 4, 'H', 'E', 'V', 'C'});
  TsDepthSignal(VideoCodec::Hevc).rewrite(packet);
  EXPECT_EQ(packet[26], 16);
  EXPECT_EQ(packet[29], 0x24);
  EXPECT_EQ(packet[37], 0x05);
  EXPECT_EQ(packet[42], 'C');
  EXPECT_EQ(checkOf(packet), 0u);
}

TEST(TsDepthSignal, LeavesOtherPacketsAsTheyAre) {
  Packet other = mapPacket();
  other[2] = 1;  // another PID
  Packet later = mapPacket();
  later[1] &= 0x0f;  // does not begin a section
  for (const Packet& packet : {other, later}) {
    Packet same = packet;
    TsDepthSignal(VideoCodec::H264).rewrite(same);
    EXPECT_EQ(same, packet);
  }
}

// ---- pace ----

Packet plainPacket() {
  Packet packet{0x47, 0x01, 0x00, 0x10};
  return packet;
}
// With a programme clock reference of `ms`, in units of 1/90 ms.
Packet timedPacket(std::int64_t ms) {
  Packet packet{0x47, 0x01, 0x00, 0x30, 7, 0x10};
  const std::int64_t base = ms * 90;
  for (int i = 0; i < 4; ++i) packet[static_cast<std::size_t>(6 + i)] = static_cast<std::uint8_t>(base >> (25 - 8 * i));
  packet[10] = static_cast<std::uint8_t>((base & 1) << 7);
  return packet;
}

struct Line {
  ManualClock clock{MonotonicTime(std::chrono::seconds(100))};
  std::vector<std::pair<Duration, std::size_t>> sent;  // since 100 s, bytes
  TsPacer pacer{clock, [this](std::span<const std::uint8_t> datagram) {
                  sent.emplace_back(clock.now() - MonotonicTime(std::chrono::seconds(100)), datagram.size());
                  return true;
                }};
  void add(const Packet& packet) { EXPECT_TRUE(pacer.add(packet)); }
};

TEST(TsPacer, SpreadsPacketsEvenlyBetweenReferences) {
  Line line;
  line.add(timedPacket(5000));  // the first reference is sent at once, whatever its value
  for (int i = 0; i < 27; ++i) line.add(plainPacket());
  EXPECT_TRUE(line.sent.empty());
  line.add(timedPacket(5040));
  // 28 packets, four datagrams in 40 ms.
  ASSERT_EQ(line.sent.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(line.sent[i].first, std::chrono::milliseconds(10 * i));
    EXPECT_EQ(line.sent[i].second, 7u * 188);
  }
  EXPECT_TRUE(line.pacer.finish());
  ASSERT_EQ(line.sent.size(), 5u);
  EXPECT_EQ(line.sent[4].first, std::chrono::milliseconds(40));
  EXPECT_EQ(line.sent[4].second, 188u);
  EXPECT_EQ(line.pacer.latest(), Duration(0));
}

TEST(TsPacer, SendsAtOnceWhatIsLateAndSaysHowLate) {
  Line line;
  line.add(timedPacket(0));
  line.clock.advance(std::chrono::milliseconds(300));
  line.add(timedPacket(100));
  ASSERT_EQ(line.sent.size(), 1u);
  EXPECT_EQ(line.sent[0].first, std::chrono::milliseconds(300));
  EXPECT_EQ(line.pacer.latest(), std::chrono::milliseconds(300));
  line.add(timedPacket(400));  // due at 100 ms and late too; after it the pace is in time again
  line.add(timedPacket(500));
  EXPECT_EQ(line.sent[2].first, std::chrono::milliseconds(400));
}

// The counter has 33 bits: it begins again 95443.717 s after its 0.
TEST(TsPacer, KeepsThePaceWhereTheReferencesBeginAgain) {
  Line line;
  for (const std::int64_t ms : {95'443'600, 95'443'700, 83, 183}) line.add(timedPacket(ms));
  ASSERT_EQ(line.sent.size(), 3u);
  EXPECT_EQ(line.sent[1].first, std::chrono::milliseconds(100));
  EXPECT_NEAR(toSeconds(line.sent[2].first), 0.2, 1e-3);
  EXPECT_TRUE(line.pacer.finish());
  EXPECT_NEAR(toSeconds(line.sent[3].first), 0.3, 1e-3);
  EXPECT_EQ(line.pacer.latest(), Duration(0));
}

TEST(TsPacer, GivesUpWhenItCannotSend) {
  ManualClock clock;
  TsPacer pacer(clock, [](std::span<const std::uint8_t>) { return false; });
  EXPECT_TRUE(pacer.add(timedPacket(0)));
  EXPECT_FALSE(pacer.add(timedPacket(10)));
}

}  // namespace
}  // namespace relievo
