// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening/apart.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "platform/files/file_system_answer.h"

namespace relievo::ffmpeg {
namespace {

using Steady = std::chrono::steady_clock;

constexpr auto kLook = std::chrono::milliseconds(10);    // between looks at what may interrupt
constexpr auto kGrace = std::chrono::milliseconds(200);  // in which FFmpeg usually ends when it is told to
constexpr int kMostLeft = 8;                             // as in kTooManyLeft
constexpr Error kTooManyLeft{ErrorCode::Exhausted, 0,
                             "8 films or lists that were given up are still being opened, and nothing can end that; "
                             "wait, or start the program again"};

std::atomic<int> left_behind = 0;  // threads that still run, and that nobody waits for

struct Call {
  explicit Call(std::function<void()> its_work) : work(std::move(its_work)) {}

  std::function<void()> work;
  std::mutex mutex;
  std::condition_variable has_ended;
  bool ended = false;
  bool left = false;
};

void run(Call& call) {
  call.work();
  const std::scoped_lock lock(call.mutex);
  call.ended = true;
  if (call.left) --left_behind;
  call.has_ended.notify_one();
}

// False: it does not end in time.
bool waitFor(Call& call, const std::function<bool()>& gives_up) {
  constexpr auto kNever = Steady::time_point::max();
  auto until = kNever;
  std::unique_lock lock(call.mutex);
  while (!call.ended && Steady::now() < until) {
    call.has_ended.wait_for(lock, kLook);
    until = gives_up() ? std::min(until, Steady::now() + kGrace) : kNever;
  }
  call.left = !call.ended;
  if (call.left) ++left_behind;
  return !call.left;
}

}  // namespace

Result<bool> runApart(std::function<void()> work, const std::function<bool()>& gives_up) {
  if (left_behind >= kMostLeft) return std::unexpected(kTooManyLeft);
  const auto call = std::make_shared<Call>(std::move(work));
  try {
    std::thread([call] { run(*call); }).detach();
  } catch (const std::system_error& error) {
    return fail(ErrorCode::Exhausted, kProcessLimit, error.code().value());
  }
  return waitFor(*call, gives_up);
}

}  // namespace relievo::ffmpeg
