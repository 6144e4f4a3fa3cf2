// SPDX-License-Identifier: Apache-2.0
// Media source: `open` indexes the file's packets, and `seek` searches the index.
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "drivers/sample/sample.h"
#include "drivers/sample/sample_film.h"

namespace relievo {
namespace {

constexpr std::uint32_t kLargestSide = 16384;

// The base class guards the states: it calls each function below only in the states that its contract allows.
class SampleSource final : public MediaSource {
 private:
  struct Entry {
    SamplePacketHeader header;
    std::streamoff offset = 0;
  };

  // After a failure the base class calls `closeSource`, so there is nothing to undo here.
  Result<Description> openSource(const std::string& url) override {
    interrupted_ = false;
    file_.open(url, std::ios::binary);
    if (!file_) return fail(ErrorCode::NotFound, "the film cannot be opened; check its path", errno);
    SampleHeader header;
    if (!readInto(header) || header.magic != kSampleMagic)
      return fail(ErrorCode::Corrupt, "this is no sample film; choose another file");
    // Check every value from the file before using it.
    if (header.width < 1 || header.width > kLargestSide || header.height < 1 || header.height > kLargestSide ||
        header.frame_period_ns < 1) {
      return fail(ErrorCode::Corrupt, "the film's header is invalid; check the file");
    }
    readIndex();
    return describe(header);
  }

  // A truncated file ends with its last whole packet.
  void readIndex() {
    const std::streamoff begin = file_.tellg();
    const std::streamoff end = file_.seekg(0, std::ios::end).tellg();
    file_.seekg(begin);
    for (Entry entry; readInto(entry.header);) {
      entry.offset = file_.tellg();
      if (end - entry.offset < std::streamoff{entry.header.bytes}) break;
      index_.push_back(entry);
      file_.seekg(entry.header.bytes, std::ios::cur);
    }
    file_.clear();
    next_ = 0;
  }

  [[nodiscard]] Description describe(const SampleHeader& header) const {
    StreamInfo pictures;
    pictures.kind = StreamKind::Video;
    pictures.codec = kSamplePictures;
    pictures.width = static_cast<int>(header.width);
    pictures.height = static_cast<int>(header.height);
    pictures.frame_period = Duration(header.frame_period_ns);
    Description film{.streams = {pictures}, .tags = {}, .duration = Duration(0), .origin = {}};
    if (header.sample_rate_hz > 0) {
      StreamInfo sound;
      sound.index = 1;
      sound.kind = StreamKind::Audio;
      sound.codec = kSampleSound;
      sound.sample_rate_hz = static_cast<int>(header.sample_rate_hz);
      sound.channels = static_cast<int>(header.channels);
      film.streams.push_back(sound);
    }
    film.tags["TITLE"] = std::string(header.title.data(), ::strnlen(header.title.data(), header.title.size()));
    for (const Entry& entry : index_) {
      if (entry.header.stream != 0) continue;
      film.duration = std::max(film.duration, Duration(entry.header.pts_ns + header.frame_period_ns));
    }
    return film;
  }

  Result<std::optional<Packet>> readPacket() override {
    if (interrupted_) return fail(ErrorCode::Cancelled, "reading was interrupted");
    if (next_ == index_.size()) return std::nullopt;  // the end: the base class remembers it
    const Entry& entry = index_[next_];
    // The packet's holder owns the memory, which may outlive the source.
    const auto bytes = std::make_shared<std::vector<std::uint8_t>>(entry.header.bytes);
    if (!file_.seekg(entry.offset).read(reinterpret_cast<char*>(bytes->data()), entry.header.bytes)) {
      return fail(ErrorCode::Io, "the film cannot be read any further; check the disk");
    }
    ++next_;
    return Packet{.stream = entry.header.stream,
                  .data = bytes->data(),
                  .bytes = bytes->size(),
                  .pts = MediaTime(Duration(entry.header.pts_ns)),
                  .keyframe = entry.header.keyframe != 0,
                  .owner = bytes};
  }

  Result<void> seekTo(MediaTime target) override {
    if (interrupted_) return fail(ErrorCode::Cancelled, "seeking was interrupted");
    next_ = 0;
    for (std::size_t i = 0; i < index_.size(); ++i) {
      const SamplePacketHeader& packet = index_[i].header;
      if (packet.stream == 0 && packet.keyframe != 0 && MediaTime(Duration(packet.pts_ns)) <= target) next_ = i;
    }
    return {};
  }

  void closeSource() noexcept override {
    file_ = {};
    index_.clear();
  }

  // Called from another thread, in any state. A source that waits for a network or a camera must check it at least
  // every 100 ms; a file does not wait.
  void interrupted() noexcept override { interrupted_ = true; }

  template <class T>
  bool readInto(T& value) {
    return static_cast<bool>(file_.read(reinterpret_cast<char*>(&value), sizeof value));
  }

  std::ifstream file_;
  std::vector<Entry> index_;
  std::size_t next_ = 0;
  std::atomic<bool> interrupted_{false};
};

}  // namespace

std::unique_ptr<MediaSource> makeSampleSource() {
  return std::make_unique<SampleSource>();
}

}  // namespace relievo
