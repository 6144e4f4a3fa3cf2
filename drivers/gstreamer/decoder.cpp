// SPDX-License-Identifier: Apache-2.0
// Packets go in until as many are inside as a decoder may need, then one comes out for each that goes in. The caller's
// thread does nothing but hand over; the element's own threads decode.
#include <algorithm>
#include <deque>
#include <utility>

#include "drivers/gstreamer/elements.h"
#include "drivers/gstreamer/gstreamer.h"
#include "drivers/gstreamer/picture.h"
#include "drivers/gstreamer/pipeline.h"
#include "hal/media/leading_pictures.h"
#include "platform/clock.h"
#include "platform/log.h"

namespace relievo {
namespace {

using namespace gstreamer;

constexpr int kMaxHeldFrames = 64;  // beyond a hardware element's buffers, frames are copies
// Packets inside without a picture: H.264's reordering and a few more. An element that needs more, such as one with
// many threads, gets more.
constexpr std::size_t kUsuallyInside = 20, kMoreInside = 8, kMostInside = 64;
constexpr std::uint64_t kFarthest = 16;  // pictures by which H.264 and HEVC may delay a picture
constexpr Duration kDefaultPeriod = std::chrono::milliseconds(40);
// How long the element may do nothing while it has work; the first time it may have to start its device.
constexpr Duration kPatience = std::chrono::milliseconds(400), kFirstPatience = std::chrono::milliseconds(800);
// An element in software shares the processors with whatever else runs; a picture takes it many times as long then.
constexpr Duration kSoftwarePatience = std::chrono::seconds(5);
constexpr Duration kTurn = std::chrono::milliseconds(20), kHungry = std::chrono::milliseconds(60);
// GStreamer's times cannot be negative; media times can, slightly.
constexpr Duration kTimeOffset = std::chrono::hours(1000);

constexpr const char* kHangs = "the GStreamer element stopped responding";

GstClockTime toPipeline(MediaTime time) noexcept {
  return static_cast<GstClockTime>(std::max((time.time_since_epoch() + kTimeOffset).count(), std::int64_t{0}));
}

class GstreamerDecoder final : public VideoDecoder {
 public:
  explicit GstreamerDecoder(std::string element) : wanted_(std::move(element)) {}
  ~GstreamerDecoder() override { close(); }

  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = "gstreamer", .max_held_frames = kMaxHeldFrames, .hardware = isHardwareElement()};
  }
  [[nodiscard]] std::string description() const override {
    return std::string("gstreamer, ") + GST_OBJECT_NAME(factory_.get());
  }

 private:
  [[nodiscard]] bool isHardwareElement() const noexcept { return factory_ && isHardware(*factory_); }

  Result<void> openDecoder(const StreamInfo& stream) override {
    coding_ = codingOf(stream);
    if (coding_ == nullptr) return fail(ErrorCode::Unsupported, "GStreamer is not used for this codec");
    if (auto loaded = load(); !loaded) return loaded;
    auto factories = decodersFor(*coding_, stream.bits, wanted_);
    if (!factories) return std::unexpected(factories.error());
    stream_ = stream;
    inside_most_ = kUsuallyInside;
    given_any_ = false;
    forget();
    Result<void> started;
    for (FactoryPtr& factory : *factories) {
      factory_ = std::move(factory);
      if (started = start(); started) return {};
      log(LogLevel::Info, "media", "%s: %s", GST_OBJECT_NAME(factory_.get()), started.error().message);
    }
    return started;
  }

  Result<void> start() {
    auto made = Pipeline::make(*coding_, *factory_, capsOf(*coding_, stream_));
    if (!made) return std::unexpected(made.error());
    pipeline_ = std::move(*made);
    return {};
  }

  struct Inside {
    std::uint64_t tag;
    MediaTime pts;
    bool leads;  // of LeadingPictures
  };

  Result<Feed> feedPacket(const Packet& packet) override {
    if (packet.bytes == 0) return Feed::Accepted;
    if (!packet.pts) return fail(ErrorCode::Unsupported, "GStreamer cannot decode pictures without timestamps");
    if (const auto failed = pipeline_->failure()) return std::unexpected(*failed);
    if (inside_.size() >= inside_most_) return Feed::Full;
    if (!begun_ && !packet.keyframe) {  // packets before the first key frame are not decodable
      countDamaged();
      return Feed::Accepted;
    }
    if (!std::exchange(begun_, true)) leading_.begin(*packet.pts);
    inside_.push_back({++last_tag_, *packet.pts, leading_.has(*packet.pts)});
    pipeline_->push(
        bufferOf(packet, toPipeline(*packet.pts), packet.dts ? toPipeline(*packet.dts) : GST_CLOCK_TIME_NONE));
    return Feed::Accepted;
  }

  Result<Progress> receiveFrame(Frame& frame) override {
    Duration idle{0};
    for (std::size_t waited_for = 0;;) {
      if (draining_ && !begun_) return Progress::EndOfStream;
      const auto got = takePicture(frame);
      if (!got) return std::unexpected(got.error());
      if (*got) return Progress::Picture;
      if (draining_ && pipeline_->ended()) return endOfStream();
      if (!draining_ && inside_.size() < inside_most_) return Progress::NeedsPackets;
      const std::size_t waiting = pipeline_->waiting();
      if (std::exchange(waited_for, waiting) != waiting) idle = Duration(0);  // the element takes packets
      if (!draining_ && waiting == 0 && idle >= kHungry && inside_most_ < kMostInside) {
        inside_most_ += kMoreInside;
        return Progress::NeedsPackets;
      }
      if (auto still = wait(idle); !still) return std::unexpected(still.error());
    }
  }

  // False if there is none.
  Result<bool> takePicture(Frame& frame) {
    for (;;) {
      const SamplePtr sample = next_ ? std::move(next_) : pipeline_->pull(Duration(0));
      if (const auto failed = pipeline_->failure())
        return std::unexpected(*failed);  // the picture may come from after the failure
      if (!sample) return false;
      const GstBuffer* const buffer = gst_sample_get_buffer(sample.get());
      const auto packet = answered(*buffer);
      if (!packet) continue;
      given_any_ = true;
      if (GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_CORRUPTED)) {
        giveUp(*packet);
        continue;
      }
      auto picture = frameOf(*sample, stream_, held_, isHardwareElement() && *held_ >= kPicturesHeld);
      if (!picture) return std::unexpected(picture.error());
      frame = std::move(*picture);
      frame.pts = packet->pts;
      frame.duration = stream_.frame_period > Duration(0) ? stream_.frame_period : kDefaultPeriod;
      return true;
    }
  }

  // The packet that yielded the picture; nullopt if unknown. Packets that should have yielded theirs long before are
  // counted as damaged.
  std::optional<Inside> answered(const GstBuffer& buffer) {
    const GstClockTime time = GST_BUFFER_PTS(&buffer);
    const auto found = std::find_if(inside_.begin(), inside_.end(), [&](auto& i) { return toPipeline(i.pts) == time; });
    if (found == inside_.end()) return std::nullopt;
    const Inside packet = *found;
    inside_.erase(found);
    for (; !inside_.empty() && inside_.front().tag + kFarthest < packet.tag; inside_.pop_front()) {
      giveUp(inside_.front());
    }
    return packet;
  }
  void giveUp(const Inside& packet) noexcept {
    if (!packet.leads) countDamaged();
  }

  // Each wait counts at most two turns, so that a stalled machine does not time the element out.
  Result<void> wait(Duration& idle) {
    const Duration patience = given_any_ ? kPatience : kFirstPatience;
    if (idle >= (isHardwareElement() ? patience : kSoftwarePatience)) {
      pipeline_->abandon();
      return fail(ErrorCode::Lost, kHangs);
    }
    const MonotonicTime begin = clock_.now();
    next_ = pipeline_->pull(kTurn);
    if (!next_) clock_.sleepUntil(begin + kTurn / 10);  // a failed pipeline does not wait
    idle += std::min(clock_.now() - begin, 2 * kTurn);
    return {};
  }

  Result<void> startDrain() override {
    draining_ = true;
    if (begun_) pipeline_->end();
    return {};
  }
  // The remaining packets will yield no pictures.
  Progress endOfStream() {
    for (; !inside_.empty(); inside_.pop_front()) giveUp(inside_.front());
    return Progress::EndOfStream;
  }

  // An ended pipeline takes no more packets, and elements differ in what a flush leaves inside.
  Result<void> flushDecoder() override {
    const bool fresh = !begun_ && !draining_;
    forget();
    if (fresh) return {};
    if (!pipeline_->stop()) return fail(ErrorCode::Lost, kHangs);
    return start();
  }

  void closeDecoder() noexcept override {
    forget();
    pipeline_.reset();
  }

  void forget() noexcept {
    inside_.clear();
    next_.reset();
    begun_ = draining_ = false;
  }

  MonotonicClock clock_;
  const std::string wanted_;
  const Coding* coding_ = nullptr;
  FactoryPtr factory_;  // of the element
  StreamInfo stream_;
  std::unique_ptr<Pipeline> pipeline_;
  HeldCount held_ = std::make_shared<std::atomic<int>>(0);
  SamplePtr next_;  // a picture that a wait got

  std::deque<Inside> inside_;  // packets that have no picture yet
  std::size_t inside_most_ = kUsuallyInside;
  std::uint64_t last_tag_ = 0;
  bool begun_ = false;  // a packet was fed
  LeadingPictures leading_;
  bool draining_ = false;
  bool given_any_ = false;
};

}  // namespace

std::unique_ptr<VideoDecoder> makeGstreamerDecoder(std::string element) {
  return std::make_unique<GstreamerDecoder>(std::move(element));
}

}  // namespace relievo
