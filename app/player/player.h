// SPDX-License-Identifier: Apache-2.0
// Plays one film: follows the remote, the reader and the clock through the states, and hands each pair to both senses.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "app/player/film_feed.h"
#include "app/player/haptic_session.h"
#include "app/player/key_table.h"
#include "app/player/picture.h"
#include "app/player/playhead.h"
#include "app/player/recorder.h"
#include "app/player/report.h"
#include "app/player/screen_text.h"
#include "app/player/state_table.h"
#include "app/player/surface_feeder.h"
#include "hal/remote_input.h"
#include "platform/failure.h"

namespace relievo {

struct PlayerConfig {
  SourceOptions source;
  DisplayConfig display;
  StereoSettings stereo;
  std::optional<DisplayVolume> volume;  // nothing: the default one of the picture's shape
  bool loop = false;
  std::optional<Duration> duration;  // of the machine's time
  bool own_threads = true;           // false: reader and ticks run inside `step`, for simulated time
};

// Borrowed; they must outlive the player. Null: there is none.
struct PlayerParts {
  Clock& clock;
  Display& display;
  HapticDevice* haptic = nullptr;
  RemoteInput* remote = nullptr;
  Recorder* recorder = nullptr;
  PairReader::Backends backends;
};

// One thread, the display's. Never waits for the film or the finger, only for the display's refresh.
class Player {
 public:
  static constexpr Duration kSeekStep = std::chrono::seconds(10);

  Player(PlayerConfig config, PlayerParts parts);
  ~Player();

  // Plays until the end, a stop or a failure. `stop` may be set by a signal handler. Once.
  [[nodiscard]] Outcome<void> run(const std::atomic<bool>& stop);
  // After `run`.
  [[nodiscard]] PlayReport report() const;

 private:
  bool apply(PlayerEvent event);
  void note(const std::string& what, const std::string& done, std::optional<MonotonicTime> when = {});
  void fail(std::string thing, const Error& error);

  void step(MonotonicTime now);
  [[nodiscard]] bool alive() const noexcept;
  void end(MonotonicTime now);
  [[nodiscard]] MonotonicTime nextWake(MonotonicTime now) const;
  void finish();

  void boot();
  void attendScreen(MonotonicTime now);
  void readRemote(MonotonicTime now);
  void obey(PlayerCommand command, MonotonicTime now);
  void changeStereo(PlayerCommand command);
  void setHeld(bool held, MonotonicTime now);
  void setClockHeld(bool held, MonotonicTime now);
  void seek(MediaTime target, PlayerEvent why, MonotonicTime now);

  void followDevice();
  void followReader(MonotonicTime now);
  void opened();
  void begin(MonotonicTime now);
  void setScene();
  void startTouch();
  void followClock(MonotonicTime now);
  void followEnd(MediaTime position, MonotonicTime now);
  void endOfFilm(MonotonicTime now);
  void noteMissing();
  void closeSegment(MonotonicTime now);

  void followSurface();
  void feedSurface(const ClockSample& clock);
  void showPresent(MonotonicTime now);
  void redrawFinger(MonotonicTime now);
  [[nodiscard]] bool draw(MonotonicTime now);
  void noteLost();
  void drainTouch();
  [[nodiscard]] std::optional<FingerMark> fingerMark();
  void writeText(MonotonicTime now);
  [[nodiscard]] MediaTime seekBase(MonotonicTime now) const;
  [[nodiscard]] MonotonicTime nextPicture(MonotonicTime now) const;

  PlayerConfig config_;
  PlayerParts parts_;
  FilmFeed feed_;
  Picture picture_;
  ScreenText text_;
  HapticSession haptic_;
  Playhead head_;
  MediaClock clock_;
  SurfaceFeeder surface_;
  bool scene_known_ = false;  // from the first pair on

  PlayerState state_ = PlayerState::Boot;
  bool held_ = false;  // the viewer wants it paused
  std::optional<Failure> failure_;
  MonotonicTime started_;
  Duration period_{0};  // of the film
  DisplayVolume volume_;

  std::optional<MediaTime> target_;           // of a seek that has shown no picture yet
  bool seek_wanted_ = false;                  // by the viewer: it goes into the report
  bool new_epoch_ = true;                     // the next picture does not continue the last one
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
};

}  // namespace relievo
