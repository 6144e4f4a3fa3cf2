// SPDX-License-Identifier: Apache-2.0
// The film on the screen: draws pictures, redraws them for the fingers or the text, and counts those shown and dropped.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/player/control/command.h"
#include "app/player/file_writer.h"
#include "app/player/film/coming_relief.h"
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

// Use on the player's thread only, which is the display's. Blocks only for the display's refresh. A function that draws
// fails only with errors that no retry helps: Unsupported is caused by the film, any other error by the display.
class FilmScreen {
 public:
  // `osd`: whether text is drawn over the picture.
  FilmScreen(Display& display, const DisplayConfig& config, const StereoSettings& stereo, bool osd, const Clock& clock,
             Journal& journal, FileWriter& files) noexcept
      : picture_(display, config, stereo), osd_(osd), clock_(clock), journal_(journal), files_(files) {}

  // A missing screen (NotFound) is noted in the journal and is no failure. `stop`: see Picture.
  [[nodiscard]] Result<void> open(const std::atomic<bool>& stop);
  void close() noexcept { picture_.close(); }
  // Once a round. Cancelled if the viewer has closed the window.
  [[nodiscard]] Result<void> attend(MonotonicTime now);

  // A film begins, or is turned: sets how to read its depth, the volume that it fills, and its frame period.
  // `on_side`: turned by 90 or 270 degrees; a shape that the viewer has chosen is that of the film before it is turned.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume, bool on_side, Duration period,
                MonotonicTime now);
  // To be shown with the first picture of all: what a viewer can do.
  void setFirstHint(std::string words) { first_hint_ = std::move(words); }
  void announce(const AnnouncedFilm& film) { picture_.announce(film); }
  // Files and addresses that the viewer has dropped on the window since the last call.
  [[nodiscard]] std::vector<std::string> takeDropped() { return picture_.takeDropped(); }
  // Draws a picture of the film, and the subtitles of `place`; `coming` follows it. False if the screen is lost: the
  // picture counts as dropped.
  [[nodiscard]] Result<bool> show(const FramePair& pair, MediaTime place, std::optional<Duration> late,
                                  const DepthComing& coming, const FingerMarks& fingers, MonotonicTime now);
  // The same for a picture that `show` has shown before it was turned: it is not counted again.
  [[nodiscard]] Result<void> showTurned(const FramePair& pair, MediaTime place, const DepthComing& coming,
                                        const FingerMarks& fingers, MonotonicTime now);
  // The subtitles of a film; see Picture.
  [[nodiscard]] SubtitleWords& subtitles() noexcept { return picture_.subtitles(); }
  [[nodiscard]] const SubtitleWords& subtitles() const noexcept { return picture_.subtitles(); }
  // Call when the film continues elsewhere: after an opening or a seek.
  void jump();
  // Saves the shown picture, without the text over it. `film`: its file's name, for the screenshot's. A notice reports
  // success or failure.
  void saveScreenshot(const std::string& film);
  // Counts pictures that were never shown.
  void skip(std::uint64_t pictures) noexcept { dropped_ += pictures; }
  // Between two pictures of the film, at `place`: draws the present one again if a finger, the text or a subtitle has
  // changed and there is time until `next_picture`.
  [[nodiscard]] Result<void> redraw(const FingerMarks& fingers, MediaTime place, MonotonicTime next_picture,
                                    MonotonicTime now);
  // For when there is no film: the next redraw draws a black picture.
  void clear() noexcept;
  // Updates the text over the picture, from the first picture on, and the list of films. A film that takes long to open
  // is named.
  void write(const ScreenFacts& facts, MonotonicTime next_picture, MonotonicTime now);
  // True if the viewer has asked for the statistics.
  [[nodiscard]] bool wantsStatistics() const noexcept { return text_.showsStatistics(); }
  void setStatistics(ScreenRows rows) { statistics_ = std::move(rows); }
  // The film's position, 0 to 1, under the mouse on the bar; nullopt if there is no bar. A mouse near the bar's place
  // shows the bar. A press on the bar holds it: until the button is released, the mouse may leave it.
  [[nodiscard]] std::optional<double> barAt(const SurfaceMouse& mouse, MonotonicTime now);
  [[nodiscard]] bool dragsBar() const noexcept { return drags_bar_; }
  // The button of the bar under the mouse, which `barAt` has been told of.
  [[nodiscard]] std::optional<PlayerVerb> buttonAt(const SurfaceMouse& mouse) const;
  // Whether the mouse is over the bar or the words around it, or holds it. A film without a length has a bar as well.
  [[nodiscard]] bool isOverBar(const SurfaceMouse& mouse) const;

  // The film that the mouse is over in the list of films; nullopt: none.
  [[nodiscard]] std::optional<std::size_t> filmAt(const SurfaceMouse& mouse) const;
  // Whether the mouse is over the words below the list that name the key for all keys.
  [[nodiscard]] bool isOverListHelp(const SurfaceMouse& mouse) const;
  [[nodiscard]] bool isFullScreen() const noexcept { return picture_.isFullScreen(); }

  // The keys, page by page; see ScreenText.
  void turnKeys(ScreenRows rows);
  // Call when the viewer has pressed a key: the text is shown for a while.
  void wake(MonotonicTime now) noexcept { text_.wake(now); }
  [[nodiscard]] ScreenText& text() noexcept { return text_; }
  // Handles FullScreen, Layout, SwapEyes, DepthBy, ScreenBy, ZoomBy, Aspect, SubtitleDelayBy, SubtitleSizeBy, Info and
  // Statistics; ignores other commands.
  void obey(const PlayerCommand& command);

  [[nodiscard]] const StereoSettings& stereo() const noexcept { return picture_.stereo(); }
  [[nodiscard]] const std::string& aspectWord() const noexcept { return aspect_word_; }
  [[nodiscard]] DisplayCapabilities capabilities() const noexcept { return picture_.capabilities(); }
  // The finger marks as drawn last.
  [[nodiscard]] const FingerMarks& fingers() const noexcept { return drawn_fingers_; }
  [[nodiscard]] const DisplayVolume& volume() const noexcept { return picture_.volume(); }
  // When the first picture was shown.
  [[nodiscard]] std::optional<MonotonicTime> firstShown() const noexcept { return first_shown_; }
  // Fills in the screen's part of the report.
  void describe(PlayReport& report) const;

 private:
  [[nodiscard]] Result<bool> draw(const FingerMarks& fingers, MonotonicTime now);
  [[nodiscard]] bool waitsLong(PlayerState state, MonotonicTime now) noexcept;
  void lookAhead(const Frame& depth, const DepthComing& coming);
  void writeScreenshot(MonotonicTime now);
  void noteSaved(MonotonicTime now);
  void changeAspect(const std::string& word);
  void applyAspect() noexcept;
  void noteMissing(char32_t letter);
  void noteLost();

  Picture picture_;
  DepthCalibration calibration_;
  ComingRelief coming_;
  std::string first_hint_;
  std::string screenshot_film_;                  // for the screenshot that is due
  std::deque<std::future<std::string>> saving_;  // screenshots being written: the notice for each
  ScreenText text_;
  const bool osd_;
  const Clock& clock_;
  Journal& journal_;
  FileWriter& files_;
  MonotonicTime drawn_at_;
  FingerMarks drawn_fingers_;
  ScreenContent written_;
  ScreenRows statistics_;
  std::string aspect_word_ = "film";
  std::size_t next_aspect_ = 0;
  bool on_side_ = false;
  bool drags_bar_ = false;
  bool redraw_ = false;  // true: redraw even if no finger has moved
  std::uint64_t shown_ = 0, dropped_ = 0;
  std::optional<MonotonicTime> first_shown_, waits_since_;
};

}  // namespace relievo
