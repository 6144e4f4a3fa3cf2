// SPDX-License-Identifier: Apache-2.0
// What went wrong with a network source: one sentence for each kind of failure.
#pragma once

#include <cstdarg>
#include <string>
#include <string_view>

#include "platform/error.h"

struct AVFormatContext;

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
  // Notes each warning of the demuxer from now on, except those that FFmpeg also prints for an undamaged film.
  void listenTo(const AVFormatContext& container) noexcept { container_ = &container; }
  // True if the demuxer has warned: it has skipped bytes, or a segment of a DASH film, whose opening cannot be seen
  // here.
  [[nodiscard]] bool containerWarned() const noexcept { return container_warned_; }

 private:
  static void keep(void* context, int level, const char* format, va_list arguments);

  const AVFormatContext* container_ = nullptr;
  std::string last_;
  bool container_warned_ = false;
};

// `code` is FFmpeg's, of opening a network source; `words` are the last that it logged.
[[nodiscard]] Error networkError(int code, std::string_view words) noexcept;

}  // namespace relievo::ffmpeg
