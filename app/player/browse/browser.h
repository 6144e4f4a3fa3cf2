// SPDX-License-Identifier: Apache-2.0
// The list of films on the screen: finds films, keeps their posters, and follows what the viewer does in the list.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/player/browse/film_finder.h"
#include "app/player/browse/film_shelf.h"
#include "app/player/browse/poster_maker.h"
#include "app/player/browse/sticks.h"
#include "app/player/screen/screen_list.h"
#include "platform/clock.h"

namespace relievo {

// Films that the viewer left, the last one first: the key of each (Resume::keyOf), and the position in seconds.
using LeftFilms = std::vector<std::pair<std::string, double>>;

struct BrowserConfig {
  std::vector<std::string> folders;                     // of films
  std::vector<std::string> stick_roots = stickRoots();  // below these a mount is a stick
  bool takes_drops = false;                             // a film that is dropped on the list is played
};

// The player's thread; no call waits.
class Browser {
 public:
  static constexpr Duration kLookPeriod = std::chrono::seconds(3);  // between two searches of the folders
  static constexpr std::size_t kMostRecent = 5;

  Browser(BrowserConfig config, PairReader::Backends posters, SourceOptions options, bool own_threads = true);

  // The list is shown from now on: looks for films.
  void open(LeftFilms left, MonotonicTime now);
  // Call when a film is played: no new search begins, and no posters are made.
  void close();
  // Call once a round while the list is shown. True if `view` has changed.
  [[nodiscard]] bool attend(MonotonicTime now);
  // Call once a round while a film is played: returns the mount point of this film's medium if it was removed.
  [[nodiscard]] std::optional<std::string> takenAway(const std::string& film);

  [[nodiscard]] const FilmShelf& shelf() const noexcept { return shelf_; }
  void selectBy(std::ptrdiff_t films);
  void select(std::size_t film);
  // The mouse is over this film of the view; nullopt: over none.
  void point(std::optional<std::size_t> film);
  // While a warning is shown, the rows end above it.
  void warn(bool warned);
  [[nodiscard]] const ScreenList& view() const noexcept { return view_; }

 private:
  void look(MonotonicTime now);
  void fill();
  void draw();
  [[nodiscard]] std::vector<std::string> places() const;
  [[nodiscard]] std::string nothingThere() const;

  const BrowserConfig config_;
  StickWatch sticks_;
  FilmFinder finder_;
  PosterMaker posters_;
  FilmShelf shelf_;
  ScreenList view_;
  LeftFilms left_;
  MonotonicTime next_look_;
  std::vector<std::string> sticks_before_;  // while a film is played
  bool moved_ = false;                      // the viewer has selected a film; until then the first one is selected
  bool changed_ = false;
  bool warned_ = false;
};

}  // namespace relievo
