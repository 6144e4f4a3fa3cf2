// SPDX-License-Identifier: Apache-2.0
// Each text picture is drawn from a script with exactly what is shown at that moment.
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

void ScreenWords::drawLines(const std::vector<std::string>& lines, const TextFrame& frame) {
  if (lines.empty()) return;
  text_->removeLines();
  for (const std::string& line : lines) text_->add(line, Duration(0), std::chrono::hours(1));
  TextFrame whole = frame;  // the display has the margins beside the picture as well
  whole.margin_x = whole.margin_y = 0;
  std::vector<TextPicture> drawn;
  text_->draw(whole, Duration(0), drawn, true);
  std::ranges::move(drawn, std::back_inserter(pictures_));
}

bool ScreenWords::draw(const ScreenContent& content, const TextFrame& frame) {
  if (content == drawn_ && frame_ == frame) return false;
  if (content.empty() && pictures_.empty()) return false;
  if (!ready()) return false;
  if (aspect_ != frame.aspect) text_->begin(screenHead(frame.aspect));
  aspect_ = frame.aspect;
  drawn_ = content;
  frame_ = frame;
  pictures_.clear();
  drawLines(screenLines(content, aspect_, frame.height), frame);
  if (content.list) std::ranges::move(postersOf(*content.list, frame), std::back_inserter(pictures_));
  drawLines(linesOverPosters(content, aspect_), frame);
  return true;
}

}  // namespace relievo
