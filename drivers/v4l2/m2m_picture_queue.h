// SPDX-License-Identifier: Apache-2.0
// The picture queue of a decoding device: set up for the stream, returns references to pictures.
#pragma once

#include <cstdint>
#include <memory>

#include "drivers/v4l2/m2m_buffers.h"
#include "drivers/v4l2/m2m_node.h"
#include "drivers/v4l2/m2m_picture.h"
#include "hal/media/frame.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo::v4l2 {

// One thread; frames may be dropped on any thread and may outlive the queue.
class PictureQueue {
 public:
  // "Capture Setup" of the kernel's document, initially and after a change of resolution. Unsupported if the picture
  // format cannot be read.
  [[nodiscard]] Result<void> setUp(const M2mDevice& device, const StreamInfo& stream);
  [[nodiscard]] bool running() const noexcept { return buffers_ != nullptr; }

  struct Taken {
    Frame frame;            // without its times; empty if the buffer has no picture
    std::uint64_t tag = 0;  // of the packet that it was decoded from
    bool damaged = false, last = false;
  };
  // Returns 0 or errno, like M2mBuffers::take.
  [[nodiscard]] int take(Taken& taken);
  // Discards the pictures that are finished but not taken.
  [[nodiscard]] Result<void> restart() noexcept;
  void release() noexcept;

 private:
  [[nodiscard]] Frame pictureIn(std::uint32_t index) const;

  std::shared_ptr<M2mBuffers> buffers_;  // shared with held pictures
  PictureLayout layout_;
  std::uint32_t needed_ = 0;  // buffers that the driver must keep
};

}  // namespace relievo::v4l2
