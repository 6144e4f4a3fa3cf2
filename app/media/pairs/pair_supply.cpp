// SPDX-License-Identifier: Apache-2.0
// The first pictures, and the next pair.
#include "app/media/pairs/pair_supply.h"

#include <utility>

#include "app/media/frame_rate.h"
#include "platform/log.h"

namespace relievo {

Result<void> PairSupply::readFirst(const StreamInfo& color) {
  while (color_ahead_.size() < 2) {
    auto frame = readColor();
    if (!frame) return film_.failOn(film_.options.url, frame.error());
    if (!*frame) break;
    color_ahead_.push_back(std::move(**frame));
  }
  if (color_ahead_.empty()) return film_.failOn(film_.options.url, OpenFilm::kNoPicture);
  FilmInfo& info = film_.info;
  info.color_width = color_ahead_[0].width;
  info.color_height = color_ahead_[0].height;
  info.color_stream = color.index;
  info.color_codec = color.codec;
  info.color_decoder = film_.sources.color()->decoder(OpenFilm::kColorTrack);
  if (color_ahead_.size() == 2) info.frame_period = framePeriod(color_ahead_[1].pts - color_ahead_[0].pts, color);
  info.interlaced = film_.sources.color()->deinterlaced() > 0;
  info.color_primaries = color_ahead_[0].primaries;
  info.color_transfer = color_ahead_[0].transfer;
  const bool depth_is_counted = film_.sources.depth() && film_.sources.depth()->stream().counted;
  if (film_.options.frames_per_s && !color.counted && !depth_is_counted) {
    info.notes.emplace_back("--fps has no effect: the pictures have times of their own");
  }
  return {};
}

void PairSupply::followDepth() {
  depth_.emplace([this] { return supplyDepth(); });
}

void PairSupply::goOnWithDepth() noexcept {
  depth_->restart();
  own_.lost = false;
}

void PairSupply::dropDepth() noexcept {
  depth_.reset();
}

void PairSupply::beginAgainWith(Frame depth) {
  depth_again_ = std::move(depth);
  followDepth();
}

void PairSupply::loseDepth(const Error& error) {
  own_.lost = true;
  if (std::exchange(own_.loss_told, true)) return;
  log(LogLevel::Warning, "media", "%s: no depth from here on: %s", film_.depthUrl().c_str(), error.message);
}

Result<std::optional<FramePair>> PairSupply::next() {
  auto color = nextColor();
  if (!color) return std::unexpected(color.error());
  if (!*color) return std::nullopt;
  auto standing = depthBefore(**color);
  if (standing) color_ahead_.push_front(std::move(**color));
  auto pair = standing ? Result<FramePair>(std::move(*standing)) : pairFor(std::move(**color));
  if (!pair) return std::unexpected(pair.error());
  counters_.left_out += left_out_.countBefore(*pair, film_.info.frame_period);
  pair->material = materialAt(pair->color.pts);
  goes_on_at_ = pair->color.pts + film_.info.frame_period;
  if (film_.live) {
    const MonotonicTime arrival = film_.sources.color()->source().arrival();
    pair->taken = arrival + (pair->color.pts - color_shift_).time_since_epoch();
    if (film_.backends.clock != nullptr) pair->delay = film_.backends.clock->now() - *pair->taken;
  }
  ++counters_.pairs;
  if (!pair->matched && key_step_ == Duration(0)) ++counters_.mismatched;
  if (film_.info.has_depth && !film_.info.depth_from_views && pair->depth.empty()) ++counters_.without_depth;
  return std::move(*pair);
}

// The next colour picture, with the film's timestamp.
Result<std::optional<Frame>> PairSupply::readColor() {
  auto frame = film_.sources.color()->next(OpenFilm::kColorTrack);
  if (frame && *frame) (*frame)->pts += color_shift_;
  return frame;
}

Result<std::optional<Frame>> PairSupply::nextColor() {
  if (!color_ahead_.empty()) {
    std::optional<Frame> frame(std::move(color_ahead_.front()));
    color_ahead_.pop_front();
    return frame;
  }
  auto frame = readColor();
  if (!frame) film_.failed_thing = film_.options.url;
  return frame;
}

// The next depth picture, likewise, its samples in order, registered to the colour's view.
Result<DepthFollower::Supplied> PairSupply::supplyDepth() {
  auto supplied = supplyOwnDepth();
  if (!supplied || !supplied->frame) return supplied;
  auto frame = form_.ownDepth(*supplied->frame);
  if (!frame) return std::unexpected(frame.error());
  supplied->frame = std::move(*frame);
  return supplied;
}

Result<DepthFollower::Supplied> PairSupply::supplyOwnDepth() {
  if (depth_again_) return DepthFollower::Supplied{std::exchange(depth_again_, std::nullopt), false};
  if (!film_.sources.depth()) {
    TrackReader& color = *film_.sources.color();
    auto frame = color.next(*film_.depth_beside.track);
    if (!frame) return std::unexpected(frame.error());
    if (*frame) (*frame)->pts += color_shift_;
    return DepthFollower::Supplied{std::move(*frame), color.ended(*film_.depth_beside.track)};
  }
  auto given = film_.sources.depth()->next();
  if (!given) return std::unexpected(given.error());
  own_.away = given->away;
  if (given->frame.empty()) return DepthFollower::Supplied{std::nullopt, given->ended};
  if (own_.session != given->session.number) meet(given->session, given->frame.pts);
  given->frame.pts = stretched(given->frame.pts, own_.stretch) + own_.shift;
  return DepthFollower::Supplied{std::move(given->frame), false};
}

Result<FramePair> PairSupply::pairFor(Frame color) {
  auto whole = form_.pairIn(color, film_.info);
  if (!whole) return film_.failOn(film_.options.url, whole.error());
  if (*whole) return std::move(**whole);
  auto match = depthAt(color.pts);
  if (!match) return std::unexpected(match.error());
  if (film_.info.packing == Packing::StereoTracks) {
    return FramePair{std::move(color), {}, true, {}, std::move(match->depth)};
  }
  return FramePair{std::move(color), std::move(match->depth), match->matched, {}, {}};
}

// An error in the depth ends only the depth; an interruption is returned to the caller.
Result<DepthFollower::Match> PairSupply::depthAt(MediaTime time) {
  const bool beside = film_.depth_beside.track.has_value();
  if (!depth_ || (!beside && !film_.sources.depth()) || own_.lost) return DepthFollower::Match{};
  depth_->setLive(film_.live);
  auto match = depth_->at(time);
  if (match && own_.away) return DepthFollower::Match{};  // flat, rather than with the relief of another moment
  if (match) {
    form_.stateMatrix(match->depth);  // the first was read before it was found
    return match;
  }
  const Error& error = match.error();
  const bool color_lost = beside && film_.isLoss(error);
  if (error.code == ErrorCode::Cancelled || color_lost) return film_.failOn(film_.depthUrl(), error);
  loseDepth(error);
  return DepthFollower::Match{};
}

// An error in the material ends only the material; if the colour is lost too, the next read of the colour reports it.
Frame PairSupply::materialAt(MediaTime time) {
  auto found = material_.at(time);
  if (found) return std::move(*found);
  if (found.error().code == ErrorCode::Cancelled || film_.isLoss(found.error())) return {};
  material_.giveUp();
  log(LogLevel::Warning, "media", "%s: the material track cannot be read from here on: %s", film_.options.url.c_str(),
      found.error().message);
  return {};
}

PairCounters PairSupply::counters() const noexcept {
  PairCounters counters = counters_;
  if (depth_) counters.depth_skipped = depth_->skipped();
  if (const TrackReader* const color = film_.sources.color()) {
    counters.damaged += color->damaged();
    counters.deinterlaced += color->deinterlaced();
    counters.jumps += color->source().jumps();
    counters.missed_pictures += color->source().missedPictures();
    counters.missing = color->source().missing();
  }
  if (const DepthSource* const source = film_.sources.depth()) {
    const DepthSource::Counters depth = source->counters();
    counters.damaged += depth.damaged;
    counters.deinterlaced += depth.deinterlaced;
    counters.jumps += depth.jumps;
    counters.missed_pictures += depth.missed_pictures;
    counters.depth_reconnects = depth.reconnects;
    counters.depth_missing = depth.missing;
  }
  return counters;
}

void PairSupply::close() noexcept {
  depth_.reset();
  depth_again_.reset();
  material_ = {};
  own_ = {};
  color_ahead_.clear();
  color_shift_ = Duration(0);
  goes_on_at_ = MediaTime{};
  counters_ = {};
  key_step_ = Duration(0);
  left_out_ = {};
}

}  // namespace relievo
