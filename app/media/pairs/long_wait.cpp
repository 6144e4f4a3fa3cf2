// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/long_wait.h"

#include <condition_variable>
#include <mutex>
#include <thread>

#include "app/media/film_feed.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {

void tellWait(const char* program, const std::string& url, const std::string& depth_url) {
  const std::string what =
      depth_url.empty() ? print("\"%s\"", url.c_str()) : print("\"%s\" or \"%s\"", url.c_str(), depth_url.c_str());
  log(LogLevel::Warning, program, "waiting for %s (up to %.0f s)", what.c_str(), toSeconds(FilmFeed::kPatience));
}

Result<void> openTelling(PairReader& reader, const SourceOptions& source, Duration patience) {
  std::mutex mutex;
  std::condition_variable_any wake;
  const std::jthread teller([&](const std::stop_token& done) {
    std::unique_lock lock(mutex);
    wake.wait_for(lock, done, patience, [] { return false; });
    if (!done.stop_requested()) tellWait("media", source.url, source.depth_url);
  });
  return reader.open(source);
}

}  // namespace relievo
