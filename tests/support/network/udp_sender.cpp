// SPDX-License-Identifier: Apache-2.0
// Sends on one thread with one random generator, so that the same seed gives the same faults.
#include "tests/support/network/udp_sender.h"

#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "tests/support/network/loopback.h"

namespace relievo::test {
namespace {

constexpr std::size_t kPacket = 188;

// The programme clock reference of the packet at `at`, if it has one (ISO/IEC 13818-1, 2.4.3.5).
std::optional<Duration> clockReference(const std::string& ts, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::int64_t>(static_cast<std::uint8_t>(ts[at + i])); };
  if ((byte(3) & 0x20) == 0 || byte(4) < 7 || (byte(5) & 0x10) == 0) return std::nullopt;
  const std::int64_t base = byte(6) << 25 | byte(7) << 17 | byte(8) << 9 | byte(9) << 1 | byte(10) >> 7;
  return Duration(base * 1'000'000 / 90 + ((byte(10) & 1) << 8 | byte(11)) * 1000 / 27);
}

// Each packet's sending time, interpolated between clock references.
std::vector<Duration> scheduleOf(const std::string& ts) {
  std::vector<Duration> due(ts.size() / kPacket, Duration(0));
  std::size_t last = 0;
  Duration last_time{0};
  std::optional<Duration> first;
  for (std::size_t i = 0; i < due.size(); ++i) {
    const auto reference = clockReference(ts, i * kPacket);
    if (!reference) {
      due[i] = last_time;  // packets after the last reference
      continue;
    }
    if (!first) first = reference;
    const Duration time = *reference - *first;
    for (std::size_t k = last; k < i; ++k) due[k] = last_time + (time - last_time) * (k - last) / (i - last);
    due[i] = last_time = time;
    last = i;
  }
  return due;
}

// A free port, for the reader to bind.
std::uint16_t freePort() {
  return portOf(bindLoopback(SOCK_DGRAM));
}

}  // namespace

UdpSender::UdpSender(const std::string& ts_path, const Line& line)
    : port_(freePort()), socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  std::ifstream file(ts_path, std::ios::binary);
  std::string stream(std::istreambuf_iterator<char>(file), {});
  thread_ = std::thread([this, stream = std::move(stream), line] { send(stream, line); });
}

UdpSender::~UdpSender() {
  ending_ = true;
  thread_.join();
}

std::string UdpSender::url() const {
  return "udp://127.0.0.1:" + std::to_string(port_);
}

void UdpSender::send(const std::string& stream, const Line& line) {
  MonotonicClock clock;
  std::mt19937 random(line.seed);
  const auto happens = [&](double share) { return std::uniform_real_distribution<double>(0, 1)(random) < share; };
  const sockaddr_in to = loopback(port_);
  const auto deliver = [&](const std::string& datagram) {
    ::sendto(socket_.get(), datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  };
  const MonotonicTime start = clock.now();
  silence_over_ = start + line.silent_at + line.silent_for;
  std::string held;  // sent after the next packet
  const std::vector<Duration> schedule = scheduleOf(stream);
  for (std::size_t i = 0; i < schedule.size() && !ending_; ++i) {
    const Duration due = schedule[i];
    clock.sleepUntil(start + due);
    ++sent_;
    const bool silent = due >= line.silent_at && due < line.silent_at + line.silent_for;
    if (silent || happens(line.lost)) {
      ++lost_;
      continue;
    }
    std::string datagram = stream.substr(i * kPacket, kPacket);
    if (held.empty() && happens(line.mixed_up)) {
      held = std::move(datagram);
      continue;
    }
    deliver(datagram);
    if (happens(line.doubled)) deliver(datagram);
    if (!held.empty()) deliver(std::exchange(held, {}));
  }
}

}  // namespace relievo::test
