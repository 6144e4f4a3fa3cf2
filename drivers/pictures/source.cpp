// SPDX-License-Identifier: Apache-2.0
// Hands out the files of a recording as packets, in order of time.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <compare>
#include <filesystem>
#include <string_view>
#include <utility>

#include "drivers/pictures/layouts.h"
#include "drivers/pictures/pictures.h"
#include "drivers/pictures/recording.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_file.h"
#include "platform/files/answered_place.h"
#include "platform/log.h"
#include "platform/print.h"
#include "platform/told_count.h"

namespace relievo {
namespace {

using namespace pictures;

// Limits for a file, which is held in memory, by FFmpeg's decoders two or three times. A picture of the most samples,
// in four channels, has 134 MB at 16 bits and 268 MB at 32 bits.
constexpr std::uint64_t kMostBytes = 140'000'000, kMostBytesOfFloats = 300'000'000;
constexpr Error kTooLarge{ErrorCode::Exhausted, 0, "is larger than 140 MB, the most that a picture's file may have"};
constexpr Error kTooLargeForFloats{ErrorCode::Exhausted, 0,
                                   "is larger than 300 MB, the most that a picture's file may have"};
constexpr std::size_t kMostTries = 8;  // damaged pictures at the beginning
constexpr const char* kGone = "the disk failed during playback; check it";

using Bytes = std::vector<std::uint8_t>;

Result<std::uint64_t> sizeOf(const std::string& path, const AnsweredFile& file) {
  // Of these no more is held than the file.
  constexpr std::array<std::string_view, 4> kFloats{"exr", "pfm", "npy", "npz"};
  const bool floats = std::ranges::find(kFloats, endingOf(path)) != kFloats.end();
  const auto size = file.bytes();
  if (!size || *size <= (floats ? kMostBytesOfFloats : kMostBytes)) return size;
  return std::unexpected(floats ? kTooLargeForFloats : kTooLarge);
}

Result<std::shared_ptr<Bytes>> readPicture(const std::string& path) {
  const auto file = AnsweredFile::open(path);
  if (!file) return std::unexpected(file.error());
  const auto size = sizeOf(path, *file);
  if (!size) return std::unexpected(size.error());
  auto bytes = std::make_shared<Bytes>(static_cast<std::size_t>(*size));
  const auto got = file->read(0, *bytes);
  if (!got && got.error().code == ErrorCode::Io) return fail(ErrorCode::Lost, kGone, got.error().os_error);
  if (!got) return std::unexpected(got.error());
  bytes->resize(*got);
  return bytes;
}

// A picture that is missing or damaged is passed over; these end the reading.
bool endsReading(const Error& error) noexcept {
  return error.code == ErrorCode::Lost || error.code == ErrorCode::Timeout || error.code == ErrorCode::Cancelled;
}

// A folder's name.
std::string titleOf(const std::string& url) {
  std::error_code failed;
  std::filesystem::path path = std::filesystem::absolute(pictures::pathOf(url), failed).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  return isFolder(path) ? path.filename().string() : "";
}

// A picture in the order of reading.
struct Entry {
  Duration time{0};
  int stream = 0;
  std::size_t place = 0;
  auto operator<=>(const Entry&) const = default;
};

class PicturesSource final : public MediaSource {
 public:
  PicturesSource(DescribePicture describe, UnpackPicture unpack)
      : describe_(std::move(describe)), unpack_(std::move(unpack)) {}
  ~PicturesSource() override { close(); }

 private:
  Result<Description> openSource(const std::string& url) override {
    cancelled_ = false;
    const auto found = findPictures(url);
    if (!found) return std::unexpected(found.error());
    recording_ = recordingOf(*found, pictureRate());
    Description description;
    for (const bool depth : {false, true}) {
      const auto& pictures = depth ? recording_.depth : recording_.color;
      if (pictures.empty()) continue;
      auto stream = describeStream(pictures, depth);
      if (!stream && depth && !recording_.color.empty() && !endsReading(stream.error())) {
        recording_.notes.push_back(
            print("the depth beside it is left out: %s: %s", pictures.front().path.c_str(), stream.error().message));
        recording_.depth.clear();
        continue;
      }
      if (!stream) return std::unexpected(stream.error());
      stream->index = static_cast<int>(description.streams.size());
      addEntries(pictures, stream->index);
      description.duration = std::max(description.duration, stream->duration);
      description.streams.push_back(std::move(*stream));
      if (!depth) splitInside(description.streams.back());
    }
    std::ranges::sort(entries_);
    description.notes = recording_.notes;
    if (const std::string title = titleOf(url); !title.empty()) description.tags["TITLE"] = title;
    description.origin.named_start = recording_.start;
    return description;
  }

  // Colour pictures that hold their depth are both series, unless there is a depth of its own.
  void splitInside(StreamInfo& color) {
    const auto inside = color.tags.find(kInsideTag);
    if (inside == color.tags.end()) return;
    if (recording_.depth.empty()) recording_.depth = recording_.color;
    std::erase_if(color.tags, [](const auto& tag) { return tag.first.starts_with("DEPTH_"); });  // they say its depth
  }

  // Checks the size first, since the function that describes a file may read it whole.
  Result<StreamInfo> describePicture(const std::string& path) {
    if (cancelled_) return fail(ErrorCode::Cancelled, "interrupted while opening pictures");
    const auto file = AnsweredFile::open(path);
    const auto size =
        file ? sizeOf(path, *file) : Result<std::uint64_t>(0);  // what describes it says why it cannot be opened
    if (!size) return std::unexpected(size.error());
    return describe_(path);
  }

  // Describes the stream by its first picture that can be read.
  Result<StreamInfo> describeStream(const std::vector<TimedPicture>& pictures, bool depth) {
    Result<StreamInfo> stream = fail(ErrorCode::Corrupt, "");
    for (std::size_t i = 0; i < std::min(pictures.size(), kMostTries) && !stream; ++i) {
      stream = describePicture(pictures[i].path);
      if (!stream && endsReading(stream.error())) return stream;
    }
    if (!stream) return stream;
    if (const auto note = stream->tags.extract(kNoteTag)) recording_.notes.push_back(note.mapped());
    stream->kind = StreamKind::Video;
    stream->counted = recording_.numbered || pictures.size() == 1;
    stream->frame_period = recording_.period;
    stream->average_rate = rateOf(pictures);
    stream->base_rate = recording_.numbered ? stream->average_rate : Ratio{};
    stream->duration = pictures.size() > 1 ? pictures.back().time + recording_.period : Duration(0);
    if (recording_.views) {
      stream->tags[kViewTag] = depth ? "right" : "left";
      return stream;
    }
    if (depth) stream->tags.insert(recording_.depth_tags.begin(), recording_.depth_tags.end());
    if (const auto inside = stream->tags.find(kInsideTag); depth && inside != stream->tags.end()) {
      stream->codec = inside->second;
      stream->tags.erase(inside);
    }
    if (depth && !recording_.color.empty()) stream->tags["TITLE"] = "depth";
    const std::string& first = pictures.front().path;
    const bool alone = recording_.color.empty() || recording_.depth.empty();
    if ((depth || alone) && !stream->tags[kFileTag].starts_with(first))
      stream->tags[kFileTag] = first;  // else an array in it
    return stream;
  }

  // The frame rate, in thousandths.
  [[nodiscard]] Ratio rateOf(const std::vector<TimedPicture>& pictures) const {
    if (pictures.size() < 2) return {};
    const double seconds = toSeconds(pictures.back().time - pictures.front().time);
    const double rate =
        recording_.numbered ? 1 / toSeconds(recording_.period) : static_cast<double>(pictures.size() - 1) / seconds;
    return {static_cast<int>(std::lround(std::min(rate, 1e6) * 1000)), 1000};
  }

  void addEntries(const std::vector<TimedPicture>& pictures, int stream) {
    for (std::size_t i = 0; i < pictures.size(); ++i) entries_.push_back({pictures[i].time, stream, i});
  }

  // A view, or beside depth.
  [[nodiscard]] bool isColor(const Entry& entry) const {
    const bool beside_depth = entry.stream == 0 && !recording_.color.empty() && !recording_.depth.empty();
    return recording_.views || beside_depth;
  }

  [[nodiscard]] const std::string& pathOf(const Entry& entry) const {
    const bool depth = entry.stream == 1 || recording_.color.empty();
    return (depth ? recording_.depth : recording_.color)[entry.place].path;
  }

  // The picture in the file.
  Result<std::shared_ptr<Bytes>> readFile(const std::string& path) const {
    const auto archive = unpack_ ? unpack_(path) : nullptr;
    if (!archive) return readPicture(path);
    if (const auto opened = archive->open(path); !opened) return std::unexpected(opened.error());
    const auto packet = archive->read();
    if (!packet) return std::unexpected(packet.error());
    if (!*packet) return std::make_shared<Bytes>();
    return std::make_shared<Bytes>((*packet)->data, (*packet)->data + (*packet)->bytes);
  }

  Entry takeNext() {
    if (reached_.empty()) return entries_[next_++];
    const Entry entry = reached_.back();
    reached_.pop_back();
    return entry;
  }

  void tellMissed(const std::string& path, const char* why) const {
    const std::uint64_t missed = missedPictures();
    if (!isTold(missed)) return;
    log(LogLevel::Warning, "media", "%s: %s; the picture before it is shown longer%s", path.c_str(), why,
        missed > 1 ? print(" (%llu pictures so far)", static_cast<unsigned long long>(missed)).c_str() : "");
  }

  Result<std::optional<Packet>> readPacket() override {
    while (!reached_.empty() || next_ < entries_.size()) {
      if (cancelled_) return fail(ErrorCode::Cancelled, "interrupted while reading pictures");
      const Entry entry = takeNext();
      auto bytes = readFile(pathOf(entry));
      if (!bytes && endsReading(bytes.error())) return std::unexpected(bytes.error());
      if (!bytes || (*bytes)->empty()) {
        countMissed(1);
        ++lost_[static_cast<std::size_t>(entry.stream)];
        tellMissed(pathOf(entry), bytes ? "is empty" : bytes.error().message);
        continue;
      }
      if (isNyuDepth(pathOf(entry))) mendByteOrder(**bytes);
      if (!isColor(entry) && endingOf(pathOf(entry)) == "pgm") keepCodes(**bytes);
      Packet packet{.stream = entry.stream, .data = (*bytes)->data(), .bytes = (*bytes)->size()};
      packet.pts = packet.dts = MediaTime(entry.time);
      packet.keyframe = true;
      packet.owner = std::move(*bytes);
      return packet;
    }
    return std::nullopt;
  }

  // The last picture of each stream at or before the target comes first, then what follows the target.
  Result<void> seekTo(MediaTime target) override {
    if (cancelled_) return fail(ErrorCode::Cancelled, "interrupted while seeking");
    lost_ = {};
    const auto after = std::ranges::upper_bound(entries_, target.time_since_epoch(), {}, &Entry::time);
    next_ = static_cast<std::size_t>(after - entries_.begin());
    reached_.clear();
    for (int stream = 1; stream >= 0; --stream) {
      const auto last = std::find_if(std::make_reverse_iterator(after), entries_.rend(),
                                     [stream](const Entry& entry) { return entry.stream == stream; });
      if (last != entries_.rend()) reached_.push_back(*last);
    }
    return {};
  }

  void closeSource() noexcept override {
    recording_ = {};
    entries_.clear();
    reached_.clear();
    next_ = 0;
    lost_ = {};
  }
  [[nodiscard]] Duration missingTime() const noexcept override {
    return recording_.period * std::max(lost_[0], lost_[1]);
  }
  void interrupted() noexcept override { cancelled_ = true; }

  const DescribePicture describe_;
  const UnpackPicture unpack_;
  std::atomic<bool> cancelled_{false};
  Recording recording_;
  std::vector<Entry> entries_;
  std::vector<Entry> reached_;  // by a seek, the next one last
  std::size_t next_ = 0;
  std::array<int, 2> lost_{};  // of each stream, since the last seek
};

}  // namespace

bool isPictures(const std::string& url) {
  return namesPictures(url);
}

std::unique_ptr<MediaSource> makePicturesSource(DescribePicture describe, UnpackPicture unpack) {
  return std::make_unique<PicturesSource>(std::move(describe), std::move(unpack));
}

}  // namespace relievo
