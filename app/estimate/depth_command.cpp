// SPDX-License-Identifier: Apache-2.0
#include "app/estimate/depth_command.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::size_t kWaiting = 2;       // pictures that the command has not read
constexpr std::size_t kSaidBytes = 4096;  // of its messages
constexpr std::size_t kNamed = 60;        // letters of the command in a line
constexpr std::size_t kTold = 160;        // letters of its last message
constexpr int kPatienceToWords = 60;      // 5 s of 5 minutes
constexpr auto kLook = std::chrono::milliseconds(50);

constexpr Error kCancelled{ErrorCode::Cancelled, 0, "interrupted; nothing was written"};
constexpr Error kNotEach{ErrorCode::Corrupt, 0,
                         "it must write one depth picture of 16 bits for each picture that it reads"};
constexpr Error kTooMuch{ErrorCode::Corrupt, 0,
                         "it must write one depth picture of 16 bits for each picture; is its size that of "
                         "--depth-size?"};
constexpr Error kFailed{ErrorCode::Io, 0, "the depth command failed"};
constexpr Error kStalled{ErrorCode::Timeout, 0, "the depth command has stalled; it was ended"};
constexpr Error kTooLate{ErrorCode::Timeout, 0, "the depth command answers too late; it was ended"};

std::string named(const std::string& command) {
  return command.size() <= kNamed ? command : command.substr(0, kNamed - 2) + "..";
}

std::string lastLine(std::string text) {
  const char* const ends = "\r\n ";
  text.erase(std::min(text.find_last_not_of(ends) + 1, text.size()));
  const std::size_t before = text.find_last_of("\r\n");
  return text.substr(before == text.npos ? 0 : before + 1, kTold);
}

}  // namespace

Outcome<std::unique_ptr<DepthCommand>> DepthCommand::start(Setup setup, const std::atomic<bool>& stop) {
  UniqueFd wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!wake.valid())
    return failOn(setup.command,
                  {ErrorCode::Exhausted, errno, "no file descriptor is left for it; close other programs"});
  auto child =
      ChildProcess::start(setup.command, {print("RELIEVO_WIDTH=%d", setup.cols), print("RELIEVO_HEIGHT=%d", setup.rows),
                                          print("RELIEVO_DEPTH_WIDTH=%d", setup.depth_cols),
                                          print("RELIEVO_DEPTH_HEIGHT=%d", setup.depth_rows)});
  if (!child) return failOn(setup.command, child.error());
  return std::unique_ptr<DepthCommand>(new DepthCommand(std::move(setup), std::move(*child), std::move(wake), stop));
}

DepthCommand::DepthCommand(Setup setup, ChildProcess child, UniqueFd wake, const std::atomic<bool>& stop)
    : setup_(std::move(setup)),
      stop_(stop),
      child_(std::move(child)),
      wake_(std::move(wake)),
      last_moved_(std::chrono::steady_clock::now()),
      thread_([this](const std::stop_token& done) { serve(done); }) {}

DepthCommand::~DepthCommand() {
  thread_.request_stop();
  wakeServer();
}

Outcome<void> DepthCommand::give(RawPicture picture) {
  Lock lock(mutex_);
  auto room = waitFor(lock, [&] { return waiting_.size() < kWaiting && given_ - answered_ < kMostLate; });
  if (!room) return room;
  waiting_.push_back(std::move(picture));
  ++given_;
  wakeServer();
  return {};
}

void DepthCommand::end() {
  const Lock lock(mutex_);
  no_more_ = true;
  wakeServer();
}

Outcome<std::optional<DepthEstimate>> DepthCommand::take() {
  Lock lock(mutex_);
  if (no_more_ && answered_ < given_) {
    if (auto there = waitFor(lock, [&] { return !answers_.empty(); }); !there) return std::unexpected(there.error());
  }
  if (!answers_.empty()) {
    std::optional<DepthEstimate> answer(std::move(answers_.front()));
    answers_.pop_front();
    return answer;
  }
  if (no_more_) {
    if (auto ended = checkEnd(lock); !ended) return std::unexpected(ended.error());
  }
  return std::nullopt;
}

void DepthCommand::wakeServer() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_.get(), &one, sizeof one);
}

template <class Ready>
Outcome<void> DepthCommand::waitFor(Lock& lock, Ready ready) {
  while (!ready()) {
    if (stop_.load(std::memory_order_relaxed)) return failOn(setup_.command, kCancelled);
    if (too_much_) return failed("wrote more than was asked for", kTooMuch);
    if (output_ended_) return endedEarly(lock);
    if (isSilent()) {
      const bool late = given_ - answered_ >= kMostLate && waiting_.empty();
      const auto seconds = std::chrono::duration<double>(setup_.patience).count();
      return late ? failed(print("has read %zu pictures more than it has answered", given_ - answered_), kTooLate)
                  : failed(print("has read and written nothing for %g s", seconds), kStalled);
    }
    moved_.wait_for(lock, kLook);
  }
  return {};
}

// True when the patience is over. Long before, it is told once what is waited for.
bool DepthCommand::isSilent() {
  const auto silence = std::chrono::steady_clock::now() - last_moved_;
  if (silence > setup_.patience / kPatienceToWords && !std::exchange(told_, true)) {
    log(LogLevel::Warning, "media", "waiting for \"%s\", which reads and writes nothing (up to %g s)",
        named(setup_.command).c_str(), std::chrono::duration<double>(setup_.patience).count());
  }
  return silence > setup_.patience;
}

// After the last answer the command must write nothing more and exit with 0.
Outcome<void> DepthCommand::checkEnd(Lock& lock) {
  while (!output_ended_ || !child_.end()) {
    if (too_much_) return failed("wrote more than was asked for", kTooMuch);
    if (stop_.load(std::memory_order_relaxed)) return failOn(setup_.command, kCancelled);
    if (isSilent()) {
      return failed("does not end after its last picture", kStalled);
    }
    moved_.wait_for(lock, kLook);
  }
  const auto end = *child_.end();
  if (end.by_signal) return failed(print("was ended by signal %d", end.number), kFailed);
  if (end.number != 0) return failed(print("ended with exit code %d", end.number), kFailed);
  return {};
}

// Its output has ended before its time; its exit code follows soon.
std::unexpected<Failure> DepthCommand::endedEarly(Lock& lock) {
  for (int looks = 0; looks < 40 && !child_.end(); ++looks) moved_.wait_for(lock, kLook);
  const auto end = child_.end();
  const std::string how = !end             ? "closed its output"
                          : end->by_signal ? print("was ended by signal %d", end->number)
                                           : print("ended with exit code %d", end->number);
  const std::string part = part_bytes_ == 0 ? "" : print(" and %zu of %zu bytes", part_bytes_, depthBytes());
  return failed(how + print(" after %zu depth pictures", answered_) + part, kNotEach);
}

std::unexpected<Failure> DepthCommand::failed(const std::string& what, const Error& error) const {
  const std::string words = lastLine(said_);
  return failOn(named(setup_.command) + ": " + what + (words.empty() ? "" : " (" + words + ")"), error);
}

std::size_t DepthCommand::depthBytes() const noexcept {
  return 2 * static_cast<std::size_t>(setup_.depth_cols) * static_cast<std::size_t>(setup_.depth_rows);
}

void DepthCommand::serve(const std::stop_token& done) {
  sigset_t broken_pipe;
  sigemptyset(&broken_pipe);
  sigaddset(&broken_pipe, SIGPIPE);
  ::pthread_sigmask(SIG_BLOCK, &broken_pipe, nullptr);  // a write then fails instead
  while (!done.stop_requested()) {
    const RawPicture* const next = nextToWrite();
    std::array<pollfd, 4> files{pollfd{next != nullptr ? child_.input.get() : -1, POLLOUT, 0},
                                pollfd{too_much_ ? -1 : child_.output.get(), POLLIN, 0},
                                pollfd{child_.messages.get(), POLLIN, 0}, pollfd{wake_.get(), POLLIN, 0}};
    ::poll(files.data(), files.size(), -1);
    if (files[2].revents != 0) listenSome();
    if (files[1].revents != 0) readSome();
    if (files[0].revents != 0) writeSome(*next);
    std::uint64_t count = 0;
    if (files[3].revents != 0 && ::read(wake_.get(), &count, sizeof count) < 0) continue;
    moved_.notify_all();
  }
}

// Valid until this thread has written it. After the last one the command's input ends.
const RawPicture* DepthCommand::nextToWrite() {
  const Lock lock(mutex_);
  if (!waiting_.empty()) return &waiting_.front();
  if (no_more_) child_.input.reset();
  return nullptr;
}

void DepthCommand::writeSome(const RawPicture& picture) {
  const auto& bytes = picture.bytes;
  const ssize_t n = ::write(child_.input.get(), bytes.data() + written_, bytes.size() - written_);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
  const Lock lock(mutex_);
  if (n < 0) {  // it has stopped reading; its output says why
    child_.input.reset();
    waiting_.clear();
    written_ = 0;
    return;
  }
  last_moved_ = std::chrono::steady_clock::now();
  written_ += static_cast<std::size_t>(n);
  if (written_ < bytes.size()) return;
  waiting_.pop_front();
  written_ = 0;
}

void DepthCommand::readSome() {
  part_.resize(depthBytes());
  const ssize_t n = ::read(child_.output.get(), part_.data() + part_bytes_, part_.size() - part_bytes_);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (n <= 0) child_.output.reset();
  const Lock lock(mutex_);
  output_ended_ = n <= 0;
  if (output_ended_) return;
  last_moved_ = std::chrono::steady_clock::now();
  part_bytes_ += static_cast<std::size_t>(n);
  too_much_ = answered_ == given_;
  if (too_much_ || part_bytes_ < part_.size()) return;
  DepthEstimate answer{setup_.depth_cols, setup_.depth_rows, {}};
  answer.values.reserve(part_.size() / 2);
  for (std::size_t i = 0; i < part_.size(); i += 2) {
    answer.values.push_back(static_cast<float>(part_[i] | part_[i + 1] << 8));
  }
  answers_.push_back(std::move(answer));
  part_bytes_ = 0;
  ++answered_;
}

void DepthCommand::listenSome() {
  std::array<char, 1024> heard{};
  const ssize_t n = ::read(child_.messages.get(), heard.data(), heard.size());
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (n <= 0) return child_.messages.reset();
  const Lock lock(mutex_);
  said_.append(heard.data(), static_cast<std::size_t>(n));
  if (said_.size() > kSaidBytes) said_.erase(0, said_.size() - kSaidBytes);
}

}  // namespace relievo
