// SPDX-License-Identifier: Apache-2.0
// Plays films: the loop over the player's parts, and the state, which changes only by state_table.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/player/browse/browser.h"
#include "app/player/control/command.h"
#include "app/player/control/key_table.h"
#include "app/player/control/loop_ab.h"
#include "app/player/control/mouse_wishes.h"
#include "app/player/control/wishes.h"
#include "app/player/file_writer.h"
#include "app/player/film/film_doubts.h"
#include "app/player/film/film_playback.h"
#include "app/player/film/programme.h"
#include "app/player/film/seek_times.h"
#include "app/player/journal.h"
#include "app/player/report.h"
#include "app/player/screen/film_screen.h"
#include "app/player/screen/statistics.h"
#include "app/player/sound/loudness.h"
#include "app/player/state_table.h"
#include "app/player/status_line.h"
#include "app/player/touch/film_touch.h"
#include "hal/remote_input.h"
#include "platform/failure.h"

namespace relievo {

class PlayerControl;

struct PlayerConfig {
  SourceOptions source;           // a film or a list of films; its url may be empty for one that stays
  std::vector<std::string> more;  // films or lists to play after it
  DisplayConfig display;
  StereoSettings stereo;
  std::optional<DisplayVolume> volume;  // nullopt: the default volume, in the picture's shape
  KeyTable keys = KeyTable::usual();
  KeyBoard held = KeyBoard::Remote;  // what the viewer uses, for the names of keys
  bool has_mouse = false;            // of a window
  bool mouse_touches = false;        // the mouse is the finger
  bool full_screen = false;          // a window fills the screen from the beginning
  bool loop = false;
  std::optional<MediaTime> start;  // of the film that opens; nullopt: its beginning, or where it was left
  bool unseen = false;             // off screen unasked: said when the first film has opened
  bool osd = true;                 // bar, keys and notices over the picture
  std::string volume_path;   // file in which the volume of each sound output is kept; empty: each run begins at 100 %
  std::string sound_device;  // the key for that volume
  std::optional<double> volume_percent;
  bool stays = false;                    // without a film, waits for the next one until asked to quit
  std::optional<BrowserConfig> browser;  // without a film, shows the films of these folders
  bool faults_in_list = false;   // the list of films shows why no film can be played, in place of the end of the run
  std::optional<Failure> fault;  // of the settings; the list of films shows it, and no film is opened unasked
  std::string resume_path;       // file in which positions in films are kept; empty: every film begins at its beginning
  std::optional<Duration> duration;  // of the run, in machine time
  bool own_threads = true;           // false: reader and ticks run inside `step`, for simulated time
};

// Borrowed; they must outlive the player. Null: not there.
struct PlayerParts {
  Clock& clock;
  Display& display;
  HapticDevice* haptic = nullptr;  // of the first finger
  RemoteInput* remote = nullptr;
  AudioOutput* audio = nullptr;
  Recorder* recorder = nullptr;  // of the first finger
  FingerParts second_finger;
  PlayerControl* control = nullptr;
  StatusLine* status = nullptr;
  PairReader::Backends backends;
  PairReader::Backends posters;  // of the list of films; without a source: no posters
};

// Runs on one thread, the display's. Waits only for the display's refresh, never for the film or the device.
//
// The state table decides which state comes next. Film, list, screen and touch are parts that keep their own facts and
// do not know each other; the player passes on what one part needs from another.
class Player {
 public:
  Player(PlayerConfig config, PlayerParts parts);
  ~Player();

  // Plays until the end, a stop or a failure. `stop` may be set by a signal handler. Call once. Fails if the display is
  // lost, and with the first film that could not be played; the films after it are played all the same. With a list of
  // films to return to, or a player that stays, no film counts. See also `faults_in_list`.
  [[nodiscard]] Outcome<void> run(const std::atomic<bool>& stop);
  // Carries out a viewer's command; within `run`, on its thread. A command that the present state does not allow
  // changes nothing.
  void obey(const PlayerCommand& command, MonotonicTime now);
  // Why this command has no effect now; nullopt: it has one.
  [[nodiscard]] std::optional<std::string> refusal(const PlayerCommand& command) const;
  // The report so far. On its thread.
  [[nodiscard]] PlayReport report() const;
  // After `run`: whether the films' positions could be written.
  [[nodiscard]] bool placesAreKept() const noexcept { return programme_.placesAreKept(); }

  // The present state, and the URL of the film; empty if there is none. On its thread.
  [[nodiscard]] ScreenFacts facts() const;
  // The list of films, while it is shown; else null.
  [[nodiscard]] const FilmShelf* list() const { return state_ == PlayerState::Browsing ? &browser_->shelf() : nullptr; }
  [[nodiscard]] std::string source() const { return film_.isOpen() ? programme_.film().url : ""; }

 private:
  // player.cpp: the loop, the state, and what ends it
  bool apply(PlayerEvent event);
  void failFilm(const std::string& thing, const Error& error);
  void failFilm() { failFilm(film_.failure().thing, film_.failure().error); }
  void failDisplay(const Error& error);
  void failDrawing(const Error& error);
  void boot(const std::atomic<bool>& stop);
  void step(MonotonicTime now);
  [[nodiscard]] bool alive() const noexcept;
  [[nodiscard]] MonotonicTime nextWake(MonotonicTime now) const;
  void finish(MonotonicTime now);

  // player_keys.cpp: keys, the mouse, commands
  void obeyPicture(const PlayerCommand& command, MonotonicTime now);
  [[nodiscard]] Situation situation(MonotonicTime now) const;
  void readRemote(MonotonicTime now);
  [[nodiscard]] bool hearMouse(const SurfaceMouse& mouse);
  void followMouse(MonotonicTime now);
  void obeyKey(const PlayerCommand& command, std::uint16_t code, MonotonicTime now);
  void noteUnbound(const KeyEvent& key, MonotonicTime now);
  [[nodiscard]] std::string helpKey() const;
  void nameKeys();
  [[nodiscard]] ScreenRows keyRows() const;

  // player_facts.cpp: what is told
  [[nodiscard]] std::string fileName() const;
  void followStatistics(MonotonicTime now);
  void tellStatus(MonotonicTime now);
  [[nodiscard]] std::vector<PlayerVerb> barButtons() const;

  // player_film.cpp: within a film
  void carryOut(const Deed& deed, MonotonicTime now);
  void goOn(MonotonicTime now);
  void stand(MonotonicTime now);
  void stepOn(MonotonicTime now);
  void seek(MediaTime target, PlayerEvent why, bool by_viewer, MonotonicTime now);
  void followReader(MonotonicTime now);
  void followOpening(MonotonicTime now);
  void followProgress(FilmPlayback::Progress progress, MonotonicTime now);
  void rushNoMore(MonotonicTime now);
  void begin(MonotonicTime now);
  void beginScene(MonotonicTime now);
  void turnPicture(int quarters, MonotonicTime now);
  void announce(const DisplayVolume& volume);
  [[nodiscard]] std::string firstHint() const;
  void tellDoubts(MonotonicTime now);
  void followClock(MonotonicTime now);
  void followDevice();
  void showPicture(MonotonicTime now);
  void redraw(const FingerMarks& fingers, MonotonicTime next_picture, MonotonicTime now);
  void feedTouch();
  [[nodiscard]] FingerMarks marks();

  // player_sound.cpp: sound and words
  [[nodiscard]] bool obeySound(const PlayerCommand& command, MonotonicTime now);
  void chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words, MonotonicTime now);
  void nextWords(double number, MonotonicTime now);
  void addWords(const std::string& path, MonotonicTime now);
  void showWords(bool shown, MonotonicTime now);
  void beginWords();
  void followLoopAB(MonotonicTime now);
  void setVolume(double percent);
  void mute(bool muted);

  // player_browse.cpp: the list of films to choose from
  [[nodiscard]] bool obeyBrowsing(const PlayerCommand& command, MonotonicTime now);
  [[nodiscard]] std::optional<std::string> browsingRefusal(const PlayerCommand& command) const;
  [[nodiscard]] bool returnsToBrowser() const noexcept { return browser_ && (browsed_ || config_.stays); }
  void openBrowser(MonotonicTime now);
  void closeBrowser();
  void followBrowser(MonotonicTime now);
  void chooseFilm(MonotonicTime now);
  void openSelected(MonotonicTime now);
  [[nodiscard]] std::optional<std::size_t> placeOnShelf() const;
  void goBack(MonotonicTime now);
  [[nodiscard]] bool hearMouseInList(const SurfaceMouse& mouse, bool clicks);

  // player_list.cpp: from film to film
  // `words`: subtitle files for the first of them.
  void openList(const std::vector<PlaylistEntry>& films, MonotonicTime now, std::vector<std::string> words = {});
  void followDrops(MonotonicTime now);
  void openFilm(std::size_t film, Programme::Way way, MonotonicTime now);
  void leaveFilm(MonotonicTime now);
  void stopFilm(MonotonicTime now);
  void endFilm(MonotonicTime now);
  [[nodiscard]] bool endsWithFilms() const noexcept { return !config_.stays && !returnsToBrowser(); }
  void followFault(MonotonicTime now);

  PlayerConfig config_;
  PlayerParts parts_;
  Journal journal_;
  FileWriter files_;
  Programme programme_;
  FilmPlayback film_;
  FilmTouch touch_;
  FilmScreen screen_;
  SeekTimes seeks_;
  KeyReader keys_;
  bool has_pad_ = false;             // the remote has a gamepad
  std::set<std::uint16_t> unbound_;  // keys without a meaning that were reported
  Loudness loudness_;
  std::optional<Browser> browser_;
  bool browsed_ = false;  // the list was shown
  MouseWishes mouse_;
  Statistics statistics_;
  bool words_shown_ = true;
  std::vector<std::string> words_to_add_;  // subtitle files, once the film is open
  FilmDoubts doubts_;
  LoopAB loop_ab_;
  int scene_turns_ = 0;  // FilmPlayback::turns, of the scene that is shown and felt

  PlayerState state_ = PlayerState::Boot;
  std::optional<Failure> failure_;  // of a film that could not be played, until another one opens
  std::optional<Failure> missed_;   // likewise, of the first film of the run, or the first that was not whole
  bool display_failed_ = false;     // no other film can be played either
  bool quitting_ = false;
  std::optional<MonotonicTime> ended_;
};

}  // namespace relievo
