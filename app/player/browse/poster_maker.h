// SPDX-License-Identifier: Apache-2.0
// Makes the requested posters of films on a thread of its own.
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

// Use from one thread; no call waits, except the destructor, up to half a second.
class PosterMaker {
 public:
  static constexpr std::size_t kMostKept = 48;                    // 4 MB; beyond that the oldest are dropped
  static constexpr Duration kLongest = std::chrono::seconds(10);  // for one film; after that it has no poster

  // `options` says how to read the films. Without backends no posters are made.
  PosterMaker(PairReader::Backends backends, SourceOptions options);
  ~PosterMaker();
  PosterMaker(const PosterMaker&) = delete;
  PosterMaker& operator=(const PosterMaker&) = delete;

  // Makes these posters next, in this order, instead of those requested before. If empty, it stops after the present
  // one.
  void wish(const std::vector<WishedPoster>& films);
  // Call once a round: gives up a film that takes too long. True if a poster has been made since the last call.
  [[nodiscard]] bool attend();
  // Null: not made yet.
  [[nodiscard]] std::shared_ptr<const Poster> find(const std::string& url) const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace relievo
