// SPDX-License-Identifier: Apache-2.0
// The file around the two tracks: its kind, its tags, its place.
#include "app/author/film_writer.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <utility>

extern "C" {
#include <libavutil/log.h>
}

#include "app/author/h264_track.h"
#include "platform/atomic_file.h"

namespace relievo {
namespace {

constexpr const char* kCannotWrite = "it cannot be written; is the disk full?";

// FFmpeg's name of the kind of file, by the ending; null for one that is not written here.
const char* formatOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".mkv") return "matroska";
  if (ending == ".mp4" || ending == ".m4v") return "mp4";
  if (ending == ".mov") return "mov";
  return nullptr;
}

void setTag(AVDictionary** tags, const std::string& key, const std::string& value) {
  av_dict_set(tags, key.c_str(), value.c_str(), 0);
}

}  // namespace

struct FilmWriter::Impl {
  ~Impl() {
    if (file != nullptr) {
      if (file->pb != nullptr) avio_closep(&file->pb);
      avformat_free_context(file);
    }
  }

  Result<void> openTracks(const FilmFormat& format);
  void tagTracks(const FilmFormat& format, bool matroska);
  Result<void> begin(const FilmFormat& format);

  std::string target;
  AtomicFile place;  // FFmpeg writes there by its name
  AVFormatContext* file = nullptr;
  H264Track color, depth;
};

Result<void> FilmWriter::Impl::openTracks(const FilmFormat& format) {
  auto opened = color.open(file, {.width = format.color_width,
                                  .height = format.color_height,
                                  .range = format.color_range,
                                  .matrix = format.color_matrix,
                                  .sample_aspect = format.color_aspect,
                                  .frame_period = format.frame_period,
                                  .crf = format.color_crf,
                                  .preset = "medium"});
  if (!opened) return opened;
  return depth.open(file, {.width = format.depth_width,
                           .height = format.depth_height,
                           .gray = true,
                           .range = ColorRange::Full,
                           .sample_aspect = format.depth_aspect,
                           .frame_period = format.frame_period,
                           .crf = format.depth_crf,
                           .preset = "medium",
                           // What flatters the eye moves the surface under a finger: without it edges are truer
                           // (largest error 11 codes instead of 52) at the same size.
                           .x264_parameters = ":no-psy=1:aq-mode=0"});
}

void FilmWriter::Impl::tagTracks(const FilmFormat& format, bool matroska) {
  for (const auto& [track, title] : {std::pair{&color, "color"}, std::pair{&depth, "depth"}}) {
    setTag(&track->stream()->metadata, "title", title);
    setTag(&track->stream()->metadata, "handler_name", title);
  }
  color.stream()->disposition = AV_DISPOSITION_DEFAULT;
  AVDictionary** const where = matroska ? &depth.stream()->metadata : &file->metadata;
  for (const auto& [key, value] : format.depth_tags) setTag(where, key, value);
}

Result<void> FilmWriter::Impl::begin(const FilmFormat& format) {
  const char* const kind = formatOf(target);
  if (kind == nullptr) return fail(ErrorCode::InvalidArgument, "unknown ending; name it .mkv, .mp4, .m4v or .mov");
  auto made = AtomicFile::create(target);
  if (!made) return std::unexpected(made.error());
  place = std::move(*made);
  const std::string url = "file:" + place.writtenPath();  // the name may hold a colon
  if (avformat_alloc_output_context2(&file, nullptr, kind, url.c_str()) < 0) {
    return fail(ErrorCode::Exhausted, "out of memory for a film", ENOMEM);
  }
  if (auto opened = openTracks(format); !opened) return opened;
  const bool matroska = std::string(kind) == "matroska";
  tagTracks(format, matroska);
  if (const int code = avio_open(&file->pb, url.c_str(), AVIO_FLAG_WRITE); code < 0) {
    return fail(ErrorCode::Io, kCannotWrite, osErrorOf(code));
  }
  AVDictionary* options = nullptr;
  if (!matroska) av_dict_set(&options, "movflags", "use_metadata_tags+faststart", 0);
  const int code = avformat_write_header(file, &options);
  av_dict_free(&options);
  if (code < 0) return fail(ErrorCode::Io, kCannotWrite, osErrorOf(code));
  return {};
}

FilmWriter::FilmWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FilmWriter::~FilmWriter() = default;

bool FilmWriter::knowsEnding(const std::string& path) {
  return formatOf(path) != nullptr;
}

Result<std::unique_ptr<FilmWriter>> FilmWriter::create(const std::string& path, const FilmFormat& format) {
  av_log_set_level(AV_LOG_QUIET);  // the program prints its own line
  auto impl = std::make_unique<Impl>();
  impl->target = path;
  if (auto begun = impl->begin(format); !begun) return std::unexpected(begun.error());
  return std::unique_ptr<FilmWriter>(new FilmWriter(std::move(impl)));
}

Result<void> FilmWriter::writeColor(const ColorPicture420& picture, MediaTime time, bool key) {
  return impl_->color.encode({picture.y.data(), picture.u.data(), picture.v.data()}, time, key);
}

Result<void> FilmWriter::writeDepth(const DepthPicture& picture, MediaTime time, bool key) {
  return impl_->depth.encode({picture.codes.data(), nullptr, nullptr}, time, key);
}

Result<FilmTotals> FilmWriter::finish() {
  Impl& film = *impl_;
  if (auto drained = film.color.drain(); !drained) return std::unexpected(drained.error());
  if (auto drained = film.depth.drain(); !drained) return std::unexpected(drained.error());
  int code = av_write_trailer(film.file);
  const int closed = avio_closep(&film.file->pb);
  if (code >= 0) code = closed;
  if (code < 0) return fail(ErrorCode::Io, kCannotWrite, osErrorOf(code));

  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(film.place.writtenPath(), unknown);
  if (auto committed = film.place.commit(); !committed) return std::unexpected(committed.error());
  return FilmTotals{film.color.totals(), film.depth.totals(), unknown ? 0 : bytes};
}

}  // namespace relievo
