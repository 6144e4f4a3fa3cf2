// SPDX-License-Identifier: Apache-2.0
#include "app/player/views/relief_maker.h"

#include <sys/resource.h>

#include <algorithm>
#include <utility>

#include "platform/print.h"

namespace relievo {

ReliefMaker::ReliefMaker(std::unique_ptr<StereoMatcher> matcher, const Clock& clock)
    : matcher_(std::move(matcher)), clock_(clock) {}

ReliefMaker::~ReliefMaker() {
  stop();
}

void ReliefMaker::startThread() {
  if (canMake() && !thread_.joinable()) thread_ = std::thread([this] { threadMain(); });
}

void ReliefMaker::stop() noexcept {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    jobs_.clear();
    wake_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void ReliefMaker::begin(Duration period) {
  jump();
  const std::scoped_lock lock(mutex_);
  period_ = period;
  pace_ = ReliefPace(period);
  film_is_new_ = true;
  slowness_told_ = false;
  cautions_told_.clear();
  caution_.reset();
}

void ReliefMaker::end() {
  jump();
}

void ReliefMaker::jump() {
  const std::scoped_lock lock(mutex_);
  ++generation_;
  jobs_.clear();
  made_.clear();
  begins_shot_ = true;
  offered_.reset();
  last_.reset();
  shown_.reset();
}

void ReliefMaker::offer(const FramePair& pair) {
  const std::scoped_lock lock(mutex_);
  if (pair.right.empty() || (offered_ && pair.color.pts <= *offered_)) return;
  offered_ = pair.color.pts;
  jobs_.push_back({pair.color, pair.right});
  wake_.notify_all();
}

void ReliefMaker::passed(MediaTime shown) {
  const std::scoped_lock lock(mutex_);
  shown_ = shown;
  for (; hasJob() && jobs_.front().left.pts <= shown; jobs_.pop_front()) ++summary_.dropped;
}

std::optional<Frame> ReliefMaker::take() {
  const std::scoped_lock lock(mutex_);
  if (made_.empty()) return std::nullopt;
  std::optional<Frame> relief(std::move(made_.front()));
  made_.pop_front();
  return relief;
}

bool ReliefMaker::idle() const {
  const std::scoped_lock lock(mutex_);
  return !hasJob() && made_.empty() && !at_work_;
}

std::optional<std::string> ReliefMaker::takeSlowness() {
  const std::scoped_lock lock(mutex_);
  if (slowness_told_ || !pace_.isSlow()) return std::nullopt;
  slowness_told_ = true;
  return print(
      "this computer makes about %.0f reliefs a second from the film's two views, which has %.0f pictures a second",
      pace_.reliefsPerSecond(), 1 / toSeconds(period_));
}

std::optional<StereoMatcher::Caution> ReliefMaker::takeCaution() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(caution_, std::nullopt);
}

ReliefSummary ReliefMaker::summary() const {
  const std::scoped_lock lock(mutex_);
  return summary_;
}

// To space the reliefs evenly, the pictures between them get none; nor do those that would be shown before theirs is
// ready, since otherwise every following one would be late, too.
void ReliefMaker::dropUndue() {
  const auto drop = [this] {
    jobs_.pop_front();
    ++summary_.dropped;
  };
  const Duration cost = fromSeconds(pace_.meanSeconds());
  while (shown_ && jobs_.size() > 1 && jobs_.front().left.pts < *shown_ + cost + period_) drop();
  if (!last_) return;
  const MediaTime due = *last_ + period_ * pace_.stride() - period_ / 2;
  while (hasJob() && jobs_.front().left.pts < due) drop();
}

bool ReliefMaker::work() {
  std::unique_lock lock(mutex_);
  dropUndue();
  if (!hasJob() || stopping_) return false;
  const Job job = std::move(jobs_.front());
  jobs_.pop_front();
  const std::uint64_t generation = generation_;
  const bool first = std::exchange(film_is_new_, false), begins = std::exchange(begins_shot_, false);
  const Duration budget = pace_.budget();
  at_work_ = true;
  lock.unlock();
  if (begins) matcher_->beginShot();
  Frame relief = first ? makeFirst(job, budget) : Frame{};
  const MonotonicTime start = clock_.now();
  if (!first) relief = matcher_->depthOf(job.left, job.right);
  const Duration cost = clock_.now() - start;
  const StereoMatcher::Caution caution = matcher_->caution();
  lock.lock();
  at_work_ = false;
  if (generation != generation_) return true;  // another film, or elsewhere in it
  if (caution.what != nullptr && std::ranges::find(cautions_told_, caution.what) == cautions_told_.end()) {
    cautions_told_.push_back(caution.what);
    caution_ = caution;
  }
  last_ = relief.pts;
  made_.push_back(std::move(relief));
  ++summary_.made;
  if (first) return true;
  pace_.took(cost);
  adapt();
  summary_.mean_ms = 1e3 * pace_.meanSeconds();
  return true;
}

// At one size after another, until one takes too long.
Frame ReliefMaker::makeFirst(const Job& job, Duration budget) {
  const auto sizes = matcher_->sizes();
  Frame best;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    matcher_->setSize(sizes[i]);
    matcher_->beginShot();
    const MonotonicTime start = clock_.now();
    Frame relief = matcher_->depthOf(job.left, job.right);
    const bool late = clock_.now() - start > budget;
    if (late && i > 0) break;
    best = std::move(relief);
    chosen = i;
    if (late) break;
  }
  if (matcher_->size() != sizes[chosen]) {
    matcher_->setSize(sizes[chosen]);
    matcher_->beginShot();
    best = matcher_->depthOf(job.left, job.right);  // the next one goes on from it
  }
  const std::scoped_lock lock(mutex_);
  size_ = chosen;
  since_change_ = 0;
  summary_.cols = sizes[chosen];
  return best;
}

// The matcher takes up another size at the next cut.
void ReliefMaker::adapt() {
  constexpr int kPatience = 48;  // reliefs from one change to the next
  constexpr double kSpare = 0.25;
  const auto sizes = matcher_->sizes();
  summary_.cols = matcher_->size();
  if (summary_.cols != sizes[size_] || ++since_change_ < kPatience) return;
  const bool slow = pace_.isSlow(), spare = pace_.meanSeconds() < kSpare * toSeconds(pace_.budget());
  if (slow && size_ > 0) --size_;
  else if (spare && size_ + 1 < sizes.size()) ++size_;
  else return;
  since_change_ = 0;
  matcher_->setSize(sizes[size_]);
}

// This thread has a lower priority than those of picture, sound and finger.
void ReliefMaker::threadMain() {
  constexpr int kNice = 5;
  setpriority(PRIO_PROCESS, 0, kNice);  // of this thread alone
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || hasJob(); });
      if (stopping_) return;
    }
    work();
  }
}

}  // namespace relievo
