// SPDX-License-Identifier: Apache-2.0
// The boxes of an MP4 or QuickTime film, and how many entries FFmpeg's list of a track has.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "drivers/ffmpeg/bounds/readable.h"

namespace relievo::ffmpeg {

[[nodiscard]] constexpr std::uint32_t mp4Type(std::string_view name) noexcept {
  std::uint32_t value = 0;
  for (const char c : name) value = value << 8 | static_cast<std::uint8_t>(c);
  return value;
}
[[nodiscard]] std::uint64_t bigEndian(std::span<const std::uint8_t> bytes) noexcept;

struct Mp4Box {
  std::uint32_t type = 0;
  std::uint64_t data = 0, end = 0;

  [[nodiscard]] std::uint64_t bytes() const noexcept { return end - data; }
};
// A number of `box`, `at` bytes behind the begin of its data. 0 where there is nothing.
[[nodiscard]] std::uint64_t numberIn(const Readable& file, const Mp4Box& box, std::uint64_t at, std::size_t size = 4);

// A table of a track. `copies` counts what a damaged film has more than once.
struct Mp4Table {
  Mp4Box box;
  int copies = 0;

  void note(const Mp4Box& found) noexcept {
    box = found;
    ++copies;
  }
};

struct Mp4Track {
  std::uint64_t samples = 0, chunks = 0;
  std::uint64_t piece = 1024;                 // samples of sound that FFmpeg takes together
  std::uint64_t shows = 0;                    // edits, also those that show nothing
  std::uint64_t per_second = 0;               // ticks of its times
  Mp4Table edits, times, keys, shifts, runs;  // elst, stts, stss, ctts; stsc: of chunks with as many samples
  bool picture = false, sound = false, ticks = false;

  // FFmpeg then takes pieces of chunks: of sound that is not coded.
  [[nodiscard]] bool isInChunks() const noexcept { return sound && !picture && ticks; }
};

// How many entries FFmpeg's list of `track` has, which for a film with several edits it makes of what each of them
// shows, from the key frame before it until the second one behind it. Where tables are damaged or long, as many as
// there may be. `per_second`: ticks of the film's edits. Reads at most `budget` bytes, which it lessens; nullopt if
// that is not enough for the sound. No more than about 2 * `most` are counted.
[[nodiscard]] std::optional<std::uint64_t> entriesOf(const Readable& file, const Mp4Track& track,
                                                     std::uint64_t per_second, std::uint64_t most,
                                                     std::uint64_t& budget);

}  // namespace relievo::ffmpeg
