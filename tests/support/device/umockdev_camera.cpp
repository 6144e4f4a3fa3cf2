// SPDX-License-Identifier: Apache-2.0
// Answers the driver's requests as the kernel's own drivers do.
#include "tests/support/device/umockdev_camera.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace relievo::test {
namespace {

v4l2_capability capabilities() {
  v4l2_capability is{};
  std::strcpy(reinterpret_cast<char*>(is.card), "A camera that is not there");
  is.device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  is.capabilities = is.device_caps | V4L2_CAP_DEVICE_CAPS;
  return is;
}

}  // namespace

UmockdevCamera::UmockdevCamera(UMockdevTestbed* bed, int number, CameraKind kind)
    : bed_(bed),
      name_("video" + std::to_string(number)),
      node_("/dev/" + name_),
      device_("/sys/devices/platform/camera/video4linux/" + name_),
      kind_(std::move(kind)),
      format_(kind_.formats.front()),
      requests_([this](UMockdevIoctlClient* client) { return answer(client), true; }) {
  plug();
}

UmockdevCamera::~UmockdevCamera() {
  requests_.end();
  ::munmap(memory_, std::size_t{bufferBytes()} * kind_.buffers);
}

// The node is a plain file, so that its memory can be mapped.
void UmockdevCamera::plug() {
  const std::string description = "P: /devices/platform/camera/video4linux/" + name_ + "\nN: " + name_ +
                                  "=00\nE: DEVNAME=" + node_ +
                                  "\nE: SUBSYSTEM=video4linux\nE: MAJOR=81\nE: MINOR=0\n\n";
  umockdev_testbed_add_from_string(bed_, description.c_str(), nullptr);
  gchar* const root = umockdev_testbed_get_root_dir(bed_);
  const std::string file = root + node_;
  g_free(root);
  const int fd = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  const std::size_t bytes = std::size_t{bufferBytes()} * kind_.buffers;
  void* const memory = ::ftruncate(fd, static_cast<off_t>(bytes)) == 0
                           ? ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0)
                           : MAP_FAILED;
  ::close(fd);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory for a camera at " + file);
  const bool first = memory_ == nullptr;
  {
    const std::lock_guard guard(lock_);
    if (!first) ::munmap(memory_, bytes);
    memory_ = static_cast<std::uint8_t*>(memory);
    plugged_ = true;
    streaming_ = silent_ = false;
  }
  if (first) umockdev_testbed_attach_ioctl(bed_, node_.c_str(), requests_.handler(), nullptr);
}

// Open descriptors then report that the device is gone: their requests still come here.
void UmockdevCamera::unplug() {
  {
    const std::lock_guard guard(lock_);
    plugged_ = false;
  }
  umockdev_testbed_remove_device(bed_, device_.c_str());
}

void UmockdevCamera::fault(std::uint32_t number, Fault fault) {
  const std::lock_guard guard(lock_);
  faults_.emplace_back(number, fault);
}
void UmockdevCamera::silence() {
  const std::lock_guard guard(lock_);
  silent_ = true;
}
std::uint32_t UmockdevCamera::taken() {
  const std::lock_guard guard(lock_);
  return next_number_;
}
std::uint32_t UmockdevCamera::starved() {
  const std::lock_guard guard(lock_);
  return starved_;
}
int UmockdevCamera::unknownRequests() {
  const std::lock_guard guard(lock_);
  return unknown_;
}

void UmockdevCamera::answer(UMockdevIoctlClient* client) {
  const auto request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* data =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, _IOC_SIZE(request), nullptr);
  const std::lock_guard guard(lock_);
  const int error = plugged_ ? answerTo(request, data->data) : ENODEV;
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
}

int UmockdevCamera::answerTo(unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      *static_cast<v4l2_capability*>(argument) = capabilities();
      return 0;
    case VIDIOC_ENUM_FMT: {
      auto& each = *static_cast<v4l2_fmtdesc*>(argument);
      if (each.index >= kind_.formats.size()) return EINVAL;
      each.pixelformat = kind_.formats[each.index];
      return 0;
    }
    case VIDIOC_S_FMT:
    case VIDIOC_G_FMT:
      if (request == VIDIOC_S_FMT) {
        const std::uint32_t wanted = static_cast<v4l2_format*>(argument)->fmt.pix.pixelformat;
        if (std::ranges::find(kind_.formats, wanted) != kind_.formats.end()) format_ = wanted;
      }
      return setFormat(argument);
    case VIDIOC_G_PARM: {
      auto& rate = static_cast<v4l2_streamparm*>(argument)->parm.capture;
      rate.timeperframe = {static_cast<std::uint32_t>(kind_.period.count() / 1000), 1'000'000};
      return 0;
    }
    case VIDIOC_S_PARM:
      return 0;
    case VIDIOC_REQBUFS: {
      auto& wanted = *static_cast<v4l2_requestbuffers*>(argument);
      wanted.count = std::min(wanted.count, kind_.buffers);
      empty_.clear();
      filled_.clear();
      return 0;
    }
    case VIDIOC_QUERYBUF: {
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      buffer.length = bufferBytes();
      buffer.m.offset = buffer.index * bufferBytes();
      return 0;
    }
    case VIDIOC_EXPBUF:
      return ENOTTY;
    case VIDIOC_QBUF:
      empty_.push_back(static_cast<v4l2_buffer*>(argument)->index);
      return 0;
    case VIDIOC_DQBUF:
      return takeBuffer(argument);
    case VIDIOC_STREAMON:
      streaming_ = true;
      next_time_ = clock_.now() + kind_.period;
      return 0;
    case VIDIOC_STREAMOFF:
      streaming_ = false;
      empty_.clear();
      filled_.clear();
      return 0;
    default:
      ++unknown_;
      return ENOTTY;
  }
}

int UmockdevCamera::setFormat(void* argument) {
  auto& format = static_cast<v4l2_format*>(argument)->fmt.pix;
  format = {};
  format.width = kind_.width;
  format.height = kind_.height;
  format.pixelformat = format_;
  format.field = V4L2_FIELD_NONE;
  format.bytesperline = rowBytes();
  format.sizeimage = pictureBytes();
  return 0;
}

int UmockdevCamera::takeBuffer(void* argument) {
  if (!streaming_) return EINVAL;
  const MonotonicTime now = clock_.now();
  while (!silent_ &&
         (kind_.paced ? next_time_ + kind_.delay(next_number_) <= now : filled_.empty() && !empty_.empty())) {
    takePicture(next_time_);
    next_time_ += kind_.period;
  }
  if (filled_.empty()) return EAGAIN;
  const Filled& next = filled_.front();
  auto& buffer = *static_cast<v4l2_buffer*>(argument);
  buffer.index = next.index;
  buffer.sequence = next.number;
  buffer.bytesused = next.bytes;
  buffer.flags = next.flags | V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(next.time.time_since_epoch()).count();
  buffer.timestamp = {us / 1'000'000, us % 1'000'000};
  filled_.pop_front();
  return 0;
}

void UmockdevCamera::takePicture(MonotonicTime time) {
  const std::uint32_t number = next_number_++;
  Filled picture{0, number, 0, pictureBytes(), time};
  for (const auto& [at, fault] : faults_) {
    if (at != number) continue;
    if (fault == Fault::Dropped) return;
    if (fault == Fault::Damaged) picture.flags = V4L2_BUF_FLAG_ERROR;
    if (fault == Fault::Short) picture.bytes /= 2;
    if (fault == Fault::BackInTime) picture.time -= 2 * kind_.period;
  }
  if (empty_.empty()) {
    ++starved_;
    return;
  }
  picture.index = empty_.front();
  empty_.pop_front();
  std::uint8_t* row = memory_ + std::size_t{picture.index} * bufferBytes();
  for (std::uint32_t r = 0; r < kind_.height; ++r, row += rowBytes()) {
    for (std::uint32_t c = 0; c < kind_.width; ++c) {
      const std::uint16_t value = kind_.sample(number, static_cast<int>(c), static_cast<int>(r));
      std::memcpy(row + std::size_t{2} * c, &value, sizeof value);
    }
  }
  filled_.push_back(picture);
}

}  // namespace relievo::test
