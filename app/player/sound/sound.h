// SPDX-License-Identifier: Apache-2.0
// The film's sound: keeps the output filled, and makes it the master of the film's clock.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/media/film_feed.h"
#include "app/player/sound/sound_gain.h"
#include "app/player/sound/sound_window.h"
#include "hal/audio_output.h"
#include "hal/media/media_clock.h"
#include "platform/clock.h"

namespace relievo {

// For the report. Offsets are those of the sound against each picture as it comes onto the screen, positive where the
// sound is ahead; the first fifth of a second after each start, when they are being found out, is left out.
struct SoundSummary {
  std::string device;  // "" without one, or without sound
  int rate_hz = 0;
  std::uint64_t underruns = 0;  // silences that were not the film's
  std::uint64_t realigned = 0;  // times that it was started anew, since it was too far off
  std::uint64_t pictures = 0;   // that were shown to sound
  double max_offset_ms = 0, mean_offset_ms = 0;
  double drift_ppm = 0;  // at the end of the film: how much faster than the system's clock it ran
};

// The clock is felt as well as seen, so it never jumps: it is steered by at most MediaClock::kMostSteering. Where the
// sound is further off than that can mend in time, the sound jumps: it is started anew at the film's present position,
// earlier by what it was late.
//
// A picture comes onto the screen some time after the clock has said so: it has to be drawn, and waits for the refresh.
// The sound is late by what the pictures are on average.
//
// Owner's thread only; the output, if there is one, is borrowed. Nothing waits, but for an output that is opened. One
// that is refused or goes away is tried again every few seconds; meanwhile the film follows the system's clock.
class Sound {
 public:
  static constexpr Duration kNear = std::chrono::milliseconds(8);  // good enough after a start; steering does the rest
  static constexpr Duration kFar = std::chrono::milliseconds(50);  // too far to be steered

  Sound(AudioOutput* output, const Clock& clock) noexcept : output_(output), clock_(clock) {}
  ~Sound() { close(); }
  Sound(const Sound&) = delete;
  Sound& operator=(const Sound&) = delete;

  // Before the film: whether the output is there or not, `format` is what the film's sound is wanted in from then on.
  void open();
  [[nodiscard]] std::optional<AudioFormat> format() const noexcept { return format_; }
  // The film has no sound: the output is given back, and opened again for one that has.
  void rest() noexcept;
  // Multiplies the following samples by `gain`, without a click at the change. `at_once`: also drops the samples that
  // the output still holds, which have the old gain.
  void setGain(double gain, bool at_once = false) noexcept;
  // The sound is heard so much later than the film's times say.
  void setDelay(Duration delay) noexcept;
  [[nodiscard]] Duration delay() const noexcept { return delay_; }
  // Where the sound that is heard, and has been decoded, ends; the beginning of time in silence.
  [[nodiscard]] MediaTime end() const noexcept;
  // The film is elsewhere.
  void forget() noexcept;
  // Once a step, the last thing. `plays`: the film goes at its own pace; else there is silence.
  void follow(bool plays, MediaClock& clock, FilmFeed& feed);
  // A picture has come onto the screen.
  void noteShown(MediaTime picture, const MediaClock& clock);
  void close() noexcept;

  // Faults for the report, and what was done about each.
  struct News {
    std::string what, done;
  };
  [[nodiscard]] std::optional<News> takeNews() noexcept { return std::exchange(news_, std::nullopt); }
  [[nodiscard]] SoundSummary summary() const;

 private:
  [[nodiscard]] bool ready(MonotonicTime now);
  void collect(MediaTime position, FilmFeed& feed);
  void start(MediaTime position);
  void fill();
  [[nodiscard]] bool listen(MediaClock& clock, const FilmFeed& feed, MonotonicTime now);
  [[nodiscard]] bool realign();
  void stop() noexcept;
  void lose(const Error& error);

  AudioOutput* output_;
  const Clock& clock_;
  std::optional<AudioFormat> format_;
  std::optional<SoundWindow> window_;
  std::vector<float> block_;  // on its way into the output
  SoundGain gain_;
  Duration delay_{0};

  // From a start of the output to its stop.
  struct Run {
    std::int64_t base = 0;    // the film's frame that the output began with
    std::int64_t cursor = 0;  // the film's frame to be written next
    bool heard = false;       // the output has told a position
    AudioPosition last;       // the position read last
    int readings = 0;         // of the position
    double offset_s = 0;      // of the sound to the film, smoothed
    bool settled = false;     // the offset is known, and small
    double steering = 1;      // the clock's rate
    MonotonicTime next_reading;
  };
  std::optional<Run> run_;
  Duration latency_{0};        // from the first frame's writing to its being heard, as far as positions do not tell
  double picture_late_s_ = 0;  // smoothed
  int pictures_late_ = 0;      // that this is known of
  int restarts_ = 0;           // without having settled
  MonotonicTime next_try_;
  bool gave_up_ = false, lost_ = false, told_ = false;
  bool sounds_ = false;  // there was sound to be heard

  std::optional<News> news_;
  SoundSummary summary_;
  double sum_offset_ms_ = 0;
};

}  // namespace relievo
