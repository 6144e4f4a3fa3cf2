// SPDX-License-Identifier: Apache-2.0
// What a mock packet holds: the one thing that the mock source and the mock decoder agree on.
#pragma once

#include <cstdint>

namespace relievo {

inline constexpr const char* kMockCodec = "mock";  // its StreamInfo::native is a MockTrack

struct MockPacket {
  std::int32_t frame = 0;
  bool damaged = false;
};

}  // namespace relievo
