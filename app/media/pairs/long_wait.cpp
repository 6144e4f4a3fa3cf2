// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/long_wait.h"

#include "app/media/film_feed.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {

void tellWait(const char* program, const std::string& url, const std::string& depth_url) {
  const std::string what =
      depth_url.empty() ? print("\"%s\"", url.c_str()) : print("\"%s\" or \"%s\"", url.c_str(), depth_url.c_str());
  log(LogLevel::Warning, program, "waiting for %s (up to %.0f s)", what.c_str(), toSeconds(FilmFeed::kPatience));
}

WaitTeller::WaitTeller(const SourceOptions& source, Duration patience)
    : thread_([this, url = source.url, depth_url = source.depth_url, patience](const std::stop_token& done) {
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, done, patience, [] { return false; });
        if (!done.stop_requested()) tellWait("media", url, depth_url);
      }) {}

Result<void> openTelling(PairReader& reader, const SourceOptions& source, Duration patience) {
  const WaitTeller teller(source, patience);
  return reader.open(source);
}

}  // namespace relievo
