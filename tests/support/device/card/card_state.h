// SPDX-License-Identifier: Apache-2.0
// What the parts of the fake card share.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "platform/unique_fd.h"
#include "tests/support/device/card/fake_card.h"

namespace relievo::test {

struct CardState {
  std::string path, driver;
  std::vector<drmModeModeInfo> modes;
  UniqueFd events;                                // the other end of what the driver opens
  std::map<std::uint32_t, CardPicture> pictures;  // by frame buffer
  std::map<std::uint32_t, drmModeModeInfo> blobs;
  std::uint32_t last_id = 100;
  std::optional<drmModeModeInfo> mode;
  std::uint32_t shown = 0;  // a frame buffer
  int rejected = 0;
  CardPicture drawn;  // by the last swap
};
// The state of the one fake card; valid while a FakeCard exists.
[[nodiscard]] CardState& theCard();

}  // namespace relievo::test
