// SPDX-License-Identifier: Apache-2.0
// From the reader to the present picture, by the film's clock.
#include "app/player/film/film_playback.h"

#include <algorithm>
#include <utility>

#include "app/depth_window/surface_window.h"

namespace relievo {
namespace {

static_assert(Playhead::kAhead == SurfaceWindow::kAhead, "the window shows what the playhead buffers");
constexpr std::size_t kQueuedPairs = 4;  // beyond those that the playhead holds
constexpr Duration kUnknownPeriod = std::chrono::milliseconds(40);
constexpr Duration kSoundFirst = std::chrono::milliseconds(300);  // that must be buffered when the film starts
constexpr double kRushStepS = 0.1;  // of the machine's time, between two pictures at a rate over 1

}  // namespace

FilmPlayback::FilmPlayback(PairReader::Backends backends, AudioOutput* output, const Clock& clock, Journal& journal)
    : clock_source_(clock),
      own_threads_(backends.own_threads),
      feed_(std::move(backends), kQueuedPairs),
      reliefs_(makeQuickMatcher(), clock),
      sound_(output, clock),
      journal_(journal),
      notes_(journal) {}

void FilmPlayback::begin() {
  sound_.open();
  if (own_threads_) feed_.startThread();
}

void FilmPlayback::read() {
  while (!own_threads_ && feed_.work()) {
  }
  while (!own_threads_ && reliefs_.work()) {
  }
}

void FilmPlayback::stop() noexcept {
  reliefs_.stop();
  feed_.stop();
}

void FilmPlayback::open(SourceOptions source) {
  notes_.begin(source);
  sound_.beginFilm();
  source.sound = sound_.format();
  feed_.open(std::move(source));
}

void FilmPlayback::close(MonotonicTime now) {
  countPlayed(now);
  pairs_before_ += feed_.counters();
  feed_.close();
  clock_.reset();
  setRate(1, now);
  head_ = {};
  reliefs_.end();
  sound_.forget();
  info_ = {};
  pace_.forget();
  held_ = begun_ = sought_ = starved_ = false;
  decode_pace_ = {};
  stepped_ = 0;
  turn_ = 0;
  jumped_ = true;
  target_.reset();
  dry_since_.reset();
}

FilmPlayback::Opening FilmPlayback::opening() const {
  switch (feed_.state()) {
    case FilmFeed::State::Opening:
      return Opening::Waits;
    case FilmFeed::State::Listed:
      return Opening::IsList;
    case FilmFeed::State::Failed:
      return Opening::Failed;
    default:
      return Opening::Opened;
  }
}

const FilmInfo& FilmPlayback::opened() {
  info_ = feed_.info();
  if (info_.sounds.empty() && info_.sound_codec.empty()) sound_.rest();
  if (info_.depth_from_views) beginReliefs();
  notes_.opened(info_);
  return info_;
}

Duration FilmPlayback::period() const noexcept {
  return info_.frame_period > Duration(0) ? info_.frame_period : kUnknownPeriod;
}

bool FilmPlayback::isStill() const noexcept {
  return info_.frame_period == Duration(0) && info_.sound_codec.empty();
}

FilmPlayback::Progress FilmPlayback::overOrFailed() const {
  return feed_.state() == FilmFeed::State::Failed ? Progress::Failed : Progress::Over;
}

FilmPlayback::Progress FilmPlayback::filling() {
  head_.refill(feed_);
  followReliefs();
  const bool taken = !head_.ahead().empty() && head_.ahead().front().taken;
  if (taken && info_.sound_codec.empty() && rate_ == 1) return fillingLive();
  if (!head_.filled() && !head_.last()) return Progress::Goes;
  if (head_.ahead().empty()) return overOrFailed();
  if (!hasReliefs()) return Progress::Goes;
  const MediaTime from = std::max(head_.ahead().front().color.pts, target_.value_or(MediaTime{}));
  const bool sounds = rate_ != 1 || feed_.hasSoundUntil(from + kSoundFirst);
  return sounds ? Progress::Ready : Progress::Goes;
}

void FilmPlayback::turn(int quarters) {
  turn_ = (turn_ + quarters) & 3;
  feed_.turn(turn_);
  head_.turn(turn_);
  jumped_ = true;
}

bool FilmPlayback::takeFirst() {
  head_.begin();
  return !std::exchange(begun_, true);
}

Result<void> FilmPlayback::start(MonotonicTime now) {
  const MediaTime first = std::max(picture().color.pts, target_.value_or(MediaTime{}));
  starved_ = false;
  target_.reset();
  clock_.reset();
  clock_.start(isLive() ? pace_.wanted(now) : first, now);
  live_.begin(pace_.origin(), now);
  if (held_) return clock_.pause(now);
  played_.begin(first);
  followSound(true);  // behind the last picture only sound is left: it must be under way before `going` looks for it
  return {};
}

std::size_t FilmPlayback::advance(MonotonicTime now) {
  const std::size_t stepped = std::exchange(stepped_, 0);
  if (isLive()) return stepped + advanceLive(now);
  followReliefs();
  const std::size_t pictures = head_.advance(clock_.position(now).value_or(MediaTime{}), feed_);
  if (pictures > 0) reliefs_.passed(picture().color.pts);
  followDecoder(now);
  return stepped + pictures;
}

void FilmPlayback::seek(MediaTime target, MonotonicTime now) {
  countPlayed(now);
  clock_.reset();
  head_.clear();
  decode_pace_.pause();
  reliefs_.jump();
  sound_.forget();
  target_ = target;
  feed_.seek(target, rushes() ? fromSeconds(kRushStepS * rate_) : Duration(0));
  jumped_ = sought_ = true;
}

// A seek may land within a picture, which then counts as damaged.
std::vector<LostPart> FilmPlayback::noteMissing() {
  std::vector<LostPart> parts = notes_.missing(feed_.counters());
  if (sought_) std::erase_if(parts, [](const LostPart& part) { return part.damaged > 0; });
  return parts;
}

bool FilmPlayback::arriving(MonotonicTime now) {
  if (feed_.state() == FilmFeed::State::Seeking) return false;
  if (const auto refused = feed_.takeSeekError()) {
    notes_.refused(*refused);
    target_.reset();
    setRate(1, now);
  }
  return true;
}

// After a refused seek a film reads on from its end.
bool FilmPlayback::gaveNone(MonotonicTime now) const {
  const bool from_begin = target_.value_or(MediaTime{}) == MediaTime{} && !refusesSeeks();
  return from_begin && !clock_.position(now);
}

Result<void> FilmPlayback::pause(MonotonicTime now) {
  held_ = true;
  countPlayed(now);
  return clock_.pause(now);
}

Result<void> FilmPlayback::resume(MonotonicTime now) {
  held_ = false;
  auto resumed = clock_.resume(now);
  if (const auto here = clock_.position(now)) played_.begin(*here);
  followSound(true);  // as in `start`
  return resumed;
}

void FilmPlayback::stepOn(MonotonicTime now) {
  head_.refill(feed_);
  if (head_.ahead().empty()) return;
  head_.begin();
  ++stepped_;
  clock_.start(picture().color.pts, now);  // stays paused
}

void FilmPlayback::setRate(double rate, MonotonicTime now) {
  rate_ = rate;
  static_cast<void>(clock_.setRate(rate, now));  // the clock accepts all rates of the player
}

void FilmPlayback::countPlayed(MonotonicTime now) {
  const auto here = clock_.position(now);
  const MediaTime end = picture().color.pts + period();
  const bool last = head_.last() && head_.ahead().empty();
  played_.end(here ? std::optional(std::min(*here, last ? std::max(end, sound_.end()) : end)) : std::nullopt);
}

void FilmPlayback::followSound(bool playing) {
  sound_.follow(playing && rate_ == 1, clock_, feed_);
  if (const auto news = sound_.takeNews()) journal_.note(news->what, news->done);
}

void FilmPlayback::noteShown() {
  shown_color_ = head_.colors();
  sound_.noteShown(picture().color.pts, clock_);
  noteLiveShown();
}

MonotonicTime FilmPlayback::nextPicture(MonotonicTime now) const {
  const auto sample = clock_.sample();
  const bool over = head_.last() && head_.ahead().empty();
  if (!sample || sample->rate <= 0 || starved_ || over) return MonotonicTime::max();
  if (head_.ahead().empty()) return isLive() ? std::max(pace_.next(), now) : now + period();
  return sample->when(head_.ahead().front().color.pts - (isLive() ? kMostBehind : Duration(0)));
}

// While the picture has stopped for lack of the next one, the clock runs on, so that the force fades.
std::optional<MediaTime> FilmPlayback::place(MonotonicTime now) const {
  const auto position = clock_.position(now);
  return position && starved_ ? picture().color.pts : position;
}

MediaTime FilmPlayback::goal(MonotonicTime now) const {
  return target_ ? *target_ : place(now).value_or(MediaTime{});
}

void FilmPlayback::chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words) {
  info_.sound = sound;
  info_.words = words;
  sound_.forget();
  feed_.chooseTracks(sound, words);
}

MediaTime FilmPlayback::bufferedUntil() const {
  return head_.ahead().empty() ? picture().color.pts : head_.ahead().back().color.pts;
}

std::optional<MediaTime> FilmPlayback::placeToKeep(MonotonicTime now) const {
  return target_ || info_.duration <= Duration(0) ? std::nullopt : place(now);
}

void FilmPlayback::noteNews() {
  while (const auto news = feed_.takeNews()) {
    if (news->kind == FilmFeed::News::Kind::ColorBack) jumped_ = true;  // in case the picture had stopped meanwhile
    notes_.happened(*news, info_);
    if (news->kind == FilmFeed::News::Kind::WordsRefused && info_.words == news->track) {
      info_.words.reset();
      journal_.filmIs(info_);
    }
  }
}

PairCounters FilmPlayback::pairs() const {
  PairCounters pairs = pairs_before_;
  if (isOpen()) pairs += feed_.counters();
  return pairs;
}

}  // namespace relievo
