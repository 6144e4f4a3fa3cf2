// SPDX-License-Identifier: Apache-2.0
// A playlist and its segments of fragmented MP4 (RFC 8216): made in a folder apart, moved when they are whole.
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "app/author/package/film_place.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr int kSegmentSeconds = 4;  // at least: each begins with a key frame

// In a name that the muxer takes for a pattern.
std::string withoutPattern(std::string name) {
  for (std::size_t at = 0; (at = name.find('%', at)) != std::string::npos; at += 2) name.insert(at, 1, '%');
  return name;
}

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

  Result<void> open(const std::string& path) {
    playlist_ = path;
    segments_ = segmentFolderOf(path);
    std::string pattern = path + ".XXXXXX";
    if (::mkdtemp(pattern.data()) == nullptr) {
      if (errno == ENOENT) return fail(ErrorCode::NotFound, "there is no such folder; make it first", errno);
      return fail(ErrorCode::Io, "it cannot be written there; choose another folder", errno);
    }
    apart_ = pattern;
    if (::chmod(apart_.c_str(), 0777 & ~mask()) != 0 || ::mkdir((apart_ / segments_.filename()).c_str(), 0777) != 0) {
      return fail(ErrorCode::Io, kCannotWrite, errno);
    }
    if (auto made = makeMuxer("hls", (apart_ / playlist_.filename()).string()); !made) return made;
    muxer().opaque = this;
    muxer().io_close2 = closeFile;
    return {};
  }

  Result<void> begin() override {
    const std::string folder = segments_.filename().string() + "/";
    AVDictionary* options = nullptr;
    av_dict_set(&options, "hls_segment_type", "fmp4", 0);
    av_dict_set(&options, "hls_playlist_type", "vod", 0);
    av_dict_set(&options, "hls_flags", "independent_segments", 0);
    av_dict_set_int(&options, "hls_time", kSegmentSeconds, 0);
    av_dict_set_int(&options, "hls_list_size", 0, 0);
    av_dict_set(&options, "hls_base_url", folder.c_str(), 0);
    av_dict_set(&options, "hls_fmp4_init_filename", (folder + "init.mp4").c_str(), 0);
    const std::string names = withoutPattern((apart_ / segments_.filename()).string()) + "/%05d.m4s";
    av_dict_set(&options, "hls_segment_filename", names.c_str(), 0);
    return writeHeader(options);
  }

  Result<std::uint64_t> finish() override {
    if (const int code = av_write_trailer(&muxer()); code < 0) {
      return fail(ErrorCode::Io, kCannotWrite, osErrorOf(code));
    }
    if (error_ < 0) return fail(ErrorCode::Io, kCannotWrite, osErrorOf(error_));
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
  // The muxer lets it pass when a segment could not be written.
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

  // The playlist last: who finds it finds all. Older segments change places with the new ones, and go.
  Result<void> putInPlace() const {
    const fs::path made = apart_ / segments_.filename();
    const unsigned how = fs::exists(segments_) ? RENAME_EXCHANGE : RENAME_NOREPLACE;
    const bool moved = ::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, segments_.c_str(), how) == 0 &&
                       ::rename((apart_ / playlist_.filename()).c_str(), playlist_.c_str()) == 0;
    if (!moved) return fail(ErrorCode::Io, "it cannot be put into its place", errno);
    return {};
  }

  fs::path playlist_, segments_;
  fs::path apart_;
  int error_ = 0;  // of the library, the first
};

}  // namespace

Result<std::unique_ptr<FilmPlace>> makeHlsFolder(const std::string& path) {
  auto folder = std::make_unique<HlsFolder>();
  if (auto opened = folder->open(path); !opened) return std::unexpected(opened.error());
  return folder;
}

}  // namespace relievo
