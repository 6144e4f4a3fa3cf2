// SPDX-License-Identifier: Apache-2.0
// The layout: prepare_iphone_data.py of ScanNet++'s toolkit.
#include "drivers/scan/depth_bin.h"

#include <lz4.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "drivers/scan/scan_picture.h"
#include "platform/files/byte_reader.h"

namespace relievo::scan {
namespace {

constexpr std::size_t kSamples = std::size_t{DepthBin::kCols} * DepthBin::kRows;
constexpr std::uint32_t kMostPacked = 2 * 4 * kSamples;  // what cannot be packed grows by little
constexpr std::size_t kMostMarks = 256, kMostPictures = 1'000'000;
constexpr const char* kNone = "is no depth.bin of ScanNet++, or damaged at its beginning; check the file";

void putMm(std::span<const std::uint8_t> metres, std::vector<std::uint8_t>& mm) {
  constexpr float kMost = 65535;
  ByteReader floats(metres);
  mm.clear();
  mm.reserve(2 * kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const float value = 1000 * floats.value<float>();
    const auto code = value >= 0 && value < kMost ? static_cast<std::uint32_t>(std::lround(value)) : 0;  // NaN as well
    mm.push_back(static_cast<std::uint8_t>(code));
    mm.push_back(static_cast<std::uint8_t>(code >> 8));
  }
}

bool inflatePicture(Inflater& inflater, std::vector<std::uint8_t>& mm) {
  std::vector<std::uint8_t> metres(4 * kSamples);
  if (inflater.read(metres) != metres.size()) return false;
  putMm(metres, mm);
  return true;
}

bool unpackLz4(const std::vector<std::uint8_t>& block, std::vector<std::uint8_t>& mm) {
  mm.resize(2 * kSamples);
  const auto bytes = [](auto& of) { return static_cast<int>(of.size()); };
  return LZ4_decompress_safe(reinterpret_cast<const char*>(block.data()), reinterpret_cast<char*>(mm.data()),
                             bytes(block), bytes(mm)) == bytes(mm);
}

}  // namespace

// False unless there is a whole picture at the beginning.
bool DepthBin::list(std::uint64_t end, const std::atomic<bool>& cancelled) {
  std::uint64_t at = 0;
  while (at < end && places_.size() < kMostPictures && !cancelled) {
    std::array<std::uint8_t, 4> length{};
    const auto got = file_.read(at, length);
    const auto bytes = ByteReader(length).value<std::uint32_t>();
    cut_off_ = !got || *got < length.size() || bytes == 0 || bytes > kMostPacked || at + 4 + bytes > end;
    if (cut_off_) break;
    places_.push_back({at + 4, bytes});
    at += 4 + bytes;
  }
  return !places_.empty();
}

Result<DepthBin> DepthBin::open(AnsweredFile file, const std::atomic<bool>& cancelled) {
  const auto end = file.bytes();
  if (!end) return std::unexpected(end.error());
  std::vector<std::uint8_t> mm;
  DepthBin bin(std::move(file));
  if (bin.list(*end, cancelled) && bin.next(mm) == Read::Picture) {
    bin.next_ = 0;
    return bin;
  }
  bin.places_.clear();
  bin.cut_off_ = false;
  bin.stream_.emplace(bin.file_, 0, *end);
  bin.next_ = 0;
  bin.addMark();
  if (bin.next(mm) != Read::Picture) return fail(ErrorCode::Corrupt, kNone);
  bin.goTo(0, cancelled);
  return bin;
}

std::optional<std::size_t> DepthBin::pictures() const noexcept {
  return stream_ ? std::nullopt : std::optional(places_.size());
}

// Thins the marks out once there are many.
void DepthBin::addMark() {
  if (!marks_.empty() && next_ < marks_.back().picture + marks_apart_) return;
  marks_.push_back({next_, *stream_});
  if (marks_.size() < kMostMarks) return;
  marks_apart_ *= 2;
  std::size_t place = 0;
  std::erase_if(marks_, [&](const Mark&) { return place++ % 2 == 1; });
}

DepthBin::Read DepthBin::next(std::vector<std::uint8_t>& mm) {
  if (stream_) {
    if (!inflatePicture(*stream_, mm)) {
      cut_off_ = stream_->damaged();
      return Read::End;
    }
    ++next_;
    addMark();
    return Read::Picture;
  }
  if (next_ == places_.size()) return Read::End;
  const Place& place = places_[next_++];
  const auto packed = readPlace(file_, place);
  if (!packed) return Read::Damaged;
  if (unpackLz4(*packed, mm)) return Read::Picture;
  Inflater inflater(file_, place.begin, place.begin + place.bytes);
  return inflatePicture(inflater, mm) ? Read::Picture : Read::Damaged;
}

bool DepthBin::goTo(std::size_t number, const std::atomic<bool>& cancelled) {
  if (!stream_) {
    next_ = std::min(number, places_.size());
    return true;
  }
  if (number < next_ || number >= next_ + marks_apart_) {
    const auto later = std::ranges::upper_bound(marks_, number, {}, &Mark::picture);
    const Mark& mark = *std::prev(later);
    if (number < next_ || mark.picture > next_) {
      stream_.emplace(mark.inflater);
      next_ = mark.picture;
    }
  }
  std::vector<std::uint8_t> mm;
  while (next_ < number && !cancelled && next(mm) == Read::Picture) {
  }
  return !cancelled;
}

}  // namespace relievo::scan
