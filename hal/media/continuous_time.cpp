// SPDX-License-Identifier: Apache-2.0
// Gives each packet one of two offsets, the current one or that before the last jump.
#include "hal/media/continuous_time.h"

#include <algorithm>

namespace relievo {
namespace {

constexpr int kLateBegin = 3;
constexpr Duration kDisorder = std::chrono::milliseconds(200);  // decoding times rise; tolerance for rounding

}  // namespace

void ContinuousTime::begin(Duration longest_gap) noexcept {
  longest_gap_ = longest_gap;
  offset_ = Duration(0);
  before_.reset();
  latest_.reset();
  lines_.clear();
}

bool ContinuousTime::goesOn(const Line* line, MediaTime time) const noexcept {
  if (!latest_) return true;
  const bool falls = time < (line != nullptr ? line->last - kDisorder : *latest_ - kLateBegin * longest_gap_);
  return !falls && time <= *latest_ + longest_gap_;
}

Duration ContinuousTime::offsetFor(int stream, MediaTime time) {
  if (longest_gap_ == Duration(0)) return Duration(0);
  const auto found = lines_.find(stream);
  const Line* const line = found == lines_.end() ? nullptr : &found->second;
  const MediaTime expected = line != nullptr ? line->last + line->step : latest_.value_or(time);
  const auto distance = [&](Duration offset) { return std::chrono::abs(time + offset - expected); };

  Duration offset = offset_;
  const bool now = goesOn(line, time + offset_);
  const bool then = before_ && goesOn(line, time + *before_);
  if (then && (!now || distance(*before_) < distance(offset_))) {
    offset = *before_;
  } else if (!now) {
    before_ = offset_;
    offset = offset_ = expected - time;
    jumped_at_ = expected;
    ++jumps_;
  }

  const MediaTime placed = time + offset;
  const Duration step = line != nullptr ? placed - line->last : Duration(0);
  const bool usual = step > Duration(0) && step <= longest_gap_;
  lines_[stream] = {placed, usual ? step : line != nullptr ? line->step : Duration(0)};
  latest_ = latest_ ? std::max(*latest_, placed) : placed;
  if (*latest_ > jumped_at_ + longest_gap_) before_.reset();
  return offset;
}

}  // namespace relievo
