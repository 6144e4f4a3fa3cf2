// SPDX-License-Identifier: Apache-2.0
// Where the viewer left each film: kept in a file that survives a power cut.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hal/media/media_time.h"

namespace relievo {

// JSON: [["URL", seconds], ..], the film seen last first. Written whole or not at all, on a thread of its own, since a
// disk may take its time. A file that cannot be read counts as empty and is replaced; what cannot be written is told
// once, in the log.
class Resume {
 public:
  static constexpr std::size_t kMostFilms = 200;
  static constexpr Duration kLeast = std::chrono::seconds(2);  // nobody has left a film so early

  // $STATE_DIRECTORY (of a service), else $XDG_STATE_HOME/relievo, else ~/.local/state/relievo; empty without a home.
  [[nodiscard]] static std::string defaultPath();

  explicit Resume(std::string path);
  ~Resume();  // what was kept last is written
  Resume(const Resume&) = delete;
  Resume& operator=(const Resume&) = delete;

  // What a film is kept by: a path without its detours from the root on, an address as it is.
  [[nodiscard]] static std::string keyOf(const std::string& url);

  // The key of the film that was seen last.
  [[nodiscard]] std::optional<std::string> last() const;
  [[nodiscard]] std::optional<MediaTime> find(const std::string& url) const;
  // All of them: keys and seconds, the film seen last first.
  [[nodiscard]] std::vector<std::pair<std::string, double>> all() const;
  // Never waits. The newest position is on the disk soon afterwards.
  void keep(const std::string& url, MediaTime position);
  // The film has been seen to its end.
  void forget(const std::string& url);

 private:
  using Films = std::vector<std::pair<std::string, double>>;
  void changed();
  void write(const Films& films);
  void threadMain();

  const std::string path_;
  mutable std::mutex mutex_;  // of all below
  std::condition_variable wake_;
  Films films_;
  bool dirty_ = false, stopping_ = false;
  bool told_ = false;  // the thread's own
  std::thread thread_;
};

}  // namespace relievo
