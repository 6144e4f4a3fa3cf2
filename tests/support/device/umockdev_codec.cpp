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

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo::test {
namespace {

constexpr std::size_t kMemoryBytes = std::size_t{1} << 30;  // of a sparse file
constexpr std::uint32_t kMostBuffers = 32;
constexpr std::uint32_t kPage = 4096;

std::uint32_t wholePages(std::uint32_t bytes) {
  return (bytes + kPage - 1) / kPage * kPage;
}
std::uint64_t tagOf(const v4l2_buffer& buffer) {
  return static_cast<std::uint64_t>(buffer.timestamp.tv_sec) * 1'000'000 +
         static_cast<std::uint64_t>(buffer.timestamp.tv_usec);
}

}  // namespace

struct UmockdevCodec::Library {
  AVCodecContext* context = nullptr;
  std::deque<AVFrame*> pictures;

  explicit Library(std::uint32_t fourcc) {
    const AVCodec* const codec =
        avcodec_find_decoder(fourcc == V4L2_PIX_FMT_HEVC ? AV_CODEC_ID_HEVC : AV_CODEC_ID_H264);
    context = avcodec_alloc_context3(codec);
    context->thread_count = 1;
    if (avcodec_open2(context, codec, nullptr) < 0) throw std::runtime_error("FFmpeg has no decoder");
  }
  ~Library() {
    forget();
    avcodec_free_context(&context);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  bool feed(const std::uint8_t* data, std::uint32_t bytes, std::uint64_t tag) {
    AVPacket* packet = av_packet_alloc();
    av_new_packet(packet, static_cast<int>(bytes));
    std::memcpy(packet->data, data, bytes);
    packet->pts = static_cast<std::int64_t>(tag);
    const bool good = avcodec_send_packet(context, packet) >= 0;
    av_packet_free(&packet);
    receive();
    return good;
  }
  void receive() {
    for (;;) {
      AVFrame* picture = av_frame_alloc();
      if (avcodec_receive_frame(context, picture) < 0) return av_frame_free(&picture);
      pictures.push_back(picture);
    }
  }
  void drain() {
    avcodec_send_packet(context, nullptr);
    receive();
    avcodec_flush_buffers(context);
  }
  void pop() {
    av_frame_free(&pictures.front());
    pictures.pop_front();
  }
  void forget() {
    while (!pictures.empty()) pop();
    avcodec_flush_buffers(context);
  }
};

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
      sizes.stepwise = {16, kind_.largest, 1, 16, kind_.largest, 1};
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
    packet_bytes_ = wholePages(kind_.planes ? format.fmt.pix_mp.plane_fmt[0].sizeimage : format.fmt.pix.sizeimage);
    size_ = kUntold;
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
  library_ = std::make_unique<Library>(kind_.packets);
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

void UmockdevCodec::work() {
  if (!library_ || !packets_run_) return;
  while (!hung_ && (deliver() || decodeOne())) {
    if (hangs_left_ == 0 || given_ < hang_after_) continue;
    --hangs_left_;
    hung_ = true;
  }
  if (!hung_) finishDrain();
}

// False without a picture or without a free buffer for it.
bool UmockdevCodec::deliver() {
  if (library_->pictures.empty()) return false;
  const AVFrame& picture = *library_->pictures.front();
  const Size size{static_cast<std::uint32_t>(picture.width), static_cast<std::uint32_t>(picture.height)};
  if (size != size_ && !changing_) announce(size);
  if (changing_) giveLast();
  if (changing_ || !pictures_run_ || empty_.empty() || last_given_) return false;
  const std::uint32_t index = empty_.front();
  empty_.pop_front();
  fill(index);
  const bool damaged = (picture.flags & AV_FRAME_FLAG_CORRUPT) != 0 || picture.decode_error_flags != 0;
  pictures_done_.push_back({index, kind_.planes ? lumaBytes() : lumaBytes() * 3 / 2,
                            damaged ? static_cast<std::uint32_t>(V4L2_BUF_FLAG_ERROR) : 0U,
                            static_cast<std::uint64_t>(picture.pts)});
  library_->pop();
  ++given_;
  ++pictures_;
  return true;
}

void UmockdevCodec::announce(const Size& size) {
  size_ = size;
  ++events_;
  changing_ = true;
}

// An empty last buffer, as with most drivers.
void UmockdevCodec::giveLast() {
  if (!pictures_run_ || last_given_ || empty_.empty()) return;
  last_given_ = true;
  pictures_done_.push_back({empty_.front(), 0, V4L2_BUF_FLAG_LAST, 0});
  empty_.pop_front();
}

// Only once the earlier pictures are out.
bool UmockdevCodec::decodeOne() {
  if (!library_->pictures.empty() || packets_.empty() || last_given_) return false;
  const Packet packet = packets_.front();
  packets_.pop_front();
  const bool good = library_->feed(memory_ + packet_offsets_[packet.index], packet.bytes, packet.tag);
  const AVCodecContext& known = *library_->context;
  if (known.width > 0 && size_ == kUntold) {
    announce({static_cast<std::uint32_t>(known.width), static_cast<std::uint32_t>(known.height)});
  }
  packets_done_.push_back({packet.index, 0, good ? 0U : static_cast<std::uint32_t>(V4L2_BUF_FLAG_ERROR), packet.tag});
  return true;
}

void UmockdevCodec::finishDrain() {
  if (!draining_ || changing_ || !packets_.empty() || !library_->pictures.empty()) return;
  if (!drained_) {
    drained_ = true;
    library_->drain();
    return work();
  }
  giveLast();
}

void UmockdevCodec::fill(std::uint32_t index) {
  const AVFrame& picture = *library_->pictures.front();
  std::uint8_t* const luma = memory_ + picture_offsets_[index];
  std::uint8_t* const chroma = luma + (kind_.planes ? wholePages(lumaBytes()) : lumaBytes());
  for (int r = 0; r < picture.height; ++r) {
    std::memcpy(luma + std::size_t{stride()} * static_cast<std::size_t>(r), picture.data[0] + r * picture.linesize[0],
                static_cast<std::size_t>(picture.width));
  }
  const bool apart = kind_.pictures == V4L2_PIX_FMT_YUV420;
  for (int i = 1; i <= 2; ++i) {
    for (int r = 0; r < (picture.height + 1) / 2; ++r) {
      const std::uint8_t* const from = picture.data[i] + r * picture.linesize[i];
      std::uint8_t* const to =
          apart ? chroma + (i - 1) * (lumaBytes() / 4) + std::size_t{stride() / 2} * static_cast<std::size_t>(r)
                : chroma + (i - 1) + std::size_t{stride()} * static_cast<std::size_t>(r);
      for (int c = 0; c < (picture.width + 1) / 2; ++c) to[apart ? c : 2 * c] = from[c];
    }
  }
}

}  // namespace relievo::test
