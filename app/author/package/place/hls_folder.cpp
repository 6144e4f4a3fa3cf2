// SPDX-License-Identifier: Apache-2.0
// A playlist and its segments of fragmented MP4 (RFC 8216): written in a temporary folder, moved when complete.
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/author/package/place/film_io.h"
#include "app/author/package/place/film_place.h"
#include "platform/files/file_system_answer.h"
#include "platform/files/litter.h"
#include "platform/files/move.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr int kSegmentSeconds = 4;  // at least: each segment begins with a key frame

// The plain names that the muxer uses for any film. `openFile` maps them to the real paths.
constexpr const char* kPlaylist = "film.m3u8";
constexpr const char* kStart = "init.mp4";

mode_t mask() {
  const mode_t now = ::umask(022);
  ::umask(now);
  return now;
}

// The temporary folder beside the playlist. Access to it, its removal included, goes through calls that time out.
struct Apart {
  Apart(const std::string& path, const std::string& segments_name) {
    removeLitter(path);
    std::string pattern = litterPattern(path);
    if (::mkdtemp(pattern.data()) == nullptr) {
      error = errno == ENOENT ? Error{ErrorCode::NotFound, errno, "there is no such folder; make it first"}
                              : Error{ErrorCode::Io, errno, "it cannot be written there; choose another folder"};
      return;
    }
    held.reset(::open(pattern.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!held.valid()) {
      error = Error{ErrorCode::Exhausted, errno, kCannotWrite};
      ::rmdir(pattern.c_str());
      return;
    }
    folder = pattern;
    segments = folder / segments_name;
    holdLitter(held.get());
    if (::chmod(folder.c_str(), 0777 & ~mask()) != 0 || ::mkdir(segments.c_str(), 0777) != 0) {
      const bool is_long = errno == ENAMETOOLONG;
      error = Error{ErrorCode::Io, errno, is_long ? "its name is too long; choose a shorter one" : kCannotWrite};
    }
  }
  ~Apart() { remove(); }
  Apart(const Apart&) = delete;
  Apart& operator=(const Apart&) = delete;

  // Removes the folder once; any thread.
  void remove() {
    if (folder.empty() || removed.exchange(true)) return;
    held.reset();  // removing a folder takes a descriptor, and there may be no other
    std::error_code ignored;
    for (const fs::path& each : {segments, folder}) fs::remove_all(each, ignored);
  }

  std::atomic<bool> removed{false};
  fs::path folder, segments;
  UniqueFd held;  // lock on the folder, so that no other run deletes it as a leftover
  std::optional<Error> error;
};

// The size of the files that the playlist names, with the start; 0 if one of them is missing or empty.
std::uint64_t bytesNamed(const fs::path& playlist, const fs::path& segments) {
  const auto sizeOf = [&](const fs::path& name) {
    std::error_code failed;
    const std::uint64_t bytes = fs::file_size(segments / name, failed);
    return failed ? 0 : bytes;
  };
  const std::uint64_t start = sizeOf(kStart);
  std::uint64_t bytes = start;
  std::ifstream list(playlist);
  for (std::string line; std::getline(list, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    const std::uint64_t segment = sizeOf(fs::path(line).filename());
    if (segment == 0) return 0;
    bytes += segment;
  }
  return start == 0 || bytes == start ? 0 : bytes;
}

struct Move {
  fs::path from, to;
};
// The playlist last, so that whoever finds it finds every segment. Older segments are exchanged for the new ones and
// deleted, or exchanged back if the playlist cannot be moved into place. 0 or errno.
int putInPlace(const Move& segments, const Move& playlist, Existing existing) {
  const bool keeps = existing == Existing::Keep;
  std::error_code none;
  const bool replaces = !keeps && fs::exists(segments.to, none);
  const auto moveSegments = replaces ? exchange : moveToNew;
  if (const int failed = moveSegments(segments.from, segments.to); failed != 0) return failed;
  const auto movePlaylist = [&] { return std::rename(playlist.from.c_str(), playlist.to.c_str()) == 0 ? 0 : errno; };
  const int failed = keeps ? moveToNew(playlist.from, playlist.to) : movePlaylist();
  if (failed != 0)
    static_cast<void>(replaces ? exchange(segments.from, segments.to) : moveToNew(segments.to, segments.from));
  return failed;
}

class HlsFolder final : public FilmPlace {
 public:
  ~HlsFolder() override {
    if (made_ == nullptr) return;
    const auto remove = [made = std::move(made_)] { made->remove(); };
    const bool answers = !error_ || error_->code == ErrorCode::Io;
    const CancelsAnswers kept(nullptr);
    if (!answers || !fileSystem().ask(playlist_, remove)) fileSystem().leave(remove);
  }

  Result<void> open(const std::string& path, Existing existing) {
    existing_ = existing;
    playlist_ = path;
    segments_ = segmentFolderOf(path);
    cancelled_ = CancelsAnswers::flag();
    auto made = answerOf(
        path, [path, segments = segments_.filename().string()] { return std::make_shared<Apart>(path, segments); });
    if (!made) return std::unexpected(made.error());
    if ((*made)->error) return std::unexpected(*(*made)->error);
    made_ = std::move(*made);
    apart_ = made_->folder;
    if (auto muxed = makeMuxer("hls", kPlaylist); !muxed) return muxed;
    muxer().opaque = this;
    muxer().io_open = openFile;
    muxer().io_close2 = closeFile;
    return {};
  }

  Result<void> begin() override {
    const std::string folder = segments_.filename().string() + "/";  // without special characters, see segmentFolderOf
    AVDictionary* options = nullptr;
    av_dict_set(&options, "hls_segment_type", "fmp4", 0);
    av_dict_set(&options, "hls_playlist_type", "vod", 0);
    av_dict_set(&options, "hls_flags", "independent_segments", 0);
    av_dict_set_int(&options, "hls_time", kSegmentSeconds, 0);
    av_dict_set_int(&options, "hls_list_size", 0, 0);
    av_dict_set(&options, "hls_base_url", folder.c_str(), 0);
    av_dict_set(&options, "hls_fmp4_init_filename", (folder + kStart).c_str(), 0);
    av_dict_set(&options, "hls_segment_filename", "%05d.m4s", 0);
    return writeHeader(options);
  }

  Result<std::uint64_t> finish() override {
    const int code = av_write_trailer(&muxer());
    if (error_) return std::unexpected(failureOf(codeOf(*error_)));
    if (code < 0) return std::unexpected(failureOf(code));
    const Move segments{madeSegments(), segments_}, playlist{apart_ / kPlaylist, playlist_};
    const auto whole = answerOf(playlist_, [=] { return bytesNamed(playlist.from, segments.from); });
    if (!whole) return std::unexpected(whole.error());
    if (*whole == 0) return fail(ErrorCode::Io, "a segment is missing; is the disk full?");
    const auto moved =
        answerOf(playlist_, [=, existing = existing_] { return putInPlace(segments, playlist, existing); });
    if (!moved) return std::unexpected(moved.error());
    if (*moved == 0) return *whole;
    if (*moved == EEXIST) {
      return fail(ErrorCode::Io, "was written by another program in the meantime; choose another name", EEXIST);
    }
    return fail(ErrorCode::Io, "cannot be moved to its final name", *moved);
  }

 private:
  [[nodiscard]] fs::path madeSegments() const { return apart_ / segments_.filename(); }

  // Only the last part of the URL is used: the muxer's own folders are ignored.
  static int openFile(AVFormatContext* muxer, AVIOContext** file, const char* url, int, AVDictionary**) {
    auto& self = *static_cast<HlsFolder*>(muxer->opaque);
    const std::string name = fs::path(url).filename().string();
    return self.open(name == kPlaylist ? self.apart_ / name : self.madeSegments() / name, *file);
  }
  int open(const std::string& place, AVIOContext*& file) {
    const CancelsAnswers cancels(cancelled_);  // the muxer's threads have no flag of their own
    const auto fd = answerOf(place, [place] {
      const int made = ::open(place.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
      return std::pair(std::make_shared<UniqueFd>(made), made < 0 ? errno : 0);
    });
    if (!fd) return note(fd.error());
    if (fd->second != 0) return note({ErrorCode::Io, fd->second, kCannotWrite});
    AnsweredOutput output(std::move(*fd->first), place);
    output.cancelBy(cancelled_);
    file = makeFilmIo(std::move(output));
    return file == nullptr ? note({ErrorCode::Exhausted, ENOMEM, "out of memory for a film"}) : 0;
  }

  // The muxer ignores the failure to write a segment, so it is recorded here.
  static int closeFile(AVFormatContext* muxer, AVIOContext* file) {
    auto& self = *static_cast<HlsFolder*>(muxer->opaque);
    avio_flush(file);
    const auto synced = fileOf(*file).sync();
    const int code = synced ? std::min(file->error, 0) : self.note(synced.error());
    freeFilmIo(file);
    return code;
  }

  // The first error counts.
  int note(const Error& error) {
    if (!error_) error_ = error;
    return codeOf(error);
  }
  [[nodiscard]] std::optional<Error> fileError() override { return error_; }

  fs::path playlist_, segments_;
  fs::path apart_;
  std::shared_ptr<Apart> made_;
  const std::atomic<bool>* cancelled_ = nullptr;
  Existing existing_ = Existing::Replace;
  std::optional<Error> error_;
};

}  // namespace

Result<std::unique_ptr<FilmPlace>> makeHlsFolder(const std::string& path, Existing existing) {
  auto folder = std::make_unique<HlsFolder>();
  if (auto opened = folder->open(path, existing); !opened) return std::unexpected(opened.error());
  return folder;
}

}  // namespace relievo
