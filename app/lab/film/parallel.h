// SPDX-License-Identifier: Apache-2.0
// Distributes independent pieces of work over all processors.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace relievo {

// Calls work(0) .. work(count - 1), each once, in any order and on several threads. `work` must not throw. `tell` is
// called on the caller's thread from time to time with the number of finished pieces.
template <class Work, class Tell>
void inParallel(std::size_t count, Work&& work, Tell&& tell) {
  std::atomic<std::size_t> next{0}, done{0};
  const auto step = [&] {
    const std::size_t i = next++;
    if (i >= count) return false;
    work(i);
    ++done;
    return true;
  };
  const auto drain = [&] {
    while (step()) {
    }
  };
  const std::size_t threads = std::min<std::size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::jthread> helpers;
  for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(drain);
  while (step()) tell(done.load());
}
template <class Work>
void inParallel(std::size_t count, Work&& work) {
  inParallel(count, work, [](std::size_t) {});
}

}  // namespace relievo
