// SPDX-License-Identifier: Apache-2.0
// A camera as an endless film.
#include <deque>
#include <utility>

#include "drivers/v4l2/annex_b.h"
#include "drivers/v4l2/camera.h"
#include "drivers/v4l2/stream.h"
#include "drivers/v4l2/v4l2.h"

namespace relievo {
namespace {

using namespace v4l2;

// The usual range of depth cameras in mm; the user may set a better one for the scene.
constexpr const char* kNearMm = "300";
constexpr const char* kFarMm = "3000";

class V4l2Source final : public MediaSource {
 public:
  ~V4l2Source() override { close(); }

 private:
  Result<Description> openSource(const std::string& url) override {
    camera_.forgive();
    const auto wish = parseAddress(url);
    if (!wish) return std::unexpected(wish.error());
    if (auto opened = camera_.open(*wish); !opened) return std::unexpected(opened.error());
    auto first = camera_.take();
    countMissed(camera_.takeLost());
    if (!first) return std::unexpected(first.error());
    begin_ = first->taken;
    Description description;
    description.origin = {.remote = true, .longest_gap = Duration(0), .arrival = begin_, .sender_start = std::nullopt};
    description.tags["TITLE"] = camera_.card();
    if (camera_.format().depth) description.streams.push_back(describe(RawStream::View::Gray));
    description.streams.push_back(describe(RawStream::View::AsItIs));
    queue(std::move(*first));
    return description;
  }

  [[nodiscard]] StreamInfo describe(RawStream::View view) const {
    const Format& format = camera_.format();
    StreamInfo stream;
    stream.kind = StreamKind::Video;
    stream.codec = format.codec;
    stream.width = camera_.layout().frame.width;
    stream.height = camera_.layout().frame.height;
    stream.frame_period = camera_.period();
    if (!format.raw) return stream;
    stream.native = std::shared_ptr<const RawStream>(new RawStream{format, camera_.layout(), camera_.period(), view},
                                                     RawStreamDeleter{});
    if (!format.depth || view == RawStream::View::Gray) return stream;
    stream.index = 1;
    stream.auxiliary = true;
    if (format.distances) {
      stream.tags = {{"DEPTH_UNIT", "1"}, {"DEPTH_INVALID", "0"}, {"DEPTH_NEAR", kNearMm}, {"DEPTH_FAR", kFarMm}};
    }
    return stream;
  }

  // Both tracks of a depth camera share the same memory.
  void queue(Picture picture) {
    Packet packet;
    packet.data = picture.data;
    packet.bytes = picture.bytes;
    packet.pts = packet.dts = MediaTime(picture.taken - begin_);
    packet.keyframe = camera_.format().fourcc != V4L2_PIX_FMT_H264 || isAvcKey({picture.data, picture.bytes});
    packet.owner = std::move(picture.owner);
    queue_.push_back(packet);
    if (!camera_.format().depth) return;
    packet.stream = 1;
    queue_.push_back(std::move(packet));
  }

  Result<std::optional<Packet>> readPacket() override {
    if (queue_.empty()) {
      auto picture = camera_.take();
      countMissed(camera_.takeLost());
      if (!picture) return std::unexpected(picture.error());
      queue(std::move(*picture));
    }
    std::optional<Packet> packet(std::move(queue_.front()));
    queue_.pop_front();
    return packet;
  }

  Result<void> seekTo(MediaTime) override { return fail(ErrorCode::Unsupported, "a camera cannot seek"); }

  void closeSource() noexcept override {
    queue_.clear();
    camera_.close();
  }
  void interrupted() noexcept override { camera_.interrupt(); }

  Camera camera_;
  MonotonicTime begin_;
  std::deque<Packet> queue_;
};

}  // namespace

std::unique_ptr<MediaSource> makeV4l2Source() {
  return std::make_unique<V4l2Source>();
}

}  // namespace relievo
