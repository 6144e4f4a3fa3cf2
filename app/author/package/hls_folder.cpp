// SPDX-License-Identifier: Apache-2.0
// A playlist and its segments of fragmented MP4 (RFC 8216): written in a temporary folder, moved when complete.
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/author/package/film_place.h"
#include "platform/litter.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr int kSegmentSeconds = 4;  // at least: each segment begins with a key frame

// The plain names that the muxer uses for any film. `openFile` maps them to the real paths.
constexpr const char* kPlaylist = "film.m3u8";
constexpr const char* kStart = "init.mp4";

bool onDisk(const fs::path& file) {
  const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  return fd.valid() && ::fsync(fd.get()) == 0;
}

class HlsFolder final : public FilmPlace {
 public:
  ~HlsFolder() override {
    std::error_code ignored;
    if (!apart_.empty()) fs::remove_all(apart_, ignored);
  }

  Result<void> open(const std::string& path, Existing existing) {
    existing_ = existing;
    playlist_ = path;
    segments_ = segmentFolderOf(path);
    removeLitter(path);
    std::string pattern = litterPattern(path);
    if (::mkdtemp(pattern.data()) == nullptr) {
      if (errno == ENOENT) return fail(ErrorCode::NotFound, "there is no such folder; make it first", errno);
      return fail(ErrorCode::Io, "it cannot be written there; choose another folder", errno);
    }
    apart_ = pattern;
    held_.reset(::open(apart_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    holdLitter(held_.get());
    if (::chmod(apart_.c_str(), 0777 & ~mask()) != 0 || ::mkdir(madeSegments().c_str(), 0777) != 0) {
      return fail(ErrorCode::Io, kCannotWrite, errno);
    }
    if (auto made = makeMuxer("hls", kPlaylist); !made) return made;
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
    if (const int code = av_write_trailer(&muxer()); code < 0) {
      return fail(ErrorCode::Io, kCannotWrite, osErrorOf(code));
    }
    if (error_ < 0) return fail(ErrorCode::Io, kCannotWrite, osErrorOf(error_));
    if (!namesOnlyWhatIsThere()) return fail(ErrorCode::Io, "a segment is missing; is the disk full?");
    std::error_code failed;
    std::uint64_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(apart_, failed)) {
      if (!entry.is_regular_file()) continue;
      if (!onDisk(entry.path())) return fail(ErrorCode::Io, kCannotWrite, errno);
      bytes += entry.file_size();
    }
    if (failed) return fail(ErrorCode::Io, kCannotWrite, failed.value());
    if (auto moved = putInPlace(); !moved) return std::unexpected(moved.error());
    return bytes;
  }

 private:
  [[nodiscard]] fs::path madeSegments() const { return apart_ / segments_.filename(); }

  // Only the last part of the URL is used: the muxer's own folders are ignored.
  static int openFile(AVFormatContext* muxer, AVIOContext** file, const char* url, int flags, AVDictionary** options) {
    auto& self = *static_cast<HlsFolder*>(muxer->opaque);
    const std::string name = fs::path(url).filename().string();
    const fs::path place = name == kPlaylist ? self.apart_ / name : self.madeSegments() / name;
    const int code = avio_open2(file, ("file:" + place.string()).c_str(), flags, nullptr, options);
    if (code < 0 && self.error_ == 0) self.error_ = code;
    return code;
  }

  // The muxer ignores the failure to write a segment, so it is recorded here.
  static int closeFile(AVFormatContext* muxer, AVIOContext* file) {
    avio_flush(file);
    const int code = file->error < 0 ? file->error : 0;
    const int closed = avio_close(file);
    int& error = static_cast<HlsFolder*>(muxer->opaque)->error_;
    if (error == 0) error = code < 0 ? code : closed;
    return code < 0 ? code : closed;
  }

  static mode_t mask() {
    const mode_t now = ::umask(022);
    ::umask(now);
    return now;
  }

  // Whether every file that the playlist names exists and is not empty.
  [[nodiscard]] bool namesOnlyWhatIsThere() const {
    std::ifstream list(apart_ / kPlaylist);
    int named = 0;
    for (std::string line; std::getline(list, line);) {
      if (line.empty() || line.starts_with('#')) continue;
      std::error_code none;
      const auto bytes = fs::file_size(madeSegments() / fs::path(line).filename(), none);
      if (none || bytes == 0) return false;
      ++named;
    }
    std::error_code none;
    return named > 0 && fs::file_size(madeSegments() / kStart, none) > 0 && !none;
  }

  static bool move(const fs::path& from, const fs::path& to, unsigned how) {
    return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), how) == 0;
  }

  // The playlist last, so that whoever finds it finds every segment. Older segments are exchanged for the new ones and
  // deleted, or exchanged back if the playlist cannot be moved into place.
  Result<void> putInPlace() const {
    const bool keeps = existing_ == Existing::Keep;
    const unsigned how = !keeps && fs::exists(segments_) ? RENAME_EXCHANGE : RENAME_NOREPLACE;
    bool moved = move(madeSegments(), segments_, how);
    int os_error = errno;
    if (moved && !move(apart_ / kPlaylist, playlist_, keeps ? RENAME_NOREPLACE : 0)) {
      os_error = errno;
      moved = false;
      move(segments_, madeSegments(), how);
    }
    if (moved) return {};
    if (os_error == EEXIST) {
      return fail(ErrorCode::Io, "was written by another program in the meantime; choose another name", os_error);
    }
    return fail(ErrorCode::Io, "cannot be moved to its final name", os_error);
  }

  fs::path playlist_, segments_;
  fs::path apart_;
  UniqueFd held_;  // lock on `apart_`, so that no other run deletes it as a leftover
  Existing existing_ = Existing::Replace;
  int error_ = 0;  // the library's first error
};

}  // namespace

Result<std::unique_ptr<FilmPlace>> makeHlsFolder(const std::string& path, Existing existing) {
  auto folder = std::make_unique<HlsFolder>();
  if (auto opened = folder->open(path, existing); !opened) return std::unexpected(opened.error());
  return folder;
}

}  // namespace relievo
