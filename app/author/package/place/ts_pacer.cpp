// SPDX-License-Identifier: Apache-2.0
// Reads programme clock references, ISO/IEC 13818-1, 2.4.3.5.
#include "app/author/package/place/ts_pacer.h"

#include <algorithm>

namespace relievo {
namespace {

// References count 33 bits of 90 kHz and begin again after 26.5 hours.
constexpr Duration kLap{(std::int64_t{1} << 33) * 1'000'000 / 90};

std::optional<Duration> referenceIn(std::span<const std::uint8_t> packet) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<std::int64_t>(packet[i]); };
  if ((byte(3) & 0x20) == 0 || byte(4) < 7 || (byte(5) & 0x10) == 0) return std::nullopt;
  const std::int64_t base = byte(6) << 25 | byte(7) << 17 | byte(8) << 9 | byte(9) << 1 | byte(10) >> 7;
  return Duration(base * 1'000'000 / 90 + ((byte(10) & 1) << 8 | byte(11)) * 1000 / 27);
}

}  // namespace

bool TsPacer::add(std::span<const std::uint8_t> packets) {
  for (; packets.size() >= kPacket; packets = packets.subspan(kPacket)) {
    const auto packet = packets.first(kPacket);
    if (auto reference = referenceIn(packet)) {
      if (!start_) {
        start_ = clock_.now() - *reference;
        last_ = *reference;
      }
      *reference += laps_;
      if (*reference < last_ - kLap / 2) {
        *reference += kLap;
        laps_ += kLap;
      }
      if (!letOut(*reference)) return false;
    }
    waiting_.insert(waiting_.end(), packet.begin(), packet.end());
  }
  return true;
}

bool TsPacer::finish() {
  return letOut(last_);
}

bool TsPacer::letOut(Duration until) {
  const Duration span = std::max(until - last_, Duration(0));
  const auto all = static_cast<std::int64_t>(waiting_.size());
  for (std::size_t at = 0; at < waiting_.size(); at += kDatagram) {
    const MonotonicTime due = start_.value_or(clock_.now()) + last_ + span * static_cast<std::int64_t>(at) / all;
    latest_ = std::max(latest_, clock_.now() - due);
    clock_.sleepUntil(due);
    const auto datagram = std::span(waiting_).subspan(at, std::min(kDatagram, waiting_.size() - at));
    if (!send_(datagram)) return false;
  }
  waiting_.clear();
  last_ = std::max(last_, until);
  return true;
}

}  // namespace relievo
