// SPDX-License-Identifier: Apache-2.0
// Text goes to libass, pictures are scaled to the film's place in the view.
#include "app/player/screen/subtitle_words.h"

#include <algorithm>
#include <cmath>

#include "platform/log.h"

namespace relievo {
namespace {

constexpr Duration kUnknownLength = std::chrono::seconds(5);
constexpr std::size_t kMostWithPictures = 64;

// Behind the first comma of a line is what does not depend on when it was read.
std::string_view withoutOrder(std::string_view line) noexcept {
  const std::size_t comma = line.find(',');
  return comma == std::string_view::npos ? line : line.substr(comma + 1);
}

// A larger one grows from the middle of its foot.
TextPicture placed(const SubtitlePicture& picture, const Subtitle& subtitle, const TextFrame& frame, double size) {
  const double width = frame.width - 2 * frame.margin_x, height = frame.height - 2 * frame.margin_y;
  const double across = subtitle.canvas_width > 0 ? width / subtitle.canvas_width : 1.0;
  const double down = subtitle.canvas_height > 0 ? height / subtitle.canvas_height : 1.0;
  const auto pixels = [](double value) { return static_cast<int>(std::lround(value)); };
  const double x = picture.x + 0.5 * picture.width * (1 - size), y = picture.y + picture.height * (1 - size);
  return {frame.margin_x + pixels(x * across),
          frame.margin_y + pixels(y * down),
          std::max(pixels(picture.width * across * size), 1),
          std::max(pixels(picture.height * down * size), 1),
          picture.width,
          picture.height,
          picture.rgba};
}

}  // namespace

bool SubtitleWords::ready() {
  if (text_ || gave_up_) return text_.has_value();
  auto text = AssText::create(true);
  if (text) {
    text_.emplace(std::move(*text));
    text_->setSize(size_);
    return true;
  }
  gave_up_ = true;
  log(LogLevel::Warning, "play", "%s; subtitles are off", text.error().message);
  return false;
}

void SubtitleWords::add(Subtitle subtitle) {
  if (!subtitle.lines.empty()) return addLines(subtitle);
  const auto at = std::ranges::lower_bound(with_pictures_, subtitle.begin, {}, &Subtitle::begin);
  if (at != with_pictures_.end() && at->begin == subtitle.begin) {
    if (at->pictures.empty()) *at = std::move(subtitle);  // it takes the place of the end of the one before
    return;                                               // else it comes again, after a seek
  }
  const bool is_late = 2 * (at - with_pictures_.begin()) >= std::ssize(with_pictures_);
  with_pictures_.insert(at, std::move(subtitle));
  if (with_pictures_.size() <= kMostWithPictures) return;
  if (is_late) with_pictures_.pop_front();
  else with_pictures_.pop_back();  // after a seek back it is the far ones that are read again
}

void SubtitleWords::addLines(const Subtitle& subtitle) {
  if (!ready()) return;
  if (styles_ != subtitle.styles) {
    styles_ = subtitle.styles;
    seen_.clear();
    text_->begin(styles_ ? *styles_ : "");
  }
  const Duration begin = subtitle.begin.time_since_epoch();
  const Duration length = subtitle.end ? *subtitle.end - subtitle.begin : kUnknownLength;
  for (const std::string& line : subtitle.lines) {
    const std::string_view words = withoutOrder(line);
    if (!seen_.emplace(begin.count(), words).second) continue;
    text_->add(std::to_string(seen_.size()) + "," + std::string(words), begin, length);
  }
}

void SubtitleWords::changeSize(double by) noexcept {
  constexpr double kLeast = 0.5, kMost = 3;
  size_ = std::clamp(size_ + by, kLeast, kMost);
  if (text_) text_->setSize(size_);
  drawn_.reset();
}

void SubtitleWords::forget() {
  styles_.reset();
  seen_.clear();
  with_pictures_.clear();
  if (text_) text_->begin("");
}

const Subtitle* SubtitleWords::pictureAt(MediaTime time) const noexcept {
  const auto after = std::ranges::upper_bound(with_pictures_, time, {}, &Subtitle::begin);
  if (after == with_pictures_.begin()) return nullptr;
  const Subtitle& last = *std::prev(after);
  return !last.pictures.empty() && (!last.end || *last.end > time) ? &last : nullptr;
}

bool SubtitleWords::drawPictures(const TextFrame& frame, MediaTime time) {
  const Subtitle* const now = pictureAt(time);
  if (now == nullptr) {
    drawn_.reset();
    return !std::exchange(pictures_, {}).empty();
  }
  if (drawn_ == std::pair(now->begin, frame)) return false;
  drawn_ = {now->begin, frame};
  pictures_.clear();
  for (const SubtitlePicture& picture : now->pictures) pictures_.push_back(placed(picture, *now, frame, size_));
  return true;
}

bool SubtitleWords::drawAll(const TextFrame& frame, MediaTime time, bool shown) {
  const bool appears = shown && !std::exchange(was_shown_, shown);
  if (!shown) {
    was_shown_ = false;
    drawn_.reset();
    return !std::exchange(pictures_, {}).empty();
  }
  if (!with_pictures_.empty()) return drawPictures(frame, time);
  if (!text_) return false;
  return text_->draw(frame, time.time_since_epoch(), pictures_, appears);
}

// All in the lower half by the same way, so that lines keep their distance. `anew`: the pictures are at their places.
bool SubtitleWords::lift(const TextFrame& frame, double down, bool anew) {
  if (anew) lifted_ = 0;
  const auto isLow = [&](const TextPicture& picture) {
    return 2 * (picture.y + lifted_) + picture.height > frame.height;
  };
  int bottom = 0;
  for (const TextPicture& picture : pictures_) {
    if (isLow(picture)) bottom = std::max(bottom, picture.y + lifted_ + picture.height);
  }
  const int up = std::max(0, bottom - static_cast<int>(std::lround(down * frame.height)));
  if (up == lifted_) return false;
  for (TextPicture& picture : pictures_) {
    if (isLow(picture)) picture.y -= up - lifted_;
  }
  lifted_ = up;
  return true;
}

bool SubtitleWords::draw(const TextFrame& frame, MediaTime time, const SubtitleRoom& room) {
  const bool changed = drawAll(frame, time - delay_, shown_ && !room.none);
  return lift(frame, room.down, changed) || changed;
}

}  // namespace relievo
