// SPDX-License-Identifier: Apache-2.0
// Reads an open film and pairs colour with depth.
#include "app/media/pair_reader.h"

#include <utility>

#include "app/media/pairs/pair_film.h"
#include "platform/log.h"

namespace relievo {
// The next colour picture, with the film's timestamp.
Result<std::optional<Frame>> PairReader::Impl::readColor() {
  auto frame = sources.color()->next(kColorTrack);
  if (frame && *frame) (*frame)->pts += color_shift;
  return frame;
}

Result<std::optional<Frame>> PairReader::Impl::nextColor() {
  if (!color_ahead.empty()) {
    std::optional<Frame> frame(std::move(color_ahead.front()));
    color_ahead.pop_front();
    return frame;
  }
  auto frame = readColor();
  if (!frame) failed_thing = options.url;
  return frame;
}

// The next depth picture, likewise, its samples in order, registered to the colour's view.
Result<DepthFollower::Supplied> PairReader::Impl::supplyDepth() {
  auto supplied = supplyOwnDepth();
  if (!supplied || !supplied->frame) return supplied;
  auto frame = meaning.form().ownDepth(*supplied->frame);
  if (!frame) return std::unexpected(frame.error());
  supplied->frame = std::move(*frame);
  return supplied;
}

Result<DepthFollower::Supplied> PairReader::Impl::supplyOwnDepth() {
  if (depth_again) return DepthFollower::Supplied{std::exchange(depth_again, std::nullopt), false};
  if (!sources.depth()) {
    auto frame = sources.color()->next(*depth_beside.track);
    if (!frame) return std::unexpected(frame.error());
    if (*frame) (*frame)->pts += color_shift;
    return DepthFollower::Supplied{std::move(*frame), sources.color()->ended(*depth_beside.track)};
  }
  auto given = sources.depth()->next();
  if (!given) return std::unexpected(given.error());
  own.away = given->away;
  if (given->frame.empty()) return DepthFollower::Supplied{std::nullopt, given->ended};
  if (own.session != given->session.number) meet(given->session, given->frame.pts);
  given->frame.pts += own.shift;
  return DepthFollower::Supplied{std::move(given->frame), false};
}

Result<FramePair> PairReader::Impl::pairFor(Frame color) {
  auto whole = meaning.form().pairIn(color, info);
  if (!whole) return failOn(options.url, whole.error());
  if (*whole) return std::move(**whole);
  auto match = depthAt(color.pts);
  if (!match) return std::unexpected(match.error());
  if (info.packing == Packing::StereoTracks) {
    return FramePair{std::move(color), {}, true, {}, std::move(match->depth)};
  }
  return FramePair{std::move(color), std::move(match->depth), match->matched, {}, {}};
}

// An error in the depth ends only the depth; an interruption is returned to the caller.
Result<DepthFollower::Match> PairReader::Impl::depthAt(MediaTime time) {
  if (!depth || (!depth_beside.track && !sources.depth()) || own.lost) return DepthFollower::Match{};
  depth->setLive(live);
  auto match = depth->at(time);
  if (match && own.away) return DepthFollower::Match{};  // flat, rather than with the relief of another moment
  if (match) return match;
  if (match.error().code == ErrorCode::Cancelled) {
    return failOn(depthUrl(), match.error());
  }
  if (depth_beside.track && isLoss(match.error())) return failOn(depthUrl(), match.error());  // the colour is lost too
  loseDepth(match.error());
  return DepthFollower::Match{};
}

// An error in the material ends only the material; if the colour is lost too, the next read of the colour reports it.
Frame PairReader::Impl::materialAt(MediaTime time) {
  auto found = material.at(time);
  if (found) return std::move(*found);
  if (found.error().code == ErrorCode::Cancelled || isLoss(found.error())) return {};
  material.giveUp();
  log(LogLevel::Warning, "media", "%s: the material track cannot be read from here on: %s", options.url.c_str(),
      found.error().message);
  return {};
}

void PairReader::Impl::loseDepth(const Error& error) {
  own.lost = true;
  if (std::exchange(own.loss_told, true)) return;
  log(LogLevel::Warning, "media", "%s: no depth from here on: %s", depthUrl().c_str(), error.message);
}

PairCounters& PairCounters::operator+=(const PairCounters& other) noexcept {
  pairs += other.pairs;
  without_depth += other.without_depth;
  mismatched += other.mismatched;
  depth_skipped += other.depth_skipped;
  damaged += other.damaged;
  deinterlaced += other.deinterlaced;
  jumps += other.jumps;
  left_out += other.left_out;
  missed_pictures += other.missed_pictures;
  reconnects += other.reconnects;
  depth_reconnects += other.depth_reconnects;
  missing += other.missing;
  depth_missing += other.depth_missing;
  return *this;
}

PairReader::PairReader(Backends backends) : impl_(std::make_unique<Impl>(std::move(backends))) {}
PairReader::~PairReader() = default;

Result<void> PairReader::open(const SourceOptions& options) {
  close();
  impl_->sources.allow();
  impl_->failed_thing.clear();
  impl_->options = options;
  impl_->exchanged = false;
  auto opened = impl_->openFilm();
  if (opened && impl_->meaning.wantsExchange()) {
    close();
    impl_->exchanged = true;
    opened = impl_->openFilm();
  }
  if (!opened) close();
  return opened;
}

Result<std::optional<FramePair>> PairReader::next() {
  if (!impl_->sources.color()) return fail(ErrorCode::InvalidState, Impl::kNotOpen);
  auto color = impl_->nextColor();
  if (!color) return std::unexpected(color.error());
  if (!*color) return std::nullopt;
  auto standing = impl_->depthBefore(**color);
  if (standing) impl_->color_ahead.push_front(std::move(**color));
  auto pair = standing ? Result<FramePair>(std::move(*standing)) : impl_->pairFor(std::move(**color));
  if (!pair) return std::unexpected(pair.error());
  impl_->counters.left_out += impl_->left_out.countBefore(*pair, impl_->info.frame_period);
  pair->material = impl_->materialAt(pair->color.pts);
  impl_->goes_on_at = pair->color.pts + impl_->info.frame_period;
  if (impl_->live) {
    pair->taken =
        impl_->sources.color()->source().arrival() + (pair->color.pts - impl_->color_shift).time_since_epoch();
    if (impl_->backends.clock != nullptr) pair->delay = impl_->backends.clock->now() - *pair->taken;
  }
  ++impl_->counters.pairs;
  impl_->meaning.checkReach(pair->depth);
  if (!pair->matched && impl_->key_step == Duration(0)) ++impl_->counters.mismatched;
  if (impl_->info.has_depth && !impl_->info.depth_from_views && pair->depth.empty()) ++impl_->counters.without_depth;
  return std::move(*pair);
}

bool PairReader::isSourceLost(const Error& error) const noexcept {
  return impl_->isLoss(error) && impl_->failed_thing == impl_->options.url;
}

std::optional<AudioChunk> PairReader::nextSound() {
  return impl_->words.nextSound(impl_->color_shift);
}

std::optional<Subtitle> PairReader::nextSubtitle() {
  return impl_->words.nextWords(impl_->color_shift);
}

void PairReader::chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words) {
  if (!impl_->sources.color()) return;
  if (std::exchange(impl_->info.sound, sound) != sound) impl_->words.openSound();
  if (std::exchange(impl_->info.words, words) != words) impl_->words.openWords();
}

bool PairReader::readAhead() {
  return impl_->sources.color() && impl_->sources.color()->readAhead();
}

void PairReader::close() noexcept {
  Impl& film = *impl_;
  film.depth.reset();
  film.material = {};
  film.depth_again.reset();
  film.meaning.close();
  film.own = {};
  film.color_ahead.clear();
  film.words.close();
  film.color_shift = Duration(0);
  film.goes_on_at = MediaTime{};
  film.counters = {};
  film.key_step = Duration(0);
  film.left_out = {};

  film.OpenFilm::close();
}

void PairReader::interrupt() noexcept {
  impl_->sources.interrupt();
}

const FilmInfo& PairReader::info() const noexcept {
  return impl_->info;
}

const std::string& PairReader::failedThing() const noexcept {
  return impl_->failed_thing;
}

PairCounters PairReader::counters() const noexcept {
  PairCounters counters = impl_->counters;
  if (impl_->depth) counters.depth_skipped = impl_->depth->skipped();
  if (impl_->sources.color()) {
    counters.damaged += impl_->sources.color()->damaged();
    counters.deinterlaced += impl_->sources.color()->deinterlaced();
    counters.jumps += impl_->sources.color()->source().jumps();
    counters.missed_pictures += impl_->sources.color()->source().missedPictures();
    counters.missing = impl_->sources.color()->source().missing();
  }
  if (impl_->sources.depth()) {
    const DepthSource::Counters depth = impl_->sources.depth()->counters();
    counters.damaged += depth.damaged;
    counters.deinterlaced += depth.deinterlaced;
    counters.jumps += depth.jumps;
    counters.missed_pictures += depth.missed_pictures;
    counters.depth_reconnects = depth.reconnects;
    counters.depth_missing = depth.missing;
  }
  return counters;
}

std::optional<VideoDecoder::Restart> PairReader::takeRestart() noexcept {
  auto restart = impl_->sources.color() ? impl_->sources.color()->takeRestart() : std::nullopt;
  return restart || !impl_->sources.depth() ? restart : impl_->sources.depth()->takeRestart();
}

std::optional<Error> PairReader::depthLoss() const noexcept {
  return impl_->sources.depth() ? impl_->sources.depth()->loss() : std::nullopt;
}

}  // namespace relievo
