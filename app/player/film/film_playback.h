// SPDX-License-Identifier: Apache-2.0
// A film being played: its reader, the pictures around the present one, its clock and its sound.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/media/film_feed.h"
#include "app/media/playhead.h"
#include "app/player/film/depth_around.h"
#include "app/player/film/live_times.h"
#include "app/player/film/played_time.h"
#include "app/player/film/sound.h"
#include "app/player/journal.h"
#include "hal/media_clock.h"
#include "platform/clock.h"
#include "platform/failure.h"

namespace relievo {

// One thread; nothing waits for the film. One object plays one film after the other. It knows no screen, no device and
// no state of the player: `opening`, `arriving`, `filling` and `going` say what the player may do next.
//
// It goes: open; `opening` until Opened, then `opened`; `filling` until Ready, then `takeFirst`, show, `start`; then
// `advance` and `going` until something else is due. After a seek `arriving` until true, then `filling` again.
class FilmPlayback {
 public:
  // `output` may be null. Without threads of its own, `read` does the reader's work.
  FilmPlayback(PairReader::Backends backends, AudioOutput* output, const Clock& clock, Journal& journal);

  void begin();
  // Without a thread: reads all that is wanted now.
  void read();
  void silence() noexcept { sound_.close(); }
  void stop() noexcept { feed_.stop(); }

  // The source's sound is asked for in what the output takes.
  void open(SourceOptions source);
  // All that belongs to the film is forgotten.
  void close(MonotonicTime now);
  [[nodiscard]] bool isOpen() const { return feed_.state() != FilmFeed::State::Closed; }

  enum class Opening : std::uint8_t { Waits, Opened, IsList, Failed };
  [[nodiscard]] Opening opening() const;
  // IsList: its films.
  [[nodiscard]] std::vector<PlaylistEntry> listed() const { return feed_.films(); }
  // Opened: what the film is, for log and journal as well.
  const FilmInfo& opened();
  // Failed: what, and why.
  [[nodiscard]] Failure failure() const { return {feed_.failedThing(), feed_.error()}; }

  enum class Progress : std::uint8_t {
    Goes,     // or waits: there is nothing to do
    Ready,    // enough is read to start
    Starved,  // nothing has come in time: the picture stands
    Over,     // the last picture has had its time
    Failed,
  };
  [[nodiscard]] Progress filling();
  // The first picture after a start, a seek or an underrun becomes the present one. True: it is the film's first.
  bool takeFirst();
  // That picture is on the screen, and its clock begins; held, it stands there.
  [[nodiscard]] Result<void> start(MonotonicTime now);
  // Goes on to the picture of this time; returns by how many pictures.
  [[nodiscard]] std::size_t advance(MonotonicTime now);
  [[nodiscard]] Progress going(MonotonicTime now);

  // From `target` on, by key frames where it rushes.
  void seek(MediaTime target, MonotonicTime now);
  // The seek is carried out, or refused: then it goes on from where it stands, at the usual rate.
  [[nodiscard]] bool arriving(MonotonicTime now);

  // The viewer wants it paused from the next `start` on, or not.
  void wishHeld(bool held) noexcept { held_ = held; }
  [[nodiscard]] bool held() const noexcept { return held_; }
  // Started: it stands at once, goes on at once.
  [[nodiscard]] Result<void> pause(MonotonicTime now);
  [[nodiscard]] Result<void> resume(MonotonicTime now);
  // Paused: the next picture. False where there is none, or none is read yet.
  [[nodiscard]] bool stepOn(MonotonicTime now);
  void setRate(double rate, MonotonicTime now);
  [[nodiscard]] double rate() const noexcept { return rate_; }
  [[nodiscard]] bool rushes() const noexcept { return rate_ > 1; }
  // It goes no further: what was played is counted up to here.
  void countPlayed(MonotonicTime now);
  // It is over, and another one follows or none: where it ended is not where the viewer left it.
  void forgetPlace() noexcept { clock_.reset(); }

  // Once a round: the sound follows; what was lost or found is noted.
  void followSound(bool playing);
  void noteNews();
  // The film has ended: what of it was not there.
  void noteMissing();
  // The present picture has come onto the screen.
  void noteShown();

  [[nodiscard]] const FramePair& picture() const noexcept { return head_.present(); }
  // It was shown, or is about to be.
  [[nodiscard]] bool begun() const noexcept { return begun_; }
  // Whether the present picture does not continue the one before it. Told once.
  [[nodiscard]] bool takeJump() noexcept { return std::exchange(jumped_, false); }
  // For the hand: nothing of a film that rushes by.
  [[nodiscard]] DepthAround depth() const;
  [[nodiscard]] std::optional<ClockSample> clock() const noexcept { return clock_.sample(); }
  // When the next picture is due: never, while the film stands.
  [[nodiscard]] MonotonicTime nextPicture(MonotonicTime now) const;
  // Where the picture is; nothing before the first one.
  [[nodiscard]] std::optional<MediaTime> place(MonotonicTime now) const;
  // Where it is, or is sought to: several presses of a key add up.
  [[nodiscard]] MediaTime goal(MonotonicTime now) const;
  // `place` where it is worth keeping: in a film of known length, and not on the way elsewhere.
  [[nodiscard]] std::optional<MediaTime> placeToKeep(MonotonicTime now) const;

  // Of the film that is open: empty until `opened`.
  [[nodiscard]] const FilmInfo& info() const noexcept { return info_; }
  [[nodiscard]] Duration period() const noexcept;
  // Of all films so far, for the report.
  [[nodiscard]] PairCounters pairs() const;
  [[nodiscard]] Duration played() const noexcept { return played_.total(); }
  [[nodiscard]] std::optional<LiveLatency> live() const { return live_.summary(); }
  [[nodiscard]] SoundSummary sound() const { return sound_.summary(); }

 private:
  [[nodiscard]] Progress overOrFailed() const;

  const Clock& clock_source_;
  Journal& journal_;
  const bool own_threads_;
  FilmFeed feed_;
  Playhead head_;
  MediaClock clock_;
  Sound sound_;

  std::string url_, depth_url_;
  FilmInfo info_;
  bool begun_ = false;
  bool held_ = false;
  double rate_ = 1;  // over 1: by key frames, without touch
  bool jumped_ = true;
  std::optional<MediaTime> target_;         // of a seek that has shown no picture yet
  std::optional<MonotonicTime> dry_since_;  // nothing has lain ahead since then
  bool starved_ = false;                    // the picture stands, though the clock goes on

  PairCounters pairs_before_;  // of the films before
  PlayedTime played_;
  LiveTimes live_;
};

}  // namespace relievo
