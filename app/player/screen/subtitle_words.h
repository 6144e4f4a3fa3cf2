// SPDX-License-Identifier: Apache-2.0
// Renders the subtitles of a moment to pictures.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/render/text/ass_text.h"
#include "hal/media/subtitle_decoder.h"

namespace relievo {

// The part of the view that the on-screen display leaves free.
struct SubtitleRoom {
  bool none = false;  // a page covers all of it
  double down = 1;    // free down to here, as a share of its height: subtitles below are moved up
};

// Use from one thread. Lines that are read again after a seek are shown once. Without a font no text is shown, which is
// logged once.
class SubtitleWords {
 public:
  void add(Subtitle subtitle);
  // Call for another track or film.
  void forget();
  void show(bool shown) noexcept { shown_ = shown; }
  // True if the film has subtitles and they are switched on.
  [[nodiscard]] bool mayShow() const noexcept { return shown_ && (!seen_.empty() || !with_pictures_.empty()); }
  // Scales the film's letters: 0.5 to 3.
  void changeSize(double by) noexcept;
  [[nodiscard]] double size() const noexcept { return size_; }
  // Each subtitle is shown this much later than its time in the film.
  void changeDelay(Duration by) noexcept { delay_ += by; }
  [[nodiscard]] Duration delay() const noexcept { return delay_; }
  // The subtitles at this time of the film. True if the pictures differ from the last ones.
  bool draw(const TextFrame& frame, MediaTime time, const SubtitleRoom& room = {});
  [[nodiscard]] const std::vector<TextPicture>& pictures() const noexcept { return pictures_; }
  // As of AssText.
  [[nodiscard]] char32_t takeMissingLetter() noexcept { return text_ ? text_->takeMissingLetter() : U'\0'; }

 private:
  void addLines(const Subtitle& subtitle);
  [[nodiscard]] bool ready();
  [[nodiscard]] const Subtitle* pictureAt(MediaTime time) const noexcept;
  bool drawPictures(const TextFrame& frame, MediaTime time);
  bool drawAll(const TextFrame& frame, MediaTime time, bool shown);
  bool lift(const TextFrame& frame, double down, bool anew);

  bool shown_ = true, was_shown_ = true;
  double size_ = 1;
  Duration delay_{0};
  std::optional<AssText> text_;
  bool gave_up_ = false;
  std::shared_ptr<const std::string> styles_;             // of the script in `text_`
  std::set<std::pair<std::int64_t, std::string>> seen_;   // begin, line
  std::deque<Subtitle> with_pictures_;                    // ascending
  std::optional<std::pair<MediaTime, TextFrame>> drawn_;  // of the shown subtitle with pictures
  std::vector<TextPicture> pictures_;
  int lifted_ = 0;  // by so many pixels those in the lower half are moved up
};

}  // namespace relievo
