// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "drivers/ffmpeg/address.h"
#include "drivers/ffmpeg/refusal.h"
#include "platform/files/file_system_answer.h"

namespace relievo::ffmpeg {
namespace {

using Steady = std::chrono::steady_clock;

constexpr auto kLook = std::chrono::milliseconds(10);    // between looks at what may interrupt
constexpr auto kGrace = std::chrono::milliseconds(200);  // in which FFmpeg usually ends when it is told to
constexpr int kMostLeft = 8;                             // as in kTooManyLeft
constexpr Error kTooManyLeft{
    ErrorCode::Exhausted, 0,
    "8 films that were given up are still being opened, and nothing can end that; wait, or start the program again"};

std::atomic<int> left_behind = 0;  // openings that still run, and that nobody waits for

struct Call {
  const std::shared_ptr<Input> input;
  std::mutex mutex;
  std::condition_variable ended;
  std::optional<Result<Input::Opened>> opened;
  bool left = false;
};

Result<Input::Opened> openKept(const std::shared_ptr<Input>& input, const std::string& url) {
  auto opened = input->open(url);
  if (opened) opened->container.get_deleter().input = input;
  return opened;
}

void run(Call& call, const std::string& url) {
  const CancelsAnswers cancels(call.input->watch().cancelFlag());
  auto opened = openKept(call.input, url);
  const std::scoped_lock lock(call.mutex);
  call.opened = std::move(opened);
  if (call.left) --left_behind;
  call.ended.notify_one();
}

// What ends the calling thread's questions ends the opening.
void passOn(Watch& watch) {
  const std::atomic<bool>* const flag = CancelsAnswers::flag();
  if (flag != nullptr && *flag) watch.cancel();
}

// False: it does not end in time.
bool hasEnded(Call& call) {
  Watch& watch = call.input->watch();
  std::optional<Steady::time_point> told;
  std::unique_lock lock(call.mutex);
  while (!call.opened && (!told || Steady::now() < *told + kGrace)) {
    call.ended.wait_for(lock, kLook);
    passOn(watch);
    if (!watch.givesUp()) told.reset();
    else if (!told) told = Steady::now();
  }
  call.left = !call.opened;
  if (call.left) ++left_behind;
  return !call.left;
}

Result<Input::Opened> openApart(const std::shared_ptr<Input>& input, const std::string& url) {
  if (left_behind >= kMostLeft) return std::unexpected(kTooManyLeft);
  input->watch().begin(kOpenPatience);
  passOn(input->watch());  // a short film would be open before the first look
  const auto call = std::make_shared<Call>(input);
  try {
    std::thread([call, url] { run(*call, url); }).detach();
  } catch (const std::system_error&) {  // no more threads
    return openKept(input, url);
  }
  if (hasEnded(*call)) return std::move(*call->opened);
  const bool interrupted = input->watch().cancelled();
  input->watch().cancel();
  const auto address = parseAddress(url);
  return std::unexpected(interrupted || !address ? kInterruptedWait : lateOpening(address->way));
}

}  // namespace

Result<Input::Opened> Opener::open(const std::string& url) {
  const auto input = std::make_shared<Input>();
  watch(input);
  if (input_->watch().cancelled()) input->watch().cancel();
  auto opened = openApart(input, url);
  if (opened) {
    input_ = input;
    return opened;
  }
  if (opened.error().code == ErrorCode::Cancelled) input_->watch().cancel();
  watch(input_);
  return opened;
}

void Opener::interrupt() noexcept {
  const std::scoped_lock lock(mutex_);
  interrupted_ = true;
  watched_->watch().cancel();
}

void Opener::forgive() {
  input_ = std::make_shared<Input>();
  const std::scoped_lock lock(mutex_);
  interrupted_ = false;
  watched_ = input_;
}

void Opener::watch(const std::shared_ptr<Input>& input) noexcept {
  const std::scoped_lock lock(mutex_);
  watched_ = input;
  if (interrupted_) input->watch().cancel();
}

}  // namespace relievo::ffmpeg
