// SPDX-License-Identifier: Apache-2.0
// Writes films of the sample driver's container.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "drivers/sample/sample_film.h"
#include "platform/clock.h"

namespace relievo::test {

struct SampleClip {
  int pictures = 30, key_interval = 10;
  Duration period = std::chrono::milliseconds(40);
  int sound_packets = 0;  // of 20 ms, 440 Hz
};

// 64x48 pictures, each unlike the one before; then the sound, in 48 kHz and two channels.
inline void writeSampleClip(const std::string& path, const SampleClip& clip) {
  constexpr std::uint32_t kWidth = 64, kHeight = 48, kRate = 48000, kPacket = 960;
  std::ofstream file(path, std::ios::binary);
  const auto put = [&file](const auto& value) { file.write(reinterpret_cast<const char*>(&value), sizeof value); };
  SampleHeader header{.width = kWidth, .height = kHeight, .frame_period_ns = clip.period.count()};
  if (clip.sound_packets > 0) header.sample_rate_hz = kRate, header.channels = 2;
  std::ranges::copy(std::string("film"), header.title.begin());
  put(header);
  for (int i = 0; i < clip.pictures; ++i) {
    put(SamplePacketHeader{.pts_ns = (i * clip.period).count(),
                           .bytes = kWidth * kHeight,
                           .keyframe = static_cast<std::uint16_t>(i % clip.key_interval == 0)});
    file << std::string(kWidth * kHeight, static_cast<char>(i));
  }
  for (int i = 0; i < clip.sound_packets; ++i) {
    put(SamplePacketHeader{.pts_ns = i * 20'000'000LL, .bytes = 4 + 4 * kPacket, .stream = 1, .keyframe = 1});
    put(kPacket);
    for (std::uint32_t n = 0; n < kPacket; ++n) {
      const double s = (i * double{kPacket} + n) / kRate;
      const auto value = static_cast<std::int16_t>(std::lround(16384 * std::sin(2 * std::numbers::pi * 440 * s)));
      put(value);
      put(value);
    }
  }
}

}  // namespace relievo::test
