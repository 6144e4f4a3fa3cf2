// SPDX-License-Identifier: Apache-2.0
// Where a film goes: a file, a folder of segments or a line, each with its muxer; whole or not at all where it stays.
#pragma once

#include <cstdint>
#include <memory>
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

// create -> tracks are added to `muxer`, the colour first, then the depth -> begin -> packets -> finish. Without
// `finish` nothing is left. One thread.
class FilmPlace {
 public:
  // Io or NotFound where nothing can be written.
  [[nodiscard]] static Result<std::unique_ptr<FilmPlace>> create(const std::string& path, FilmKind kind,
                                                                 Existing existing);
  virtual ~FilmPlace() = default;
  FilmPlace(const FilmPlace&) = delete;
  FilmPlace& operator=(const FilmPlace&) = delete;

  [[nodiscard]] AVFormatContext& muxer() noexcept { return *muxer_; }
  // Writes the header.
  [[nodiscard]] virtual Result<void> begin() = 0;
  // Writes the end and puts the film into its place; how many bytes it has.
  [[nodiscard]] virtual Result<std::uint64_t> finish() = 0;
  // How late packets went out at most, on a line.
  [[nodiscard]] virtual Duration latest() const noexcept { return Duration(0); }

 protected:
  FilmPlace() = default;
  [[nodiscard]] Result<void> makeMuxer(const char* format, const std::string& url);
  // Takes the options over.
  [[nodiscard]] Result<void> writeHeader(AVDictionary* options);

 private:
  struct Free {
    void operator()(AVFormatContext* muxer) const noexcept { avformat_free_context(muxer); }
  };
  std::unique_ptr<AVFormatContext, Free> muxer_;
};

[[nodiscard]] Result<std::unique_ptr<FilmPlace>> makeTransportStream(const std::string& path, bool live,
                                                                     Existing existing);
[[nodiscard]] Result<std::unique_ptr<FilmPlace>> makeHlsFolder(const std::string& path, Existing existing);

}  // namespace relievo
