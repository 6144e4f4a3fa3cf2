// SPDX-License-Identifier: Apache-2.0
// Gives out the pictures of ScanNet++'s depth.bin, which has no times.
#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include "drivers/scan/depth_bin.h"
#include "drivers/scan/scan.h"

namespace relievo {
namespace {

using scan::DepthBin;

constexpr double kUsualRate = 60;  // of the recorder

std::string plainPath(const std::string& url) {
  return url.starts_with("file:") ? url.substr(5) : url;
}

class DepthBinSource final : public MediaSource {
 public:
  ~DepthBinSource() override { close(); }

 private:
  Result<Description> openSource(const std::string& url) override {
    cancelled_ = false;
    number_ = 0;
    auto file = AnsweredFile::open(plainPath(url));
    if (!file) return std::unexpected(file.error());
    file_ = std::move(*file);
    auto bin = DepthBin::open(file_, cancelled_);
    if (cancelled_) return fail(ErrorCode::Cancelled, "interrupted while reading the scan");
    if (const auto failure = file_.failure()) return std::unexpected(*failure);
    if (!bin) return std::unexpected(bin.error());
    bin_.emplace(std::move(*bin));
    rate_ = pictureRate().value_or(kUsualRate);
    StreamInfo stream;
    stream.kind = StreamKind::Video;
    stream.codec = "rawvideo";
    stream.pixel_format = "gray16le";
    stream.bits = 16;
    stream.width = DepthBin::kCols;
    stream.height = DepthBin::kRows;
    stream.counted = true;
    stream.frame_period = timeOf(1);
    stream.duration = timeOf(bin_->pictures().value_or(0));
    stream.tags = {{"TITLE", "depth"}, {"DEPTH_UNIT", "1"}, {"DEPTH_INVALID", "0"}};
    Description description;
    description.duration = stream.duration;
    description.streams.push_back(std::move(stream));
    if (bin_->cutOff()) description.notes.emplace_back("the scan is cut off: it ends with its last whole frame");
    return description;
  }

  [[nodiscard]] Duration timeOf(std::size_t number) const noexcept {
    return Duration(static_cast<std::int64_t>(1e9 * static_cast<double>(number) / rate_));
  }

  Result<std::optional<Packet>> readPacket() override {
    while (!cancelled_) {
      auto mm = std::make_shared<std::vector<std::uint8_t>>();
      const DepthBin::Read read = bin_->next(*mm);
      if (const auto failure = file_.failure()) return std::unexpected(*failure);
      if (read == DepthBin::Read::End) return std::nullopt;
      const std::size_t number = number_++;
      if (read == DepthBin::Read::Damaged) {
        countMissed(1);
        continue;
      }
      Packet packet;
      packet.data = mm->data();
      packet.bytes = mm->size();
      packet.keyframe = true;
      packet.pts = packet.dts = MediaTime(timeOf(number));
      packet.owner = std::move(mm);
      return packet;
    }
    return fail(ErrorCode::Cancelled, "interrupted while reading the scan");
  }

  // To the last picture at or before the target.
  Result<void> seekTo(MediaTime target) override {
    const double at = std::max(0.0, toSeconds(target) * rate_ + 1e-6);
    number_ = static_cast<std::size_t>(at);
    if (const auto count = bin_->pictures()) number_ = std::min(number_, *count - 1);
    if (!bin_->goTo(number_, cancelled_)) return fail(ErrorCode::Cancelled, "interrupted while reading the scan");
    return {};
  }

  void closeSource() noexcept override {
    bin_.reset();
    file_.close();
  }
  void interrupted() noexcept override { cancelled_ = true; }

  std::atomic<bool> cancelled_{false};
  AnsweredFile file_;
  std::optional<DepthBin> bin_;
  double rate_ = kUsualRate;
  std::size_t number_ = 0;  // of the next picture
};

}  // namespace

bool isDepthBin(const std::string& url) {
  const std::string path = plainPath(url);
  if (path.substr(path.rfind('/') + 1) != "depth.bin") return false;
  const auto file = AnsweredFile::open(path);
  return file && file->regular();
}

std::unique_ptr<MediaSource> makeDepthBinSource() {
  return std::make_unique<DepthBinSource>();
}

}  // namespace relievo
