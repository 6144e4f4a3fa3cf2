// SPDX-License-Identifier: Apache-2.0
// Hands each call to the part of the reader that does it.
#include "app/media/pair_reader.h"

#include <array>
#include <utility>

#include "app/media/pairs/pair_film.h"
#include "app/media/tracks/turned.h"

namespace relievo {
namespace {

constexpr const char* kNotOpen = "no film is open; open one first";

}  // namespace

void turnTo(FramePair& pair, int turn) noexcept {
  const int quarters = (turn - pair.turn) & 3;
  if (quarters == 0) return;
  const std::array frames{&pair.color, &pair.depth, &pair.right, &pair.material};
  std::array<Frame, frames.size()> all;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i]->empty()) continue;
    auto made = turned(*frames[i], quarters);
    if (!made) return;  // out of memory: colour and depth stay as they are, together
    all[i] = std::move(*made);
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i]->empty()) *frames[i] = std::move(all[i]);
  }
  pair.turn = turn;
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
  OpenFilm& film = impl_->film;
  film.sources.allow();
  film.failed_thing.clear();
  film.options = options;
  film.exchanged = false;
  auto opened = impl_->openFilm();
  if (opened && impl_->meaning.wantsExchange()) {
    close();
    film.exchanged = true;
    opened = impl_->openFilm();
  }
  if (!opened) close();
  return opened;
}

Result<std::optional<FramePair>> PairReader::next() {
  if (!impl_->film.sources.color()) return fail(ErrorCode::InvalidState, kNotOpen);
  auto pair = impl_->supply.next();
  if (pair && *pair) impl_->meaning.checkReach((*pair)->depth);
  return pair;
}

Result<void> PairReader::seek(MediaTime target, Duration key_step) {
  if (!impl_->film.sources.color()) return fail(ErrorCode::InvalidState, kNotOpen);
  return impl_->supply.seek(target, key_step);
}

bool PairReader::isSourceLost(const Error& error) const noexcept {
  return impl_->film.isLoss(error) && impl_->film.failed_thing == impl_->film.options.url;
}

Result<void> PairReader::reopen() {
  if (!impl_->film.sources.color()) return fail(ErrorCode::InvalidState, kNotOpen);
  impl_->supply.leave();
  if (auto opened = impl_->openFilm(); !opened) return opened;
  return impl_->supply.goOn();
}

std::optional<AudioChunk> PairReader::nextSound() {
  return impl_->words.nextSound(impl_->supply.shift());
}

std::optional<Subtitle> PairReader::nextSubtitle() {
  return impl_->words.nextWords(impl_->supply.shift());
}

void PairReader::chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words) {
  OpenFilm& film = impl_->film;
  if (!film.sources.color()) return;
  if (std::exchange(film.info.sound, sound) != sound) impl_->words.openSound();
  if (std::exchange(film.info.words, words) != words) impl_->words.openWords();
}

void PairReader::setSoundFormat(const AudioFormat& format) {
  impl_->film.options.sound = format;
  if (impl_->film.sources.color()) impl_->words.openSound();
}

bool PairReader::readAhead() {
  return impl_->film.sources.color() && impl_->film.sources.color()->readAhead();
}

void PairReader::leaveOut(bool unreferenced, std::optional<MediaTime> until) {
  if (impl_->film.sources.color()) impl_->supply.leaveOut(unreferenced, until);
}

void PairReader::close() noexcept {
  impl_->close();
}

void PairReader::interrupt() noexcept {
  impl_->film.sources.interrupt();
}

bool PairReader::waitsForSource() const noexcept {
  return impl_->film.sources.waitsForColor(impl_->film.remote ? nullptr : impl_->film.backends.clock);
}

const FilmInfo& PairReader::info() const noexcept {
  return impl_->film.info;
}

const std::string& PairReader::failedThing() const noexcept {
  return impl_->film.failed_thing;
}

PairCounters PairReader::counters() const noexcept {
  return impl_->supply.counters();
}

std::optional<VideoDecoder::Restart> PairReader::takeRestart() noexcept {
  const OpenSources& sources = impl_->film.sources;
  auto restart = sources.color() ? sources.color()->takeRestart() : std::nullopt;
  return restart || !sources.depth() ? restart : sources.depth()->takeRestart();
}

std::optional<Error> PairReader::depthLoss() const noexcept {
  const DepthSource* const depth = impl_->film.sources.depth();
  return depth != nullptr ? depth->loss() : std::nullopt;
}

}  // namespace relievo
