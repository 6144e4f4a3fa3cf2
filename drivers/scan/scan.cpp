// SPDX-License-Identifier: Apache-2.0
#include "drivers/scan/scan.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

#include "drivers/scan/scan_file.h"
#include "drivers/scan/scan_picture.h"
#include "hal/media/media_names.h"

namespace relievo {
namespace {

using namespace scan;

constexpr Duration kUsualPeriod = std::chrono::nanoseconds(33'333'333);

std::string plainPath(const std::string& url) {
  return url.starts_with("file:") ? url.substr(5) : url;
}

Error cancelledError() noexcept {
  return {ErrorCode::Cancelled, 0, "interrupted while reading the scan"};
}

class ScanSource final : public MediaSource {
 public:
  ~ScanSource() override { close(); }

 private:
  Result<Description> openSource(const std::string& url) override {
    cancelled_ = false;
    next_ = 0;
    const std::string path = plainPath(url);
    auto file = AnsweredFile::open(path);
    if (!file) return std::unexpected(file.error());
    file_ = std::move(*file);
    const std::string ending = endingOf(path);
    auto read = ending == "klg" ? readKlg(file_, cancelled_) : readSens(file_, cancelled_);
    if (!read && ending.empty()) read = readKlg(file_, cancelled_);  // a pipe's or a memory's file has no ending
    if (const auto failure = file_.failure()) return std::unexpected(*failure);
    if (!read) return std::unexpected(read.error());
    scan_ = std::move(*read);
    has_color_ = scan_.frames.front().color.bytes > 0;
    takeTimes();
    Description description;
    if (has_color_) description.streams.push_back(streamOf(false));
    description.streams.push_back(streamOf(true));
    description.duration = description.streams.back().duration;
    if (scan_.cut_off) description.notes.emplace_back("the scan is cut off: it ends with its last whole frame");
    return description;
  }

  void takeTimes() {
    const auto& frames = scan_.frames;
    const auto not_later = [](const ScanFrame& a, const ScanFrame& b) { return b.time_us <= a.time_us; };
    constexpr std::uint64_t kLongestUs = 1'000'000'000'000;  // eleven days
    timed_ = std::ranges::adjacent_find(frames, not_later) == frames.end() && frames.size() > 1 &&
             frames.back().time_us - frames.front().time_us < kLongestUs;
  }

  [[nodiscard]] Duration timeOf(std::size_t frame) const noexcept {
    if (!timed_) return static_cast<std::int64_t>(frame) * kUsualPeriod;
    return std::chrono::microseconds(scan_.frames[frame].time_us - scan_.frames.front().time_us);
  }

  [[nodiscard]] StreamInfo streamOf(bool depth) const {
    StreamInfo stream;
    stream.index = depth && has_color_ ? 1 : 0;
    describePictures(scan_, depth, stream);
    stream.counted = !timed_;
    stream.frame_period = kUsualPeriod;
    const std::size_t count = scan_.frames.size();
    if (timed_) stream.frame_period = timeOf(count - 1) / static_cast<std::int64_t>(count - 1);
    stream.duration = timeOf(count - 1) + stream.frame_period;
    return stream;
  }

  // A frame is its colour, then its depth.
  Result<std::optional<Packet>> readPacket() override {
    while (next_ < 2 * scan_.frames.size()) {
      if (cancelled_) return std::unexpected(cancelledError());
      const std::size_t frame = next_ / 2;
      const bool depth = next_++ % 2 == 1;
      if (!depth && !has_color_) continue;
      auto stored = readPlace(file_, depth ? scan_.frames[frame].depth : scan_.frames[frame].color);
      auto packet = stored ? packetOf(scan_, depth, std::move(*stored)) : std::nullopt;
      if (!packet) {
        if (const auto failure = file_.failure()) return std::unexpected(*failure);
        countMissed(1);
        continue;
      }
      packet->stream = depth && has_color_ ? 1 : 0;
      packet->pts = packet->dts = MediaTime(timeOf(frame));
      return packet;
    }
    if (cancelled_) return std::unexpected(cancelledError());
    return std::nullopt;
  }

  // To the last frame at or before the target.
  Result<void> seekTo(MediaTime target) override {
    if (cancelled_) return std::unexpected(cancelledError());
    std::size_t low = 0, high = scan_.frames.size();
    while (low + 1 < high) {
      const std::size_t middle = (low + high) / 2;
      (MediaTime(timeOf(middle)) <= target ? low : high) = middle;
    }
    next_ = 2 * low;
    return {};
  }

  void closeSource() noexcept override {
    file_.close();
    scan_ = {};
  }
  void interrupted() noexcept override { cancelled_ = true; }

  std::atomic<bool> cancelled_{false};
  AnsweredFile file_;
  Scan scan_;
  bool has_color_ = false, timed_ = false;
  std::size_t next_ = 0;  // twice the frame, and one more for its depth
};

}  // namespace

bool isScan(const std::string& url) {
  const std::string path = plainPath(url), ending = endingOf(path);
  if (ending != "sens" && ending != "klg") return false;
  const auto file = AnsweredFile::open(path);
  return file && file->regular();
}

std::unique_ptr<MediaSource> makeScanSource() {
  return std::make_unique<ScanSource>();
}

}  // namespace relievo
