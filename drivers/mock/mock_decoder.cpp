// SPDX-License-Identifier: Apache-2.0
// A decoder that paints the picture whose number is in the packet, with a queue, a delay and a pool of realistic size.
#include <algorithm>
#include <cstring>
#include <deque>

#include "drivers/mock/mock.h"
#include "drivers/mock/mock_packet.h"

namespace relievo {
namespace {

constexpr std::ptrdiff_t kRowPaddingBytes = 16;

// A picture's memory. Counts as held as long as a copy of the frame lives.
class Picture {
 public:
  Picture(std::size_t bytes, std::shared_ptr<std::atomic<int>> outside)
      : bytes_(bytes, std::uint8_t{0xA5}), outside_(std::move(outside)) {
    ++*outside_;
  }
  ~Picture() { --*outside_; }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;
  [[nodiscard]] std::uint8_t* data() noexcept { return bytes_.data(); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::shared_ptr<std::atomic<int>> outside_;
};

std::uint16_t movingSlope(const MockTrack& track, int frame, int col, int row) {
  return static_cast<std::uint16_t>((col + row + 2 * frame) & ((1 << track.bits) - 1));
}

void paint(const MockTrack& track, int number, int component, int cols, int rows, std::uint8_t* data,
           std::ptrdiff_t stride) {
  for (int r = 0; r < rows; ++r) {
    std::uint8_t* row = data + r * stride;
    for (int c = 0; c < cols; ++c) {
      const std::uint16_t value =
          track.sample ? track.sample(number, component, c, r) : movingSlope(track, number, c, r);
      *row++ = static_cast<std::uint8_t>(value & 0xFF);
      if (track.bits > 8) *row++ = static_cast<std::uint8_t>(value >> 8);
    }
  }
}

Frame makeFrame(const MockTrack& track, int number, MediaTime pts, const std::shared_ptr<std::atomic<int>>& outside) {
  Frame frame;
  frame.pts = pts;
  frame.duration = track.frame_period;
  frame.width = track.width;
  frame.height = track.height;
  frame.model = track.model;
  frame.range = track.range;
  const bool yuv = track.model == ColorModel::Yuv;
  if (yuv) {
    frame.chroma_shift_x = static_cast<std::uint8_t>(track.chroma_shift_x);
    frame.chroma_shift_y = static_cast<std::uint8_t>(track.chroma_shift_y);
  }
  frame.plane_count = track.model == ColorModel::Gray ? 1 : 3;

  const int sample_bytes = track.bits > 8 ? 2 : 1;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(track.width) * sample_bytes + kRowPaddingBytes;
  const std::ptrdiff_t plane_bytes = stride * track.height;
  const auto picture = std::make_shared<Picture>(static_cast<std::size_t>(plane_bytes) * frame.plane_count, outside);
  for (int i = 0; i < frame.plane_count; ++i) {
    const int shift_x = i > 0 ? frame.chroma_shift_x : 0;
    const int shift_y = i > 0 ? frame.chroma_shift_y : 0;
    const int cols = (track.width + (1 << shift_x) - 1) >> shift_x;
    const int rows = (track.height + (1 << shift_y) - 1) >> shift_y;
    std::uint8_t* const data = picture->data() + i * plane_bytes;
    paint(track, number, i, cols, rows, data, stride);
    const auto plane = static_cast<std::size_t>(i);
    frame.planes[plane] = Plane{data, stride};
    frame.components[plane] = Component{.plane = static_cast<std::uint8_t>(i),
                                        .step_bytes = static_cast<std::uint8_t>(sample_bytes),
                                        .bits = static_cast<std::uint8_t>(track.bits)};
  }
  frame.owner = picture;
  return frame;
}

class MockDecoder final : public VideoDecoder {
 public:
  explicit MockDecoder(const MockDecoderProfile& profile)
      : profile_(profile),
        // A queue as short as reorder_frames would be full before the first picture.
        capacity_(std::max(profile.queue_packets, static_cast<std::size_t>(std::max(profile.reorder_frames, 0)) + 1)) {}

  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = "mock", .max_held_frames = profile_.max_held_frames, .hardware = false};
  }

 private:
  Result<void> openDecoder(const StreamInfo& stream) override {
    if (stream.codec != kMockCodec || stream.native == nullptr) {
      return fail(ErrorCode::Unsupported, "the mock decoder decodes mock films only");
    }
    track_ = std::static_pointer_cast<const MockTrack>(stream.native);
    if (track_->width < 1 || track_->height < 1 || track_->bits < 8 || track_->bits > 16) {
      return fail(ErrorCode::Corrupt, "a mock track must have a size and 8 to 16 bits");
    }
    packets_ = 0;
    leaves_out_ = false;
    forget();
    return {};
  }

  void leaveOut(bool unreferenced) noexcept override { leaves_out_ = unreferenced; }

  Result<Feed> feedPacket(const Packet& packet) override {
    if (packets_ >= profile_.lose_after_packets) return fail(ErrorCode::Lost, "the mock decoder has died");
    if (queue_.size() >= capacity_) return Feed::Full;
    ++packets_;
    MockPacket content;
    const bool whole = packet.data != nullptr && packet.bytes == sizeof content;
    if (whole) std::memcpy(&content, packet.data, sizeof content);
    // As in a real stream, packets before the first key frame cannot be decoded.
    if (packet.keyframe) has_key_frame_ = true;
    if (!whole || content.damaged || !has_key_frame_) {
      countDamaged();
    } else if (!leaves_out_ || content.frame % profile_.referenced_every == 0) {
      queue_.push_back({content.frame, packet.pts.value_or(track_->pts(content.frame))});
    }
    return Feed::Accepted;
  }

  Result<Progress> receiveFrame(Frame& frame) override {
    if (packets_ >= profile_.lose_after_packets) return fail(ErrorCode::Lost, "the mock decoder has died");
    if (queue_.empty()) return draining_ ? Progress::EndOfStream : Progress::NeedsPackets;
    const auto held_back = static_cast<std::size_t>(draining_ ? 0 : std::max(profile_.reorder_frames, 0));
    if (queue_.size() <= held_back || *outside_ >= profile_.max_held_frames) return Progress::NeedsPackets;
    frame = makeFrame(*track_, queue_.front().number, queue_.front().pts, outside_);
    queue_.pop_front();
    return Progress::Picture;
  }

  Result<void> startDrain() override {
    draining_ = true;
    return {};
  }

  Result<void> flushDecoder() override {
    if (packets_ >= profile_.lose_after_packets) return fail(ErrorCode::Lost, "the mock decoder has died");
    forget();
    return {};
  }

  void closeDecoder() noexcept override {
    forget();
    track_.reset();
  }

  void forget() noexcept {
    queue_.clear();
    draining_ = false;
    has_key_frame_ = false;
  }

  MockDecoderProfile profile_;
  std::size_t capacity_;
  std::shared_ptr<const MockTrack> track_;
  struct Queued {
    int number;
    MediaTime pts;
  };
  std::deque<Queued> queue_;
  std::uint64_t packets_ = 0;
  bool draining_ = false;
  bool has_key_frame_ = false;
  bool leaves_out_ = false;
  // The number of held pictures; shared with them, since they may outlive the decoder.
  std::shared_ptr<std::atomic<int>> outside_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace

std::unique_ptr<VideoDecoder> makeMockDecoder(MockDecoderProfile profile) {
  return std::make_unique<MockDecoder>(profile);
}

}  // namespace relievo
