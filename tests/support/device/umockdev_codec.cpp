// SPDX-License-Identifier: Apache-2.0
// The driver's side of Documentation/userspace-api/media/v4l/dev-decoder.rst.
#include "tests/support/device/umockdev_codec.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "tests/support/device/codec_library.h"

namespace relievo::test {
namespace {

constexpr std::size_t kMemoryBytes = std::size_t{1} << 30;  // of a sparse file
constexpr std::uint32_t kMostBuffers = 32;

std::uint64_t tagOf(const v4l2_buffer& buffer) {
  return static_cast<std::uint64_t>(buffer.timestamp.tv_sec) * 1'000'000 +
         static_cast<std::uint64_t>(buffer.timestamp.tv_usec);
}

}  // namespace

// The node is a plain file, so that its memory can be mapped.
UmockdevCodec::UmockdevCodec(UMockdevTestbed* bed, int number, CodecKind kind)
    : bed_(bed),
      name_("video" + std::to_string(number)),
      node_("/dev/" + name_),
      device_("/sys/devices/platform/codec/video4linux/" + name_),
      kind_(kind),
      requests_([this](UMockdevIoctlClient* client) { return answer(client); }) {
  const std::string description =
      "P: /devices/platform/codec/video4linux/" + name_ + "\nN: " + name_ + "=00\nE: DEVNAME=" + node_ +
      "\nE: SUBSYSTEM=video4linux\nE: MAJOR=81\nE: MINOR=" + std::to_string(number) + "\n\n";
  umockdev_testbed_add_from_string(bed_, description.c_str(), nullptr);
  gchar* const root = umockdev_testbed_get_root_dir(bed_);
  const std::string file = root + node_;
  g_free(root);
  const int fd = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  void* const memory = ::ftruncate(fd, static_cast<off_t>(kMemoryBytes)) == 0
                           ? ::mmap(nullptr, kMemoryBytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, fd, 0)
                           : MAP_FAILED;
  ::close(fd);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory for a decoder at " + file);
  memory_ = static_cast<std::uint8_t*>(memory);
  umockdev_testbed_attach_ioctl(bed_, node_.c_str(), requests_.handler(), nullptr);
}

UmockdevCodec::~UmockdevCodec() {
  umockdev_testbed_detach_ioctl(bed_, node_.c_str(), nullptr);
  umockdev_testbed_remove_device(bed_, device_.c_str());
  requests_.end();
  ::munmap(memory_, kMemoryBytes);
}

void UmockdevCodec::hangAfter(int pictures, int times) {
  const std::lock_guard guard(lock_);
  hang_after_ = pictures;
  hangs_left_ = times;
}
void UmockdevCodec::unplugAfter(int pictures) {
  const std::lock_guard guard(lock_);
  unplug_after_ = pictures;
}
int UmockdevCodec::openings() {
  const std::lock_guard guard(lock_);
  return openings_;
}
int UmockdevCodec::pictures() {
  const std::lock_guard guard(lock_);
  return pictures_;
}
int UmockdevCodec::drains() {
  const std::lock_guard guard(lock_);
  return drains_;
}
int UmockdevCodec::empty() {
  const std::lock_guard guard(lock_);
  return static_cast<int>(empty_.size());
}
int UmockdevCodec::unknownRequests() {
  const std::lock_guard guard(lock_);
  return unknown_;
}

bool UmockdevCodec::answer(UMockdevIoctlClient* client) {
  const auto request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* data =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, _IOC_SIZE(request), nullptr);
  const std::lock_guard guard(lock_);
  if (unplug_after_ > 0 && pictures_ >= unplug_after_) plugged_ = false;
  const int error = plugged_ ? answerTo(request, data) : ENODEV;
  if (plugged_) work();
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
  return true;
}

int UmockdevCodec::answerTo(unsigned long request, UMockdevIoctlData* data) {
  void* const argument = data->data;
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& is = *static_cast<v4l2_capability*>(argument) = {};
      std::strcpy(reinterpret_cast<char*>(is.card), "A decoder that is not there");
      is.device_caps = V4L2_CAP_STREAMING | (kind_.planes ? V4L2_CAP_VIDEO_M2M_MPLANE : V4L2_CAP_VIDEO_M2M);
      is.capabilities = is.device_caps | V4L2_CAP_DEVICE_CAPS;
      return 0;
    }
    case VIDIOC_ENUM_FMT: {
      auto& each = *static_cast<v4l2_fmtdesc*>(argument);
      if (each.index > 0) return EINVAL;
      each.pixelformat = isPackets(each.type) ? kind_.packets : kind_.pictures;
      each.flags = isPackets(each.type) ? V4L2_FMT_FLAG_COMPRESSED | V4L2_FMT_FLAG_DYN_RESOLUTION : 0U;
      return 0;
    }
    case VIDIOC_ENUM_FRAMESIZES: {
      auto& sizes = *static_cast<v4l2_frmsizeenum*>(argument);
      if (sizes.index > 0) return EINVAL;
      sizes.type = V4L2_FRMSIZE_TYPE_CONTINUOUS;
      sizes.stepwise = {kind_.smallest, kind_.largest, 1, kind_.smallest, kind_.largest, 1};
      return 0;
    }
    case VIDIOC_QUERYCTRL: {
      auto& menu = *static_cast<v4l2_queryctrl*>(argument);
      return kind_.main_profile_only && menu.id == V4L2_CID_MPEG_VIDEO_H264_PROFILE ? 0 : EINVAL;
    }
    case VIDIOC_QUERYMENU:
      return static_cast<v4l2_querymenu*>(argument)->index == V4L2_MPEG_VIDEO_H264_PROFILE_MAIN ? 0 : EINVAL;
    case VIDIOC_S_FMT:
      return setFormat(*static_cast<v4l2_format*>(argument));
    case VIDIOC_G_FMT:
      fillFormat(*static_cast<v4l2_format*>(argument));
      return 0;
    case VIDIOC_G_SELECTION: {
      if (!kind_.selects) return ENOTTY;
      auto& part = *static_cast<v4l2_selection*>(argument);
      part.r = {0, 0, size_.width, size_.height};
      return 0;
    }
    case VIDIOC_G_CTRL: {
      auto& value = *static_cast<v4l2_control*>(argument);
      if (value.id != V4L2_CID_MIN_BUFFERS_FOR_CAPTURE) return EINVAL;
      value.value = static_cast<int>(kind_.needed);
      return 0;
    }
    default:
      return answerToStreaming(request, data);
  }
}

int UmockdevCodec::answerToStreaming(unsigned long request, UMockdevIoctlData* data) {
  void* const argument = data->data;
  switch (request) {
    case VIDIOC_SUBSCRIBE_EVENT:
      return static_cast<v4l2_event_subscription*>(argument)->type == V4L2_EVENT_SOURCE_CHANGE ? 0 : EINVAL;
    case VIDIOC_DQEVENT: {
      if (events_ == 0) return ENOENT;
      --events_;
      auto& event = *static_cast<v4l2_event*>(argument) = {};
      event.type = V4L2_EVENT_SOURCE_CHANGE;
      event.u.src_change.changes = V4L2_EVENT_SRC_CH_RESOLUTION;
      return 0;
    }
    case VIDIOC_STREAMON:
      return start(isPackets(*static_cast<std::uint32_t*>(argument)));
    case VIDIOC_STREAMOFF:
      return stop(isPackets(*static_cast<std::uint32_t*>(argument)));
    case VIDIOC_DECODER_CMD: {
      const auto command = static_cast<v4l2_decoder_cmd*>(argument)->cmd;
      if (command == V4L2_DEC_CMD_STOP && packets_run_ && pictures_run_) {
        if (draining_) return EBUSY;
        draining_ = true;
        ++drains_;
      }
      if (command == V4L2_DEC_CMD_START) draining_ = drained_ = last_given_ = false;
      return 0;
    }
    case VIDIOC_EXPBUF:
      if (!kind_.exports) return ENOTTY;
      static_cast<v4l2_exportbuffer*>(argument)->fd = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
      return 0;
    default:
      return answerToBuffers(request, data);
  }
}

int UmockdevCodec::answerToBuffers(unsigned long request, UMockdevIoctlData* data) {
  if (request == VIDIOC_REQBUFS) return makeBuffers(*reinterpret_cast<v4l2_requestbuffers*>(data->data));
  if (request != VIDIOC_QUERYBUF && request != VIDIOC_QBUF && request != VIDIOC_DQBUF) {
    ++unknown_;
    return ENOTTY;
  }
  auto& buffer = *reinterpret_cast<v4l2_buffer*>(data->data);
  const bool packets = isPackets(buffer.type);
  v4l2_plane* planes = nullptr;
  if (kind_.planes) {
    planes = reinterpret_cast<v4l2_plane*>(
        umockdev_ioctl_data_resolve(data, offsetof(v4l2_buffer, m.planes), sizeof(v4l2_plane) * buffer.length, nullptr)
            ->data);
  }
  if (request == VIDIOC_QUERYBUF) {
    const std::uint32_t offset = (packets ? packet_offsets_ : picture_offsets_).at(buffer.index);
    const std::uint32_t luma = wholePages(lumaBytes());
    if (planes == nullptr) {
      buffer.m.offset = offset;
      buffer.length = packets ? packet_bytes_ : wholePages(lumaBytes() * 3 / 2);
    } else {
      buffer.length = packets ? 1 : 2;
      planes[0].m.mem_offset = offset;
      planes[0].length = packets ? packet_bytes_ : luma;
      planes[1].m.mem_offset = offset + luma;
      planes[1].length = wholePages(lumaBytes() / 2);
    }
    return 0;
  }
  if (request == VIDIOC_QBUF) {
    if (packets) {
      packets_.push_back({buffer.index, planes == nullptr ? buffer.bytesused : planes[0].bytesused, tagOf(buffer)});
    } else {
      empty_.push_back(buffer.index);
    }
    return 0;
  }
  if (!(packets ? packets_run_ : pictures_run_)) return EINVAL;
  auto& done = packets ? packets_done_ : pictures_done_;
  if (done.empty()) return !packets && last_given_ ? EPIPE : EAGAIN;
  const Done next = done.front();
  done.pop_front();
  buffer.index = next.index;
  buffer.flags = next.flags;
  buffer.timestamp = {static_cast<time_t>(next.tag / 1'000'000), static_cast<suseconds_t>(next.tag % 1'000'000)};
  buffer.bytesused = next.bytes;
  if (planes != nullptr) planes[0].bytesused = next.bytes;
  return 0;
}

bool UmockdevCodec::isPackets(std::uint32_t type) const {
  return type == V4L2_BUF_TYPE_VIDEO_OUTPUT || type == V4L2_BUF_TYPE_VIDEO_OUTPUT_MPLANE;
}

UmockdevCodec::Size UmockdevCodec::padded(const Size& size) const {
  return {(size.width + 15) / 16 * 16, (size.height + 15) / 16 * 16};
}

void UmockdevCodec::fillFormat(v4l2_format& format) const {
  const bool packets = isPackets(format.type);
  const Size coded = padded(size_);
  const std::uint32_t fourcc = packets ? kind_.packets : kind_.pictures;
  if (!kind_.planes) {
    v4l2_pix_format& picture = format.fmt.pix = {};
    picture.width = coded.width;
    picture.height = coded.height;
    picture.pixelformat = fourcc;
    picture.bytesperline = packets ? 0 : stride();
    picture.sizeimage = packets ? packet_bytes_ : lumaBytes() * 3 / 2;
    return;
  }
  v4l2_pix_format_mplane& picture = format.fmt.pix_mp = {};
  picture.width = coded.width;
  picture.height = coded.height;
  picture.pixelformat = fourcc;
  picture.num_planes = packets ? 1 : 2;
  picture.plane_fmt[0] = {.sizeimage = packets ? packet_bytes_ : lumaBytes(), .bytesperline = packets ? 0 : stride()};
  if (!packets) picture.plane_fmt[1] = {.sizeimage = lumaBytes() / 2, .bytesperline = stride()};
}

int UmockdevCodec::setFormat(v4l2_format& format) {
  const bool packets = isPackets(format.type);
  if (!(packets ? packet_offsets_ : picture_offsets_).empty()) return EBUSY;
  if (packets) {
    const auto& one = format.fmt.pix;
    const auto& several = format.fmt.pix_mp;
    packet_bytes_ = wholePages(kind_.planes ? several.plane_fmt[0].sizeimage : one.sizeimage);
    size_ = kUntold;
    if (kind_.silent) size_ = kind_.planes ? Size{several.width, several.height} : Size{one.width, one.height};
  }
  fillFormat(format);
  return 0;
}

// Old memory stays unchanged, since it may be held.
int UmockdevCodec::makeBuffers(v4l2_requestbuffers& request) {
  const bool packets = isPackets(request.type);
  auto& offsets = packets ? packet_offsets_ : picture_offsets_;
  if (request.count > 0 && !offsets.empty()) return EBUSY;
  static_cast<void>(stop(packets));
  offsets.clear();
  request.count = std::min(request.count, kMostBuffers);
  const std::uint32_t bytes =
      packets ? packet_bytes_ : wholePages(lumaBytes()) + wholePages(wholePages(lumaBytes()) / 2);
  if (next_offset_ + std::size_t{bytes} * request.count > kMemoryBytes) next_offset_ = 0;
  for (std::uint32_t i = 0; i < request.count; ++i, next_offset_ += bytes) offsets.push_back(next_offset_);
  if (!packets || request.count == 0) return 0;
  ++openings_;
  given_ = 0;
  hung_ = changing_ = false;
  events_ = 0;
  library_ = std::make_unique<CodecLibrary>(kind_.packets);
  return 0;
}

int UmockdevCodec::start(bool packets) {
  (packets ? packets_run_ : pictures_run_) = true;
  if (!packets) changing_ = last_given_ = false;
  return 0;
}

int UmockdevCodec::stop(bool packets) {
  (packets ? packets_run_ : pictures_run_) = false;
  draining_ = drained_ = last_given_ = false;
  if (packets) {
    packets_.clear();
    packets_done_.clear();
    if (library_) library_->forget();
  } else {
    empty_.clear();
    pictures_done_.clear();
  }
  return 0;
}

}  // namespace relievo::test
