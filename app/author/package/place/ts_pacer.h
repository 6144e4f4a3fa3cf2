// SPDX-License-Identifier: Apache-2.0
// Sends a transport stream in real time, as a broadcaster does.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "platform/clock.h"

namespace relievo {

// Packets are spaced evenly between the programme clock references around them, seven to a datagram. A late packet is
// sent at once.
class TsPacer {
 public:
  static constexpr std::size_t kPacket = 188, kDatagram = 7 * kPacket;
  using Send = std::function<bool(std::span<const std::uint8_t>)>;  // false on failure

  // `clock` must outlive it.
  TsPacer(Clock& clock, Send send) : clock_(clock), send_(std::move(send)) {}
  // Takes whole packets. Blocks until all packets before the last reference among them are sent.
  [[nodiscard]] bool add(std::span<const std::uint8_t> packets);
  // Sends the rest.
  [[nodiscard]] bool finish();
  [[nodiscard]] Duration latest() const noexcept { return latest_; }

 private:
  [[nodiscard]] bool letOut(Duration until);

  Clock& clock_;
  Send send_;
  std::vector<std::uint8_t> waiting_;
  std::optional<MonotonicTime> start_;  // the time of reference 0
  Duration last_{0};                    // the last reference, with its laps
  Duration laps_{0};                    // of the counter before it
  Duration latest_{0};
};

}  // namespace relievo
