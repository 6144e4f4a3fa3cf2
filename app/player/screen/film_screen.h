// SPDX-License-Identifier: Apache-2.0
// The film on the screen: draws pictures, redraws them for the finger or the text, and counts those shown and dropped.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/player/control/command.h"
#include "app/player/journal.h"
#include "app/player/screen/picture.h"
#include "app/player/screen/screen_text.h"
#include "app/render/relief/stereo.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/display.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// The player's thread only, the display's. Blocks only for the display's refresh. A function that draws fails only with
// errors that no retry helps: Unsupported is the film's fault, any other error the display's.
class FilmScreen {
 public:
  FilmScreen(Display& display, const DisplayConfig& config, const StereoSettings& stereo, const Clock& clock,
             Journal& journal) noexcept
      : picture_(display, config, stereo), clock_(clock), journal_(journal) {}

  // A missing screen (NotFound) is noted and is no failure.
  [[nodiscard]] Result<void> open();
  void close() noexcept { picture_.close(); }
  // Once a round. Cancelled if the viewer has closed the window.
  [[nodiscard]] Result<void> attend(MonotonicTime now);

  // A film begins: how to read its depth, the volume that it fills, and its frame period.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume, Duration period, MonotonicTime now);
  void announce(const AnnouncedFilm& film) { picture_.announce(film); }
  // What the viewer has dropped on the window since the last call.
  [[nodiscard]] std::vector<std::string> takeDropped() { return picture_.takeDropped(); }
  // Draws a picture of the film. False if the screen is lost: the picture counts as dropped.
  [[nodiscard]] Result<bool> show(const FramePair& pair, const std::optional<FingerMark>& finger, MonotonicTime now);
  // Counts pictures that were never shown.
  void skip(std::uint64_t pictures) noexcept { dropped_ += pictures; }
  // Between two pictures of the film: draws the present one again if finger or text have changed and there is time
  // until `next_picture`.
  [[nodiscard]] Result<void> redraw(const std::optional<FingerMark>& finger, MonotonicTime next_picture,
                                    MonotonicTime now);
  // Draws a black picture: there is no film.
  [[nodiscard]] Result<void> clear(const std::optional<FingerMark>& finger, MonotonicTime now);
  // Updates the on-screen text; from the first picture on.
  void write(const ScreenFacts& facts, MonotonicTime next_picture, MonotonicTime now);

  // The viewer has pressed a key: the text is shown for a while.
  void wake(MonotonicTime now) noexcept { text_.wake(now); }
  void tell(const std::string& why, MonotonicTime now) { text_.tell(why, now); }
  // Handles FullScreen, Layout, SwapEyes, DepthBy, ScreenBy and Info; ignores other commands.
  void obey(const PlayerCommand& command);

  [[nodiscard]] const StereoSettings& stereo() const noexcept { return picture_.stereo(); }
  [[nodiscard]] DisplayCapabilities capabilities() const noexcept { return picture_.capabilities(); }
  // Whether the finger, as drawn last, is in contact.
  [[nodiscard]] bool contact() const noexcept { return drawn_finger_ && drawn_finger_->contact; }
  // When the first picture was shown.
  [[nodiscard]] std::optional<MonotonicTime> firstShown() const noexcept { return first_shown_; }
  // Fills in the screen's part of the report.
  void describe(PlayReport& report) const;

 private:
  [[nodiscard]] Result<bool> draw(const std::optional<FingerMark>& finger, MonotonicTime now);
  void noteLost();

  Picture picture_;
  ScreenText text_;
  const Clock& clock_;
  Journal& journal_;
  MonotonicTime drawn_at_;
  std::optional<FingerMark> drawn_finger_;
  std::vector<std::string> written_;
  bool redraw_ = false;  // even if the finger has not moved
  std::uint64_t shown_ = 0, dropped_ = 0;
  std::optional<MonotonicTime> first_shown_;
};

}  // namespace relievo
