// SPDX-License-Identifier: Apache-2.0
// The reports that the host and a Polhem or WoodenHaptics board exchange: seven little-endian 16-bit words each way.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/force/encoder_gate.h"
#include "drivers/usb/usb_port.h"
#include "platform/realtime.h"

namespace relievo::polhem {

// Two boards use this over HID, without report numbers: an LPC1768 with its toolkit's default id, whose packets are
// exactly the report and which ignores packets of any other length; and a Teensy with the default id of raw HID
// sketches, whose packets are padded to 64 bytes. (After the published host library and the tables of both toolkits.)
inline constexpr UsbDeviceId kMbedId{
    .vendor = 0x1234, .product = 0x0006, .in_endpoint = 0x81, .out_endpoint = 0x01, .interrupt = true};
inline constexpr UsbDeviceId kTeensyId{
    .vendor = 0x16C0, .product = 0x0486, .in_endpoint = 0x83, .out_endpoint = 0x04, .interrupt = true};

inline constexpr std::size_t kReportBytes = 14;
inline constexpr std::size_t kPaddedBytes = kUsbPacketBytes;
using PaddedReport = std::array<std::uint8_t, kPaddedBytes>;  // the report, then zeros

// To the host: the encoders of the arm's three motors and of the grip's three joints. The board answers every command
// with one report; after power-up one more is ready to be read.
struct Report {
  EncoderCounts arm{};
  EncoderCounts grip{};   // the first also carries the button: see `button`
  std::int16_t info = 0;  // 1: the board's own button was pressed since the last Calibrate
  // Newer boards add 10000 to the first joint's count while the grip's button is down.
  [[nodiscard]] bool button() const RELIEVO_RT { return grip[0] > 5000; }
};

// To the device: currents in mA, which flow until the next command, for 0.5 s at most.
using Milliamps = std::array<std::int16_t, 3>;
enum class Verb : std::int16_t { Drive = 0, Calibrate = 1 };
struct Command {
  Milliamps motors{};  // Calibrate: the counts of the grip's joints
  Verb verb = Verb::Drive;
  EncoderCounts counts{};  // Calibrate: what the arm's encoders show from now on
};

[[nodiscard]] PaddedReport encode(const Command& command) RELIEVO_RT;
[[nodiscard]] PaddedReport encode(const Report& report) RELIEVO_RT;  // the device's side
// nullopt unless `bytes` has the length of the board's reports, `report_bytes`: kReportBytes or kPaddedBytes.
[[nodiscard]] std::optional<Report> decodeReport(UsbBytes bytes, std::size_t report_bytes) RELIEVO_RT;
[[nodiscard]] std::optional<Command> decodeCommand(UsbBytes bytes, std::size_t report_bytes) RELIEVO_RT;

}  // namespace relievo::polhem
