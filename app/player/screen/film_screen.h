// SPDX-License-Identifier: Apache-2.0
// The film on the screen: when a picture is drawn, when it is drawn again for the finger or the text, and what of it
// was seen.
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

// The player's thread only, the display's. It waits for nothing but the display's refresh. A verb that draws fails for
// what no retry helps: Unsupported is the film's fault, any other error the display's.
class FilmScreen {
 public:
  FilmScreen(Display& display, const DisplayConfig& config, const StereoSettings& stereo, const Clock& clock,
             Journal& journal) noexcept
      : picture_(display, config, stereo), clock_(clock), journal_(journal) {}

  // NotFound: it goes on without a screen, which is noted and no failure.
  [[nodiscard]] Result<void> open();
  void close() noexcept { picture_.close(); }
  // Once a round: Cancelled when the viewer has closed the window.
  [[nodiscard]] Result<void> attend(MonotonicTime now);

  // The first picture of a film is there, the next one comes after `period`.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume, Duration period, MonotonicTime now);
  // A picture of the film. True: it was seen; false: the screen is away, and the picture counts as dropped.
  [[nodiscard]] Result<bool> show(const FramePair& pair, const std::optional<FingerMark>& finger, MonotonicTime now);
  // `pictures` had their time without being shown.
  void skip(std::uint64_t pictures) noexcept { dropped_ += pictures; }
  // Between two pictures of the film: draws the present one again where it looks different by now and there is time
  // until `next_picture`.
  [[nodiscard]] Result<void> redraw(const std::optional<FingerMark>& finger, MonotonicTime next_picture,
                                    MonotonicTime now);
  // No film: black.
  [[nodiscard]] Result<void> clear(const std::optional<FingerMark>& finger, MonotonicTime now);
  // The text of this moment, from the first picture on.
  void write(const ScreenFacts& facts, MonotonicTime next_picture, MonotonicTime now);

  // The viewer has done something: the text shows.
  void wake(MonotonicTime now) noexcept { text_.wake(now); }
  void tell(const std::string& why, MonotonicTime now) { text_.tell(why, now); }
  // Layout, SwapEyes, DepthBy, ScreenBy, Info; other verbs do nothing here.
  void obey(const PlayerCommand& command);

  [[nodiscard]] const StereoSettings& stereo() const noexcept { return picture_.stereo(); }
  [[nodiscard]] DisplayCapabilities capabilities() const noexcept { return picture_.capabilities(); }
  // The finger, as it was drawn last, touches.
  [[nodiscard]] bool contact() const noexcept { return drawn_finger_ && drawn_finger_->contact; }
  // When the first picture was seen.
  [[nodiscard]] std::optional<MonotonicTime> firstShown() const noexcept { return first_shown_; }
  // The screen's share of the report.
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
  bool redraw_ = false;  // whatever the finger does
  std::uint64_t shown_ = 0, dropped_ = 0;
  std::optional<MonotonicTime> first_shown_;
};

}  // namespace relievo
