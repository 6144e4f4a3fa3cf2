// SPDX-License-Identifier: Apache-2.0
// Encodes words as bytes and decodes them.
#include "drivers/polhem/report.h"

namespace relievo::polhem {
namespace {

using Words = std::array<std::int16_t, kReportBytes / 2>;

PaddedReport bytesOf(const Words& words) RELIEVO_RT {
  PaddedReport bytes{};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const unsigned bits = static_cast<std::uint16_t>(words[i]);
    bytes[2 * i] = static_cast<std::uint8_t>(bits & 0xFFU);
    bytes[2 * i + 1] = static_cast<std::uint8_t>(bits >> 8U);
  }
  return bytes;
}

std::optional<Words> wordsOf(UsbBytes bytes, std::size_t report_bytes) RELIEVO_RT {
  if (bytes.size() != report_bytes || bytes.size() < kReportBytes) return std::nullopt;
  Words words{};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const unsigned bits = bytes[2 * i] | static_cast<unsigned>(bytes[2 * i + 1]) << 8U;
    words[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
  }
  return words;
}

}  // namespace

PaddedReport encode(const Command& command) RELIEVO_RT {
  const auto& [a, b, c] = command.motors;
  const auto& [x, y, z] = command.counts;
  return bytesOf({a, b, c, static_cast<std::int16_t>(command.verb), x, y, z});
}

PaddedReport encode(const Report& report) RELIEVO_RT {
  const auto& [a, b, c] = report.arm;
  const auto& [d, e, f] = report.grip;
  return bytesOf({a, b, c, d, e, f, report.info});
}

std::optional<Report> decodeReport(UsbBytes bytes, std::size_t report_bytes) RELIEVO_RT {
  const auto words = wordsOf(bytes, report_bytes);
  if (!words) return std::nullopt;
  const Words& w = *words;
  return Report{.arm = {w[0], w[1], w[2]}, .grip = {w[3], w[4], w[5]}, .info = w[6]};
}

std::optional<Command> decodeCommand(UsbBytes bytes, std::size_t report_bytes) RELIEVO_RT {
  const auto words = wordsOf(bytes, report_bytes);
  if (!words) return std::nullopt;
  const Words& w = *words;
  return Command{.motors = {w[0], w[1], w[2]}, .verb = static_cast<Verb>(w[3]), .counts = {w[4], w[5], w[6]}};
}

}  // namespace relievo::polhem
