// SPDX-License-Identifier: Apache-2.0
// Lets a transport stream out at its own pace, as a broadcaster does.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "platform/clock.h"

namespace relievo {

// Packets go out evenly between the times of the programme's clock references around them, seven to a datagram. One
// that comes too late goes out at once.
class TsPacer {
 public:
  static constexpr std::size_t kPacket = 188, kDatagram = 7 * kPacket;
  using Send = std::function<bool(std::span<const std::uint8_t>)>;  // false: it cannot

  // `clock` outlives it.
  TsPacer(Clock& clock, Send send) : clock_(clock), send_(std::move(send)) {}
  // Whole packets. Waits until all before the last reference among them are out.
  [[nodiscard]] bool add(std::span<const std::uint8_t> packets);
  // What is left.
  [[nodiscard]] bool finish();
  [[nodiscard]] Duration latest() const noexcept { return latest_; }
  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }

 private:
  [[nodiscard]] bool letOut(Duration until);

  Clock& clock_;
  Send send_;
  std::vector<std::uint8_t> waiting_;
  std::optional<MonotonicTime> start_;  // of reference 0
  Duration last_{0};                    // reference
  Duration latest_{0};
  std::uint64_t sent_ = 0;
};

}  // namespace relievo
