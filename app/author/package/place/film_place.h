// SPDX-License-Identifier: Apache-2.0
// The destination of a film with its muxer: a file, a folder of segments or a network address. Files appear whole or
// not at all.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

extern "C" {
#include <libavformat/avformat.h>
}

#include "app/author/package/film_kind.h"
#include "app/coding/video_encoder.h"
#include "platform/atomic_file.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

inline constexpr const char* kCannotWrite = "it cannot be written; is the disk full?";

// Order of calls: create, add tracks to `muxer` (first the colour, then the depth), begin, packets, finish. Without
// `finish` nothing is left behind. Use from one thread, except `write`, which any thread may call.
class FilmPlace {
 public:
  // Io or NotFound if nothing can be written there. No call waits longer than 10 s for the file system: Timeout. What
  // cancels the waits of the calling thread (CancelsAnswers) cancels all that follow.
  [[nodiscard]] static Result<std::unique_ptr<FilmPlace>> create(const std::string& path, FilmKind kind,
                                                                 Existing existing);
  virtual ~FilmPlace() = default;
  FilmPlace(const FilmPlace&) = delete;
  FilmPlace& operator=(const FilmPlace&) = delete;

  [[nodiscard]] AVFormatContext& muxer() noexcept { return *muxer_; }
  // Writes the header.
  [[nodiscard]] virtual Result<void> begin() = 0;
  // Takes a packet with its track and the track's times, and writes those that are due.
  [[nodiscard]] Result<void> write(AVPacket& packet);
  // Writes the end and moves the film to its final name; returns its size in bytes.
  [[nodiscard]] virtual Result<std::uint64_t> finish() = 0;
  // The largest delay of a packet sent over the network.
  [[nodiscard]] virtual Duration latest() const noexcept { return Duration(0); }

 protected:
  FilmPlace() = default;
  [[nodiscard]] Result<void> makeMuxer(const char* format, const std::string& url);
  // Takes ownership of the options.
  [[nodiscard]] Result<void> writeHeader(AVDictionary* options);
  // What went wrong when FFmpeg failed with this code.
  [[nodiscard]] Error failureOf(int code);
  // The error of the file being written; nullopt if there is none, or if the film is not a file.
  [[nodiscard]] virtual std::optional<Error> fileError() { return std::nullopt; }
  // The message for a failure for which the file gives no reason.
  [[nodiscard]] virtual const char* usualFailure() const noexcept { return kCannotWrite; }

 private:
  struct Free {
    void operator()(AVFormatContext* muxer) const noexcept { avformat_free_context(muxer); }
  };
  std::unique_ptr<AVFormatContext, Free> muxer_;
  std::mutex writing_;
};

[[nodiscard]] Result<std::unique_ptr<FilmPlace>> makeTransportStream(const std::string& path, bool live,
                                                                     Existing existing);
[[nodiscard]] Result<std::unique_ptr<FilmPlace>> makeHlsFolder(const std::string& path, Existing existing);

}  // namespace relievo
