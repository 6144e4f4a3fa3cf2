// SPDX-License-Identifier: Apache-2.0
// What the player tells of a film: how it was read, and what happens to its sources and decoders while it plays.
#pragma once

#include <optional>
#include <string>

#include "app/media/film_feed.h"
#include "app/media/pair_reader.h"
#include "app/player/journal.h"
#include "platform/error.h"

namespace relievo {

// Writes the log and the journal. One thread.
class FilmNotes {
 public:
  explicit FilmNotes(Journal& journal) : journal_(journal) {}

  // The film that is spoken of from now on; nothing has been told of it.
  void begin(const SourceOptions& source);
  // The film is still being opened: a long wait is told once.
  void waits(MonotonicTime now);
  void opened(const FilmInfo& info);
  // A source lost and found again; a decoder that begins anew.
  void happened(const FilmFeed::News& news);
  // A seek that the source refused.
  void refused(const Error& seek);
  // The machine does not decode all pictures in time; told once.
  void slow();
  // After the film's end: what of it was damaged or missing.
  void missing(const PairCounters& pairs);

 private:
  Journal& journal_;
  std::string url_, depth_url_;
  bool slowness_told_ = false, wait_told_ = false;
  std::optional<MonotonicTime> waits_since_;
};

}  // namespace relievo
