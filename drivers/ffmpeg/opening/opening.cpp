// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening/opening.h"

#include <atomic>
#include <utility>

#include "drivers/ffmpeg/address.h"
#include "drivers/ffmpeg/opening/apart.h"
#include "drivers/ffmpeg/opening/memory.h"
#include "drivers/ffmpeg/opening/seeks.h"
#include "drivers/ffmpeg/refusal.h"
#include "platform/files/file_system_answer.h"

namespace relievo::ffmpeg {
namespace {

Result<Input::Opened> openKept(const std::shared_ptr<Input>& input, const std::string& url, Duration parts_from) {
  auto opened = input->open(url, parts_from);
  if (opened) opened->container.get_deleter().input = input;
  return opened;
}

constexpr const char* kOtherTracks =
    "the list has other tracks from there on, so it plays on from where it was; make it again with parts for the whole "
    "film in every list";

// What ends the calling thread's questions ends the opening.
void passOn(Watch& watch) {
  const std::atomic<bool>* const flag = CancelsAnswers::flag();
  if (flag != nullptr && *flag) watch.cancel();
}

Result<Input::Opened> openApart(const std::shared_ptr<Input>& input, const std::string& url, Duration parts_from) {
  input->watch().begin(kOpenPatience);
  passOn(input->watch());  // a short film would be open before the first look
  const auto opened = std::make_shared<Result<Input::Opened>>();
  const auto memory = std::make_shared<OpeningMemory>();
  const auto work = [input, url, parts_from, opened, memory] {
    const CancelsAnswers cancels(input->watch().cancelFlag());
    memory->begin();
    *opened = openKept(input, url, parts_from);
    if (memory->end()) *opened = std::unexpected(kTooMuchMemory);
  };
  const auto ended = runApart(work, [&watch = input->watch(), &memory] {
    passOn(watch);
    if (memory->exceeded()) watch.cancel();
    return watch.givesUp();
  });
  if (!ended) return std::unexpected(ended.error());
  if (!*ended && memory->end()) return std::unexpected(kTooMuchMemory);
  if (*ended) return std::move(*opened);
  const bool interrupted = input->watch().cancelled();
  input->watch().cancel();
  const auto address = parseAddress(url);
  return std::unexpected(interrupted || !address ? kInterruptedWait : lateOpening(address->way));
}

}  // namespace

Result<Input::Opened> Opener::open(const std::string& url, Duration parts_from, const AVFormatContext* like) {
  const auto input = std::make_shared<Input>();
  watch(input);
  if (input_->watch().cancelled()) input->watch().cancel();
  auto opened = openApart(input, url, parts_from);
  if (opened && like != nullptr && !haveSameStreams(*like, *opened->container)) {
    opened = fail(ErrorCode::Unsupported, kOtherTracks);
  }
  if (opened) {
    opened->container.get_deleter().user = std::make_unique<BlockUser>();
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
