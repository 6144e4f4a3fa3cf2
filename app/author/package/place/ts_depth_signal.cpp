// SPDX-License-Identifier: Apache-2.0
// Edits the programme map, ISO/IEC 13818-1, 2.4.4.8.
#include "app/author/package/place/ts_depth_signal.h"

#include <algorithm>
#include <array>

namespace relievo {
namespace {

constexpr std::uint8_t kAuxiliaryVideo = 0x1e;
constexpr std::size_t kHeader = 3, kChecksum = 4;  // bytes of a section up to its length, and after its content

// Auxiliary_video_stream_descriptor (2.6.74): the coding, then one message of ISO/IEC 23002-3: depth, of whole
// pictures, not shifted, from 2/16 of the picture's width behind the screen to 8/64 in front of it. The exact
// calibration is in the stream (hal/media/stream_tags.h).
constexpr std::array<std::uint8_t, 10> descriptorFor(std::uint8_t coding) {
  return {0x2f, 8, coding, 0 /* depth */, 5, 0x3f, 0, 0, 2, 8};
}

std::size_t word(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::size_t>(bytes[at]) << 8 | bytes[at + 1];
}

// A length is the lower twelve bits of a word.
std::size_t length(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return word(bytes, at) & 0xfff;
}
void addLength(std::span<std::uint8_t> bytes, std::size_t at, std::size_t more) noexcept {
  const std::size_t changed = word(bytes, at) + more;
  bytes[at] = static_cast<std::uint8_t>(changed >> 8);
  bytes[at + 1] = static_cast<std::uint8_t>(changed);
}

}  // namespace

std::uint32_t mpegChecksum(std::span<const std::uint8_t> bytes) noexcept {
  std::uint32_t sum = 0xffffffff;
  for (const std::uint8_t byte : bytes) {
    sum ^= static_cast<std::uint32_t>(byte) << 24;
    for (int bit = 0; bit < 8; ++bit) sum = (sum << 1) ^ ((sum & 0x80000000) != 0 ? 0x04c11db7 : 0);
  }
  return sum;
}

void TsDepthSignal::rewrite(std::span<std::uint8_t> packets) const noexcept {
  for (; packets.size() >= kPacket; packets = packets.subspan(kPacket)) {
    const auto packet = packets.first(kPacket);
    const bool begins = (packet[1] & 0x40) != 0;
    if (!begins || (word(packet, 1) & 0x1fff) != kMapPid) continue;
    const std::size_t payload = 4 + ((packet[3] & 0x20) != 0 ? 1u + packet[4] : 0u);
    const std::size_t section = payload + 1 + packet[payload];  // after the pointer field
    if (section + kHeader < kPacket) rewriteMap(packet.subspan(section));
  }
}

void TsDepthSignal::rewriteMap(std::span<std::uint8_t> section) const noexcept {
  const auto descriptor = descriptorFor(coding_);
  const std::size_t end = kHeader + length(section, 1) - kChecksum;  // end of the list of streams
  if (end + kChecksum + descriptor.size() > section.size()) return;
  std::size_t stream = 12 + length(section, 10);
  while (stream + 5 <= end && (word(section, stream + 1) & 0x1fff) != kDepthPid)
    stream += 5 + length(section, stream + 3);
  if (stream + 5 > end) return;
  section[stream] = kAuxiliaryVideo;
  const auto place = section.begin() + static_cast<std::ptrdiff_t>(stream + 5);
  const auto last = section.begin() + static_cast<std::ptrdiff_t>(end);
  std::move_backward(place, last, last + descriptor.size());
  std::copy(descriptor.begin(), descriptor.end(), place);
  addLength(section, stream + 3, descriptor.size());
  addLength(section, 1, descriptor.size());
  const std::size_t at = end + descriptor.size();
  const std::uint32_t sum = mpegChecksum(section.first(at));
  for (std::size_t i = 0; i < kChecksum; ++i) section[at + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
}

}  // namespace relievo
