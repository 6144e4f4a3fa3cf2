// SPDX-License-Identifier: Apache-2.0
// Video decoder for uncoded pictures, which it passes on without a copy.
#include <deque>

#include "drivers/sample/sample.h"
#include "drivers/sample/sample_film.h"

namespace relievo {
namespace {

constexpr std::size_t kMostQueued = 4;

class SampleDecoder final : public VideoDecoder {
 public:
  // A decoder with its own pool of buffers states how many of them the player may hold: at least three.
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = "sample", .max_held_frames = 8, .hardware = false};
  }

 private:
  Result<void> openDecoder(const StreamInfo& stream) override {
    if (stream.codec != kSamplePictures)
      return fail(ErrorCode::Unsupported, "the sample decoder decodes only sample films");
    if (stream.width < 1 || stream.height < 1)
      return fail(ErrorCode::Corrupt, "the pictures have no size; check the film");
    width_ = stream.width, height_ = stream.height;
    period_ = stream.frame_period;
    forget();
    return {};
  }

  Result<Feed> feedPacket(const Packet& packet) override {
    if (queue_.size() == kMostQueued) return Feed::Full;  // not taken: the caller feeds the same packet again
    const auto whole = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    if (packet.bytes != whole || !packet.pts) {
      countDamaged();  // no error: the packet is dropped
    } else {
      queue_.push_back(packet);  // holds the owner, so the memory stays valid
    }
    return Feed::Accepted;
  }

  // Pictures come in presentation order. A codec that reorders must hold them back until their turn.
  Result<Progress> receiveFrame(Frame& frame) override {
    if (queue_.empty()) return draining_ ? Progress::EndOfStream : Progress::NeedsPackets;
    const Packet& packet = queue_.front();
    frame.pts = *packet.pts;
    frame.duration = period_;
    frame.width = width_;
    frame.height = height_;
    frame.model = ColorModel::Gray;
    frame.range = ColorRange::Full;
    frame.plane_count = 1;
    frame.planes[0] = {.data = packet.data, .stride_bytes = width_};
    frame.components[0] = {.plane = 0, .step_bytes = 1, .bits = 8};
    frame.owner = packet.owner;  // the samples stay valid while any copy of the frame lives
    queue_.pop_front();
    return Progress::Picture;
  }

  Result<void> startDrain() override {
    draining_ = true;
    return {};
  }
  Result<void> flushDecoder() override {
    forget();
    return {};
  }
  void closeDecoder() noexcept override { forget(); }

  void forget() noexcept {
    queue_.clear();
    draining_ = false;
  }

  int width_ = 0, height_ = 0;
  Duration period_{0};
  std::deque<Packet> queue_;
  bool draining_ = false;
};

}  // namespace

std::unique_ptr<VideoDecoder> makeSampleDecoder() {
  return std::make_unique<SampleDecoder>();
}

}  // namespace relievo
