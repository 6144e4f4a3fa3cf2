// SPDX-License-Identifier: Apache-2.0
// What the parts of the fake card share.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "platform/unique_fd.h"
#include "tests/support/device/card/fake_card.h"

namespace relievo::test {

struct CardState {
  static constexpr std::uint32_t kConnector = 1, kEncoder = 2, kCrtc = 3, kPlane = 4, kPointer = 5;
  std::string path, driver;
  std::vector<drmModeModeInfo> modes;
  UniqueFd events;                                // the other end of what the driver opens
  std::map<std::uint32_t, CardPicture> pictures;  // by frame buffer
  std::map<std::uint32_t, drmModeModeInfo> blobs;
  std::uint32_t last_id = 100;
  std::optional<drmModeModeInfo> mode;
  std::uint32_t shown = 0;  // a frame buffer
  int rejected = 0;
  std::map<std::pair<std::uint32_t, std::string>, std::uint64_t> left;  // by object and property: not 0
  bool keeps_left = false;                                              // it rejects changes of them
  CardPicture drawn;                                                    // by the last swap
};
// The state of the one fake card; valid while a FakeCard exists.
[[nodiscard]] CardState& theCard();

}  // namespace relievo::test
