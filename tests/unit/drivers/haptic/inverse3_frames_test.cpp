// SPDX-License-Identifier: Apache-2.0
// WebSocket frames and the upgrade, on the examples of RFC 6455 and on bytes that break its rules.
#include "drivers/inverse3/frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "drivers/inverse3/handshake.h"
#include "tests/support/device/inverse3_service.h"

namespace relievo::inverse3 {
namespace {

using test::serverFrame;

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int each : values) text += static_cast<char>(each);
  return text;
}

struct Heard {
  Opcode kind;
  std::string payload;
  bool operator==(const Heard&) const = default;
};
void PrintTo(const Heard& heard, std::ostream* out) {
  *out << static_cast<int>(heard.kind) << " \"" << heard.payload.substr(0, 60) << '"';
}

// What a reader finds in `stream` when it comes in pieces of `piece` bytes.
struct Listener {
  std::vector<Heard> hear(const std::string& stream, std::size_t piece = 1) {
    std::vector<Heard> heard;
    for (std::size_t at = 0; at < stream.size();) {
      const auto room = reader->room();
      const std::size_t count = std::min({piece, stream.size() - at, room.size()});
      std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), count, room.begin());
      reader->received(count);
      at += count;
      while (const auto message = reader->next()) heard.push_back({message->kind, std::string(message->payload)});
    }
    return heard;
  }
  std::unique_ptr<FrameReader> reader = std::make_unique<FrameReader>();
};

// Section 5.7, but for the masked one, which no server may send.
TEST(Inverse3Frames, TheExamplesOfTheStandardAreRead) {
  const std::string hello = bytes({0x81, 0x05, 0x48, 0x65, 0x6c, 0x6c, 0x6f});
  const std::string pieces = bytes({0x01, 0x03, 0x48, 0x65, 0x6c, 0x80, 0x02, 0x6c, 0x6f});
  const std::string ping = bytes({0x89, 0x05, 0x48, 0x65, 0x6c, 0x6c, 0x6f});
  const std::string binary = bytes({0x82, 0x7E, 0x01, 0x00}) + std::string(256, 'x');
  for (const std::size_t piece : {1U, 2U, 7U, 1000U}) {
    EXPECT_EQ(Listener().hear(hello + pieces + ping + binary, piece),
              (std::vector<Heard>{{Opcode::Text, "Hello"},
                                  {Opcode::Text, "Hello"},
                                  {Opcode::Ping, "Hello"},
                                  {Opcode::Binary, std::string(256, 'x')}}))
        << piece;
  }
}

TEST(Inverse3Frames, AControlFrameMayComeBetweenThePiecesOfAMessage) {
  EXPECT_EQ(Listener().hear(serverFrame(1, "a", false) + serverFrame(9, "?") + serverFrame(0, "", false) +
                            serverFrame(0, "b")),
            (std::vector<Heard>{{Opcode::Ping, "?"}, {Opcode::Text, "ab"}}));
}

TEST(Inverse3Frames, AMessageOfAnyLengthUpToTheMostIsRead) {
  for (const std::size_t size : {0UL, 1UL, 125UL, 126UL, 127UL, 255UL, 256UL, 32767UL, 32768UL}) {
    const std::string text(size, 'j');
    Listener listener;
    for (int i = 0; i < 5; ++i) {
      EXPECT_EQ(listener.hear(serverFrame(1, text), 4099), (std::vector<Heard>{{Opcode::Text, text}})) << size;
    }
    EXPECT_FALSE(listener.reader->broken());
  }
}

// More messages come at once than are taken, and fill the reader.
TEST(Inverse3Frames, OnesThatWaitAreNotThrownAway) {
  constexpr int kMessages = 3000;
  std::string stream;
  for (int i = 0; i < kMessages; ++i) stream += serverFrame(1, std::to_string(i) + std::string(70, 'j'));
  const auto reader = std::make_unique<FrameReader>();
  bool full = false;
  std::size_t at = 0;
  for (int i = 0; i < kMessages; ++i) {
    if (i % 16 == 0) {
      const auto room = reader->room();
      const std::size_t count = std::min(room.size(), stream.size() - at);
      std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), count, room.begin());
      reader->received(count);
      at += count;
      full = full || reader->room().empty();
    }
    const auto message = reader->next();
    ASSERT_TRUE(message) << i;
    ASSERT_EQ(message->payload, std::to_string(i) + std::string(70, 'j'));
  }
  EXPECT_TRUE(full);
}

TEST(Inverse3Frames, WhatBreaksTheRulesEndsTheReading) {
  const std::string half(20000, 'x');
  const std::string breaches[] = {
      bytes({0xC1, 0x00}),                                       // a reserved bit
      bytes({0x83, 0x00}),                                       // kinds that are not defined
      bytes({0x8B, 0x00}),                                       //
      bytes({0x81, 0x85, 0x37, 0xfa, 0x21, 0x3d}),               // masked
      bytes({0x09, 0x00}),                                       // a ping in pieces
      bytes({0x89, 0x7E, 0x00, 0x7E}),                           // a long ping
      bytes({0x80, 0x00}),                                       // the rest of nothing
      bytes({0x01, 0x00, 0x81, 0x00}),                           // a message within another
      bytes({0x81, 0x7E, 0x00, 0x7D}),                           // lengths with a shorter form
      bytes({0x81, 0x7F, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF}),         //
      bytes({0x81, 0x7F, 0x80, 0, 0, 0, 0, 0, 0, 0}),            // too long
      bytes({0x81, 0x7E, 0x80, 0x01}),                           //
      serverFrame(1, half, false) + serverFrame(0, half, true),  // too long together
  };
  for (const std::string& breach : breaches) {
    Listener listener;
    EXPECT_EQ(listener.hear(serverFrame(1, "ok") + breach + serverFrame(1, "never read"), 3),
              (std::vector<Heard>{{Opcode::Text, "ok"}}))
        << testing::PrintToString(breach.substr(0, 12));
    EXPECT_TRUE(listener.reader->broken());
    EXPECT_TRUE(listener.hear(std::string(200000, '\x81'), 5000).empty()) << "whatever else comes";
    listener.reader->clear();
    EXPECT_EQ(listener.hear(serverFrame(1, "again")), (std::vector<Heard>{{Opcode::Text, "again"}}));
  }
}

// The masked "Hello" of section 5.7. Bytes of the mask as on this machine.
TEST(Inverse3Frames, AFrameIsMaskedAsTheStandardSays) {
  std::array<char, 300> out{};
  const std::uint8_t key[] = {0x37, 0xfa, 0x21, 0x3d};
  std::uint32_t mask = 0;
  std::copy(std::begin(key), std::end(key), reinterpret_cast<std::uint8_t*>(&mask));
  const std::size_t size = writeFrame(Opcode::Text, "Hello", mask, out);
  EXPECT_EQ(std::string(out.data(), size), bytes({0x81, 0x85, 0x37, 0xfa, 0x21, 0x3d, 0x7f, 0x9f, 0x4d, 0x51, 0x58}));
  EXPECT_EQ(writeFrame(Opcode::Pong, std::string(125, 'x'), mask, out), 131U);
  EXPECT_EQ(writeFrame(Opcode::Text, std::string(126, 'x'), mask, out), 134U);
  EXPECT_EQ(std::string(out.data(), 4), bytes({0x81, 0xFE, 0, 126}));
  EXPECT_EQ(writeFrame(Opcode::Text, std::string(293, 'x'), mask, out), 0U) << "301 bytes do not fit";
  EXPECT_EQ(writeFrame(Opcode::Text, std::string(292, 'x'), mask, out), 300U);
}

// Section 1.3: the key "dGhlIHNhbXBsZSBub25jZQ==" is "the sample nonce".
TEST(Inverse3Handshake, SendsAndAcceptsTheStandardsExample) {
  Nonce nonce{};
  std::copy_n("the sample nonce", nonce.size(), nonce.begin());
  EXPECT_EQ(upgradeRequest("box:10001", nonce),
            "GET / HTTP/1.1\r\nHost: box:10001\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n");
  const std::string good =
      "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n";
  EXPECT_TRUE(acceptsUpgrade(good, nonce));
  const auto with = [&](const std::string& old_text, const std::string& new_text) {
    std::string head = good;
    return head.replace(head.find(old_text), old_text.size(), new_text);
  };
  EXPECT_TRUE(acceptsUpgrade(with("Upgrade: websocket", "uPGRADE:WebSocket \t"), nonce));
  EXPECT_FALSE(acceptsUpgrade(with("101", "200"), nonce));
  EXPECT_FALSE(acceptsUpgrade(with("Upgrade: websocket", "Upgrade: h2c"), nonce));
  EXPECT_FALSE(acceptsUpgrade(with("Connection: Upgrade", "Connection: close"), nonce));
  EXPECT_FALSE(acceptsUpgrade(with("s3pP", "S3pP"), nonce)) << "the answer to another key";
  EXPECT_FALSE(acceptsUpgrade(with("\r\nSec", "\r\nSec-WebSocket-Extensions: x\r\nSec"), nonce))
      << "nobody asked for it";
  EXPECT_FALSE(acceptsUpgrade("", nonce));
  EXPECT_FALSE(acceptsUpgrade(good, Nonce{}));
}

}  // namespace
}  // namespace relievo::inverse3
