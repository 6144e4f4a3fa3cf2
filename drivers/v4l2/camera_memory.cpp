// SPDX-License-Identifier: Apache-2.0
// Memory-mapped streaming (Documentation/userspace-api/media/v4l/mmap.rst, dmabuf.rst).
#include "drivers/v4l2/camera_memory.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <cerrno>
#include <utility>

#include "drivers/v4l2/control.h"

namespace relievo::v4l2 {
namespace {

constexpr std::uint32_t kFewest = 2;
constexpr const char* kNoBuffers = "the camera's driver gives no buffers; another program may be using it";

}  // namespace

Held::Held(std::shared_ptr<CameraMemory> from, std::uint32_t which)
    : memory(std::move(from)), index(which), data(memory->data(which)), dma_buf(memory->dmaBuf(which)) {}

Held::~Held() {
  memory->give(index);
}

Result<std::shared_ptr<CameraMemory>> CameraMemory::make(UniqueFd device, std::uint32_t wanted) {
  std::shared_ptr<CameraMemory> memory(new CameraMemory(std::move(device)));
  v4l2_requestbuffers request{};
  request.count = wanted;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (control(memory->device(), VIDIOC_REQBUFS, &request) < 0) {
    return fail(errno == EBUSY ? ErrorCode::Io : ErrorCode::Unsupported, kNoBuffers, errno);
  }
  if (request.count < kFewest) return fail(ErrorCode::Exhausted, kNoBuffers);
  memory->buffers_.resize(request.count);
  for (std::uint32_t i = 0; i < request.count; ++i) {
    if (auto mapped = memory->map(i); !mapped) return std::unexpected(mapped.error());
  }
  for (std::uint32_t i = 0; i < request.count; ++i) memory->give(i);
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (memory->withCamera() < request.count || control(memory->device(), VIDIOC_STREAMON, &type) < 0) {
    return fail(ErrorCode::Io, "the camera does not start; another program may be using it, or its bus is full", errno);
  }
  return memory;
}

Result<void> CameraMemory::map(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  if (control(device(), VIDIOC_QUERYBUF, &buffer) < 0) return fail(ErrorCode::Io, kNoBuffers, errno);
  void* const data =
      ::mmap(nullptr, buffer.length, PROT_READ, MAP_SHARED, device(), static_cast<off_t>(buffer.m.offset));
  if (data == MAP_FAILED) return fail(ErrorCode::Exhausted, "out of memory for the camera's pictures", errno);
  buffers_[index].data = static_cast<std::uint8_t*>(data);
  buffers_[index].bytes = buffer.length;

  v4l2_exportbuffer exported{};
  exported.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  exported.index = index;
  exported.flags = O_CLOEXEC | O_RDONLY;
  exported.fd = -1;
  if (control(device(), VIDIOC_EXPBUF, &exported) == 0) buffers_[index].dma_buf.reset(exported.fd);
  return {};
}

CameraMemory::~CameraMemory() {
  close();
  for (const Buffer& buffer : buffers_) {
    if (buffer.data != nullptr) ::munmap(buffer.data, buffer.bytes);
  }
}

int CameraMemory::take(v4l2_buffer& filled) noexcept {
  filled = {};
  filled.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  filled.memory = V4L2_MEMORY_MMAP;
  if (control(device(), VIDIOC_DQBUF, &filled) < 0) return errno;
  if (filled.index >= buffers_.size()) return EPROTO;
  const std::scoped_lock lock(mutex_);
  --with_camera_;
  return 0;
}

std::uint32_t CameraMemory::withCamera() const noexcept {
  const std::scoped_lock lock(mutex_);
  return with_camera_;
}

void CameraMemory::give(std::uint32_t index) noexcept {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  const std::scoped_lock lock(mutex_);
  if (device_.valid() && control(device(), VIDIOC_QBUF, &buffer) == 0) ++with_camera_;
}

// Frees the device's buffers, so that it can be opened again while old pictures are still held.
void CameraMemory::close() noexcept {
  const std::scoped_lock lock(mutex_);
  if (!device_.valid()) return;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_requestbuffers none{};
  none.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  none.memory = V4L2_MEMORY_MMAP;
  control(device(), VIDIOC_STREAMOFF, &type);
  control(device(), VIDIOC_REQBUFS, &none);
  device_.reset();
  with_camera_ = 0;
}

}  // namespace relievo::v4l2
