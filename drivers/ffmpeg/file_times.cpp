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
#include <libavutil/opt.h>
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

// What `look` returns; the container then reads on where it was.
template <typename Look>
auto keepingPlace(AVIOContext& file, const Look& look) noexcept {
  const int error = file.error;
  const std::int64_t before = avio_tell(&file);
  const auto seen = look();
  avio_seek(&file, before, SEEK_SET);
  file.error = error;
  return seen;
}

// Fills `out` with what stands in the file from `position` on. False if not as many bytes can be read.
bool readFrom(AVIOContext* file, std::int64_t position, std::span<std::uint8_t> out) noexcept {
  if (file == nullptr || (file->seekable & AVIO_SEEKABLE_NORMAL) == 0 || position < 0) return false;
  const int bytes = static_cast<int>(out.size());
  return avio_seek(file, position, SEEK_SET) >= 0 && avio_read(file, out.data(), bytes) == bytes;
}
bool readAt(const AVFormatContext& context, std::int64_t position, std::span<std::uint8_t> out) noexcept {
  return context.pb != nullptr && keepingPlace(*context.pb, [&] { return readFrom(context.pb, position, out); });
}

// True for a copy that was broken off after the file system had set its final size. A whole film may end in null
// packets, in padding, or in what another program has added.
bool endsInZeros(const AVFormatContext& context, std::int64_t bytes) noexcept {
  std::array<std::uint8_t, 4096> last{};
  const auto size = static_cast<std::int64_t>(last.size());
  return readAt(context, bytes - size, last) && std::ranges::all_of(last, [](std::uint8_t byte) { return byte == 0; });
}

// A container's own sign that its end is missing, and how much at least; 0 without one.
struct OwnSign {
  std::string_view container;
  Duration (*missing)(const AVFormatContext&, const FileEnd::Reached&) noexcept;
};

// By the pictures that an AVI file's header counts. Of a cut file FFmpeg has shortened the stated length by the bytes
// that are left.
Duration uncounted(const AVFormatContext& context, const FileEnd::Reached& end) noexcept {
  Duration longest{0};
  for (const AVStream* const stream : std::span(context.streams, context.nb_streams)) {
    if (kindOf(*stream) != StreamKind::Video) continue;
    longest = std::max(longest, durationFrom(stream->nb_frames, stream->time_base));
  }
  const Duration missing = longest - end.latest;
  return missing > kWholeWithin ? missing : Duration(0);
}

// A Y4M file that ends within a picture.
Duration brokenPicture(const AVFormatContext& context, const FileEnd::Reached& end) noexcept {
  constexpr std::string_view kFrame = "FRAME";
  std::array<std::uint8_t, kFrame.size()> begin{};
  if (end.read <= 0 || end.read >= end.bytes) return Duration(0);
  const auto there = std::min(end.bytes - end.read, static_cast<std::int64_t>(begin.size()));
  const std::span some = std::span(begin).first(static_cast<std::size_t>(there));
  if (!readAt(context, end.read, some) || !std::ranges::equal(some, kFrame.substr(0, some.size()))) return Duration(0);
  return end.picture;
}

// A transport stream that ends within a packet: ISO/IEC 13818-1, 2.4.3.2. Those of an M2TS file begin with four more
// bytes. What is no packet may stand behind a whole film.
Duration brokenPacket(const AVFormatContext& context, const FileEnd::Reached& end) noexcept {
  constexpr std::uint8_t kSync = 0x47;
  std::int64_t size = 0;
  if (av_opt_get_int(context.priv_data, "ts_packetsize", 0, &size) < 0 || size < 188) return Duration(0);
  const std::int64_t before = size == 192 ? 4 : 0;
  const std::int64_t rest = end.bytes % size;
  if (rest <= before) return Duration(0);
  for (std::int64_t packet = end.bytes - rest; packet >= end.bytes - rest - 2 * size; packet -= size) {
    std::array<std::uint8_t, 1> byte{};
    if (!readAt(context, packet + before, byte) || byte[0] != kSync) return Duration(0);
  }
  return end.picture;
}

// An Ogg file whose last page is not the last one of its stream: RFC 3533, 6.
Duration lastPageGone(const AVFormatContext& context, const FileEnd::Reached& end) noexcept {
  constexpr std::string_view kPage = "OggS";
  constexpr std::uint8_t kLast = 4;
  std::array<std::uint8_t, 65307> tail{};  // the largest page
  const std::span some =
      std::span(tail).first(static_cast<std::size_t>(std::min(end.bytes, static_cast<std::int64_t>(tail.size()))));
  if (!readAt(context, end.bytes - static_cast<std::int64_t>(some.size()), some)) return Duration(0);
  const auto page = std::ranges::find_end(some, kPage);
  return page.size() > 0 && some.end() - page.begin() > 5 && (page.begin()[5] & kLast) == 0 ? end.picture : Duration(0);
}

// How long the bytes from `read` on would last, at the mean bit rate.
Duration restOf(const FileEnd::Reached& end, std::int64_t read) noexcept {
  const auto rest = static_cast<double>(end.bytes - read);
  return fromSeconds(toSeconds(end.latest) * rest / static_cast<double>(read));
}

// What follows the last packet of a GIF file where a trailer or another block should stand (GIF89a, 15 to 27): FFmpeg
// ends there, or takes all the rest for the last picture's.
Duration behindLast(const AVFormatContext& context, const FileEnd::Reached& end) noexcept {
  constexpr std::uint8_t kExtension = 0x21, kImage = 0x2c, kTrailer = 0x3b;
  std::int64_t at = end.last;
  std::array<std::uint8_t, 13> bytes{};
  const auto take = [&](std::int64_t count) {
    const std::span some = std::span(bytes).first(static_cast<std::size_t>(count));
    const bool there = readFrom(context.pb, at, some);
    at += count;
    return there;
  };
  const auto skipColors = [&](std::uint8_t flags) { at += (flags & 0x80) != 0 ? 6 << (flags & 7) : 0; };
  const auto skipParts = [&] {  // each has its length before it; the last one has none
    while (take(1) && bytes[0] != 0) at += bytes[0];
  };
  if (at == 0 && take(13)) skipColors(bytes[10]);
  while (take(1)) {
    if (bytes[0] == kTrailer) return Duration(0);
    if (bytes[0] == kImage && take(9)) {
      skipColors(bytes[8]);
    } else if (bytes[0] != kExtension) {
      return restOf(end, at);
    }
    ++at;  // an extension's label, or a picture's code size
    skipParts();
  }
  return end.picture;
}

// The place is kept once, since FFmpeg reads a whole buffer anew for each return.
Duration trailerGone(const AVFormatContext& context, const FileEnd::Reached& end) noexcept {
  return context.pb == nullptr ? end.picture : keepingPlace(*context.pb, [&] { return behindLast(context, end); });
}

// A WMV file that is shorter than its header says: File Properties Object of the ASF specification, 3.2. FFmpeg then
// knows no length. A broadcast's header does not know its size.
Duration smallerThanItsHeaderSays(const AVFormatContext& context, const FileEnd::Reached& end) noexcept {
  constexpr std::array<std::uint8_t, 16> kProperties{0xa1, 0xdc, 0xab, 0x8c, 0x47, 0xa9, 0xcf, 0x11,
                                                     0x8e, 0xe4, 0x00, 0xc0, 0x0c, 0x20, 0x53, 0x65};
  constexpr std::ptrdiff_t kSize = 40, kFlags = 88;
  std::array<std::uint8_t, 4096> head{};
  if (end.bytes < static_cast<std::int64_t>(head.size()) || !readAt(context, 0, head)) return Duration(0);
  const auto found = std::ranges::search(head, kProperties);
  if (found.empty() || head.end() - found.begin() <= kFlags || (found.begin()[kFlags] & 1) != 0) return Duration(0);
  std::int64_t size = 0;
  for (std::ptrdiff_t i = 7; i >= 0; --i) size = size % (std::int64_t{1} << 48) * 256 + found.begin()[kSize + i];
  return size > end.bytes ? end.picture : Duration(0);  // how much is known by a gap, if it was in the middle
}

constexpr std::array kOwnSigns{OwnSign{"avi", uncounted},       OwnSign{"yuv4mpegpipe", brokenPicture},
                               OwnSign{"mpegts", brokenPacket}, OwnSign{"ogg", lastPageGone},
                               OwnSign{"gif", trailerGone},     OwnSign{"asf", smallerThanItsHeaderSays}};

constexpr Duration kDoubtful = std::chrono::milliseconds(250);  // FFmpeg's parsers are some pictures late
constexpr Duration kLongGap = std::chrono::seconds(1);
constexpr Duration kUsualPicture = std::chrono::milliseconds(40);  // where its length is unknown

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

Duration PacketLengths::of(const Packet& packet, Duration stated) {
  if (!packet.dts) return stated;
  Line& line = lines_.try_emplace(packet.stream, Line{.last = *packet.dts}).first->second;
  if (*packet.dts > line.last) line.step = *packet.dts - line.last;
  line.last = *packet.dts;
  return stated > Duration(0) ? stated : line.step;
}

void FileGaps::begin() noexcept {
  ends_.clear();
  missing_.clear();
}

void FileGaps::note(const Packet& packet, Duration length, Doubt doubt, unsigned losses, const std::string& url) {
  if (doubt > Doubt::Steady) {
    for (auto& [stream, other] : ends_) other.doubtful_until = other.time + kDoubtful;
  }
  if (!packet.dts || length <= Duration(0)) return;
  auto& [end, doubtful_until, left] = ends_.try_emplace(packet.stream, End{*packet.dts, *packet.dts}).first->second;
  const Duration gap = *packet.dts - end;
  const bool lost = gap > kWholeWithin && left < losses;
  if (lost) ++left;
  if (lost || (gap > kWholeWithin && end < doubtful_until)) {
    missing_[packet.stream] += gap;
    if (!lost && isTold(++gaps_)) {
      log(LogLevel::Warning, "media", "%s: %.1f s at %.1f s are missing: a part of it cannot be read", url.c_str(),
          toSeconds(gap), toSeconds(end));
    }
  } else if (gap > kLongGap && doubt == Doubt::Steady && isTold(++gaps_)) {
    log(LogLevel::Warning, "media", "%s: for %.1f s at %.1f s there are no pictures: a still, or a part is missing",
        url.c_str(), toSeconds(gap), toSeconds(end));
  }
  end = *packet.dts + length;
  if (doubt > Doubt::Steady) doubtful_until = end + kDoubtful;
}

Duration FileGaps::missing() const noexcept {
  Duration most{0};
  for (const auto& [stream, missing] : missing_) most = std::max(most, missing);
  return most;
}

void FileEnd::open(const AVFormatContext& context, Duration start) noexcept {
  *this = {};
  start_ = start;
  reached_.bytes = bytesOf(context);
  reached_.picture = kUsualPicture;
}

void FileEnd::seek(MediaTime target) noexcept {
  reached_.latest = target.time_since_epoch();
  reached_.read = 0;
  missing_ = Duration(0);
  sought_ = target > MediaTime{};
  broken_ = false;
}

void FileEnd::note(const Packet& packet, Duration length, bool broken, std::int64_t position) noexcept {
  const auto begin = packet.pts ? packet.pts : packet.dts;
  if (begin) reached_.latest = std::max(reached_.latest, begin->time_since_epoch() + length);
  if (position >= 0) reached_.last = position;
  if (position >= 0) reached_.read = std::max(reached_.read, position + static_cast<std::int64_t>(packet.bytes));
  if (length > Duration(0)) reached_.picture = length;
  broken_ = broken;
}

// A length that the container states counts with a single programme only, and of a list only from its beginning on: the
// times within it may jump. A length that FFmpeg took from the last times of a file counts if the file has become
// shorter since.
void FileEnd::reach(const AVFormatContext& context, bool doubtful) noexcept {
  const bool one = context.nb_programs < 2;
  const bool stated = context.duration_estimation_method == AVFMT_DURATION_FROM_STREAM;
  const bool jumps = (context.iformat->flags & AVFMT_TS_DISCONT) != 0;
  const bool told = one && context.duration > 0 && (stated ? !jumps || !sought_ : bytesOf(context) < reached_.bytes);
  missing_ = told ? lengthOf(context, start_) - reached_.latest : Duration(0);
  const bool unreadable = doubtful && !stated && !jumps;
  if (one && (jumps || unreadable)) missing_ = std::max(missing_, unread(context, unreadable));
  if (missing_ <= kWholeWithin) missing_ = broken_ ? reached_.picture : Duration(0);
  const auto own = std::ranges::find(kOwnSigns, context.iformat->name, &OwnSign::container);
  if (own != kOwnSigns.end()) missing_ = std::max(missing_, own->missing(context, reached_));
}

// The time for which the bytes behind the last packet would last, at the mean bit rate, if they were never written or
// cannot be read.
Duration FileEnd::unread(const AVFormatContext& context, bool unreadable) const noexcept {
  const std::int64_t bytes = reached_.bytes, rest = bytes - reached_.read;
  if (reached_.read <= 0 || rest < bytes / 50) return Duration(0);
  if (!unreadable && (rest < kTailBytes || !endsInZeros(context, bytes))) return Duration(0);
  return restOf(reached_, reached_.read);
}

}  // namespace relievo::ffmpeg
