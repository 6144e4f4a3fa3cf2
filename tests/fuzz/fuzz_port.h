// SPDX-License-Identifier: Apache-2.0
// A USB port whose device answers correctly, wrongly or not at all, as the fuzzer's bytes decide.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/usb/usb_port.h"

namespace relievo::test {

// Aborts if a property does not hold, so that the fuzzer keeps the input.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

class FuzzPort final : public UsbPort {
 public:
  // `honest` returns a correct device's answer to these bytes, or nullopt for none.
  using Honest = std::function<std::optional<UsbPacket>(UsbBytes sent)>;
  FuzzPort(FuzzedDataProvider& data, ManualClock& clock, Honest honest)
      : data_(data), clock_(clock), honest_(std::move(honest)), stubborn_(data.ConsumeBool()) {}

  std::function<void(UsbBytes)> on_sent = [](UsbBytes) {};
  // called after many calls and repeatedly from then on, to interrupt a wait
  std::function<void()> on_many_verbs = [] {};

  Result<void> open() override { return count(), trouble(); }
  void close() noexcept override { exchanging_ = false; }
  Result<void> control(std::uint8_t, std::uint16_t) override { return count(), trouble(); }
  Result<void> send(UsbBytes bytes, Duration timeout) override {
    count();
    take(bytes);
    if (auto bad = trouble(); !bad) return bad;
    if (data_.ConsumeIntegralInRange(0, 30) != 1) return {};
    clock_.advance(timeout);
    return fail(ErrorCode::Timeout, "the fuzzer's device is busy");
  }
  Result<UsbPacket> receive(Duration timeout) override {
    clock_.advance(std::chrono::microseconds(100));  // no packet comes sooner
    if (const auto packet = answer(); !packet || packet->bytes > 0) return packet;
    clock_.advance(timeout);
    return fail(ErrorCode::Timeout, "the fuzzer's device has nothing to say");
  }
  Result<void> startExchange(UsbBytes quiet) override {
    count();
    if (auto bad = trouble(); !bad) return bad;
    quiet_.assign(quiet.begin(), quiet.end());
    exchanging_ = true;
    return {};
  }
  Result<UsbPacket> take() RELIEVO_RT override { return answer(); }
  Result<bool> post(UsbBytes bytes) RELIEVO_RT override {
    count();
    if (auto bad = trouble(); !bad) return std::unexpected(bad.error());
    if (data_.ConsumeIntegralInRange(0, 30) == 1) return false;
    take(bytes);
    return true;
  }
  void stopExchange() noexcept override { exchanging_ = false; }
  bool quieten() noexcept override {
    require(exchanging_, "the motors are stopped while there is an exchange");
    on_sent(quiet_);
    return true;
  }

  [[nodiscard]] bool exchanging() const { return exchanging_; }

 private:
  void count() {
    constexpr int kMany = 5000;
    if (++verbs_ % kMany == 0) on_many_verbs();
    require(verbs_ < 10 * kMany, "a driver ends what it does");
  }
  void take(UsbBytes bytes) {
    on_sent(bytes);
    pending_ = honest_(bytes);
  }
  Result<void> trouble() {
    const int what = data_.remaining_bytes() > 0 ? data_.ConsumeIntegralInRange(0, 255) : 255;
    if (what == 0) return fail(ErrorCode::Lost, "the fuzzer's device has gone");
    if (what == 1) return fail(ErrorCode::Io, "the fuzzer's bus is noisy");
    return {};
  }
  // When the bytes run out, a stubborn device repeats its last answer.
  Result<UsbPacket> answer() {
    count();
    if (auto bad = trouble(); !bad) return std::unexpected(bad.error());
    if (data_.remaining_bytes() == 0) return stubborn_ ? said_ : UsbPacket{};
    UsbPacket packet;
    switch (data_.ConsumeIntegralInRange(0, 7)) {
      case 0:
        break;
      case 1:
        packet.bytes = data_.ConsumeData(packet.data.data(), data_.ConsumeIntegralInRange<std::size_t>(0, 64));
        break;
      case 2:  // the right answer with one byte changed, or too short
        packet = std::exchange(pending_, std::nullopt).value_or(UsbPacket{});
        packet.data[data_.ConsumeIntegralInRange<std::size_t>(0, 63)] = data_.ConsumeIntegral<std::uint8_t>();
        packet.bytes = std::min(packet.bytes, data_.ConsumeIntegralInRange<std::size_t>(0, 64));
        break;
      default:
        packet = std::exchange(pending_, std::nullopt).value_or(UsbPacket{});
    }
    if (packet.bytes > 0) said_ = packet;
    return packet;
  }

  FuzzedDataProvider& data_;
  ManualClock& clock_;
  Honest honest_;
  bool stubborn_;
  bool exchanging_ = false;
  int verbs_ = 0;
  std::vector<std::uint8_t> quiet_;
  std::optional<UsbPacket> pending_;
  UsbPacket said_;
};

}  // namespace relievo::test
