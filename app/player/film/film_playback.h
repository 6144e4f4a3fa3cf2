// SPDX-License-Identifier: Apache-2.0
// A film being played: its reader, the pictures around the present one, its clock and its sound.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/media/film_feed.h"
#include "app/media/playhead.h"
#include "app/player/film/decode_pace.h"
#include "app/player/film/depth_around.h"
#include "app/player/film/film_notes.h"
#include "app/player/film/live_pace.h"
#include "app/player/film/live_times.h"
#include "app/player/film/played_time.h"
#include "app/player/journal.h"
#include "app/player/sound/sound.h"
#include "app/player/views/relief_maker.h"
#include "hal/media/media_clock.h"
#include "platform/clock.h"
#include "platform/failure.h"

namespace relievo {

// One thread; no call blocks on the film. One object plays one film after another. It does not know the screen, the
// device or the player's state: `opening`, `arriving`, `filling` and `going` tell the player what it may do next.
//
// Order of calls: `open`; `opening` until Opened, then `opened`; `filling` until Ready, then `takeFirst`, show the
// picture, `start`; then `advance` and `going` in every round. After `seek`: `arriving` until true, then `filling`
// again.
class FilmPlayback {
 public:
  // `output` may be null. If `backends` has no threads of its own, call `read` to do the reader's work.
  FilmPlayback(PairReader::Backends backends, AudioOutput* output, const Clock& clock, Journal& journal);

  // Sets a callback for the depth of a live film, called on the reader's thread as soon as it was read. Before `begin`.
  void hearLive(std::function<void(const FramePair&)> hear) { feed_.hearLive(std::move(hear)); }
  void begin();
  // Without a reader thread: does all reading that is due.
  void read();
  void silence() noexcept { sound_.close(); }
  void stop() noexcept;

  // Opens a film; its sound is decoded to the output's format.
  void open(SourceOptions source);
  // Closes the film and forgets everything about it.
  void close(MonotonicTime now);
  [[nodiscard]] bool isOpen() const { return feed_.state() != FilmFeed::State::Closed; }

  enum class Opening : std::uint8_t { Waits, Opened, IsList, Failed };
  [[nodiscard]] Opening opening() const;
  // Once a round, in Waits.
  void noteWait(MonotonicTime now) { notes_.waits(now); }
  // The entries of the list; in IsList.
  [[nodiscard]] std::vector<PlaylistEntry> listed() const { return feed_.films(); }
  // Reads the film's description and logs it; call once, in Opened.
  const FilmInfo& opened();
  // The source that failed and the error; in Failed.
  [[nodiscard]] Failure failure() const { return feed_.failure(); }

  enum class Progress : std::uint8_t {
    Goes,     // playing or waiting: nothing to do
    Ready,    // enough is buffered to start
    Starved,  // the next picture has not arrived in time: the picture stops
    Over,     // the last picture was shown for its whole time, a photo for some seconds
    Failed,
  };
  [[nodiscard]] Progress filling();
  // Makes the first picture after a start, a seek or an underrun the present one. True if it is the film's first.
  bool takeFirst();
  // Starts the clock at the present picture, which is on the screen, or where a seek within its time went; paused if
  // the film is held.
  [[nodiscard]] Result<void> start(MonotonicTime now);
  // Makes the picture of this time the present one; returns how many pictures it moved on, with those stepped on to.
  [[nodiscard]] std::size_t advance(MonotonicTime now);
  [[nodiscard]] Progress going(MonotonicTime now);

  // Continues from `target`; by key frames at a rate over 1.
  void seek(MediaTime target, MonotonicTime now);
  // The first picture after a seek has not been shown yet.
  [[nodiscard]] bool isSeeking() const noexcept { return target_.has_value(); }
  // True when the seek has been carried out or refused. After a refusal the film continues from where it is, at rate 1.
  [[nodiscard]] bool arriving(MonotonicTime now);
  // After Over: not one picture came since the film was opened, or since the seek to its beginning.
  [[nodiscard]] bool gaveNone(MonotonicTime now) const;
  // True once the open film has refused a seek.
  [[nodiscard]] bool refusesSeeks() const noexcept { return notes_.refusesSeeks(); }

  // Whether the next `start` leaves the film paused.
  void wishHeld(bool held) noexcept { held_ = held; }
  [[nodiscard]] bool held() const noexcept { return held_; }
  // Pause and resume at once; after `start`.
  [[nodiscard]] Result<void> pause(MonotonicTime now);
  [[nodiscard]] Result<void> resume(MonotonicTime now);
  // While paused: makes the next picture the present one, if it is buffered. `advance` counts it.
  void stepOn(MonotonicTime now);
  void setRate(double rate, MonotonicTime now);
  [[nodiscard]] double rate() const noexcept { return rate_; }
  [[nodiscard]] bool rushes() const noexcept { return rate_ > 1; }
  // Adds the time played since the last start or resume to `played`.
  void countPlayed(MonotonicTime now);
  // The film has ended: its end is not kept as the place where the viewer left it.
  void forgetPlace() noexcept { clock_.reset(); }

  // Turns the pictures clockwise by so many quarters more, until the film is closed; those that were read, too. Call
  // only for a film of one view.
  void turn(int quarters);
  // 0 to 3.
  [[nodiscard]] int turns() const noexcept { return turn_; }

  // The next subtitle that has been read.
  [[nodiscard]] std::optional<Subtitle> takeSubtitle() { return feed_.takeSubtitle(); }
  // Chooses other tracks, by their places in `info`; seek to the present position afterwards.
  void chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words);
  // Adds a subtitle file behind those of `info`.
  void addSubtitles(const FilmTrack& file) { info_.subtitles.push_back(file), feed_.addSubtitles(file); }
  [[nodiscard]] Sound& soundOutput() noexcept { return sound_; }
  [[nodiscard]] Duration soundDelay() const noexcept { return sound_.delay(); }
  // Once a round: feeds the sound output, and notes losses and recoveries in the journal.
  void followSound(bool playing);
  void noteNews();
  // Notes what the film lacked, and returns what it lacks for sure; after its end.
  std::vector<LostPart> noteMissing();
  // The present picture is now on the screen.
  void noteShown();

  [[nodiscard]] const FramePair& picture() const noexcept { return head_.present(); }
  // How long the present picture has been due; nullopt where its time does not tell: of a live film, without a clock.
  [[nodiscard]] std::optional<Duration> late(MonotonicTime now) const;
  // True if the present picture has not been shown; false if only its depth is new (FramePair::stands).
  [[nodiscard]] bool hasNewPicture() const noexcept { return head_.colors() != shown_color_; }
  // The film's first picture was shown or is about to be.
  [[nodiscard]] bool begun() const noexcept { return begun_; }
  // True once after the film was opened or sought: the present picture does not continue the one before it.
  [[nodiscard]] bool takeJump() noexcept { return std::exchange(jumped_, false); }
  // The depth for touch; empty at a rate over 1.
  [[nodiscard]] DepthAround depth() const;
  // The depth of the coming pictures, for subtitles in front of it.
  [[nodiscard]] DepthComing coming() const;
  [[nodiscard]] std::optional<ClockSample> clock() const noexcept { return clock_.sample(); }
  // When the next picture is due; MonotonicTime::max() while the film is paused, waits for it or has no more.
  [[nodiscard]] MonotonicTime nextPicture(MonotonicTime now) const;
  // The playing position; nullopt before the first picture.
  [[nodiscard]] std::optional<MediaTime> place(MonotonicTime now) const;
  // The target of a pending seek, else `place`, so that several presses of a seek key add up.
  [[nodiscard]] MediaTime goal(MonotonicTime now) const;
  // The time of the last decoded picture.
  [[nodiscard]] MediaTime bufferedUntil() const;
  // `place` if it should be kept for later: the film has a known length and no seek is pending.
  [[nodiscard]] std::optional<MediaTime> placeToKeep(MonotonicTime now) const;

  // The open film's description; empty until `opened`.
  [[nodiscard]] const FilmInfo& info() const noexcept { return info_; }
  [[nodiscard]] Duration period() const noexcept;
  // A film of one picture, without sound.
  [[nodiscard]] bool isStill() const noexcept;
  // Totals over all films, for the report.
  [[nodiscard]] PairCounters pairs() const;
  [[nodiscard]] Duration played() const noexcept { return played_.total(); }
  [[nodiscard]] std::optional<LiveLatency> live() const { return live_.summary(); }
  // A camera's picture, or another live film without sound: pictures are shown as they arrive, and the clock follows
  // touch, as far behind as its look-ahead needs (LivePace). With sound, or if frames are sent ahead of time, the film
  // is played like any other.
  [[nodiscard]] bool isLive() const noexcept { return pace_.asItComes() && rate_ == 1; }
  // How long the surface waits for frames; chosen when the first picture is taken.
  [[nodiscard]] LookAhead lookAhead() const noexcept { return isLive() ? pace_.lookAhead() : LookAhead{}; }
  // For the ticks of a live film; null if it is paused, or not live.
  [[nodiscard]] LiveTimes* liveTimes() noexcept { return isLive() && !held_ ? &live_ : nullptr; }
  [[nodiscard]] SoundSummary sound() const { return sound_.summary(); }
  [[nodiscard]] ReliefSummary reliefs() const { return reliefs_.summary(); }

 private:
  [[nodiscard]] Progress overOrFailed() const;
  // In film_reliefs.cpp: depth that is made from the film's two views.
  [[nodiscard]] bool makesReliefs() const noexcept { return info_.depth_from_views && !rushes(); }
  void beginReliefs();
  void followReliefs();
  [[nodiscard]] bool hasReliefs() const;
  void gatherReliefs(DepthAround& around) const;
  // In film_late.cpp, with `going`.
  void followDecoder(MonotonicTime now);
  [[nodiscard]] bool waitsForDecoder() const noexcept;
  // In film_live.cpp.
  [[nodiscard]] Progress fillingLive();
  void hearOfAhead() noexcept;
  [[nodiscard]] std::size_t advanceLive(MonotonicTime now);
  void followLive(bool picture, MonotonicTime now);
  void noteLiveShown();

  const Clock& clock_source_;
  const bool own_threads_;
  FilmFeed feed_;
  Playhead head_;
  ReliefMaker reliefs_;
  MediaClock clock_;
  Sound sound_;
  Journal& journal_;
  FilmNotes notes_;

  FilmInfo info_;
  bool begun_ = false;
  bool sought_ = false;  // since it was opened
  bool held_ = false;
  double rate_ = 1;  // over 1: by key frames, without touch
  int turn_ = 0;     // quarters, clockwise
  bool jumped_ = true;
  std::optional<MediaTime> target_;         // of a seek whose first picture has not been shown yet
  std::optional<MonotonicTime> dry_since_;  // since when no picture is buffered
  std::size_t stepped_ = 0;                 // pictures that were stepped to since `advance`
  bool starved_ = false;                    // the picture has stopped while the clock runs on
  std::uint64_t shown_color_ = 0;           // Playhead::colors, of the picture on the screen
  DecodePace decode_pace_;

  PairCounters pairs_before_;  // of earlier films
  PlayedTime played_;
  LiveTimes live_;
  LivePace pace_;
};

}  // namespace relievo
