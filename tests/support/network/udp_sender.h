// SPDX-License-Identifier: Apache-2.0
// Sends a transport stream like a broadcaster, over a line that loses, duplicates and reorders packets.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "platform/clock.h"
#include "platform/unique_fd.h"

namespace relievo::test {

// The line's faults; the same for the same seed.
struct Line {
  double lost = 0;                       // share
  double doubled = 0;                    // share
  double mixed_up = 0;                   // share: sent after the next packet
  Duration silent_at{0}, silent_for{0};  // an outage
  unsigned seed = 1;
};

// Sends the file once, from construction on, in time with its clock references, with one packet per datagram.
class UdpSender {
 public:
  UdpSender(const std::string& ts_path, const Line& line);
  ~UdpSender();
  [[nodiscard]] std::string url() const;
  [[nodiscard]] std::uint64_t sent() const { return sent_; }  // packets, including lost ones
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] MonotonicTime silenceOver() const { return silence_over_; }

 private:
  void send(const std::string& stream, const Line& line);

  std::uint16_t port_ = 0;
  UniqueFd socket_;
  std::atomic<bool> ending_{false};
  std::atomic<std::uint64_t> sent_{0}, lost_{0};
  std::atomic<MonotonicTime> silence_over_{MonotonicTime{}};
  std::thread thread_;
};

}  // namespace relievo::test
