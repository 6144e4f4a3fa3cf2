// SPDX-License-Identifier: Apache-2.0
// Destinations of films, what their muxers share, and the plain file.
#include "app/author/package/place/film_place.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "app/author/package/place/film_io.h"
#include "platform/atomic_file.h"
#include "platform/files/file_system_answer.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

struct Ending {
  const char* text;
  FilmKind kind;
};
constexpr std::array kEndings{Ending{".mkv", FilmKind::Matroska},
                              Ending{".mp4", FilmKind::Mp4},
                              Ending{".m4v", FilmKind::Mp4},
                              Ending{".mov", FilmKind::Mov},
                              Ending{".ts", FilmKind::TransportStream},
                              Ending{".m3u8", FilmKind::Hls}};

// Matroska and MP4, whose muxers seek back and forth.
class PlainFile final : public FilmPlace {
 public:
  ~PlainFile() override { freeFilmIo(file_); }

  Result<void> open(const std::string& path, FilmKind kind, Existing existing) {
    auto made = AtomicFile::create(path, existing);
    if (!made) return std::unexpected(made.error());
    place_ = std::move(*made);
    place_.output().cancelBy(CancelsAnswers::flag());
    matroska_ = kind == FilmKind::Matroska;
    return makeMuxer(matroska_ ? "matroska" : kind == FilmKind::Mov ? "mov" : "mp4", path);
  }

  Result<void> begin() override {
    file_ = makeFilmIo(place_.output());
    if (file_ == nullptr) return fail(ErrorCode::Exhausted, "out of memory for a film", ENOMEM);
    muxer().pb = file_;
    muxer().flags |= AVFMT_FLAG_CUSTOM_IO;
    muxer().opaque = this;
    muxer().io_open = openAgain;
    muxer().io_close2 = closeAgain;
    AVDictionary* options = nullptr;
    if (!matroska_) av_dict_set(&options, "movflags", "use_metadata_tags+faststart", 0);
    return writeHeader(options);
  }

  Result<std::uint64_t> finish() override {
    int code = av_write_trailer(&muxer());
    avio_flush(file_);
    if (code >= 0) code = file_->error;
    if (code < 0) return std::unexpected(failureOf(code));
    const std::uint64_t bytes = place_.output().bytes();
    if (auto committed = place_.commit(); !committed) return std::unexpected(committed.error());
    return bytes;
  }

 private:
  // MP4's muxer reads what it has written, to move its index to the front.
  static int openAgain(AVFormatContext* muxer, AVIOContext** file, const char*, int flags, AVDictionary**) {
    if ((flags & AVIO_FLAG_WRITE) != 0) return AVERROR(EINVAL);
    *file = makeFilmReader(static_cast<PlainFile*>(muxer->opaque)->place_.output());
    return *file == nullptr ? AVERROR(ENOMEM) : 0;
  }
  static int closeAgain(AVFormatContext*, AVIOContext* file) {
    freeFilmIo(file);
    return 0;
  }

  [[nodiscard]] std::optional<Error> fileError() override {
    return place_.output().valid() ? place_.output().error() : std::nullopt;
  }

  AtomicFile place_;
  AVIOContext* file_ = nullptr;
  bool matroska_ = false;
};

}  // namespace

std::optional<FilmKind> filmKindOf(const std::string& path) {
  if (path.starts_with("udp://") || path.starts_with("srt://")) return FilmKind::Live;
  const std::string ending = lowerCase(std::filesystem::path(path).extension().string());
  const auto known = std::find_if(kEndings.begin(), kEndings.end(), [&](const Ending& e) { return ending == e.text; });
  return known == kEndings.end() ? std::nullopt : std::optional(known->kind);
}

bool holds(FilmKind kind, VideoCodec codec) noexcept {
  return codec != VideoCodec::Ffv1 || kind == FilmKind::Matroska;
}

std::string segmentFolderOf(const std::string& playlist) {
  const std::filesystem::path path(playlist);
  const std::string stem = path.stem().string();
  std::string plain = stem;
  const auto odd = [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_' && c != '.'; };
  std::replace_if(plain.begin(), plain.end(), odd, '_');
  if (plain != stem) {                // keeps two names apart that differ only in replaced characters
    std::uint32_t hash = 2166136261;  // FNV-1a
    for (const unsigned char c : stem) hash = (hash ^ c) * 16777619;
    std::array<char, 10> text{};
    std::snprintf(text.data(), text.size(), "-%08x", hash);
    plain += text.data();
  }
  return (path.parent_path() / (plain + ".segments")).string();
}

Result<std::unique_ptr<FilmPlace>> FilmPlace::create(const std::string& path, FilmKind kind, Existing existing) {
  if (kind == FilmKind::Hls) return makeHlsFolder(path, existing);
  if (kind == FilmKind::TransportStream || kind == FilmKind::Live) {
    return makeTransportStream(path, kind == FilmKind::Live, existing);
  }
  auto file = std::make_unique<PlainFile>();
  if (auto opened = file->open(path, kind, existing); !opened) return std::unexpected(opened.error());
  return file;
}

Result<void> FilmPlace::makeMuxer(const char* format, const std::string& url) {
  AVFormatContext* made = nullptr;
  if (avformat_alloc_output_context2(&made, nullptr, format, url.c_str()) < 0) {
    return fail(ErrorCode::Exhausted, "out of memory for a film", ENOMEM);
  }
  muxer_.reset(made);
  muxer_->strict_std_compliance = FF_COMPLIANCE_EXPERIMENTAL;  // as FFmpeg 5.1 calls FLAC and TrueHD in MP4
  return {};
}

Result<void> FilmPlace::writeHeader(AVDictionary* options) {
  const int code = avformat_write_header(muxer_.get(), &options);
  av_dict_free(&options);
  if (code < 0) return std::unexpected(failureOf(code));
  return {};
}

Result<void> FilmPlace::write(AVPacket& packet) {
  const std::lock_guard lock(writing_);
  const int code = av_interleaved_write_frame(muxer_.get(), &packet);
  if (code < 0) return std::unexpected(failureOf(code));
  return {};
}

Error FilmPlace::failureOf(int code) {
  const auto of_file = fileError();
  const bool unanswered = of_file && (of_file->code == ErrorCode::Timeout || of_file->code == ErrorCode::Cancelled);
  return unanswered ? *of_file : Error{ErrorCode::Io, osErrorOf(code), usualFailure()};
}

}  // namespace relievo
