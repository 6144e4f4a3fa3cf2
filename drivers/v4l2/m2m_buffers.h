// SPDX-License-Identifier: Apache-2.0
// One of the two buffer queues of a memory-to-memory device: packets to it, or pictures from it.
#pragma once

#include <linux/videodev2.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo::v4l2 {

// Of an errno of the device's: Lost where it has gone, else Io.
[[nodiscard]] Result<void> outcomeOf(int error) noexcept;

// Mapped buffers, each with the device, here, or lent to who holds its picture. Thread: one, but `giveBack`.
class M2mBuffers {
 public:
  static constexpr std::size_t kMostPlanes = 3;  // of memory
  struct Memory {
    std::uint8_t* data = nullptr;
    std::size_t bytes = 0;
    UniqueFd dma_buf;
  };
  struct Buffer {
    std::array<Memory, kMostPlanes> planes;
    enum class Where : std::uint8_t { Here, WithDevice, Lent } where = Where::Here;
  };
  // What the device has done with one.
  struct Done {
    std::uint32_t index = 0;
    std::size_t bytes = 0;  // in the first plane
    std::uint64_t tag = 0;
    bool damaged = false, last = false;
  };

  // `type` a V4L2_BUF_TYPE; buffers of pictures are exported as well where the driver can.
  [[nodiscard]] static Result<std::shared_ptr<M2mBuffers>> make(std::shared_ptr<const UniqueFd> device,
                                                                std::uint32_t type, std::uint32_t wanted);
  ~M2mBuffers();
  M2mBuffers(const M2mBuffers&) = delete;
  M2mBuffers& operator=(const M2mBuffers&) = delete;

  // All below: 0, or errno.
  [[nodiscard]] int start() noexcept;
  // All that the device has are here again, undone.
  int stop() noexcept;
  // One that is here, with the bytes of its first plane (packets); the device copies the tag from packet to picture.
  [[nodiscard]] int queue(std::uint32_t index, std::size_t bytes, std::uint64_t tag) noexcept;
  // Afterwards it is here. EAGAIN: none is done; EPIPE: none will be before the device goes on.
  [[nodiscard]] int take(Done& done) noexcept;
  // Every one that is here.
  [[nodiscard]] int queueAll() noexcept;

  [[nodiscard]] std::optional<std::uint32_t> anyHere() const noexcept;
  [[nodiscard]] std::uint32_t withDevice() const noexcept;
  [[nodiscard]] std::uint32_t count() const noexcept { return static_cast<std::uint32_t>(buffers_.size()); }
  [[nodiscard]] const std::array<Memory, kMostPlanes>& memory(std::uint32_t index) const noexcept {
    return buffers_[index].planes;
  }
  void lend(std::uint32_t index) noexcept;
  // To the device, if that is still there. Any thread.
  void giveBack(std::uint32_t index) noexcept;
  // The device lets go of them and they of it; the memory stays until this dies.
  void release() noexcept;

 private:
  M2mBuffers(std::shared_ptr<const UniqueFd> device, std::uint32_t type) noexcept
      : type_(type), device_(std::move(device)) {}
  [[nodiscard]] Result<void> map(std::uint32_t index);
  [[nodiscard]] bool holdsPackets() const noexcept { return V4L2_TYPE_IS_OUTPUT(type_); }
  [[nodiscard]] int queueLocked(std::uint32_t index, std::size_t bytes, std::uint64_t tag) noexcept;

  const std::uint32_t type_;
  std::size_t plane_count_ = 1;
  mutable std::mutex mutex_;  // guards the device's life and where the buffers are
  std::shared_ptr<const UniqueFd> device_;
  std::vector<Buffer> buffers_;
};

}  // namespace relievo::v4l2
