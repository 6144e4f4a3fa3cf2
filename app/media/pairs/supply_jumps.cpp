// SPDX-License-Identifier: Apache-2.0
// Leaves out pictures, seeks in a film, resumes it after its source was lost, and aligns the clocks of two sources.
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/media/pairs/pair_supply.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kSameClock = std::chrono::seconds(20);  // two streams of one sender differ by less than this

// Pictures whose names are from one clock or one count keep their distance if most of the shorter series lies within
// the other; else the two begin together.
Duration distanceByName(const MediaSource& color, const DepthSource::Session& depth) {
  const bool known = color.namedStart() && depth.named_start && color.duration() > Duration(0);
  if (!known || depth.duration == Duration(0)) return Duration(0);
  const Duration distance = *depth.named_start - *color.namedStart();
  const Duration common = std::min(color.duration(), distance + depth.duration) - std::max(Duration(0), distance);
  return 2 * common >= std::min(color.duration(), depth.duration) ? distance : Duration(0);
}

double perSecond(const Ratio& rate) noexcept {
  return rate.known() ? static_cast<double>(rate.num) / rate.den : 0;
}

// The number of pictures of a file that has them at even steps; 0 if unknown.
double evenPictures(const StreamInfo& stream) noexcept {
  constexpr double kEven = 0.02;  // a phone's film of 30 a second is stated as 29.8 or so
  const double average = perSecond(stream.average_rate), base = perSecond(stream.base_rate);
  if (base == 0 || std::abs(average / base - 1) > kEven) return 0;
  return std::round(toSeconds(stream.duration) * average);
}

// Longer or shorter by more than a picture and by more than 1 %, as the last picture or sound may make a film.
bool differInLength(const StreamInfo& color, const StreamInfo& depth) noexcept {
  const Duration least = std::max({color.frame_period, depth.frame_period, color.duration / 100});
  return std::chrono::abs(color.duration - depth.duration) > least;
}

}  // namespace

void PairSupply::pairByCount(const StreamInfo& color) {
  own_.stretch = 1;
  const DepthSource* const source = film_.sources.depth();
  if (source == nullptr || film_.live) return;
  const StreamInfo& depth = source->stream();
  const double pictures = evenPictures(color);
  const bool films = color.duration > Duration(0) && depth.duration > depth.frame_period;
  if (!films || !differInLength(color, depth)) return;
  const bool counted = pictures > 1 && pictures == evenPictures(depth);
  if (counted) own_.stretch = perSecond(depth.average_rate) / perSecond(color.average_rate);
  const double depth_s = toSeconds(depth.duration), color_s = toSeconds(color.duration);
  film_.info.notes.push_back(
      counted ? print("colour and depth have %.0f pictures each, of %.4g and %.4g a second: they are paired by number",
                      pictures, perSecond(color.average_rate), perSecond(depth.average_rate))
              : print("the depth lasts %.1f s, the colour %.1f s: they are paired by time", depth_s, color_s));
}

void PairSupply::leaveOut(bool unreferenced, std::optional<MediaTime> until) {
  if (film_.live || key_step_ != Duration(0)) return;
  if (unreferenced || until) left_out_.begin();
  film_.sources.color()->leaveOutUnreferenced(unreferenced);
  // If this fails, reading the next picture fails as well and reports it.
  if (until) static_cast<void>(film_.sources.color()->hurryTo(*until - color_shift_));
}

// Depth of a time between the last colour picture and this one, if pictures between them were left out.
std::optional<FramePair> PairSupply::depthBefore(const Frame& color) {
  const Duration period = film_.info.frame_period;
  if (!left_out_.areBefore(color.pts, period)) return std::nullopt;
  if (!depth_ || film_.info.packing != Packing::Tracks || own_.lost) return std::nullopt;
  const auto next = depth_->peek();
  if (!next || *next == nullptr) return std::nullopt;
  const MediaTime time = (*next)->pts;
  if (time <= left_out_.lastPair() || time > color.pts - period / 2) return std::nullopt;
  auto match = depthAt(time);
  if (!match || match->depth.empty()) return std::nullopt;
  FramePair pair;
  pair.color.pts = time;
  pair.depth = std::move(match->depth);
  pair.stands = true;
  return pair;
}

// Drops the colour pictures before the target, and reads the depth along so that its packets do not pile up. Returns
// the last of them.
Result<std::optional<Frame>> PairSupply::passTo(MediaTime target) {
  std::optional<Frame> last;
  for (;;) {
    auto color = nextColor();
    if (!color) return std::unexpected(color.error());
    if (!*color) return last;
    if ((*color)->pts >= target) {
      color_ahead_.push_front(std::move(**color));
      return last;
    }
    if (auto passed = depthAt((*color)->pts); !passed) return std::unexpected(passed.error());
    static_cast<void>(materialAt((*color)->pts));
    last = std::move(*color);
  }
}

// Whether the picture before the target is the one to show there: the next is far, or only sound is left.
bool PairSupply::isGap(MediaTime target) const {
  if (key_step_ != Duration(0)) return false;
  if (color_ahead_.empty()) return target < MediaTime(film_.info.duration);
  return color_ahead_.front().pts > target + film_.info.frame_period * 5 / 4;  // containers round their timestamps
}

// Call after the colour was sought, and with it a depth track of the same source.
Result<void> PairSupply::seekDepth(MediaTime target) {
  material_.restart();
  if (!depth_) return {};
  depth_->restart();
  own_.lost = false;
  if (!film_.sources.depth()) return {};
  const auto sought = film_.sources.depth()->seek(stretched(target - own_.shift, 1 / own_.stretch), key_step_);
  if (sought) return {};
  if (sought.error().code == ErrorCode::Cancelled) return film_.failOn(film_.depthUrl(), sought.error());
  loseDepth(sought.error());
  return {};
}

// Resumes with the picture after the last one; a separate depth source has kept its position.
Result<void> PairSupply::goOnInFile() {
  const MediaTime target = goes_on_at_ - film_.info.frame_period / 2;  // containers round their timestamps
  if (auto sought = film_.sources.color()->seek(target, key_step_); !sought)
    return film_.failOn(film_.options.url, sought.error());
  color_ahead_.clear();
  if (film_.depth_beside.track) depth_->restart();
  material_.restart();
  if (auto passed = passTo(target); !passed) return std::unexpected(passed.error());
  return {};
}

// Computes the shift that aligns a new session of the depth source with the colour.
void PairSupply::meet(const DepthSource::Session& session, MediaTime first) {
  if (own_.session) depth_->restart();
  own_.session = session.number;
  const MediaSource& color = film_.sources.color()->source();
  own_.shift = session.live ? Duration(0) : distanceByName(color, session);
  if (!session.live) return;
  if (!color.live()) {  // align what arrives now with what is shown now
    own_.shift = goes_on_at_ - first;
    return;
  }
  const Duration by_arrival = session.arrival - color.arrival();
  Duration distance = by_arrival;
  if (session.sender_start && color.senderStart()) {
    const Duration by_sender = *session.sender_start - *color.senderStart();
    if (std::chrono::abs(by_sender - by_arrival) < kSameClock) distance = by_sender;
  }
  own_.shift = distance + color_shift_;
}

Result<void> PairSupply::seek(MediaTime target, Duration key_step) {
  if (auto sought = film_.sources.color()->seek(target, key_step); !sought) {
    return film_.failOn(film_.options.url, sought.error());
  }
  goes_on_at_ = target;  // if it is lost before the next pair
  color_ahead_.clear();
  left_out_.jump();
  key_step_ = key_step;
  if (auto sought = seekDepth(target); !sought) return sought;
  auto passed = passTo(target);
  if (!passed) return std::unexpected(passed.error());
  if (*passed && isGap(target)) color_ahead_.push_front(std::move(**passed));
  return {};
}

void PairSupply::leave() {
  const TrackReader& color = *film_.sources.color();
  counters_.damaged += color.damaged();
  counters_.deinterlaced += color.deinterlaced();
  counters_.jumps += color.source().jumps();
  counters_.missed_pictures += color.source().missedPictures();
  color_ahead_.clear();
  color_shift_ = Duration(0);
}

Result<void> PairSupply::goOn() {
  ++counters_.reconnects;
  if (!film_.live) return goOnInFile();
  color_shift_ = goes_on_at_ - color_ahead_.front().pts;
  for (Frame& frame : color_ahead_) frame.pts += color_shift_;
  own_.session.reset();  // because the colour's shift has changed
  return {};
}

}  // namespace relievo
