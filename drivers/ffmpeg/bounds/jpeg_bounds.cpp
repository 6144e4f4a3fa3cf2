// SPDX-License-Identifier: Apache-2.0
// Markers of ITU-T T.81, annex B, as FFmpeg finds them.
#include "drivers/ffmpeg/bounds/jpeg_bounds.h"

#include <algorithm>
#include <array>
#include <optional>

namespace relievo::ffmpeg {
namespace {

constexpr std::uint8_t kMark = 0xFF, kStartOfImage = 0xD8, kEndOfImage = 0xD9, kStartOfScan = 0xDA, kTables = 0xDB;
constexpr int kMostFields = 2;

class Markers {
 public:
  explicit Markers(const Readable& bytes) : bytes_(bytes) {}

  // Those without a meaning, in the data of a scan, are passed over.
  std::optional<std::uint8_t> next() {
    for (;;) {
      at_ = std::find(at_, end_, kMark);
      if (at_ == end_ && !fill()) return std::nullopt;
      if (*at_ != kMark) continue;
      std::optional<std::uint8_t> code = kMark;
      while (code == kMark) code = byte();
      if (!code) return std::nullopt;
      const bool restart = *code >= 0xD0 && *code <= 0xD7;
      if (*code != 0 && !restart) return code;
    }
  }

  // Whether another image begins here, or a little further on.
  bool begins() {
    constexpr std::uint64_t kPadding = 16;
    const std::uint64_t here = place();
    return next() == kStartOfImage && place() <= here + kPadding;
  }

  // Passes over the data of a marker that states its length, but not if it states more than there is, or less than the
  // least that may be, as FFmpeg does.
  void skip(std::uint64_t least) {
    const std::uint64_t begin = place(), bytes = length();
    const std::uint64_t end = begin + bytes;
    std::array<std::uint8_t, 1> last{};
    if (bytes < least) return;
    if (end <= read_ || bytes_(end - 1, last) == last.size()) goTo(end);
  }

  // Passes over as many tables as FFmpeg reads: it goes on behind the last whole one.
  void skipTables() {
    std::int64_t rest = static_cast<std::int64_t>(length()) - 2;
    while (rest >= 65) {
      const auto kind = byte();
      if (!kind) return;
      const int bytes = *kind >> 4 == 0 ? 64 : 128;  // of one byte each, or two
      goTo(place() + static_cast<std::uint64_t>(bytes));
      rest -= 1 + bytes;
    }
  }

 private:
  [[nodiscard]] std::uint64_t place() const { return read_ - static_cast<std::uint64_t>(end_ - at_); }

  std::optional<std::uint8_t> byte() {
    if (at_ == end_ && !fill()) return std::nullopt;
    return *at_++;
  }

  // Of a marker's data, itself included.
  std::uint64_t length() {
    const auto high = byte(), low = byte();
    return high && low ? std::max<std::uint64_t>(2, *high << 8U | *low) : 2;
  }

  void goTo(std::uint64_t to) {
    if (to <= read_) {
      at_ = end_ - static_cast<std::ptrdiff_t>(read_ - to);
    } else {
      read_ = to;
      at_ = end_;
    }
  }

  bool fill() {
    const std::size_t got = bytes_(read_, piece_);
    read_ += got;
    at_ = piece_.begin();
    end_ = at_ + static_cast<std::ptrdiff_t>(got);
    return got > 0;
  }

  const Readable& bytes_;
  std::array<std::uint8_t, 16384> piece_{};
  std::array<std::uint8_t, 16384>::const_iterator at_ = piece_.end(), end_ = piece_.end();
  std::uint64_t read_ = 0;  // the place behind the piece
};

bool ofAnApplication(std::uint8_t marker) noexcept {
  return marker >= 0xE0 && marker <= 0xEF;
}

// What FFmpeg reads by its length: frames that it decodes, Huffman tables, restart intervals, applications' data and
// comments. Of other frames it reads only the marker.
bool statesLength(std::uint8_t marker) noexcept {
  return (marker >= 0xC0 && marker <= 0xC4) || marker == 0xDD || ofAnApplication(marker) || marker == 0xFE;
}

bool beginsFrame(std::uint8_t marker) noexcept {
  return marker >= 0xC0 && marker <= 0xC3;
}

}  // namespace

const char* exceededJpegBound(const Readable& packet) {
  Markers markers(packet);
  int scans = 0, fields = 0;
  bool framed = false;  // FFmpeg passes over an end before any frame
  for (auto marker = markers.next(); marker; marker = markers.next()) {
    if (*marker == kStartOfScan && ++scans > kMostScans) return kTooManyScans;
    framed = framed || beginsFrame(*marker);
    if (*marker == kEndOfImage && framed && (++fields == kMostFields || !markers.begins())) return nullptr;
    if (*marker == kTables) {
      markers.skipTables();
    } else if (statesLength(*marker)) {
      markers.skip(ofAnApplication(*marker) ? 6 : 2);
    }
  }
  return nullptr;
}

const char* exceededJpegFileBound(const Readable& file) {
  std::array<std::uint8_t, 3> begin{};
  if (file(0, begin) != begin.size() || begin != std::array<std::uint8_t, 3>{kMark, kStartOfImage, kMark}) {
    return nullptr;
  }
  return exceededJpegBound(file);
}

}  // namespace relievo::ffmpeg
