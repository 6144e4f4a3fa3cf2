// SPDX-License-Identifier: Apache-2.0
// The pictures' side of a decoding device: set up as the stream says, each picture by reference.
#pragma once

#include <cstdint>
#include <memory>

#include "drivers/v4l2/m2m_buffers.h"
#include "drivers/v4l2/m2m_node.h"
#include "drivers/v4l2/m2m_picture.h"
#include "hal/frame.h"
#include "hal/media_source.h"
#include "platform/error.h"

namespace relievo::v4l2 {

// One thread; frames may be dropped on any, and outlive the queue.
class PictureQueue {
 public:
  // "Capture Setup" of the kernel's document, the first time and after a change of resolution. Unsupported where the
  // pictures cannot be read.
  [[nodiscard]] Result<void> setUp(const M2mDevice& device, const StreamInfo& stream);
  [[nodiscard]] bool running() const noexcept { return buffers_ != nullptr; }

  struct Taken {
    Frame frame;            // without its times; empty where there is none in it
    std::uint64_t tag = 0;  // of the packet that it is from
    bool damaged = false, last = false;
  };
  // 0, or errno, as of M2mBuffers::take.
  [[nodiscard]] int take(Taken& taken);
  // Forgets the pictures that are done but not taken.
  [[nodiscard]] Result<void> restart() noexcept;
  void release() noexcept;

 private:
  [[nodiscard]] Frame pictureIn(std::uint32_t index) const;

  std::shared_ptr<M2mBuffers> buffers_;  // shared with the pictures that are held
  PictureLayout layout_;
  std::uint32_t needed_ = 0;  // that the driver has to have
};

}  // namespace relievo::v4l2
