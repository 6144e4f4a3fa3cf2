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

// For the report. Offsets are those of the sound against each picture as it appears on the screen, positive if the
// sound is ahead; the first fifth of a second after each start, in which they are measured first, is left out.
struct SoundSummary {
  std::string device;  // "" without one, or without sound
  int rate_hz = 0;
  std::uint64_t underruns = 0;  // silences that are not in the film
  std::uint64_t realigned = 0;  // how often it was restarted because it was too far off
  std::uint64_t pictures = 0;   // pictures shown with sound
  double max_offset_ms = 0, mean_offset_ms = 0;
  double drift_ppm = 0;  // at the end of the film: how much faster than the system's clock it ran
};

// The clock is felt as well as seen, so it never jumps: it is steered by at most MediaClock::kMostSteering. If the
// sound is too far off for that, the sound jumps: it is restarted at the film's present position, earlier by the delay
// that it had.
//
// A picture appears on the screen some time after the clock has reached it: it has to be drawn, and waits for the
// refresh. The sound is delayed by the pictures' mean delay.
//
// Use on the owner's thread; the output, if there is one, is borrowed. No call waits, except for opening the output. An
// output that is refused or lost is tried again every few seconds; meanwhile the film follows the system's clock. One
// that answers for the first time while a film plays gets that film's sound in its own format.
class Sound {
 public:
  static constexpr Duration kNear = std::chrono::milliseconds(8);  // good enough after a start; steering does the rest
  static constexpr Duration kFar = std::chrono::milliseconds(50);  // too far to be steered

  Sound(AudioOutput* output, const Clock& clock) noexcept : output_(output), clock_(clock) {}
  ~Sound() { close(); }
  Sound(const Sound&) = delete;
  Sound& operator=(const Sound&) = delete;

  // Call before the film. `format` is then the format in which the film's sound is needed, whether the output is
  // available or not.
  void open();
  [[nodiscard]] std::optional<AudioFormat> format() const noexcept { return format_; }
  // A film begins: takes the format of a card that another one was exchanged for. Before `format`.
  void beginFilm();
  // For a film without sound: closes the output, which is opened again for a film that has some.
  void rest() noexcept;
  // Multiplies the following samples by `gain`, without a click at the change. `at_once`: also drops the samples that
  // the output still holds, which have the old gain.
  void setGain(double gain, bool at_once = false) noexcept;
  // Delays the sound by so much against the film's times.
  void setDelay(Duration delay) noexcept;
  [[nodiscard]] Duration delay() const noexcept { return delay_; }
  // The end of the sound that has been decoded and is being played; media time 0 in silence.
  [[nodiscard]] MediaTime end() const noexcept;
  // Call when the film continues elsewhere.
  void forget() noexcept;
  // Call once a step, last. `plays`: the film plays at its own pace; else there is silence.
  void follow(bool plays, MediaClock& clock, FilmFeed& feed);
  // A picture has appeared on the screen.
  void noteShown(MediaTime picture, const MediaClock& clock);
  void close() noexcept;

  // Faults and the reaction to each, for the report.
  struct News {
    std::string what, done;
  };
  [[nodiscard]] std::optional<News> takeNews() noexcept { return std::exchange(news_, std::nullopt); }
  [[nodiscard]] SoundSummary summary() const;

 private:
  void take(const AudioFormat& format);
  [[nodiscard]] bool ready(FilmFeed& feed, MonotonicTime now);
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
  std::vector<float> block_;  // on its way to the output
  SoundGain gain_;
  Duration delay_{0};

  // The state from a start of the output to its stop.
  struct Run {
    std::int64_t base = 0;    // the film's frame that the output began with
    std::int64_t cursor = 0;  // the film's frame to be written next
    bool heard = false;       // the output has reported a position
    AudioPosition last;       // the position read last
    int readings = 0;         // of the position
    double offset_s = 0;      // of the sound to the film, smoothed
    bool settled = false;     // the offset is known, and small
    double steering = 1;      // factor on the clock's rate
    MonotonicTime next_reading;
  };
  std::optional<Run> run_;
  Duration latency_{0};        // from writing the first frame until it is heard, unless positions include it
  double picture_late_s_ = 0;  // smoothed
  int pictures_late_ = 0;      // number of pictures in that mean
  int restarts_ = 0;           // without having settled in between
  MonotonicTime next_try_;
  std::optional<MonotonicTime> late_since_;  // a sound server has not answered since
  bool known_ = false;                       // the output has told its format
  std::optional<AudioFormat> other_;         // that the output has had since it was opened again
  bool gave_up_ = false, lost_ = false, told_ = false;
  bool sounds_ = false;  // there has been sound to play

  std::optional<News> news_;
  SoundSummary summary_;
  double sum_offset_ms_ = 0;
};

}  // namespace relievo
