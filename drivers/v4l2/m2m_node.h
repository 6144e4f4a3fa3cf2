// SPDX-License-Identifier: Apache-2.0
// Finds the decoding nodes of /dev and what each decodes, and opens a free one.
#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/v4l2/annex_b.h"
#include "drivers/v4l2/v4l2.h"
#include "hal/media/media_source.h"
#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo::v4l2 {

struct M2mNode : V4l2M2mNode {
  bool planes = false;  // it has the multi-planar interface

  // The V4L2_BUF_TYPE of its two queues.
  [[nodiscard]] std::uint32_t packetQueue() const noexcept {
    return planes ? V4L2_BUF_TYPE_VIDEO_OUTPUT_MPLANE : V4L2_BUF_TYPE_VIDEO_OUTPUT;
  }
  [[nodiscard]] std::uint32_t pictureQueue() const noexcept {
    return planes ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
  }
};

struct M2mDevice {
  M2mNode node;
  std::shared_ptr<const UniqueFd> fd;
};
// Opens the first free node that decodes the stream, and sets its packet format. NotFound: none decodes this codec.
// Unsupported: it cannot decode such pictures, or not of this size, or in no format that can be read. Io: it is busy.
[[nodiscard]] Result<M2mDevice> openM2mDevice(const StreamInfo& stream, const std::optional<CodingProfile>& profile);

// A V4L2_DEC_CMD. Returns 0 or errno.
[[nodiscard]] int command(int fd, std::uint32_t command) noexcept;
// Asks for the events of a change of the pictures' format. False if the driver has none.
[[nodiscard]] bool subscribeChanges(int fd) noexcept;
// Takes the next event: whether it tells a change of the resolution. nullopt if there is none.
[[nodiscard]] std::optional<bool> nextEvent(int fd) noexcept;

}  // namespace relievo::v4l2
