// SPDX-License-Identifier: Apache-2.0
// Negotiates the pictures' format and lends their buffers to frames.
#include "drivers/v4l2/m2m_picture_queue.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/v4l2/control.h"

namespace relievo::v4l2 {
namespace {

constexpr std::uint32_t kPlayersHold = 12;   // pictures for the player, beyond those that the driver needs
constexpr std::uint32_t kUsualPictures = 8;  // that the driver needs, if it does not report the number

// The object behind Frame::owner: a held buffer, which is returned on the thread that drops the last reference.
struct HeldPicture {
  std::shared_ptr<M2mBuffers> buffers;
  std::uint32_t index;
  HeldPicture(std::shared_ptr<M2mBuffers> from, std::uint32_t which) : buffers(std::move(from)), index(which) {
    buffers->lend(index);
  }
  ~HeldPicture() { buffers->giveBack(index); }
  HeldPicture(const HeldPicture&) = delete;
  HeldPicture& operator=(const HeldPicture&) = delete;
};

// Keeps the driver's choice if it can be read, else chooses the first format that can.
Result<void> chooseReadable(int fd, v4l2_format& format) noexcept {
  const bool planes = V4L2_TYPE_IS_MULTIPLANAR(format.type);
  const auto chosen = [&] { return planes ? format.fmt.pix_mp.pixelformat : format.fmt.pix.pixelformat; };
  if (isPictureFormat(chosen())) return {};
  v4l2_fmtdesc each{.index = 0, .type = format.type};
  for (; control(fd, VIDIOC_ENUM_FMT, &each) == 0; ++each.index) {
    if (!isPictureFormat(each.pixelformat)) continue;
    if (planes) {
      format.fmt.pix_mp.pixelformat = each.pixelformat;
    } else {
      format.fmt.pix.pixelformat = each.pixelformat;
    }
    if (control(fd, VIDIOC_S_FMT, &format) == 0 && chosen() == each.pixelformat) return {};
  }
  return fail(ErrorCode::Unsupported, kUnreadable);
}

// VIDIOC_G_SELECTION takes the single-planar type for both interfaces. A driver without it (meson) may give the coded
// size, a few samples larger than the container's; a size that is farther from that one is another.
std::optional<v4l2_rect> visiblePart(int fd, const v4l2_format& format, const StreamInfo& stream) noexcept {
  v4l2_selection part{};
  part.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  part.target = V4L2_SEL_TGT_COMPOSE;
  if (control(fd, VIDIOC_G_SELECTION, &part) == 0) return part.r;
  constexpr std::uint32_t kMostPadding = 64;
  const bool planes = V4L2_TYPE_IS_MULTIPLANAR(format.type);
  const v4l2_rect told{0, 0, static_cast<std::uint32_t>(stream.width), static_cast<std::uint32_t>(stream.height)};
  const std::uint32_t across = (planes ? format.fmt.pix_mp.width : format.fmt.pix.width) - told.width;
  const std::uint32_t down = (planes ? format.fmt.pix_mp.height : format.fmt.pix.height) - told.height;
  return across < kMostPadding && down < kMostPadding ? std::optional(told) : std::nullopt;
}

std::uint32_t neededBy(int fd) noexcept {
  v4l2_control least{.id = V4L2_CID_MIN_BUFFERS_FOR_CAPTURE, .value = 0};
  const bool told = control(fd, VIDIOC_G_CTRL, &least) == 0 && least.value > 0 && least.value <= VIDEO_MAX_FRAME / 2;
  return told ? static_cast<std::uint32_t>(least.value) : kUsualPictures;
}

}  // namespace

Result<void> PictureQueue::setUp(const M2mDevice& device, const StreamInfo& stream) {
  release();
  const int fd = device.fd->get();
  v4l2_format format{};
  format.type = device.node.pictureQueue();
  if (control(fd, VIDIOC_G_FMT, &format) < 0) return outcomeOf(errno);
  if (auto readable = chooseReadable(fd, format); !readable) return readable;
  const auto layout = layoutOf(format, visiblePart(fd, format, stream), stream);
  if (!layout) return fail(ErrorCode::Unsupported, kUnreadable);
  layout_ = *layout;
  needed_ = neededBy(fd);
  auto buffers = M2mBuffers::make(device.fd, format.type, needed_ + kPlayersHold);
  if (!buffers) return std::unexpected(buffers.error());
  if (!layout_.fits((*buffers)->memory(0))) return fail(ErrorCode::Unsupported, kUnreadable);
  if (auto queued = outcomeOf((*buffers)->queueAll()); !queued) return queued;
  if (auto started = outcomeOf((*buffers)->start()); !started) return started;
  buffers_ = std::move(*buffers);
  return {};
}

int PictureQueue::take(Taken& taken) {
  M2mBuffers::Done done;
  if (const int error = buffers_->take(done); error != 0) return error;
  taken = {.frame = {}, .tag = done.tag, .damaged = done.damaged, .last = done.last};
  if (done.bytes > 0 && !done.damaged) {
    taken.frame = pictureIn(done.index);
    setFields(taken.frame, done.field);
  } else {
    buffers_->giveBack(done.index);
  }
  return 0;
}

Frame PictureQueue::pictureIn(std::uint32_t index) const {
  const auto& memory = buffers_->memory(index);
  std::array<const std::uint8_t*, 3> data{};
  std::array<int, 3> fds{-1, -1, -1};
  if (buffers_->withDevice() >= needed_) {
    for (std::size_t i = 0; i < data.size(); ++i) {
      data[i] = memory[i].data;
      fds[i] = memory[i].dma_buf.get();
    }
    Frame frame = layout_.placeAt(data, fds);
    frame.owner = std::make_shared<HeldPicture>(buffers_, index);
    return frame;
  }
  auto copy = std::make_shared<std::array<std::vector<std::uint8_t>, 3>>();
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (memory[i].data != nullptr) (*copy)[i].assign(memory[i].data, memory[i].data + layout_.bytes[i]);
    data[i] = (*copy)[i].data();
  }
  buffers_->giveBack(index);
  Frame frame = layout_.placeAt(data, fds);
  frame.owner = std::move(copy);
  return frame;
}

Result<void> PictureQueue::restart() noexcept {
  if (auto stopped = outcomeOf(buffers_->stop()); !stopped) return stopped;
  if (auto queued = outcomeOf(buffers_->queueAll()); !queued) return queued;
  return outcomeOf(buffers_->start());
}

void PictureQueue::release() noexcept {
  if (buffers_) buffers_->release();
  buffers_.reset();
}

}  // namespace relievo::v4l2
