// SPDX-License-Identifier: Apache-2.0
// The Falcon's wire format: published packets, streams corrupted anywhere, and impossible encoder readings.
#include "drivers/falcon/packet.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "drivers/falcon/link.h"

namespace relievo::falcon {
namespace {

struct Captured {
  Packet bytes;
  Words words;
};

// Sent by the maker's own driver, as recorded in libnifalcon's utilities (BSD licence); all carry the blue light.
constexpr Captured kCaptured[] = {
    {{0x3c, 0x50, 0x50, 0x50, 0x41, 0x43, 0x45, 0x50, 0x41, 0x43, 0x4d, 0x50, 0x41, 0x45, 0x41, 0x3e},
     {4095, 3906, 4034}},  // at its limit
    {{0x3c, 0x41, 0x4d, 0x4b, 0x41, 0x4d, 0x4e, 0x4b, 0x41, 0x49, 0x45, 0x4c, 0x41, 0x45, 0x41, 0x3e},
     {2752, 2780, 2888}},
    {{0x3c, 0x50, 0x42, 0x46, 0x41, 0x4e, 0x4b, 0x46, 0x41, 0x47, 0x50, 0x46, 0x41, 0x45, 0x41, 0x3e},
     {1311, 1453, 1526}},
    {{0x3c, 0x46, 0x4a, 0x43, 0x41, 0x4c, 0x4e, 0x43, 0x41, 0x4f, 0x50, 0x43, 0x41, 0x45, 0x41, 0x3e}, {661, 731, 766}},
    {{0x3c, 0x4d, 0x4b, 0x45, 0x50, 0x4c, 0x42, 0x41, 0x41, 0x42, 0x4b, 0x44, 0x41, 0x45, 0x41, 0x3e},
     {-2900, 27, 929}},
    {{0x3c, 0x50, 0x49, 0x42, 0x41, 0x42, 0x50, 0x44, 0x50, 0x50, 0x47, 0x45, 0x41, 0x45, 0x41, 0x3e},
     {399, -3087, 1135}},
    {{0x3c, 0x4a, 0x46, 0x4e, 0x50, 0x42, 0x4f, 0x4a, 0x41, 0x4b, 0x4c, 0x49, 0x50, 0x45, 0x41, 0x3e},
     {-679, 2529, -1862}},
    {{0x3c, 0x50, 0x4c, 0x50, 0x50, 0x49, 0x49, 0x41, 0x41, 0x42, 0x47, 0x50, 0x50, 0x45, 0x41, 0x3e},
     {-65, 136, -159}},
    // The source's annotation repeats another packet's words; these are from the bytes.
    {{0x3c, 0x42, 0x4c, 0x4a, 0x41, 0x44, 0x47, 0x4e, 0x50, 0x46, 0x47, 0x4a, 0x50, 0x45, 0x41, 0x3e},
     {2481, -669, -1691}},
};

TEST(FalconPacket, TheNineOnRecordDecodeAndEncodeExactly) {
  for (const Captured& each : kCaptured) {
    const auto command = decodeCommand(each.bytes);
    ASSERT_TRUE(command);
    EXPECT_EQ(command->motors, each.words);
    EXPECT_TRUE(command->blue);
    EXPECT_FALSE(command->homing || command->green || command->red);
    EXPECT_EQ(encode(*command), each.bytes);
  }
}

TEST(FalconPacket, AnEmptyCommandIsWrittenAsZeros) {
  const Packet packet = encode(Command{});
  EXPECT_EQ(std::string(packet.begin(), packet.end()), "<AAAAAAAAAAAAAA>");
}

TEST(FalconPacket, RepliesKeepTheirEndsAndFlags) {
  for (const std::int16_t value : {std::int16_t{-32768}, std::int16_t{-1}, std::int16_t{0}, std::int16_t{32767}}) {
    const Reply reply{.encoders = {value, 5, -7}, .buttons = 9, .homed = 5};
    const auto back = decodeReply(encode(reply));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->encoders, reply.encoders);
    EXPECT_EQ(back->buttons, 9);
    EXPECT_EQ(back->homed, 5);
    EXPECT_FALSE(back->allHomed());
  }
}

TEST(FalconPacket, EveryByteThatCannotBeIsRefused) {
  const Packet good = encode(Reply{.encoders = {100, -200, 300}, .homed = 7});
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const std::uint8_t wrong : {std::uint8_t{0}, std::uint8_t{0x40}, std::uint8_t{0xFF}}) {
      Packet bad = good;
      bad[at] = wrong;
      EXPECT_FALSE(decodeReply(bad)) << "byte " << at << " = " << int{wrong};
    }
  }
}

TEST(FalconStream, FindsTheFirstWholePacketAfterAnyFault) {
  const Packet packet = encode(Reply{.encoders = {1, 2, 3}});
  for (std::size_t cut = 0; cut < kPacketBytes; ++cut) {
    PacketStream stream;
    stream.add(std::span(packet).first(cut));  // the rest never comes
    stream.add(packet);
    const auto found = stream.next();
    ASSERT_TRUE(found) << cut;
    EXPECT_EQ(*found, packet);
    EXPECT_FALSE(stream.next());
  }
}

TEST(FalconStream, TakesPacketsHoweverTheyAreSplit) {
  const Packet packet = encode(Reply{.encoders = {-1, 20, 300}});
  PacketStream stream;
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    for (const std::uint8_t& byte : packet) {
      stream.add({&byte, 1});
      while (stream.next()) ++found;
    }
  }
  EXPECT_EQ(found, 100);
}

TEST(FalconStream, MoreThanItHoldsCostsTheOldest) {
  PacketStream stream;
  for (std::int16_t i = 0; i < 100; ++i) stream.add(encode(Reply{.encoders = {i, 0, 0}}));
  std::vector<std::int16_t> firsts;
  while (const auto packet = stream.next()) firsts.push_back(decodeReply(*packet)->encoders[0]);
  ASSERT_EQ(firsts.size(), 8U);
  EXPECT_EQ(firsts.front(), 92);
  const std::vector<std::uint8_t> noise(1000, 'A');
  stream.add(noise);
  EXPECT_FALSE(stream.next());
  stream.add(encode(Reply{}));
  EXPECT_TRUE(stream.next());
}

TEST(FalconGate, MotionPassesAndALeapDoesNot) {
  EncoderGate gate(kMmPerCount, 1000);
  gate.reset({0, 0, 0});
  int place = 0;
  for (int tick = 1; tick < 200; ++tick) {  // accelerates by 3 counts per tick^2, then slows down as gently
    place += tick < 20 ? 3 * tick : std::max(0, 57 - 3 * (tick - 20));
    ASSERT_TRUE(gate.accept({static_cast<std::int16_t>(place), 0, 0})) << tick;
  }
  EXPECT_FALSE(gate.accept({static_cast<std::int16_t>(place), 16, 0})) << "the lowest nibble but one has turned";
  EXPECT_TRUE(gate.accept({static_cast<std::int16_t>(place), 0, 0}));
}

TEST(FalconGate, ALeapThatStaysIsBelievedTheSecondTime) {
  EncoderGate gate(kMmPerCount, 1000);
  gate.reset({0, 0, 0});
  EXPECT_FALSE(gate.accept({500, 0, 0}));
  EXPECT_TRUE(gate.accept({501, 0, 0}));
  EXPECT_TRUE(gate.accept({502, 0, 0}));
  EXPECT_FALSE(gate.accept({900, 0, 0}));
  EXPECT_FALSE(gate.accept({1300, 0, 0})) << "two leaps that disagree";
}

TEST(FalconGate, ATickWithoutAWordWidensIt) {
  EncoderGate gate(kMmPerCount, 1000);
  gate.reset({0, 0, 0});
  gate.skip();
  gate.skip();
  EXPECT_TRUE(gate.accept({17, 0, 0}));
  EXPECT_FALSE(gate.accept({40, 0, 0}));
}

TEST(FalconBridge, APacketThatSaysItIsBrokenCarriesNothing) {
  UsbPacket packet{.data = {0x01, 0x60, 'x', 'y'}, .bytes = 4};
  EXPECT_EQ(payloadOf(packet).size(), 2U);
  for (const unsigned error : {0x02U, 0x04U, 0x08U, 0x10U}) {  // overrun, parity, framing, break
    packet.data[1] = static_cast<std::uint8_t>(0x60 | error);
    EXPECT_TRUE(payloadOf(packet).empty()) << error;
  }
  packet = {.data = {0x01, 0x60}, .bytes = 2};
  EXPECT_TRUE(payloadOf(packet).empty()) << "the bridge's two status bytes";
}

}  // namespace
}  // namespace relievo::falcon
