// SPDX-License-Identifier: Apache-2.0
// Reads depth, notices its loss and reopens the source, on the caller's thread or on its own.
#include "app/media/depth_source.h"

#include <utility>

namespace relievo {
namespace {

constexpr std::size_t kQueued = 8;  // pictures read ahead
constexpr Duration kPatience = std::chrono::milliseconds(250);
constexpr Duration kWarmUp = std::chrono::seconds(5);

}  // namespace

DepthSource::~DepthSource() {
  if (!thread_.joinable()) return;
  {
    std::unique_lock lock(mutex_);
    // Repeated, because an interrupt that arrives just before the thread opens the source has no effect.
    while (!thread_ended_) {
      lock.unlock();
      interrupt();
      lock.lock();
      ready_.wait_for(lock, std::chrono::milliseconds(10), [this] { return thread_ended_; });
    }
  }
  thread_.join();
}

Result<void> DepthSource::open(const std::string& url) {
  url_ = url;
  if (auto connected = connect(); !connected) return connected;
  const MediaSource& source = reader_->source();
  facts_.stream = *findDepthTrack(source);
  facts_.tags = source.tags();
  facts_.notes = source.notes();
  reopens_ = source.remote() && backends_.clock != nullptr;
  if (reopens_ && backends_.own_threads) thread_ = std::thread([this] { threadMain(); });
  return {};
}

Result<void> DepthSource::connect() {
  auto reader = std::make_unique<TrackReader>(backends_.make_source(url_), backends_.make_decoder);
  {
    const std::scoped_lock lock(mutex_);
    if (interrupted_) return fail(ErrorCode::Cancelled, "interrupted before it was opened");
    reader_.swap(reader);
  }
  reader.reset();
  if (auto opened = reader_->open(url_, frames_per_s_); !opened) return opened;
  const MediaSource& source = reader_->source();
  const StreamInfo* const stream = findDepthTrack(source);
  if (stream == nullptr) return fail(ErrorCode::NotFound, "it has no video track; check the file");
  StreamInfo told = *stream;
  if (frames_per_s_ && stream->counted) told.frame_period = fromSeconds(1 / *frames_per_s_);
  const auto track = reader_->select(told);
  if (!track) return std::unexpected(track.error());
  track_ = *track;
  facts_.decoder = reader_->decoder(track_);
  const std::scoped_lock lock(mutex_);
  session_ = {session_.number + 1,  source.live(),       source.arrival(),
              source.senderStart(), source.namedStart(), source.duration()};
  return {};
}

Result<DepthSource::Given> DepthSource::next() {
  if (!thread_.joinable()) return nextHere();
  std::unique_lock lock(mutex_);
  if (!late_) {
    ready_.wait_for(lock, warming_up_ ? kWarmUp : kPatience,
                    [this] { return !queue_.empty() || ended_ || loss_ || interrupted_; });
  }
  if (interrupted_) return fail(ErrorCode::Cancelled, "interrupted while waiting for the depth");
  late_ = queue_.empty();
  if (queue_.empty()) return Given{.session = session_, .ended = ended_, .away = !ended_};
  warming_up_ = false;
  Given given = std::move(queue_.front());
  queue_.pop_front();
  wake_.notify_all();
  return given;
}

Result<DepthSource::Given> DepthSource::nextHere() {
  std::unique_lock lock(mutex_);
  if (loss_) findAgain(lock);
  if (!loss_) readOne(lock);
  if (loss_ && (!reopens_ || loss_->code == ErrorCode::Cancelled)) {
    return std::unexpected(*std::exchange(loss_, std::nullopt));
  }
  if (queue_.empty()) return Given{.session = session_, .ended = ended_, .away = !ended_};
  Given given = std::move(queue_.front());
  queue_.pop_front();
  return given;
}

Result<void> DepthSource::seek(MediaTime target, Duration key_step) {
  std::unique_lock lock(mutex_);
  queue_.clear();
  goes_on_at_ = target;
  seek_.key_step = key_step;
  ended_ = late_ = false;
  warming_up_ = true;
  if (thread_.joinable()) {
    seek_.target = target;
    ++seek_.number;
    wake_.notify_all();
    return {};
  }
  if (loss_) return {};  // the reopening will seek to the target
  lock.unlock();
  return reader_->seek(target, key_step);
}

void DepthSource::interrupt() noexcept {
  const std::scoped_lock lock(mutex_);
  interrupted_ = true;
  if (reader_) reader_->interrupt();
  wake_.notify_all();
  ready_.notify_all();
}

std::optional<Error> DepthSource::loss() const {
  const std::scoped_lock lock(mutex_);
  return reopens_ ? loss_ : std::nullopt;
}

DepthSource::Counters DepthSource::counters() const {
  const std::scoped_lock lock(mutex_);
  return counters_;
}

std::optional<VideoDecoder::Restart> DepthSource::takeRestart() noexcept {
  const std::scoped_lock lock(mutex_);
  return std::exchange(restart_, std::nullopt);
}

void DepthSource::threadMain() {
  std::unique_lock lock(mutex_);
  while (!interrupted_) {
    if (loss_) {
      wake_.wait_for(lock, back_off_.next() - backends_.clock->now(), [this] { return interrupted_; });
    } else {
      wake_.wait(lock, [this] { return interrupted_ || seek_.target || (!ended_ && queue_.size() < kQueued); });
    }
    if (!interrupted_) work(lock);
  }
  thread_ended_ = true;
  ready_.notify_all();
}

void DepthSource::work(std::unique_lock<std::mutex>& lock) {
  if (loss_) return findAgain(lock);
  if (!seek_.target) return readOne(lock);
  const MediaTime target = *std::exchange(seek_.target, std::nullopt);
  const Duration key_step = seek_.key_step;
  lock.unlock();
  const auto sought = reader_->seek(target, key_step);
  lock.lock();
  if (!sought) lose(sought.error());
}

void DepthSource::readOne(std::unique_lock<std::mutex>& lock) {
  const std::uint64_t generation = seek_.number;
  lock.unlock();
  auto frame = reader_->next(track_);
  const bool ended = reader_->ended(track_);
  lock.lock();
  count();
  if (auto restart = reader_->takeRestart()) restart_ = restart;
  if (generation != seek_.number) return;  // a seek has happened meanwhile
  if (!frame) return lose(frame.error());
  if (*frame) goes_on_at_ = (*frame)->pts;
  ended_ = !*frame && ended;
  if (*frame) queue_.push_back({.frame = std::move(**frame), .session = session_});
  ready_.notify_all();
}

void DepthSource::findAgain(std::unique_lock<std::mutex>& lock) {
  if (!reopens_ || backends_.clock->now() < back_off_.next()) return;
  before_ = counters_;
  const MediaTime target = goes_on_at_;
  const Duration key_step = seek_.key_step;
  const std::uint64_t sought = seek_.number;
  lock.unlock();
  auto found = connect();
  if (found && !reader_->source().live()) found = reader_->seek(target, key_step);
  lock.lock();
  if (!found) return back_off_.failed(backends_.clock->now());
  loss_.reset();
  if (sought == seek_.number) seek_.target.reset();  // else a newer one is still to be carried out
  ++counters_.reconnects;
}

void DepthSource::lose(const Error& error) {
  loss_ = error;
  if (reopens_) back_off_.begin(backends_.clock->now());
  ready_.notify_all();
}

void DepthSource::count() {
  counters_.damaged = before_.damaged + reader_->damaged();
  counters_.deinterlaced = before_.deinterlaced + reader_->deinterlaced();
  counters_.jumps = before_.jumps + reader_->source().jumps();
  counters_.missed_pictures = before_.missed_pictures + reader_->source().missedPictures();
  counters_.missing = reader_->source().missing();
}

}  // namespace relievo
