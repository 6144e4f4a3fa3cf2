// SPDX-License-Identifier: Apache-2.0
// Makes posters of films on a thread of its own, those that are wished for and no more.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/player/browse/poster.h"

namespace relievo {

struct WishedPoster {
  std::string url, depth_url;
};

// One thread calls it; no verb waits, but for the destructor, up to half a second.
class PosterMaker {
 public:
  static constexpr std::size_t kMostKept = 48;                    // 4 MB; then the oldest go
  static constexpr Duration kLongest = std::chrono::seconds(10);  // for one; after that the film has none

  // `options` says how the films are read. Without backends it makes none.
  PosterMaker(PairReader::Backends backends, SourceOptions options);
  ~PosterMaker();
  PosterMaker(const PosterMaker&) = delete;
  PosterMaker& operator=(const PosterMaker&) = delete;

  // These next, in this order, instead of those wished for before; none: it rests, and leaves the one it is at.
  void wish(const std::vector<WishedPoster>& films);
  // Once a round: gives up a film that takes too long. True if a poster has been made since the last call.
  [[nodiscard]] bool attend();
  // Null: not yet made.
  [[nodiscard]] std::shared_ptr<const Poster> find(const std::string& url) const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace relievo
