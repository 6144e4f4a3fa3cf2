// SPDX-License-Identifier: Apache-2.0
// Reads an open film and pairs colour with depth.
#include "app/media/pair_reader.h"

#include <utility>

#include "app/media/depth_picture.h"
#include "app/media/pair_film.h"
#include "app/media/reading/stereo_pair.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr const char* kNotOpen = "no film is open; open one first";

}  // namespace

// The next colour picture, with the film's timestamp.
Result<std::optional<Frame>> PairReader::Impl::readColor() {
  auto frame = color_reader->next(kColorTrack);
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
  if (reordering.order == SampleOrder::AsStored && !registrar) return supplied;
  auto frame = inOrder(*supplied->frame, reordering.order);
  if (frame && registrar) frame = registrar->registered(*frame);
  if (!frame) return std::unexpected(frame.error());
  supplied->frame = std::move(*frame);
  return supplied;
}

Result<DepthFollower::Supplied> PairReader::Impl::supplyOwnDepth() {
  if (reordering.again) return DepthFollower::Supplied{std::exchange(reordering.again, std::nullopt), false};
  if (!depth_source) {
    auto frame = color_reader->next(*depth_track);
    if (!frame) return std::unexpected(frame.error());
    if (*frame) (*frame)->pts += color_shift;
    return DepthFollower::Supplied{std::move(*frame), color_reader->ended(*depth_track)};
  }
  auto given = depth_source->next();
  if (!given) return std::unexpected(given.error());
  own.away = given->away;
  if (given->frame.empty()) return DepthFollower::Supplied{std::nullopt, given->ended};
  if (own.session != given->session.number) meet(given->session, given->frame.pts);
  given->frame.pts += own.shift;
  return DepthFollower::Supplied{std::move(given->frame), false};
}

Result<FramePair> PairReader::Impl::pairFor(Frame color) {
  if (info.packing == Packing::DepthAlone) {
    auto ordered = inOrder(color, reordering.order);
    if (!ordered) return failOn(options.url, ordered.error());
    Frame shown = depthPicture(*ordered, info.calibration.calibration);
    return FramePair{std::move(shown), std::move(*ordered), true, {}, {}};
  }
  if (isPacked()) {
    auto halves = splitPacked(color, info.packing, clues.code, gray);
    if (!halves) return failOn(options.url, halves.error());
    return FramePair{std::move(halves->color), std::move(halves->depth), true, {}, {}};
  }
  if (isStereo(info.packing)) {
    auto views = viewsOf(color, info.packing, right_first, views_squeezed);
    if (views) return FramePair{std::move(views->left), {}, true, {}, std::move(views->right)};
  }
  if (info.packing == Packing::StereoLayers) {
    Frame right = color.right ? *color.right : Frame{};
    right.pts = color.pts;
    color.right.reset();
    return FramePair{std::move(color), {}, true, {}, std::move(right)};
  }
  auto match = depthAt(color.pts);
  if (!match) return std::unexpected(match.error());
  if (info.packing == Packing::StereoTracks) {
    return FramePair{std::move(color), {}, true, {}, std::move(match->depth)};
  }
  return FramePair{std::move(color), std::move(match->depth), match->matched, {}, {}};
}

// An error in the depth ends the depth only; just an interruption is returned to the caller.
Result<DepthFollower::Match> PairReader::Impl::depthAt(MediaTime time) {
  if (!depth || (!depth_track && !depth_source) || own.lost) return DepthFollower::Match{};
  depth->setLive(live);
  auto match = depth->at(time);
  if (match && own.away) return DepthFollower::Match{};  // flat, rather than the shape of another moment
  if (match) return match;
  if (match.error().code == ErrorCode::Cancelled) {
    return failOn(depthUrl(), match.error());
  }
  if (depth_track && isLoss(match.error())) return failOn(depthUrl(), match.error());  // the colour is lost too
  loseDepth(match.error());
  return DepthFollower::Match{};
}

void PairReader::Impl::loseDepth(const Error& error) {
  own.lost = true;
  if (std::exchange(own.loss_told, true)) return;
  log(LogLevel::Warning, "media", "%s: no depth from here on: %s", depthUrl().c_str(), error.message);
}

// Drops the colour pictures before the target, and reads the depth along so that its packets do not pile up.
Result<void> PairReader::Impl::passTo(MediaTime target) {
  for (;;) {
    auto color = nextColor();
    if (!color) return std::unexpected(color.error());
    if (!*color) return {};
    if ((*color)->pts >= target) {
      color_ahead.push_front(std::move(**color));
      return {};
    }
    if (auto passed = depthAt((*color)->pts); !passed) return std::unexpected(passed.error());
    static_cast<void>(materialAt((*color)->pts));
  }
}

// The colour has already been sought, and so has a depth track in the same source.
Result<void> PairReader::Impl::seekDepth(MediaTime target) {
  if (material) material->restart();
  if (!depth) return {};
  depth->restart();
  own.lost = false;
  if (!depth_source) return {};
  const auto sought = depth_source->seek(target - own.shift, key_step);
  if (sought) return {};
  if (sought.error().code == ErrorCode::Cancelled) return failOn(depthUrl(), sought.error());
  loseDepth(sought.error());
  return {};
}

// Resumes with the picture after the last one; a separate depth source has kept its position.
Result<void> PairReader::Impl::goOn() {
  const MediaTime target = goes_on_at - info.frame_period / 2;  // containers round their timestamps
  if (auto sought = color_reader->seek(target, key_step); !sought) return failOn(options.url, sought.error());
  color_ahead.clear();
  if (depth_track) depth->restart();
  if (material) material->restart();
  return passTo(target);
}

// Closes the colour source but keeps its counters.
void PairReader::Impl::leaveColor() {
  counters.damaged += color_reader->damaged();
  counters.deinterlaced += color_reader->deinterlaced();
  counters.jumps += color_reader->source().jumps();
  counters.missed_pictures += color_reader->source().missedPictures();
  color_ahead.clear();
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
  {
    const std::scoped_lock lock(impl_->readers_mutex);
    impl_->interrupted = false;
  }
  impl_->failed_thing.clear();
  impl_->options = options;
  auto opened = impl_->openFilm();
  if (!opened) close();
  return opened;
}

Result<std::optional<FramePair>> PairReader::next() {
  if (!impl_->color_reader) return fail(ErrorCode::InvalidState, kNotOpen);
  auto color = impl_->nextColor();
  if (!color) return std::unexpected(color.error());
  if (!*color) return std::nullopt;
  auto standing = impl_->depthBefore(**color);
  if (standing) impl_->color_ahead.push_front(std::move(**color));
  auto pair = standing ? Result<FramePair>(std::move(*standing)) : impl_->pairFor(std::move(**color));
  if (!pair) return std::unexpected(pair.error());
  impl_->countLeftOut(*pair);
  pair->material = impl_->materialAt(pair->color.pts);
  impl_->goes_on_at = pair->color.pts + impl_->info.frame_period;
  if (impl_->live) {
    pair->taken = impl_->color_reader->source().arrival() + (pair->color.pts - impl_->color_shift).time_since_epoch();
    if (impl_->backends.clock != nullptr) pair->delay = impl_->backends.clock->now() - *pair->taken;
  }
  ++impl_->counters.pairs;
  if (impl_->reach_open && !pair->depth.empty()) impl_->checkReach(pair->depth);
  if (!pair->matched && impl_->key_step == Duration(0)) ++impl_->counters.mismatched;
  if (impl_->info.has_depth && !impl_->info.depth_from_views && pair->depth.empty()) ++impl_->counters.without_depth;
  return std::move(*pair);
}

Result<void> PairReader::seek(MediaTime target, Duration key_step) {
  if (!impl_->color_reader) return fail(ErrorCode::InvalidState, kNotOpen);
  if (auto sought = impl_->color_reader->seek(target, key_step); !sought) {
    return impl_->failOn(impl_->options.url, sought.error());
  }
  impl_->color_ahead.clear();
  impl_->last_color = impl_->last_pair = std::nullopt;
  impl_->key_step = key_step;
  if (auto sought = impl_->seekDepth(target); !sought) return sought;
  return impl_->passTo(target);
}

bool PairReader::isSourceLost(const Error& error) const noexcept {
  return impl_->isLoss(error) && impl_->failed_thing == impl_->options.url;
}

Result<void> PairReader::reopen() {
  Impl& film = *impl_;
  if (!film.color_reader) return fail(ErrorCode::InvalidState, kNotOpen);
  film.leaveColor();
  film.color_shift = Duration(0);
  if (auto opened = film.openFilm(); !opened) return opened;
  ++film.counters.reconnects;
  if (!film.live) return film.goOn();
  film.color_shift = film.goes_on_at - film.color_ahead.front().pts;
  for (Frame& frame : film.color_ahead) frame.pts += film.color_shift;
  film.own.session.reset();  // because the colour's shift has changed
  return {};
}

// The next sound, with the film's timestamp.
std::optional<AudioChunk> PairReader::nextSound() {
  auto chunk = impl_->color_reader ? impl_->color_reader->nextSound() : std::nullopt;
  if (chunk) chunk->pts += impl_->color_shift;
  return chunk;
}

std::optional<Subtitle> PairReader::nextSubtitle() {
  if (!impl_->words_ahead.empty()) {
    std::optional<Subtitle> subtitle(std::move(impl_->words_ahead.front()));
    impl_->words_ahead.pop_front();
    return subtitle;
  }
  auto subtitle = impl_->color_reader ? impl_->color_reader->nextWords() : std::nullopt;
  if (!subtitle) return subtitle;
  subtitle->begin += impl_->color_shift;
  if (subtitle->end) *subtitle->end += impl_->color_shift;
  return subtitle;
}

void PairReader::chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words) {
  if (!impl_->color_reader) return;
  if (std::exchange(impl_->info.sound, sound) != sound) impl_->openSound();
  if (std::exchange(impl_->info.words, words) != words) impl_->openWords();
}

bool PairReader::readAhead() {
  return impl_->color_reader && impl_->color_reader->readAhead();
}

void PairReader::close() noexcept {
  Impl& film = *impl_;
  film.depth.reset();
  film.material.reset();
  film.material_refused = nullptr;
  film.registrar.reset();
  film.depth_track.reset();
  film.depth_stream = nullptr;
  film.reordering = {};
  film.own = {};
  film.color_ahead.clear();
  film.words_ahead.clear();
  film.color_shift = Duration(0);
  film.goes_on_at = MediaTime{};
  film.remote = film.live = false;
  film.counters = {};
  film.key_step = Duration(0);
  film.leaves_out = false;
  film.last_color = film.last_pair = std::nullopt;
  film.reach_open = false;
  film.info = {};
  std::unique_ptr<DepthSource> depth_source;  // destroyed outside the lock, because that joins its thread
  const std::scoped_lock lock(film.readers_mutex);
  film.color_reader.reset();
  depth_source.swap(film.depth_source);
}

void PairReader::interrupt() noexcept {
  const std::scoped_lock lock(impl_->readers_mutex);
  impl_->interrupted = true;
  if (impl_->color_reader) impl_->color_reader->interrupt();
  if (impl_->depth_source) impl_->depth_source->interrupt();
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
  if (impl_->color_reader) {
    counters.damaged += impl_->color_reader->damaged();
    counters.deinterlaced += impl_->color_reader->deinterlaced();
    counters.jumps += impl_->color_reader->source().jumps();
    counters.missed_pictures += impl_->color_reader->source().missedPictures();
    counters.missing = impl_->color_reader->source().missing();
  }
  if (impl_->depth_source) {
    const DepthSource::Counters depth = impl_->depth_source->counters();
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
  auto restart = impl_->color_reader ? impl_->color_reader->takeRestart() : std::nullopt;
  return restart || !impl_->depth_source ? restart : impl_->depth_source->takeRestart();
}

std::optional<Error> PairReader::depthLoss() const noexcept {
  return impl_->depth_source ? impl_->depth_source->loss() : std::nullopt;
}

}  // namespace relievo
