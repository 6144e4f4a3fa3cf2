// SPDX-License-Identifier: Apache-2.0
// Where the viewer left each film, stored in a file that survives a power cut.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/player/file_writer.h"
#include "hal/media/media_time.h"

namespace relievo {

// JSON: [["URL", seconds], ..], the film seen last first. The file writer writes it whole or not at all. A damaged file
// counts as empty and is replaced; one that cannot be read is left unchanged. A failure to read or write is logged
// once.
class Resume {
 public:
  static constexpr std::size_t kMostFilms = 200;
  static constexpr Duration kLeast = std::chrono::seconds(2);  // earlier positions are not kept

  // $STATE_DIRECTORY (of a service), else $XDG_STATE_HOME/relievo, else ~/.local/state/relievo; empty without a home.
  [[nodiscard]] static std::string defaultPath();

  // `files` must outlive it.
  Resume(std::string path, FileWriter& files);

  // The key under which a film's position is kept: its absolute path without "..", or its address unchanged.
  [[nodiscard]] static std::string keyOf(const std::string& url);

  // The key of the film that was seen last.
  [[nodiscard]] std::optional<std::string> last() const;
  [[nodiscard]] std::optional<MediaTime> find(const std::string& url) const;
  // All keys and seconds, the film seen last first.
  [[nodiscard]] std::vector<std::pair<std::string, double>> all() const;
  // Never waits. The newest position is written to disk soon afterwards.
  void keep(const std::string& url, MediaTime position);
  // The film has been seen to its end.
  void forget(const std::string& url);
  // False if the newest positions could not be written, or the file could not be read. Call when the writer is
  // finished.
  [[nodiscard]] bool isKept() const noexcept { return state_->kept; }

 private:
  using Films = std::vector<std::pair<std::string, double>>;
  void changed();

  std::string path_;  // empty: nothing is written
  FileWriter& files_;
  Films films_;
  struct State {
    bool kept = true, told = false;
  };
  std::shared_ptr<State> state_ = std::make_shared<State>();  // the writer's
};

}  // namespace relievo
