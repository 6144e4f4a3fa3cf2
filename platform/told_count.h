// SPDX-License-Identifier: Apache-2.0
// Which of many events of one kind get a line of the log.
#pragma once

#include <cstdint>

namespace relievo {

// True for the first, tenth, hundredth, .. `count` includes the event, and grows by 1 each time.
[[nodiscard]] constexpr bool isTold(std::uint64_t count) noexcept {
  while (count >= 10 && count % 10 == 0) count /= 10;
  return count == 1;
}

}  // namespace relievo
