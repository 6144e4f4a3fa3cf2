// SPDX-License-Identifier: Apache-2.0
// Passes raw pictures on without decoding; converts depth to a gray picture if it is shown as the colour.
#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include "drivers/v4l2/camera_memory.h"
#include "drivers/v4l2/stream.h"
#include "drivers/v4l2/v4l2.h"

namespace relievo {
namespace {

using namespace v4l2;

constexpr std::size_t kQueued = 4;
constexpr int kMaxHeldFrames = 64;  // beyond the camera's buffers, frames are copies

// The distance that is shown black: the size of a room, since the film's own range is not known here.
constexpr int kBlackMm = 3000;

std::vector<std::uint8_t> brightnessTable(const Format& format) {
  std::vector<std::uint8_t> table(std::size_t{1} << format.bits);
  for (std::size_t code = 0; code < table.size(); ++code) {
    const auto mm = static_cast<int>(std::min<std::size_t>(code, kBlackMm));
    const int near = code == 0 ? 0 : 255 * (kBlackMm - mm) / kBlackMm;
    table[code] = static_cast<std::uint8_t>(format.distances ? near : code >> (format.bits - 8));
  }
  return table;
}

class RawDecoder final : public VideoDecoder {
 public:
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = "v4l2", .max_held_frames = kMaxHeldFrames, .hardware = false};
  }

 private:
  Result<void> openDecoder(const StreamInfo& stream) override {
    if (!isV4l2Raw(stream)) return fail(ErrorCode::Unsupported, "the stream holds no raw pictures of a camera");
    stream_ = std::static_pointer_cast<const RawStream>(stream.native);
    brightness_.clear();
    if (stream_->view == RawStream::View::Gray) brightness_ = brightnessTable(stream_->format);
    return {};
  }

  Result<Feed> feedPacket(const Packet& packet) override {
    if (queue_.size() >= kQueued) return Feed::Full;
    if (packet.bytes < stream_->layout.bytes || !packet.pts) {
      countDamaged();
    } else {
      queue_.push_back(packet);
    }
    return Feed::Accepted;
  }

  Result<Progress> receiveFrame(Frame& frame) override {
    if (queue_.empty()) return draining_ ? Progress::EndOfStream : Progress::NeedsPackets;
    const Packet packet = std::move(queue_.front());
    queue_.pop_front();
    frame = stream_->view == RawStream::View::Gray ? grayOf(packet) : frameOf(packet);
    frame.pts = *packet.pts;
    frame.duration = stream_->period;
    return Progress::Picture;
  }

  [[nodiscard]] Frame frameOf(const Packet& packet) const {
    Frame frame = stream_->layout.placeAt(packet.data);
    frame.owner = packet.owner;
    if (std::get_deleter<HeldDeleter>(packet.owner) == nullptr) return frame;
    const int fd = static_cast<const Held*>(packet.owner.get())->dma_buf;
    for (std::size_t i = 0; i < frame.plane_count; ++i) {
      frame.dma_bufs[i] = {fd, static_cast<std::uint32_t>(stream_->layout.plane_offsets[i])};
    }
    return frame;
  }

  [[nodiscard]] Frame grayOf(const Packet& packet) const {
    const Frame depth = stream_->layout.placeAt(packet.data);
    const auto cols = static_cast<std::size_t>(depth.width), rows = static_cast<std::size_t>(depth.height);
    auto pixels = std::make_shared<std::vector<std::uint8_t>>(cols * rows);
    const std::size_t mask = brightness_.size() - 1;
    for (std::size_t r = 0; r < rows; ++r) {
      const std::uint8_t* sample = depth.planes[0].data + static_cast<std::ptrdiff_t>(r) * depth.planes[0].stride_bytes;
      std::uint8_t* const out = pixels->data() + r * cols;
      for (std::size_t c = 0; c < cols; ++c, sample += 2) {
        out[c] = brightness_[(static_cast<std::size_t>(sample[0]) | static_cast<std::size_t>(sample[1]) << 8) & mask];
      }
    }
    Frame gray = depth;
    gray.components[0] = Component{};
    gray.planes[0] = {pixels->data(), depth.width};
    gray.owner = std::move(pixels);
    return gray;
  }

  Result<void> startDrain() override {
    draining_ = true;
    return {};
  }
  Result<void> flushDecoder() override {
    forget();
    return {};
  }
  void closeDecoder() noexcept override {
    forget();
    stream_.reset();
  }
  void forget() noexcept {
    queue_.clear();
    draining_ = false;
  }

  std::shared_ptr<const RawStream> stream_;
  std::vector<std::uint8_t> brightness_;  // indexed by code
  std::deque<Packet> queue_;
  bool draining_ = false;
};

}  // namespace

bool isV4l2Raw(const StreamInfo& stream) noexcept {
  return std::get_deleter<RawStreamDeleter>(stream.native) != nullptr;
}

std::unique_ptr<VideoDecoder> makeV4l2RawDecoder() {
  return std::make_unique<RawDecoder>();
}

}  // namespace relievo
