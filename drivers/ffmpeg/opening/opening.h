// SPDX-License-Identifier: Apache-2.0
// Opens inputs on threads of their own, which are left behind if they do not end in time.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "drivers/ffmpeg/input.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

// Each input is opened apart (apart.h): `open` fails at the latest a moment after its time-out or an interrupt.
// Exhausted if too many are left behind. All calls on one thread, except `interrupt`.
class Opener {
 public:
  // Lets go of the input, and of an interrupt. Its container must be closed.
  void forgive();
  // What CancelsAnswers of the calling thread has interrupts it, too. If it fails, the input stays as it was.
  // `parts_from`: see Input. `like`: it fails also if its streams are not of the same kinds in the same order.
  [[nodiscard]] Result<Input::Opened> open(const std::string& url, Duration parts_from = Duration(0),
                                           const AVFormatContext* like = nullptr);
  // Of the container that was opened last, which keeps it.
  [[nodiscard]] Input& input() const noexcept { return *input_; }
  // Ends `open`, or whatever reads the container. Any thread.
  void interrupt() noexcept;

 private:
  // `interrupt` ends this one from now on, and at once if it was called before.
  void watch(const std::shared_ptr<Input>& input) noexcept;

  std::shared_ptr<Input> input_ = std::make_shared<Input>();
  std::mutex mutex_;                         // guards what follows
  std::shared_ptr<Input> watched_ = input_;  // what `interrupt` ends
  bool interrupted_ = false;                 // since `forgive`
};

}  // namespace relievo::ffmpeg
