// SPDX-License-Identifier: Apache-2.0
// The complete drivers of the Falcon and the Polhem, on a device that answers anything, with calls in any order: the
// position is finite, no command exceeds the limit, and the motors are off after a stop, a close or a loss.
#include <cmath>
#include <glm/geometric.hpp>

#include "drivers/falcon/falcon.h"
#include "drivers/falcon/link.h"
#include "drivers/falcon/packet.h"
#include "drivers/polhem/polhem.h"
#include "drivers/polhem/report.h"
#include "tests/fuzz/fuzz_port.h"

namespace relievo {
namespace {

using test::FuzzPort;
using test::require;
using State = HapticDevice::State;

void live(FuzzedDataProvider& data, ManualClock& clock, FuzzPort& port, HapticDevice& device, const bool& pushes) {
  port.on_many_verbs = [&device] { device.cancel(); };
  while (data.remaining_bytes() > 0) {
    if (device.state() == State::Closed) (void)device.open();
    else if (device.state() == State::Opened) (void)device.home();
    else if (device.state() == State::Ready) (void)device.start();
    for (int i = data.ConsumeIntegralInRange(0, 40); i > 0 && device.state() == State::Running; --i) {
      clock.advance(std::chrono::microseconds(data.ConsumeIntegralInRange(0, 3000)));
      const auto sample = device.read();
      require(!sample || glm::length(sample->position_mm) < 1500, "the finger is somewhere");
      (void)device.write({data.ConsumeFloatingPointInRange(-6.0, 6.0), data.ConsumeFloatingPointInRange(-6.0, 6.0), 1});
    }
    const int verb = data.ConsumeIntegralInRange(0, 7);
    if (verb == 0) device.stop();
    if (verb == 1 || device.state() == State::Lost) device.close();
    require(!pushes || device.state() == State::Running, "there is no force but while it runs");
    require(port.exchanging() == (device.state() == State::Running), "an exchange goes on while it runs");
  }
  device.close();
  require(!port.exchanging() && !pushes, "closed is without force");
}

// Homed; the grip moves a little.
std::optional<UsbPacket> falconAnswer(UsbBytes sent, int& tick) {
  if (sent.size() != falcon::kPacketBytes) return std::nullopt;
  const auto step = static_cast<std::int16_t>(20 * std::sin(0.01 * ++tick));
  const auto bytes = falcon::encode(falcon::Reply{.encoders = {step, step, step}, .homed = 7});
  UsbPacket packet;
  packet.data = {0x01, 0x60};
  std::copy(bytes.begin(), bytes.end(), packet.data.begin() + falcon::kStatusBytes);
  packet.bytes = falcon::kStatusBytes + bytes.size();
  return packet;
}

void fuzzFalcon(FuzzedDataProvider& data) {
  ManualClock clock;
  int tick = 0;
  auto port = std::make_unique<FuzzPort>(data, clock, [&tick](UsbBytes sent) { return falconAnswer(sent, tick); });
  FuzzPort& fuzz_port = *port;
  bool pushes = false;
  fuzz_port.on_sent = [&pushes](UsbBytes bytes) {
    require(bytes.size() == falcon::kPacketBytes, "a command is a packet");
    const auto command = falcon::decodeCommand(std::span<const std::uint8_t, falcon::kPacketBytes>(bytes));
    require(command.has_value(), "a command can be read");
    for (const int word : command->motors) require(std::abs(word) <= falcon::kMostWord, "no word is beyond the limit");
    pushes = command->motors != falcon::Words{};
  };
  const auto device = makeFalcon({.watchdog_thread = false}, std::move(port), clock);
  live(data, clock, fuzz_port, *device, pushes);
}

void fuzzPolhem(FuzzedDataProvider& data) {
  ManualClock clock;
  int tick = 0;
  const std::size_t report_bytes = data.ConsumeBool() ? polhem::kReportBytes : polhem::kPaddedBytes;
  polhem::Description arm = polhem::kWoodenHaptics2019;
  arm.max_milliamps = data.ConsumeIntegralInRange(10, 3000);
  const auto answer = [&](UsbBytes sent) -> std::optional<UsbPacket> {
    (void)sent;
    const auto step = static_cast<std::int16_t>(2 * std::sin(0.01 * ++tick));
    UsbPacket packet;
    packet.data = polhem::encode(polhem::Report{.arm = {step, step, step}});
    packet.bytes = report_bytes;
    return packet;
  };
  auto port = std::make_unique<FuzzPort>(data, clock, answer);
  FuzzPort& fuzz_port = *port;
  bool pushes = false;
  fuzz_port.on_sent = [&](UsbBytes bytes) {
    const auto command = polhem::decodeCommand(bytes, bytes.size());
    require(command && (bytes.size() == polhem::kReportBytes || bytes.size() == polhem::kPaddedBytes),
            "a command is a report");
    for (const int each : command->motors)
      require(std::abs(each) <= arm.max_milliamps, "no current is beyond the limit");
    pushes = command->motors != polhem::Milliamps{};
    const polhem::PaddedReport again = polhem::encode(*command);
    require(std::equal(bytes.begin(), bytes.end(), again.begin()), "a command is its bytes");
  };
  const auto device = makePolhem({.description = arm, .watchdog_thread = false}, std::move(port), clock);
  live(data, clock, fuzz_port, *device, pushes);
}

void fuzzReports(FuzzedDataProvider& data) {
  const auto bytes = data.ConsumeBytes<std::uint8_t>(data.ConsumeIntegralInRange<std::size_t>(0, 80));
  for (const std::size_t length : {polhem::kReportBytes, polhem::kPaddedBytes}) {
    const auto report = polhem::decodeReport(bytes, length);
    require(report.has_value() == (bytes.size() == length), "a report has its length");
    if (!report) continue;
    const polhem::PaddedReport again = polhem::encode(*report);
    require(std::equal(bytes.begin(), bytes.begin() + polhem::kReportBytes, again.begin()), "a report is its bytes");
  }
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  relievo::fuzzReports(data);
  if (data.ConsumeBool()) relievo::fuzzFalcon(data);
  else relievo::fuzzPolhem(data);
  return 0;
}
