// SPDX-License-Identifier: Apache-2.0
// The nodes of /dev that decode: which there are, what each takes, and one that is free.
#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/v4l2/annex_b.h"
#include "drivers/v4l2/v4l2.h"
#include "hal/media_source.h"
#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo::v4l2 {

// The fourcc of a codec's packets; nothing for one that is not decoded here.
[[nodiscard]] std::optional<std::uint32_t> packetFormatOf(const std::string& codec) noexcept;

struct M2mNode : V4l2M2mNode {
  bool planes = false;  // it has the multi-planar interface

  // The kinds of its queues: of packets, of pictures.
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
// The first free one that decodes the stream, with its packets' format set. NotFound: there is none at all, or none for
// this codec. Unsupported: it takes no such pictures, or so large ones. Io: it is busy.
[[nodiscard]] Result<M2mDevice> openM2mDevice(const StreamInfo& stream, const std::optional<CodingProfile>& profile);

}  // namespace relievo::v4l2
