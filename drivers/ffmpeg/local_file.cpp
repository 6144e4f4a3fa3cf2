// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/local_file.h"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "drivers/ffmpeg/address.h"
#include "drivers/ffmpeg/bounds/jpeg_bounds.h"
#include "drivers/ffmpeg/bounds/matroska_bounds.h"
#include "drivers/ffmpeg/bounds/mp4_bounds.h"
#include "drivers/ffmpeg/bounds/png_bounds.h"
#include "platform/files/answered_file.h"
#include "platform/files/file_system_answer.h"

extern "C" {
#include <libavutil/error.h>
#include <libavutil/mem.h>
}

namespace relievo::ffmpeg {
namespace {

constexpr int kBufferBytes = 32768;  // as FFmpeg's

struct LocalFile {
  AnsweredFile file;
  Watch* watch = nullptr;
  std::int64_t at = 0;
};

int failed(LocalFile& local, const Error& error) noexcept {
  if (error.code == ErrorCode::Timeout) local.watch->noteUnanswered(error);
  return codeOf(error);
}

int readSome(void* opaque, std::uint8_t* out, int bytes) {
  auto& local = *static_cast<LocalFile*>(opaque);
  const std::atomic<bool>* const cancels = CancelsAnswers::flag();  // of whoever only looks at a picture
  if (local.watch->givesUp() || (cancels != nullptr && *cancels)) return AVERROR_EXIT;
  const auto got =
      local.file.readSome(static_cast<std::uint64_t>(local.at), std::span(out, static_cast<std::size_t>(bytes)));
  if (!got) return failed(local, got.error());
  if (*got == 0) return AVERROR_EOF;
  local.at += static_cast<std::int64_t>(*got);
  return static_cast<int>(*got);
}

std::int64_t seek(void* opaque, std::int64_t offset, int whence) {
  auto& local = *static_cast<LocalFile*>(opaque);
  if (whence == SEEK_CUR) offset += local.at;
  if (whence == SEEK_END || whence == AVSEEK_SIZE) {
    const auto bytes = local.file.bytes();
    if (!bytes) return failed(local, bytes.error());
    if (whence == AVSEEK_SIZE) return static_cast<std::int64_t>(*bytes);
    offset += static_cast<std::int64_t>(*bytes);
  }
  if (offset < 0) return AVERROR(EINVAL);
  return local.at = offset;
}

}  // namespace

std::string localPathOf(const std::string& url) {
  if (url.starts_with("file:")) return url.substr(5);
  return schemeOf(url).empty() ? url : "";
}

Result<AVIOContext*> openLocalFile(const std::string& path, Watch& watch) {
  auto file = AnsweredFile::open(path);
  if (!file) {
    if (file.error().code == ErrorCode::Timeout) watch.noteUnanswered(file.error());
    return std::unexpected(file.error());
  }
  for (const auto exceeded : {exceededPngBound, exceededJpegFileBound, exceededMatroskaBound, exceededMp4Bound}) {
    if (const char* const why = exceeded(readable(*file))) return fail(ErrorCode::Unsupported, why);
  }
  auto local = std::make_unique<LocalFile>(std::move(*file), &watch);
  auto* const buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
  AVIOContext* const context =
      buffer == nullptr ? nullptr : avio_alloc_context(buffer, kBufferBytes, 0, local.get(), readSome, nullptr, seek);
  if (context == nullptr) {
    av_free(buffer);
    return fail(ErrorCode::Exhausted, "out of memory while opening the source", ENOMEM);
  }
  static_cast<void>(local.release());  // freed by closeLocalFile
  return context;
}

int codeOf(const Error& error) noexcept {
  if (error.code == ErrorCode::Cancelled) return AVERROR_EXIT;
  if (error.code == ErrorCode::Timeout) return AVERROR(ETIMEDOUT);
  return AVERROR(error.os_error != 0 ? error.os_error : EIO);
}

bool isLocalFile(const AVIOContext* file) noexcept {
  return file != nullptr && file->read_packet == readSome;
}

void closeLocalFile(AVIOContext* file) noexcept {
  const std::unique_ptr<LocalFile> local(static_cast<LocalFile*>(file->opaque));
  av_free(std::exchange(file->buffer, nullptr));
  avio_context_free(&file);
}

}  // namespace relievo::ffmpeg
