// SPDX-License-Identifier: Apache-2.0
// Draws a script of one moment.
#include "app/player/screen/screen_words.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "app/player/screen/list_script.h"
#include "app/player/screen/screen_script.h"
#include "platform/log.h"

namespace relievo {

bool ScreenWords::ready() {
  if (text_ || gave_up_) return text_.has_value();
  auto text = AssText::create();
  if (text) {
    text_.emplace(std::move(*text));
    return true;
  }
  gave_up_ = true;
  log(LogLevel::Warning, "play", "%s; on-screen text is off", text.error().message);
  return false;
}

bool ScreenWords::draw(const ScreenContent& content, const TextFrame& frame) {
  if (content == drawn_ && frame_ == frame) return false;
  if (content.empty() && pictures_.empty()) return false;
  const bool anew = !frame_.has_value();
  if (!ready()) return false;
  if (aspect_ != frame.aspect) text_->begin(screenHead(frame.aspect));
  aspect_ = frame.aspect;
  text_->removeLines();
  for (const std::string& line : screenLines(content, aspect_)) text_->add(line, Duration(0), std::chrono::hours(1));
  drawn_ = content;
  frame_ = frame;
  TextFrame whole = frame;  // the display has the margins beside the picture as well
  whole.margin_x = whole.margin_y = 0;
  pictures_.resize(words_);  // posters are made anew
  const bool changed = text_->draw(whole, Duration(0), pictures_, anew);
  const bool had_posters = std::exchange(words_, pictures_.size()) < shown_;
  if (content.list) std::ranges::move(postersOf(*content.list, frame), std::back_inserter(pictures_));
  shown_ = pictures_.size();
  return changed || had_posters || shown_ > words_;
}

}  // namespace relievo
