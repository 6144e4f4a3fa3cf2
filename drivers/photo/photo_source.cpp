// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>

#include "drivers/photo/photo.h"
#include "platform/files/answered_file.h"

namespace relievo {
namespace {

constexpr std::uint64_t kFirstBytes = 64;

// The file's bytes, if it is a regular file that begins like one of the kinds and is not larger than such photos are;
// else none.
PhotoBytes bytesOf(const std::string& path, std::span<const PhotoKind> kinds) {
  auto bytes = std::make_shared<std::vector<std::uint8_t>>();
  const auto file = AnsweredFile::open(path);
  const std::uint64_t size = file && file->regular() ? file->bytes().value_or(0) : 0;
  if (size == 0) return bytes;
  const auto readTo = [&](std::uint64_t end) {
    const std::size_t begin = bytes->size();
    bytes->resize(static_cast<std::size_t>(end));
    bytes->resize(begin + file->read(begin, std::span(*bytes).subspan(begin)).value_or(0));
  };
  readTo(std::min(kFirstBytes, size));
  const auto takes = [&](const PhotoKind& kind) { return size <= kind.most_bytes && kind.begins(*bytes); };
  if (std::ranges::any_of(kinds, takes)) {
    readTo(size);
  } else {
    bytes->clear();
  }
  return bytes;
}

class PhotoSource final : public MediaSource {
 public:
  explicit PhotoSource(std::span<const PhotoKind> kinds) noexcept : kinds_(kinds) {}
  ~PhotoSource() override { close(); }

 private:
  Result<Description> openSource(const std::string& url) override {
    interrupted_ = false;
    parts_ = photoParts(url, kinds_);
    next_ = 0;
    if (parts_.empty()) return fail(ErrorCode::Corrupt, "is no photo with depth or two views; check the file");
    Description description;
    for (PhotoPart& part : parts_) {
      part.stream.index = static_cast<int>(description.streams.size());
      part.stream.kind = StreamKind::Video;
      part.stream.counted = true;
      description.streams.push_back(part.stream);
      if (!part.note.empty()) description.notes.push_back(part.note);
    }
    return description;
  }

  Result<std::optional<Packet>> readPacket() override {
    if (interrupted_) return fail(ErrorCode::Cancelled, "interrupted");
    if (next_ == parts_.size()) return std::nullopt;
    const PhotoPart& part = parts_[next_++];
    return Packet{.stream = part.stream.index,
                  .data = part.coded.data(),
                  .bytes = part.coded.size(),
                  .pts = MediaTime{},
                  .dts = MediaTime{},
                  .keyframe = true,
                  .owner = part.owner};
  }

  Result<void> seekTo(MediaTime) override {
    next_ = 0;
    return {};
  }
  void closeSource() noexcept override { parts_.clear(); }
  void interrupted() noexcept override { interrupted_ = true; }

  const std::span<const PhotoKind> kinds_;
  std::atomic<bool> interrupted_ = false;
  std::vector<PhotoPart> parts_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<PhotoPart> photoParts(const std::string& path, std::span<const PhotoKind> kinds) {
  const PhotoBytes file = bytesOf(path, kinds);
  for (const PhotoKind& kind : kinds) {
    if (!kind.begins(*file)) continue;
    if (auto parts = kind.parts(file); !parts.empty()) return parts;
  }
  return {};
}

bool isPhoto(const std::string& path, std::span<const PhotoKind> kinds) {
  return !photoParts(path, kinds).empty();
}

std::unique_ptr<MediaSource> makePhotoSource(std::span<const PhotoKind> kinds) {
  return std::make_unique<PhotoSource>(kinds);
}

}  // namespace relievo
