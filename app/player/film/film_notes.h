// SPDX-License-Identifier: Apache-2.0
// Reports how a film was read, and what happens to its sources and decoders while it plays.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/media/film_feed.h"
#include "app/media/lost_part.h"
#include "app/media/pair_reader.h"
#include "app/player/journal.h"
#include "platform/error.h"

namespace relievo {

// Writes the log and the journal. One thread.
class FilmNotes {
 public:
  explicit FilmNotes(Journal& journal) : journal_(journal) {}

  // Starts a film: nothing has been reported about it yet.
  void begin(const SourceOptions& source);
  // The film is still being opened: a long wait is reported once.
  void waits(MonotonicTime now);
  void opened(const FilmInfo& info);
  // A source was lost or found again, a decoder was restarted, or the sound or subtitles that were chosen cannot
  // be decoded.
  void happened(const FilmFeed::News& news, const FilmInfo& info);
  // A seek that the source refused.
  void refused(const Error& seek);
  [[nodiscard]] bool refusesSeeks() const noexcept { return refuses_seeks_; }
  // The machine does not decode all pictures in time; reported once.
  void slow();
  // After the film's end: what it lacked.
  std::vector<LostPart> missing(const PairCounters& pairs);

 private:
  void refusedSound(const FilmInfo& info, const char* why);
  void refusedWords(const FilmInfo& info, std::size_t track, const char* why);

  Journal& journal_;
  std::string url_, depth_url_;
  bool slowness_told_ = false, wait_told_ = false, refuses_seeks_ = false;
  std::optional<MonotonicTime> waits_since_;
};

}  // namespace relievo
