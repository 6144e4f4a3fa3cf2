// SPDX-License-Identifier: Apache-2.0
// The requests of an FT232B (FTDI's SIO protocol) and the boot loader's protocol, after libnifalcon (BSD licence).
#include "drivers/falcon/link.h"

#include <algorithm>
#include <array>

#include "drivers/falcon/packet.h"

namespace relievo::falcon {
namespace {

using namespace std::chrono_literals;

constexpr Duration kAnswer = 20ms;  // time-out of one read
constexpr Duration kEcho = 100ms;   // for 62 bytes: 4 ms on the line and the latency timer's 16

struct Request {
  std::uint8_t request;
  std::uint16_t value;
};
constexpr Request kEmptyIncoming{0, 1}, kEmptyOutgoing{0, 2};
constexpr Request kRtsLow{1, 0x0200}, kDtrLow{1, 0x0100}, kDtrHigh{1, 0x0101};
constexpr Request kNoFlowControl{2, 0}, k8N1{4, 0x0008};
constexpr Request k9600Baud{3, 0x4138}, k143KiloBaud{3, 0x0015}, k1500KiloBaud{3, 0x0002};
constexpr Request kLatency16Ms{9, 16}, kLatency1Ms{9, 1};

Result<void> ask(UsbPort& port, std::initializer_list<Request> requests) {
  for (const Request& each : requests) {
    if (auto done = port.control(each.request, each.value); !done) return done;
  }
  return {};
}

// Reads until `most` bytes are there or none has come for `wait`. No bytes at all is no failure.
Result<std::vector<std::uint8_t>> gather(UsbPort& port, std::size_t most, Duration wait, const Patience& patience) {
  std::vector<std::uint8_t> bytes;
  MonotonicTime news = patience.clock.now();
  while (patience.clock.now() - news < wait && bytes.size() < most) {
    if (patience.cancelled) return fail(ErrorCode::Cancelled, "opening the Falcon was cancelled");
    const auto packet = port.receive(kAnswer);
    if (!packet && packet.error().code != ErrorCode::Timeout) return std::unexpected(packet.error());
    // The bridge sends its two status bytes whenever its latency timer expires; only a payload resets the wait.
    const UsbBytes payload = packet ? payloadOf(*packet) : UsbBytes();
    if (!payload.empty()) news = patience.clock.now();
    bytes.insert(bytes.end(), payload.begin(), payload.end());
  }
  return bytes;
}

bool endsWith(UsbBytes bytes, UsbBytes wanted) {
  return bytes.size() >= wanted.size() && std::ranges::equal(bytes.last(wanted.size()), wanted);
}

// The boot loader's answer may have a zero byte before it.
Result<void> greet(UsbPort& port, const Patience& patience) {
  constexpr std::array<std::uint8_t, 3> kHello{0x0A, 0x43, 0x0D};
  constexpr std::array<std::uint8_t, 4> kWelcome{0x0A, 0x44, 0x2C, 0x0D};
  constexpr int kGreetings = 20;
  for (int i = 0; i < kGreetings; ++i) {
    if (auto sent = port.send(kHello, kEcho); !sent) return sent;
    const auto answer = gather(port, kWelcome.size() + 1, 3 * kAnswer, patience);
    if (!answer) return std::unexpected(answer.error());
    if (endsWith(*answer, kWelcome)) return {};
  }
  return fail(ErrorCode::Timeout,
              "the Falcon's boot loader does not answer; check its power adaptor and plug it in again");
}

Result<void> sendEchoed(UsbPort& port, UsbBytes bytes, const Patience& patience) {
  if (auto sent = port.send(bytes, kEcho); !sent) return sent;
  const auto echo = gather(port, bytes.size(), kEcho, patience);
  if (!echo) return std::unexpected(echo.error());
  if (echo->size() < bytes.size())
    return fail(ErrorCode::Timeout, "the Falcon's boot loader stopped echoing; plug it in again");
  if (!std::ranges::equal(*echo, bytes))
    return fail(ErrorCode::Corrupt, "the Falcon's boot loader echoed wrong bytes; plug it in again");
  return {};
}

// Slow line, for the boot loader: 9600 baud, 8N1, DTR raised, latency timer 16 ms (with 1 ms its checks fail).
Result<void> setBootMode(UsbPort& port) {
  return ask(port, {kEmptyIncoming, kEmptyOutgoing, kLatency16Ms, k9600Baud, k8N1, kNoFlowControl, kRtsLow, kDtrLow,
                    kDtrHigh});
}

// Fast line, for the firmware: 1.5 MBd, latency timer 1 ms, both directions emptied.
Result<void> setRunMode(UsbPort& port) {
  return ask(port, {kLatency1Ms, k1500KiloBaud, kEmptyIncoming, kEmptyOutgoing});
}

}  // namespace

UsbBytes payloadOf(const UsbPacket& packet) RELIEVO_RT {
  if (packet.bytes <= kStatusBytes || (packet.data[1] & kLineErrors) != 0) return {};
  return packet.view().subspan(kStatusBytes);
}

Result<bool> firmwareAnswers(UsbPort& port, const Patience& patience) {
  if (auto ready = setRunMode(port); !ready) return std::unexpected(ready.error());
  for (int i = 0; i < 3; ++i) {
    if (auto sent = port.send(encode(Command{}), kAnswer); !sent) {
      if (sent.error().code == ErrorCode::Timeout) continue;
      return std::unexpected(sent.error());
    }
    const auto answer = gather(port, kPacketBytes, kAnswer, patience);
    if (!answer) return std::unexpected(answer.error());
    PacketStream stream;
    stream.add(*answer);
    if (stream.next()) return true;
  }
  return false;
}

Result<void> loadFirmware(UsbPort& port, const std::vector<std::uint8_t>& image, const Patience& patience) {
  constexpr std::array<std::uint8_t, 1> kBegin{0x41};
  if (auto ready = setBootMode(port); !ready) return ready;
  if (auto greeted = greet(port, patience); !greeted) return greeted;
  if (auto fast = ask(port, {kDtrLow, k143KiloBaud}); !fast) return fast;
  if (auto begun = sendEchoed(port, kBegin, patience); !begun) return begun;
  for (std::size_t at = 0; at < image.size(); at += kMostPayload) {
    const std::size_t bytes = std::min(kMostPayload, image.size() - at);
    if (auto sent = sendEchoed(port, UsbBytes(image).subspan(at, bytes), patience); !sent) return sent;
  }
  return setRunMode(port);
}

}  // namespace relievo::falcon
