// SPDX-License-Identifier: Apache-2.0
// Work that comes in independent pieces, on all processors.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace relievo {

// Calls work(0) .. work(count - 1), each once, in any order and on several threads. `work` does not throw.
template <class Work>
void inParallel(std::size_t count, Work&& work) {
  std::atomic<std::size_t> next{0};
  const auto drain = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  const std::size_t threads = std::min<std::size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::jthread> helpers;
  for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(drain);
  drain();
}

}  // namespace relievo
