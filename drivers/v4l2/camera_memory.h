// SPDX-License-Identifier: Apache-2.0
// The buffers that a camera fills, shared by the camera and the holders of its pictures.
#pragma once

#include <linux/videodev2.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo::v4l2 {

// A held buffer. The destructor, on any thread, returns it to the camera unless that was closed. The memory stays
// mapped as long as any buffer is held.
class CameraMemory;
struct Held {
  std::shared_ptr<CameraMemory> memory;
  std::uint32_t index = 0;
  const std::uint8_t* data = nullptr;
  int dma_buf = -1;

  Held(std::shared_ptr<CameraMemory> from, std::uint32_t which);
  ~Held();
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
};
// Of Packet::owner; the deleter's type identifies this back end's packets.
struct HeldDeleter {
  void operator()(const Held* held) const noexcept { delete held; }
};

class CameraMemory {
 public:
  // Maps the buffers of an open device, exports each as a dma-buf if the driver can, and queues all to the camera.
  [[nodiscard]] static Result<std::shared_ptr<CameraMemory>> make(UniqueFd device, std::uint32_t wanted);
  ~CameraMemory();
  CameraMemory(const CameraMemory&) = delete;
  CameraMemory& operator=(const CameraMemory&) = delete;

  [[nodiscard]] int device() const noexcept { return device_.get(); }
  // Dequeues a filled buffer. Returns 0 or errno.
  [[nodiscard]] int take(v4l2_buffer& filled) noexcept;
  // The number of buffers that the camera has.
  [[nodiscard]] std::uint32_t withCamera() const noexcept;
  [[nodiscard]] std::size_t bytes(std::uint32_t index) const noexcept { return buffers_[index].bytes; }
  [[nodiscard]] const std::uint8_t* data(std::uint32_t index) const noexcept { return buffers_[index].data; }
  [[nodiscard]] int dmaBuf(std::uint32_t index) const noexcept { return buffers_[index].dma_buf.get(); }
  [[nodiscard]] std::uint32_t count() const noexcept { return static_cast<std::uint32_t>(buffers_.size()); }
  // Returns a buffer to the camera.
  void give(std::uint32_t index) noexcept;
  // Stops the camera and closes the device.
  void close() noexcept;

 private:
  struct Buffer {
    std::uint8_t* data = nullptr;
    std::size_t bytes = 0;
    UniqueFd dma_buf;
  };
  explicit CameraMemory(UniqueFd device) noexcept : device_(std::move(device)) {}
  [[nodiscard]] Result<void> map(std::uint32_t index);

  mutable std::mutex mutex_;  // guards device_ and with_camera_
  UniqueFd device_;
  std::uint32_t with_camera_ = 0;
  std::vector<Buffer> buffers_;  // never changes once made
};

}  // namespace relievo::v4l2
