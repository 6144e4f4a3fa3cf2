// SPDX-License-Identifier: Apache-2.0
// Which doubts about a film's reading are shown over its picture. Pure.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/media/reading/film_reading.h"

namespace relievo {

// Each doubt is shown once, also where a film is opened again, or several with the same one follow each other. The
// terminal has them all.
class FilmDoubts {
 public:
  // A film has been opened.
  void begin(const FilmReading& reading) {
    // Of a near end that is taken as in most films, a viewer sees and feels nothing wrong.
    std::vector<std::string> doubts(reading.doubts.begin() + (reading.near_end_is_usual ? 1 : 0), reading.doubts.end());
    const auto isGone = [&](const std::string& told) { return std::ranges::find(doubts, told) == doubts.end(); };
    if (!doubts.empty()) std::erase_if(told_, isGone);
    for (std::string& doubt : doubts) {
      if (std::ranges::find(told_, doubt) == told_.end()) waiting_.push_back(std::move(doubt));
    }
  }
  // The next one to be shown.
  [[nodiscard]] std::optional<std::string> next() {
    if (waiting_.empty()) return std::nullopt;
    std::optional<std::string> doubt(std::move(waiting_.front()));
    waiting_.pop_front();
    told_.push_back(*doubt);
    return doubt;
  }
  // The film is closed: returns what must not stand over the next one.
  [[nodiscard]] const std::vector<std::string>& end() {
    waiting_.clear();
    return told_;
  }

 private:
  std::deque<std::string> waiting_;
  std::vector<std::string> told_;  // of the last film that had some
};

}  // namespace relievo
