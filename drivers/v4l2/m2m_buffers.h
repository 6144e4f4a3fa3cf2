// SPDX-License-Identifier: Apache-2.0
// One of the two buffer queues of a memory-to-memory device: packets to the device, or pictures from it.
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

// Converts the device's errno: Lost if the device has gone, else Io.
[[nodiscard]] Result<void> outcomeOf(int error) noexcept;

// Mapped buffers. The device has each one, or this queue, or the holder of its picture. Thread: one, except `giveBack`.
class M2mBuffers {
 public:
  static constexpr std::size_t kMostPlanes = 3;  // memory planes
  struct Memory {
    std::uint8_t* data = nullptr;
    std::size_t bytes = 0;
    UniqueFd dma_buf;
  };
  struct Buffer {
    std::array<Memory, kMostPlanes> planes;
    enum class Where : std::uint8_t { Here, WithDevice, Lent } where = Where::Here;
  };
  // A buffer that the device has finished.
  struct Done {
    std::uint32_t index = 0;
    std::size_t bytes = 0;  // in the first plane
    std::uint64_t tag = 0;
    bool damaged = false, last = false;
    std::uint32_t field = V4L2_FIELD_ANY;  // of a picture
  };

  // `type`: a V4L2_BUF_TYPE. Picture buffers are exported as dma-bufs if the driver can.
  [[nodiscard]] static Result<std::shared_ptr<M2mBuffers>> make(std::shared_ptr<const UniqueFd> device,
                                                                std::uint32_t type, std::uint32_t wanted);
  ~M2mBuffers();
  M2mBuffers(const M2mBuffers&) = delete;
  M2mBuffers& operator=(const M2mBuffers&) = delete;

  // The calls below return 0 or errno.
  [[nodiscard]] int start() noexcept;
  // The device returns all its buffers unprocessed.
  int stop() noexcept;
  // Gives the device a buffer that is Here. `bytes`: used in its first plane, for packets. The device copies `tag` from
  // packet to picture.
  [[nodiscard]] int queue(std::uint32_t index, std::size_t bytes, std::uint64_t tag) noexcept;
  // Takes a finished buffer, which is then Here. EAGAIN: none is finished; EPIPE: none will be until the device is
  // restarted.
  [[nodiscard]] int take(Done& done) noexcept;
  // Queues every buffer that is Here.
  [[nodiscard]] int queueAll() noexcept;

  [[nodiscard]] std::optional<std::uint32_t> anyHere() const noexcept;
  [[nodiscard]] std::uint32_t withDevice() const noexcept;
  [[nodiscard]] std::uint32_t count() const noexcept { return static_cast<std::uint32_t>(buffers_.size()); }
  [[nodiscard]] const std::array<Memory, kMostPlanes>& memory(std::uint32_t index) const noexcept {
    return buffers_[index].planes;
  }
  void lend(std::uint32_t index) noexcept;
  // Returns a lent buffer to the device, if that is still open. Any thread.
  void giveBack(std::uint32_t index) noexcept;
  // Frees the device's buffers and lets go of the device; the memory stays mapped until this is destroyed.
  void release() noexcept;

 private:
  M2mBuffers(std::shared_ptr<const UniqueFd> device, std::uint32_t type) noexcept
      : type_(type), device_(std::move(device)) {}
  [[nodiscard]] Result<void> map(std::uint32_t index);
  [[nodiscard]] bool holdsPackets() const noexcept { return V4L2_TYPE_IS_OUTPUT(type_); }
  [[nodiscard]] int queueLocked(std::uint32_t index, std::size_t bytes, std::uint64_t tag) noexcept;

  const std::uint32_t type_;
  std::size_t plane_count_ = 1;
  mutable std::mutex mutex_;  // guards device_ and each buffer's `where`
  std::shared_ptr<const UniqueFd> device_;
  std::vector<Buffer> buffers_;
};

}  // namespace relievo::v4l2
