// SPDX-License-Identifier: Apache-2.0
// The states of a stateful decoder (Documentation/userspace-api/media/v4l/dev-decoder.rst; comments in quotes are the
// names of its sequences).
#include <poll.h>

#include <algorithm>
#include <deque>
#include <utility>

#include "drivers/v4l2/annex_b.h"
#include "drivers/v4l2/m2m_buffers.h"
#include "drivers/v4l2/m2m_node.h"
#include "drivers/v4l2/m2m_picture_queue.h"
#include "drivers/v4l2/v4l2.h"
#include "hal/media/leading_pictures.h"
#include "platform/clock.h"

namespace relievo {
namespace {

using namespace v4l2;

constexpr std::uint32_t kPackets = 6;        // buffers for packets
constexpr int kMaxHeldFrames = 64;           // beyond the driver's buffers, frames are copies
constexpr std::size_t kMostUnanswered = 64;  // packets without a picture, until the oldest counts as damaged
constexpr Duration kDefaultPeriod = std::chrono::milliseconds(40);
// How long the driver may do nothing while it has work; the first time it may have to load firmware.
constexpr Duration kPatience = std::chrono::milliseconds(400), kFirstPatience = std::chrono::seconds(1);
constexpr Duration kTurn = std::chrono::milliseconds(20);
// A driver that tells no format after that is asked for it: see `tellsNothing`.
constexpr Duration kUntoldFor = std::chrono::milliseconds(100);
constexpr std::size_t kUntoldPackets = 32;
constexpr Duration kNap = std::chrono::milliseconds(1);  // after poll(2) announced something and there was nothing

constexpr const char* kHangs = "the video hardware stopped responding";

class M2mDecoder final : public VideoDecoder {
 public:
  ~M2mDecoder() override { close(); }

  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = "v4l2-m2m", .max_held_frames = kMaxHeldFrames, .hardware = true};
  }
  [[nodiscard]] std::string description() const override {
    return device_ ? "v4l2-m2m, " + device_->node.card + " at " + device_->node.path : capabilities().name;
  }

 private:
  // "Initialization".
  Result<void> openDecoder(const StreamInfo& stream) override {
    auto form = AnnexB::make(stream);
    if (!form) return std::unexpected(form.error());
    const auto profile = form->profile();
    auto device = openM2mDevice(stream, profile);
    if (!device) return std::unexpected(device.error());
    if (!profile && stream.codec != "fwht") {
      return fail(ErrorCode::Unsupported, "the stream's header does not show whether hardware can decode it");
    }
    form_ = std::move(*form);
    stream_ = stream;
    if (stream_.frame_period <= Duration(0)) stream_.frame_period = kDefaultPeriod;
    device_ = std::move(*device);
    tells_changes_ = subscribeChanges(fd());
    auto packets = M2mBuffers::make(device_->fd, device_->node.packetQueue(), kPackets);
    if (!packets) return std::unexpected(packets.error());
    packets_ = std::move(*packets);
    given_any_ = false;
    forget();
    return outcomeOf(packets_->start());
  }

  struct Unanswered {
    std::uint64_t tag;
    MediaTime pts;
    bool leads;  // of LeadingPictures
  };

  Result<Feed> feedPacket(const Packet& packet) override {
    if (packet.bytes == 0) return Feed::Accepted;
    if (!packet.pts) return fail(ErrorCode::Unsupported, "video hardware cannot decode pictures without timestamps");
    if (auto served = serve(); !served) return std::unexpected(served.error());
    const auto index = packets_->anyHere();
    if (!index) return Feed::Full;
    const M2mBuffers::Memory& room = packets_->memory(*index)[0];
    const bool decodable = begun_ || packet.keyframe;  // packets before the first key frame are not decodable
    const auto bytes = decodable ? form_.write(packet, !begun_, {room.data, room.bytes}) : std::nullopt;
    if (!bytes) {
      countDamaged();
      return Feed::Accepted;
    }
    if (auto queued = outcomeOf(packets_->queue(*index, *bytes, ++last_tag_)); !queued) {
      return std::unexpected(queued.error());
    }
    if (!std::exchange(begun_, true)) leading_.begin(*packet.pts);
    unanswered_.push_back({last_tag_, *packet.pts, leading_.has(*packet.pts)});
    if (unanswered_.size() <= kMostUnanswered) return Feed::Accepted;
    giveUp(unanswered_.front());
    unanswered_.pop_front();
    return Feed::Accepted;
  }

  // "Decoding", and the sequences that it may lead to.
  Result<Progress> receiveFrame(Frame& frame) override {
    idle_ = Duration(0);
    for (;;) {
      if (draining_ && !begun_) return Progress::EndOfStream;
      const auto served = serve();
      if (!served) return std::unexpected(served.error());
      const auto got = pictures_.running() ? takePicture(frame) : Result<bool>(false);
      if (!got) return std::unexpected(got.error());
      if (*got) return Progress::Picture;
      if (stopped_ && !change_due_) {  // the change's event may have come together with the last picture
        if (auto again = serve(); !again) return std::unexpected(again.error());
      }
      if (stopped_ && !change_due_) {
        if (drain_told_) return endOfStream();
        if (auto resumed = resume(); !resumed) return std::unexpected(resumed.error());
      }
      const bool has_room = packets_->anyHere().has_value();
      if (!draining_ && has_room) return Progress::NeedsPackets;
      if (draining_ && !pictures_.running() && !change_due_ && packets_->withDevice() == 0) return endOfStream();
      if (draining_ && pictures_.running() && !stopped_) tellDrain();
      if (auto waited = wait(); !waited) return std::unexpected(waited.error());
    }
  }

  // Handles the driver's events and finished packets, and sets up pictures when a format change is due.
  Result<void> serve() {
    while (const auto changes = tells_changes_ ? nextEvent(fd()) : std::nullopt) {
      change_due_ = change_due_ || *changes;
      progressed();
    }
    M2mBuffers::Done done;
    int error = 0;
    while ((error = packets_->take(done)) == 0) {
      if (done.damaged) lose(done.tag);
      progressed();
    }
    if (isFatal(error)) return outcomeOf(error);
    const bool first = !pictures_.running() && begun_ && (change_due_ || tellsNothing());
    const bool change = pictures_.running() && change_due_ && (stopped_ || assumed_);
    return first || change ? setUpPictures() : Result<void>{};
  }

  // True if the driver has had time to tell the pictures' format and has not. Some tell none that is as in `open`
  // (bcm2835-codec), none at the beginning (s5p-mfc), or wait for the buffers of pictures (older venus).
  // "Initialization" lets the client set these up beforehand.
  [[nodiscard]] bool tellsNothing() const noexcept {
    const bool took_all = draining_ && packets_->withDevice() == 0;
    return !tells_changes_ || took_all || idle_ >= kUntoldFor || unanswered_.size() >= kUntoldPackets;
  }

  Result<void> setUpPictures() {
    const bool assumed = !change_due_;
    auto made = pictures_.setUp(*device_, stream_);
    if (!made && assumed && made.error().code == ErrorCode::Io) return {};  // the driver may not know the format yet
    if (!made) return made;
    assumed_ = assumed;
    change_due_ = stopped_ = drain_told_ = false;
    progressed();
    return {};
  }

  // False if there is none.
  Result<bool> takePicture(Frame& frame) {
    for (;;) {
      PictureQueue::Taken taken;
      const int error = pictures_.take(taken);
      if (error == EPIPE) stopped_ = true;
      if (isFatal(error)) return std::unexpected(outcomeOf(error).error());
      if (error != 0) return false;
      progressed();
      stopped_ = stopped_ || taken.last;
      if (taken.damaged) lose(taken.tag);
      const auto packet = taken.frame.empty() ? std::nullopt : answered(taken.tag);
      if (!packet) continue;
      frame = std::move(taken.frame);
      frame.pts = packet->pts;
      frame.duration = stream_.frame_period;
      given_any_ = true;
      assumed_ = false;
      return true;
    }
  }

  // The packet with that tag; nullopt if it was fed before a flush.
  std::optional<Unanswered> answered(std::uint64_t tag) {
    const auto found = std::find_if(unanswered_.begin(), unanswered_.end(), [&](auto& u) { return u.tag == tag; });
    if (found == unanswered_.end()) return std::nullopt;
    const Unanswered packet = *found;
    unanswered_.erase(found);
    return packet;
  }
  void lose(std::uint64_t tag) {
    if (const auto packet = answered(tag)) giveUp(*packet);
  }
  void giveUp(const Unanswered& packet) noexcept {
    if (!packet.leads) countDamaged();
  }

  // The kernel's document of stateful decoders, section "Drain".
  Result<void> startDrain() override {
    draining_ = true;
    return {};
  }
  // The result is ignored: if the driver is busy with an earlier command or does not know this one, `wait` times out.
  void tellDrain() {
    if (!std::exchange(drain_told_, true)) static_cast<void>(command(fd(), V4L2_DEC_CMD_STOP));
  }
  // The remaining packets will yield no pictures.
  Progress endOfStream() {
    for (; !unanswered_.empty(); unanswered_.pop_front()) giveUp(unanswered_.front());
    return Progress::EndOfStream;
  }
  // Continues after an end-of-stream mark inside the stream.
  Result<void> resume() {
    stopped_ = false;
    return outcomeOf(command(fd(), V4L2_DEC_CMD_START));
  }

  // "Seek", on both queues at once.
  Result<void> flushDecoder() override {
    if (auto served = serve(); !served) return served;
    if (auto stopped = outcomeOf(packets_->stop()); !stopped) return stopped;
    if (change_due_) pictures_.release();  // the last picture before the change will not come any more
    if (pictures_.running()) {
      if (auto restarted = pictures_.restart(); !restarted) return restarted;
    }
    forget();
    return outcomeOf(packets_->start());
  }

  void closeDecoder() noexcept override {
    pictures_.release();
    if (packets_) packets_->release();
    packets_.reset();
    device_.reset();
    change_due_ = false;
    forget();
  }

  void forget() noexcept {
    unanswered_.clear();
    begun_ = draining_ = drain_told_ = stopped_ = false;
    progressed();
  }

  [[nodiscard]] int fd() const noexcept { return device_->fd->get(); }

  // EINVAL: the queue is not running yet.
  static bool isFatal(int error) noexcept { return error != 0 && error != EAGAIN && error != EPIPE && error != EINVAL; }

  void progressed() noexcept {
    idle_ = Duration(0);
    said_ready_ = false;
  }
  // Waits for the driver. Each wait counts at most two turns, so that a stalled machine does not time the driver out.
  Result<void> wait() {
    if (idle_ >= (given_any_ ? kPatience : kFirstPatience)) return fail(ErrorCode::Timeout, kHangs);
    const MonotonicTime begin = clock_.now();
    if (said_ready_) {
      clock_.sleepUntil(begin + kNap);
      said_ready_ = false;
    } else {
      pollfd device{fd(), POLLIN | POLLOUT | POLLPRI, 0};
      constexpr int kTurnMs = static_cast<int>(kTurn / std::chrono::milliseconds(1));
      said_ready_ = ::poll(&device, 1, kTurnMs) > 0;
    }
    idle_ += std::min(clock_.now() - begin, 2 * kTurn);
    return {};
  }

  MonotonicClock clock_;
  StreamInfo stream_;
  AnnexB form_;
  std::optional<M2mDevice> device_;
  bool tells_changes_ = false;
  std::shared_ptr<M2mBuffers> packets_;
  PictureQueue pictures_;

  std::deque<Unanswered> unanswered_;  // packets that have no picture yet
  std::uint64_t last_tag_ = 0;
  bool begun_ = false;  // a packet was fed
  LeadingPictures leading_;
  bool change_due_ = false;  // the pictures' format changes
  bool assumed_ = false;     // it was not told, and no picture has come yet: there is none to wait for at a change
  bool stopped_ = false;     // the last picture before a change or of a drain has come
  bool draining_ = false, drain_told_ = false;
  bool given_any_ = false;
  Duration idle_{0};
  bool said_ready_ = false;
};

}  // namespace

std::unique_ptr<VideoDecoder> makeV4l2M2mDecoder() {
  return std::make_unique<M2mDecoder>();
}

}  // namespace relievo
