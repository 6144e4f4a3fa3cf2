// SPDX-License-Identifier: Apache-2.0
// Memory-mapped streaming by the single- or multi-planar interface (Documentation/userspace-api/media/v4l/mmap.rst,
// planar-apis.rst).
#include "drivers/v4l2/m2m_buffers.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <algorithm>
#include <utility>

#include "drivers/v4l2/control.h"

namespace relievo::v4l2 {
namespace {

using Where = M2mBuffers::Buffer::Where;

constexpr const char* kNoBuffers = "the video hardware gives no buffers; it is busy or out of memory";
constexpr std::uint64_t kMicroseconds = 1'000'000;

// An ioctl's argument for one buffer, in the single- or multi-planar form.
struct Form {
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
  v4l2_buffer buffer{};

  Form(std::uint32_t type, std::uint32_t index) noexcept {
    buffer.type = type;
    buffer.index = index;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (!V4L2_TYPE_IS_MULTIPLANAR(type)) return;
    buffer.m.planes = planes.data();
    buffer.length = static_cast<std::uint32_t>(planes.size());
  }
  [[nodiscard]] bool multi() const noexcept { return V4L2_TYPE_IS_MULTIPLANAR(buffer.type); }
};

}  // namespace

Result<void> outcomeOf(int error) noexcept {
  if (error == 0) return {};
  if (error == ENODEV || error == ENXIO) return fail(ErrorCode::Lost, "the video hardware has gone away", error);
  return fail(ErrorCode::Io, "the video hardware failed", error);
}

Result<std::shared_ptr<M2mBuffers>> M2mBuffers::make(std::shared_ptr<const UniqueFd> device, std::uint32_t type,
                                                     std::uint32_t wanted) {
  std::shared_ptr<M2mBuffers> made(new M2mBuffers(std::move(device), type));
  v4l2_requestbuffers request{};
  request.count = wanted;
  request.type = type;
  request.memory = V4L2_MEMORY_MMAP;
  if (control(made->device_->get(), VIDIOC_REQBUFS, &request) < 0 || request.count == 0) {
    return fail(errno == ENODEV ? ErrorCode::Lost : ErrorCode::Exhausted, kNoBuffers, errno);
  }
  made->buffers_.resize(request.count);
  for (std::uint32_t i = 0; i < request.count; ++i) {
    if (auto mapped = made->map(i); !mapped) return std::unexpected(mapped.error());
  }
  return made;
}

Result<void> M2mBuffers::map(std::uint32_t index) {
  const int fd = device_->get();
  Form form(type_, index);
  if (control(fd, VIDIOC_QUERYBUF, &form.buffer) < 0) return fail(ErrorCode::Exhausted, kNoBuffers, errno);
  plane_count_ = form.multi() ? std::min<std::size_t>(form.buffer.length, kMostPlanes) : 1;
  const int access = holdsPackets() ? PROT_READ | PROT_WRITE : PROT_READ;
  for (std::size_t i = 0; i < plane_count_; ++i) {
    const std::size_t bytes = form.multi() ? form.planes[i].length : form.buffer.length;
    const std::uint32_t offset = form.multi() ? form.planes[i].m.mem_offset : form.buffer.m.offset;
    void* const data = ::mmap(nullptr, bytes, access, MAP_SHARED, fd, static_cast<off_t>(offset));
    if (data == MAP_FAILED) return fail(ErrorCode::Exhausted, kNoBuffers, errno);
    Memory& memory = buffers_[index].planes[i];
    memory.data = static_cast<std::uint8_t*>(data);
    memory.bytes = bytes;
    if (holdsPackets()) continue;
    v4l2_exportbuffer exported{};
    exported.type = type_;
    exported.index = index;
    exported.plane = static_cast<std::uint32_t>(i);
    exported.flags = O_CLOEXEC | O_RDONLY;
    if (control(fd, VIDIOC_EXPBUF, &exported) == 0) memory.dma_buf.reset(exported.fd);
  }
  return {};
}

M2mBuffers::~M2mBuffers() {
  release();
  for (const Buffer& buffer : buffers_) {
    for (const Memory& memory : buffer.planes) {
      if (memory.data != nullptr) ::munmap(memory.data, memory.bytes);
    }
  }
}

int M2mBuffers::start() noexcept {
  auto type = static_cast<int>(type_);
  return control(device_->get(), VIDIOC_STREAMON, &type) < 0 ? errno : 0;
}

int M2mBuffers::stop() noexcept {
  const std::scoped_lock lock(mutex_);
  auto type = static_cast<int>(type_);
  const int error = control(device_->get(), VIDIOC_STREAMOFF, &type) < 0 ? errno : 0;
  for (Buffer& buffer : buffers_) {
    if (buffer.where == Where::WithDevice) buffer.where = Where::Here;
  }
  return error;
}

int M2mBuffers::queue(std::uint32_t index, std::size_t bytes, std::uint64_t tag) noexcept {
  const std::scoped_lock lock(mutex_);
  return queueLocked(index, bytes, tag);
}

int M2mBuffers::queueLocked(std::uint32_t index, std::size_t bytes, std::uint64_t tag) noexcept {
  Form form(type_, index);
  if (form.multi()) form.buffer.length = static_cast<std::uint32_t>(plane_count_);
  if (holdsPackets()) {
    form.buffer.bytesused = form.planes[0].bytesused = static_cast<std::uint32_t>(bytes);
    form.buffer.timestamp = {static_cast<time_t>(tag / kMicroseconds), static_cast<suseconds_t>(tag % kMicroseconds)};
  }
  if (control(device_->get(), VIDIOC_QBUF, &form.buffer) < 0) return errno;
  buffers_[index].where = Where::WithDevice;
  return 0;
}

int M2mBuffers::queueAll() noexcept {
  const std::scoped_lock lock(mutex_);
  for (std::uint32_t i = 0; i < count(); ++i) {
    if (buffers_[i].where != Where::Here) continue;
    if (const int error = queueLocked(i, 0, 0); error != 0) return error;
  }
  return 0;
}

int M2mBuffers::take(Done& done) noexcept {
  Form form(type_, 0);
  if (control(device_->get(), VIDIOC_DQBUF, &form.buffer) < 0) return errno;
  if (form.buffer.index >= count()) return EPROTO;
  const auto seconds = static_cast<std::uint64_t>(form.buffer.timestamp.tv_sec);
  done = {.index = form.buffer.index,
          .bytes = form.multi() ? form.planes[0].bytesused : form.buffer.bytesused,
          .tag = seconds * kMicroseconds + static_cast<std::uint64_t>(form.buffer.timestamp.tv_usec),
          .damaged = (form.buffer.flags & V4L2_BUF_FLAG_ERROR) != 0,
          .last = (form.buffer.flags & V4L2_BUF_FLAG_LAST) != 0,
          .field = form.buffer.field};
  const std::scoped_lock lock(mutex_);
  buffers_[done.index].where = Where::Here;
  return 0;
}

std::optional<std::uint32_t> M2mBuffers::anyHere() const noexcept {
  const std::scoped_lock lock(mutex_);
  const auto found = std::find_if(buffers_.begin(), buffers_.end(), [](auto& b) { return b.where == Where::Here; });
  if (found == buffers_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - buffers_.begin());
}

std::uint32_t M2mBuffers::withDevice() const noexcept {
  const std::scoped_lock lock(mutex_);
  const auto with = [](const Buffer& b) { return b.where == Where::WithDevice; };
  return static_cast<std::uint32_t>(std::count_if(buffers_.begin(), buffers_.end(), with));
}

void M2mBuffers::lend(std::uint32_t index) noexcept {
  const std::scoped_lock lock(mutex_);
  buffers_[index].where = Where::Lent;
}

void M2mBuffers::giveBack(std::uint32_t index) noexcept {
  const std::scoped_lock lock(mutex_);
  buffers_[index].where = Where::Here;
  if (device_) static_cast<void>(queueLocked(index, 0, 0));  // `take` reports a device that fails
}

void M2mBuffers::release() noexcept {
  const std::scoped_lock lock(mutex_);
  if (!device_) return;
  auto type = static_cast<int>(type_);
  v4l2_requestbuffers none{};
  none.type = type_;
  none.memory = V4L2_MEMORY_MMAP;
  control(device_->get(), VIDIOC_STREAMOFF, &type);
  control(device_->get(), VIDIOC_REQBUFS, &none);
  device_.reset();
}

}  // namespace relievo::v4l2
