// SPDX-License-Identifier: Apache-2.0
// Finds the films in folders and on sticks, without ever making the player wait for a disk.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "app/player/browse/film_shelf.h"

namespace relievo {

inline constexpr int kDeepest = 4;
inline constexpr std::size_t kMostFilms = 1000, kMostNames = 50'000;

// Finds the films in a folder and its sub-folders, down to kDeepest below it, in natural order: those of a folder
// before those of its sub-folders. A folder with depth pictures in a folder `depth` is one film. Hidden names and
// pictures are skipped. At most kMostFilms, of at most kMostNames names.
//
// Each place is read on a thread of its own, so that a disk or server that does not answer costs only its own films.
// Use from one thread; no call waits, except the destructor, up to half a second.
class FilmFinder {
 public:
  // With `own_threads` false, `look` itself reads, for simulated time.
  explicit FilmFinder(bool own_threads = true) noexcept : own_threads_(own_threads) {}
  ~FilmFinder();
  FilmFinder(const FilmFinder&) = delete;
  FilmFinder& operator=(const FilmFinder&) = delete;

  // Reads these folders, and checks which of `files` exist. A place that is already being read is not read again;
  // results of places that are no longer named are dropped.
  void look(const std::vector<std::string>& folders, const std::vector<std::string>& files);
  // True if something new was found since the last call.
  [[nodiscard]] bool hasNews();
  // The films found in a folder; empty until it has been read.
  [[nodiscard]] std::vector<ShelfFilm> filmsIn(const std::string& folder) const;
  // Why a folder could not be read; no error if it was read, or is not read yet.
  [[nodiscard]] std::error_code failureOf(const std::string& folder) const;
  // Those of `files` that exist.
  [[nodiscard]] std::vector<std::string> there() const;

 private:
  struct Shared;
  void read(const std::string& place, const std::vector<std::string>& files);
  const bool own_threads_;
  std::shared_ptr<Shared> shared_;
};

}  // namespace relievo
