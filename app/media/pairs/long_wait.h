// SPDX-License-Identifier: Apache-2.0
// Says what a program waits for where opening a film takes long: a pipe without a writer, a slow server.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "app/media/pair_reader.h"
#include "platform/clock.h"

namespace relievo {

inline constexpr Duration kLongWait = std::chrono::seconds(5);

// Logs: waiting for "film.mkv" or "depth.mkv" (up to 30 s). `depth_url` may be empty.
void tellWait(const char* program, const std::string& url, const std::string& depth_url);

// Says so once, as tellWait, if it lives for longer than `patience`.
class WaitTeller {
 public:
  explicit WaitTeller(const SourceOptions& source, Duration patience = kLongWait);

 private:
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

// Opens the reader; after `patience` it says so once.
[[nodiscard]] Result<void> openTelling(PairReader& reader, const SourceOptions& source, Duration patience = kLongWait);

}  // namespace relievo
