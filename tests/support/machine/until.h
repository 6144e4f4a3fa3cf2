// SPDX-License-Identifier: Apache-2.0
// Waits for what another thread or program brings about.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace relievo::test {

// Asks every 5 ms until it is so. False if it is not so after 20 s: then it has hung.
inline bool until(const std::function<bool()>& so) {
  for (int tries = 0; tries < 4000; ++tries) {
    if (so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace relievo::test
