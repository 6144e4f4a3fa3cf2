// SPDX-License-Identifier: Apache-2.0
// Plays films: follows the remote, the reader and the clock through the states, and hands each pair to both senses.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "app/depth_window/surface_feeder.h"
#include "app/media/film_feed.h"
#include "app/media/playhead.h"
#include "app/player/control/command.h"
#include "app/player/control/key_table.h"
#include "app/player/film/resume.h"
#include "app/player/film/sound.h"
#include "app/player/report.h"
#include "app/player/screen/picture.h"
#include "app/player/screen/screen_text.h"
#include "app/player/state_table.h"
#include "app/player/touch/haptic_session.h"
#include "app/player/touch/recorder.h"
#include "hal/remote_input.h"
#include "platform/failure.h"
#include "platform/histogram.h"

namespace relievo {

class PlayerControl;

struct PlayerConfig {
  SourceOptions source;  // a film or a list of films; its url may be empty for one that stays
  DisplayConfig display;
  StereoSettings stereo;
  std::optional<DisplayVolume> volume;  // nothing: the default one of the picture's shape
  KeyTable keys = KeyTable::usual();
  bool loop = false;
  bool stays = false;       // without a film it waits for the next one, until it is asked to quit
  std::string resume_path;  // where each film was left is kept there; empty: every film begins at its beginning
  std::optional<Duration> duration;  // of the machine's time
  bool own_threads = true;           // false: reader and ticks run inside `step`, for simulated time
};

// Borrowed; they must outlive the player. Null: there is none.
struct PlayerParts {
  Clock& clock;
  Display& display;
  HapticDevice* haptic = nullptr;
  RemoteInput* remote = nullptr;
  AudioOutput* audio = nullptr;
  Recorder* recorder = nullptr;
  PlayerControl* control = nullptr;
  PairReader::Backends backends;
};

// One thread, the display's. Never waits for the film or the finger, only for the display's refresh.
class Player {
 public:
  Player(PlayerConfig config, PlayerParts parts);
  ~Player();

  // Plays until the end, a stop or a failure. `stop` may be set by a signal handler. Once. Fails for a lost display and
  // when the last film could not be played, not for one before it in a list: that is in the report.
  [[nodiscard]] Outcome<void> run(const std::atomic<bool>& stop);
  // A viewer's wish. Within `run`, on its thread. One that the present state does not allow changes nothing.
  void obey(const PlayerCommand& command, MonotonicTime now);
  // What has happened so far. On its thread.
  [[nodiscard]] PlayReport report() const;

  // What is going on, and of which film; empty: none. On its thread.
  [[nodiscard]] ScreenFacts facts() const;
  [[nodiscard]] std::string source() const { return film_open_ ? film().url : ""; }

 private:
  // player.cpp: its life
  bool apply(PlayerEvent event);
  void note(const std::string& what, const std::string& done, std::optional<MonotonicTime> when = {});
  void fail(std::string thing, const Error& error);
  void failDisplay(const Error& error);
  void boot();
  void step(MonotonicTime now);
  [[nodiscard]] bool alive() const noexcept;
  [[nodiscard]] MonotonicTime nextWake(MonotonicTime now) const;
  void finish(MonotonicTime now);
  void attendScreen(MonotonicTime now);

  // player_remote.cpp: the viewer's wishes
  void readRemote(MonotonicTime now);
  void play(MonotonicTime now);
  void pause(MonotonicTime now);
  void stepPicture(MonotonicTime now);
  void changeRate(double rate, MonotonicTime now);
  void changeStereo(const PlayerCommand& command);
  void setClockHeld(bool held, MonotonicTime now);
  void seekShare(double share, MonotonicTime now);
  void seek(MediaTime target, PlayerEvent why, bool wanted, MonotonicTime now);
  [[nodiscard]] std::optional<MediaTime> place(MonotonicTime now) const;
  [[nodiscard]] MediaTime seekBase(MonotonicTime now) const;

  // player_list.cpp: from film to film
  void openList(const std::string& url, const std::string& depth_url, MonotonicTime now);
  void openFilm(std::size_t film, MonotonicTime now);
  void previousFilm(MonotonicTime now);
  void leaveFilm(MonotonicTime now);
  void stopFilm(MonotonicTime now);
  void endOfFilm(MonotonicTime now);
  void noteMissing();
  void followFault(MonotonicTime now);
  void followList(MonotonicTime now);
  void goOnWhereLeft(MonotonicTime now);
  void keepPosition(MonotonicTime now);
  [[nodiscard]] const PlaylistEntry& film() const noexcept { return films_[film_]; }

  // player_film.cpp: within a film
  void followDevice();
  void followSource();
  void followReader(MonotonicTime now);
  void opened(MonotonicTime now);
  void begin(MonotonicTime now);
  void setScene();
  void startTouch();
  void followClock(MonotonicTime now);
  void followSound();
  void followEnd(MediaTime position, MonotonicTime now);
  void closeSegment(MonotonicTime now);

  void followSurface();
  void feedSurface(const ClockSample& clock);
  void showPresent(MonotonicTime now);
  void noteLatency();
  void redrawFinger(MonotonicTime now);
  [[nodiscard]] bool draw(MonotonicTime now);
  void noteLost();
  void drainTouch();
  [[nodiscard]] std::optional<FingerMark> fingerMark();
  void writeText(MonotonicTime now);
  [[nodiscard]] MonotonicTime nextPicture(MonotonicTime now) const;

  PlayerConfig config_;
  PlayerParts parts_;
  FilmFeed feed_;
  Picture picture_;
  ScreenText text_;
  HapticSession haptic_;
  Sound sound_;
  Playhead head_;
  MediaClock clock_;
  SurfaceFeeder surface_;
  bool scene_known_ = false;  // from the first pair on

  KeyReader keys_;
  std::optional<Resume> resume_;

  PlayerState state_ = PlayerState::Boot;
  bool held_ = false;  // the viewer wants it paused
  double rate_ = 1;    // over 1: by key frames, without touch
  bool quitting_ = false;
  bool hopeless_ = false;  // no other film would go better
  std::optional<Failure> failure_;
  std::vector<PlaylistEntry> films_ = std::vector<PlaylistEntry>(1);
  std::size_t film_ = 0;     // of them
  bool film_open_ = false;   // or being opened
  int lists_ = 0;            // that were found to be one, since the first was asked for
  bool backwards_ = false;   // the viewer goes back through the list, until a film opens
  bool played_one_ = false;  // of the list, before this film
  MonotonicTime keep_due_;   // the position
  MonotonicTime started_;
  std::optional<MonotonicTime> ended_;
  Duration period_{0};  // of the film
  DisplayVolume volume_;

  std::optional<MediaTime> target_;           // of a seek that has shown no picture yet
  bool seek_wanted_ = false;                  // by the viewer: it goes into the report
  bool new_epoch_ = true;                     // the next picture does not continue the last one
  MonotonicTime sought_;                      // when it was asked for
  std::optional<MonotonicTime> await_touch_;  // the first tick after this is on the sought surface

  std::optional<MonotonicTime> dry_since_;  // nothing has lain ahead since then
  std::optional<MediaTime> segment_begin_;
  Duration played_{0};
  MonotonicTime last_draw_;
  std::optional<FingerMark> last_mark_;
  bool redraw_ = false;
  std::vector<std::string> last_text_;
  bool haptic_lost_ = false;  // it was there once and went away
  bool depth_missing_ = false;
  bool depth_refused_ = false;
  PlayReport report_;
  Histogram picture_latency_, touch_latency_;  // of a live film
};

}  // namespace relievo
