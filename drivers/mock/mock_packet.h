// SPDX-License-Identifier: Apache-2.0
// The contents of a mock packet, shared by the mock source and the mock decoders.
#pragma once

#include <cstdint>

namespace relievo {

inline constexpr const char* kMockCodec = "mock";  // its StreamInfo::native is a MockTrack

struct MockPacket {
  std::int32_t frame = 0;
  bool damaged = false;
};

}  // namespace relievo
