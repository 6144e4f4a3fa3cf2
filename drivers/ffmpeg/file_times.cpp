// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/file_times.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "drivers/ffmpeg/container.h"
#include "drivers/ffmpeg/library.h"
#include "platform/log.h"
#include "platform/told_count.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace relievo::ffmpeg {
namespace {

constexpr Duration kReordering = std::chrono::seconds(1);  // after a jump, FFmpeg returns decreasing decoding times
constexpr Duration kAnyGap = std::chrono::hours(24 * 365);
// A container's duration may include a last picture longer than its packet, or sound that a codec adds at the end.
constexpr Duration kWholeWithin = std::chrono::milliseconds(250);
constexpr std::int64_t kTailBytes = 65536;  // tables and padding behind the last packet of a multiplex are shorter

// The file's present size; 0 if unknown.
std::int64_t bytesOf(const AVFormatContext& context) noexcept {
  return context.pb == nullptr ? 0 : std::max<std::int64_t>(avio_size(context.pb), 0);
}

// Fills `out` with what stands in the file from `position` on; the container then reads on where it was. False if not
// as many bytes can be read.
bool readAt(const AVFormatContext& context, std::int64_t position, std::span<std::uint8_t> out) noexcept {
  AVIOContext* const file = context.pb;
  if (file == nullptr || (file->seekable & AVIO_SEEKABLE_NORMAL) == 0 || position < 0) return false;
  const int error = file->error;
  const std::int64_t before = avio_tell(file);
  const int bytes = static_cast<int>(out.size());
  const bool all = avio_seek(file, position, SEEK_SET) >= 0 && avio_read(file, out.data(), bytes) == bytes;
  avio_seek(file, before, SEEK_SET);
  file->error = error;
  return all;
}

// As a copy leaves it that was broken off on a file system which had given it its size. A whole film may end in null
// packets, padding, or in what another program has added.
bool endsInZeros(const AVFormatContext& context, std::int64_t bytes) noexcept {
  std::array<std::uint8_t, 4096> last{};
  const auto size = static_cast<std::int64_t>(last.size());
  return readAt(context, bytes - size, last) && std::ranges::all_of(last, [](std::uint8_t byte) { return byte == 0; });
}

// By the pictures that an AVI file's header counts; 0 for another container. Of a cut file FFmpeg has shortened the
// stated length by the bytes that are left.
Duration countedLength(const AVFormatContext& context) noexcept {
  Duration longest{0};
  if (context.iformat->name != std::string_view("avi")) return longest;
  for (const AVStream* const stream : std::span(context.streams, context.nb_streams)) {
    if (kindOf(*stream) != StreamKind::Video) continue;
    longest = std::max(longest, durationFrom(stream->nb_frames, stream->time_base));
  }
  return longest;
}

// Where the file ends at `bytes` within the picture behind `read` of a Y4M film, that picture's time; else 0.
Duration brokenPicture(const AVFormatContext& context, std::int64_t read, std::int64_t bytes) noexcept {
  constexpr std::string_view kFrame = "FRAME";
  std::array<std::uint8_t, kFrame.size()> begin{};
  if (context.iformat->name != std::string_view("yuv4mpegpipe") || read <= 0 || read >= bytes) return Duration(0);
  const auto there = std::min(bytes - read, static_cast<std::int64_t>(begin.size()));
  const std::span some = std::span(begin).first(static_cast<std::size_t>(there));
  if (!readAt(context, read, some) || !std::ranges::equal(some, kFrame.substr(0, some.size()))) return Duration(0);
  return durationFrom(1, context.streams[0]->time_base);
}

}  // namespace

void FileTimes::begin() noexcept {
  continuous_.begin(kAnyGap);
  highest_.clear();
  mended_by_ = Duration(0);
}

void FileTimes::mend(Packet& packet, const std::string& url) {
  if (packet.dts) {
    const auto [known, first] = highest_.try_emplace(packet.stream, *packet.dts);
    if (first || *packet.dts > known->second || *packet.dts < known->second - kReordering) known->second = *packet.dts;
    const Duration offset = continuous_.offsetFor(packet.stream, known->second);
    if (offset > mended_by_) {
      log(LogLevel::Warning, "media", "%s: its times jump back by %.1f s at %.1f s; they are made continuous",
          url.c_str(), toSeconds(offset - mended_by_), toSeconds(*packet.dts + offset));
    }
    mended_by_ = std::max(mended_by_, offset);
    *packet.dts += offset;
    if (packet.pts) *packet.pts += offset;
  } else if (packet.pts) {
    *packet.pts += mended_by_;
  }
}

void FileGaps::note(const Packet& packet, Duration length, const std::string& url) {
  if (!packet.dts || length <= Duration(0)) return;
  const auto end = ends_.try_emplace(packet.stream, *packet.dts).first;
  const Duration gap = *packet.dts - end->second;
  if (gap > kWholeWithin && isTold(++gaps_)) {
    log(LogLevel::Warning, "media", "%s: %.1f s at %.1f s are missing: a part of it cannot be opened", url.c_str(),
        toSeconds(gap), toSeconds(end->second));
  }
  end->second = *packet.dts + length;
}

void FileEnd::open(const AVFormatContext& context, Duration start) noexcept {
  *this = {};
  start_ = start;
  bytes_ = bytesOf(context);
}

void FileEnd::seek(MediaTime target) noexcept {
  latest_ = target.time_since_epoch();
  missing_ = Duration(0);
  read_ = 0;
}

void FileEnd::note(const Packet& packet, Duration length, std::int64_t position) noexcept {
  const auto begin = packet.pts ? packet.pts : packet.dts;
  if (begin) latest_ = std::max(latest_, begin->time_since_epoch() + length);
  if (position >= 0) read_ = std::max(read_, position + static_cast<std::int64_t>(packet.bytes));
}

// A length that the container states counts with a single programme only. A length that FFmpeg took from the last times
// of a file counts if the file has become shorter since.
void FileEnd::reach(const AVFormatContext& context) noexcept {
  const bool one = context.nb_programs < 2;
  const bool stated = context.duration_estimation_method == AVFMT_DURATION_FROM_STREAM;
  const bool told = one && context.duration > 0 && (stated || bytesOf(context) < bytes_);
  const Duration end = std::max(told ? lengthOf(context, start_) : Duration(0), countedLength(context));
  const bool is_multiplex = one && (context.iformat->flags & AVFMT_TS_DISCONT) != 0;
  missing_ = std::max(end - latest_, is_multiplex ? unread(context) : Duration(0));
  if (missing_ <= kWholeWithin) missing_ = brokenPicture(context, read_, bytes_);
}

// The time for which the bytes behind the last packet that were never written would last, at the mean bit rate.
Duration FileEnd::unread(const AVFormatContext& context) const noexcept {
  const std::int64_t rest = bytes_ - read_;
  if (read_ <= 0 || rest < kTailBytes || rest < bytes_ / 50 || !endsInZeros(context, bytes_)) return Duration(0);
  return fromSeconds(toSeconds(latest_) * static_cast<double>(rest) / static_cast<double>(read_));
}

}  // namespace relievo::ffmpeg
