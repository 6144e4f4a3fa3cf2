// SPDX-License-Identifier: Apache-2.0
// Boxes of ISO/IEC 14496-12 and of QuickTime: a size, a type, and what is in it. FFmpeg takes a table wherever it
// stands.
#include "drivers/ffmpeg/bounds/mp4_bounds.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/ffmpeg/bounds/mp4_track.h"

namespace relievo::ffmpeg {
namespace {

constexpr std::uint64_t kNoEnd = std::uint64_t{1} << 62;  // the kernel refuses to read beyond 2^63
constexpr std::uint64_t kMostHeaderBytes = std::uint64_t{16} << 20;
constexpr std::uint64_t kMostTableBytes = std::uint64_t{128} << 20;  // that are read, of all tracks
constexpr int kMostBoxes = 100'000, kMostTracks = 1000, kMostFragments = 200'000;
constexpr int kDeepest = 10;                                        // as in FFmpeg
constexpr int kLaterBoxes = 64;                                     // that are looked at behind the header
constexpr std::uint64_t kSoundPiece = 1024, kShortestPacket = 160;  // samples of sound that FFmpeg takes together

using Box = Mp4Box;

constexpr std::uint32_t type(std::string_view name) noexcept {
  return mp4Type(name);
}

std::optional<Box> boxAt(const Readable& file, std::uint64_t place, std::uint64_t end) {
  std::array<std::uint8_t, 16> head{};
  if (place >= end || end - place < 8) return std::nullopt;
  const std::size_t got = file(place, head);
  if (got < 8) return std::nullopt;
  const std::span bytes(head);
  std::uint64_t size = bigEndian(bytes.first(4)), in_head = 8;
  if (size == 1) size = got < 16 ? 0 : bigEndian(bytes.subspan(8)), in_head = 16;
  else if (size == 0) size = end - place;
  if (size < in_head || end - place < in_head) return std::nullopt;
  return Box{.type = static_cast<std::uint32_t>(bigEndian(bytes.subspan(4, 4))),
             .data = place + in_head,
             .end = place + std::min(size, end - place)};
}

bool isContainer(std::uint32_t kind) noexcept {
  constexpr std::string_view kNames[] = {"moov", "trak", "mdia", "minf", "stbl", "edts", "dinf", "mvex", "moof",
                                         "traf", "tref", "udta", "sinf", "schi", "wave", "gmhd", "ilst"};
  return std::ranges::any_of(kNames, [kind](std::string_view name) { return kind == type(name); });
}

class Tables {
 public:
  explicit Tables(const Readable& file) noexcept : file_(&file) {}

  const char* exceeded() {
    int later = 0;
    const auto first = boxAt(*file_, 0, kNoEnd);
    for (auto box = first; box && later < kLaterBoxes; box = boxAt(*file_, box->end, kNoEnd)) {
      note(*box, 0, 0);
      if (exceeded_ != nullptr) break;
      if (has_header_ || is_part_) ++later;
    }
    return has_header_ || (first && isNamed(*first)) ? exceeded_ : nullptr;
  }

 private:
  static bool isNamed(const Box& box) noexcept {
    for (int shift = 0; shift < 32; shift += 8) {
      const auto c = static_cast<std::uint8_t>(box.type >> shift);
      if (c < ' ' || c > '~') return false;
    }
    return true;
  }

  void exceed(const char* why) noexcept {
    if (exceeded_ == nullptr) exceeded_ = why;
  }
  void add(std::uint64_t samples) noexcept {
    samples_ += std::min(samples, 2 * kMostMp4Samples);
    if (samples_ > kMostMp4Samples) exceed(kTooManyMp4Samples);
  }

  [[nodiscard]] std::uint64_t numberIn(const Box& box, std::uint64_t at, std::size_t size = 4) const {
    return ffmpeg::numberIn(*file_, box, at, size);
  }

  void lookInto(const Box& parent, std::uint64_t from, int depth) {
    for (std::uint64_t place = from; exceeded_ == nullptr;) {
      const auto box = boxAt(*file_, place, parent.end);
      if (!box) return;
      note(*box, parent.type, depth);
      place = box->end;
    }
  }

  void note(const Box& box, std::uint32_t parent, int depth) {
    if (++boxes_ > kMostBoxes) return exceed(kTooManyMp4Boxes);
    if ((parent == type("ilst") || parent == type("udta")) && ++tags_ > kMostMp4Tags) return exceed(kTooManyMp4Tags);
    if (depth > kDeepest) return;
    if (box.type == type("moov") || hidesHeader(box)) has_header_ = true;
    if (box.type == type("trak")) return noteTrack(box, depth);
    if (box.type == type("cmov")) return unpack(box, depth);
    if (box.type == type("meta")) return lookInto(box, beginOfMeta(box), depth + 1);
    if (isContainer(box.type) || hidesHeader(box)) return lookInto(box, box.data, depth + 1);
    noteTable(box);
    noteList(box);
  }

  // FFmpeg takes these for the header if that is in them.
  [[nodiscard]] bool hidesHeader(const Box& box) const {
    if (box.type != type("free") && box.type != type("hoov")) return false;
    const std::uint64_t first = numberIn(box, 4);
    return first == type("mvhd") || first == type("cmov");
  }

  // Where FFmpeg finds the first box in it.
  [[nodiscard]] std::uint64_t beginOfMeta(const Box& box) const {
    constexpr std::uint64_t kFarthest = 64;
    for (std::uint64_t at = 4; at < kFarthest; at += 4) {
      if (numberIn(box, at) == type("hdlr")) return box.data + at - 4;
    }
    return box.end;
  }

  void noteTrack(const Box& box, int depth) {
    if (++tracks_ > kMostTracks) return exceed(kTooManyMp4Boxes);
    const Mp4Track before = std::exchange(track_, {});
    const bool in_another = std::exchange(in_track_, true);
    lookInto(box, box.data, depth + 1);
    in_track_ = in_another;
    if (exceeded_ != nullptr) return;
    const auto entries = entriesOf(*file_, track_, per_second_, kMostMp4Samples, budget_);
    add(entries.value_or(kNoEnd));
    track_ = before;
  }

  // Of a list of what a track's samples are. FFmpeg takes packets of 160 samples and more one by one, as many shorter
  // ones as 1024 samples hold, and 1024 samples where there are none.
  [[nodiscard]] std::uint64_t pieceOf(const Box& kinds) const {
    if (numberIn(kinds, 4) > 1 || numberIn(kinds, 12) == type("agsm")) return kShortestPacket;
    const std::uint64_t version = numberIn(kinds, 24, 2);
    const std::uint64_t packet = version == 1 ? numberIn(kinds, 44) : version == 2 ? numberIn(kinds, 76) : 0;
    if (packet >= kShortestPacket) return std::min(packet, kSoundPiece);
    return packet > 1 ? kSoundPiece / packet * packet : kSoundPiece;
  }

  void noteTable(const Box& box) {
    const auto count = [&] { return numberIn(box, 4); };
    if (box.type == type("stsz") || box.type == type("stz2")) track_.samples += numberIn(box, 8);
    else if (box.type == type("stts")) track_.ticks = count() == 1 && numberIn(box, 12) == 1;
    else if (box.type == type("stco")) track_.chunks += std::min(count(), box.bytes() / 4);
    else if (box.type == type("co64")) track_.chunks += std::min(count(), box.bytes() / 8);
    else if (box.type == type("elst")) track_.shows += box.bytes() / (numberIn(box, 0, 1) == 1 ? 20 : 12);
    else if (box.type == type("stsd")) track_.piece = std::min(track_.piece, pieceOf(box));
    else if (box.type == type("hdlr")) track_.picture = track_.picture || numberIn(box, 8) == type("vide");
    else if (box.type == type("mdhd")) track_.per_second = numberIn(box, numberIn(box, 0, 1) == 1 ? 20 : 12);
    else if (box.type == type("mvhd")) per_second_ = numberIn(box, numberIn(box, 0, 1) == 1 ? 20 : 12);
    if (box.type == type("hdlr")) track_.sound = track_.sound || numberIn(box, 8) == type("soun");
    keep(box);
  }

  void keep(const Box& box) noexcept {
    if (box.type == type("elst")) track_.edits.note(box);
    else if (box.type == type("stts")) track_.times.note(box);
    else if (box.type == type("stss")) track_.keys.note(box);
    else if (box.type == type("ctts")) track_.shifts.note(box);
    else if (box.type == type("stsc")) track_.runs.note(box);
  }

  void noteList(const Box& box) {
    if (box.type == type("tfhd")) is_part_ = true;
    if (box.type == type("trun")) add(numberIn(box, 4));
    if (box.type == type("sidx")) fragments_ += numberIn(box, numberIn(box, 0, 1) == 0 ? 22 : 30, 2);
    if (box.type == type("keys")) names_ += std::min(numberIn(box, 4), box.bytes() / 8);
    if (fragments_ > kMostFragments) exceed(kTooManyMp4Boxes);
    if (names_ > kMostMp4Tags) exceed(kTooManyMp4Tags);
  }

  // A packed header: what it is packed by, its length, and a stream of zlib. A film has one.
  void unpack(const Box& box, int depth) {
    if (std::exchange(unpacked_, true) || in_track_) return exceed(kTooLongMp4Header);
    constexpr std::uint64_t kStream = 24;
    const std::uint64_t length = numberIn(box, kStream - 4);
    if (box.bytes() < kStream || box.bytes() > kMostHeaderBytes || length > kMostHeaderBytes)
      return exceed(kTooLongMp4Header);
    std::vector<std::uint8_t> packed(static_cast<std::size_t>(box.bytes() - kStream)),
        header(static_cast<std::size_t>(length));
    packed.resize((*file_)(box.data + kStream, packed));
    uLongf unpacked = header.size();
    if (::uncompress(header.data(), &unpacked, packed.data(), packed.size()) != Z_OK) return exceed(kTooLongMp4Header);
    const Readable content = readable(std::span<const std::uint8_t>(header).first(unpacked));
    const Readable* const around = std::exchange(file_, &content);
    lookInto({.type = type("moov"), .data = 0, .end = unpacked}, 0, depth + 1);
    file_ = around;
  }

  const Readable* file_;
  Mp4Track track_;
  bool has_header_ = false, unpacked_ = false, in_track_ = false;
  bool is_part_ = false;  // of a film whose header is another file
  std::uint64_t samples_ = 0, budget_ = kMostTableBytes;
  std::uint64_t per_second_ = 0;  // ticks of the film's edits
  int boxes_ = 0, tracks_ = 0, tags_ = 0;
  std::uint64_t fragments_ = 0, names_ = 0;  // of tags that stand in a list of their own
  const char* exceeded_ = nullptr;
};

}  // namespace

const char* exceededMp4Bound(const Readable& file) {
  return Tables(file).exceeded();
}

}  // namespace relievo::ffmpeg
