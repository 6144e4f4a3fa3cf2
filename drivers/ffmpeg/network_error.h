// SPDX-License-Identifier: Apache-2.0
// What went wrong with a network source: one sentence for each kind of failure.
#pragma once

#include <cstdarg>
#include <string>
#include <string_view>

#include "platform/error.h"

namespace relievo::ffmpeg {

// While one lives, keeps the last error line that FFmpeg logs on this thread. FFmpeg returns the same code for a name
// that cannot be resolved, a TLS that fails and a redirect without end; its words tell them apart.
class LibraryWords {
 public:
  LibraryWords() noexcept;
  ~LibraryWords();
  LibraryWords(const LibraryWords&) = delete;
  LibraryWords& operator=(const LibraryWords&) = delete;

  [[nodiscard]] const std::string& last() const noexcept { return last_; }
  // FFmpeg has left out a segment of a DASH film that it could not open. It opens them itself.
  [[nodiscard]] bool passedOver() const noexcept { return passed_over_; }

 private:
  static void keep(void* context, int level, const char* format, va_list arguments);

  std::string last_;
  bool passed_over_ = false;
};

// `code` is FFmpeg's, of opening a network source; `words` are the last that it logged.
[[nodiscard]] Error networkError(int code, std::string_view words) noexcept;

}  // namespace relievo::ffmpeg
