// SPDX-License-Identifier: Apache-2.0
#include "app/author/package/place/film_io.h"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <utility>

extern "C" {
#include <libavformat/version.h>
#include <libavutil/error.h>
#include <libavutil/mem.h>
}

namespace relievo {
namespace {

constexpr int kBufferBytes = 65536;

#if LIBAVFORMAT_VERSION_MAJOR >= 61  // FFmpeg 7
using FilmBytes = const std::uint8_t;
#else
using FilmBytes = std::uint8_t;
#endif

struct FilmIo {
  AnsweredOutput file;
  std::uint64_t at = 0;
};

int write(void* opaque, FilmBytes* data, int bytes) {
  auto& io = *static_cast<FilmIo*>(opaque);
  const auto written = io.file.write(io.at, {data, static_cast<std::size_t>(bytes)});
  if (!written) return codeOf(written.error());
  io.at += static_cast<std::uint64_t>(bytes);
  return bytes;
}

int read(void* opaque, std::uint8_t* data, int bytes) {
  auto& io = *static_cast<FilmIo*>(opaque);
  const auto got = io.file.read(io.at, {data, static_cast<std::size_t>(bytes)});
  if (!got) return codeOf(got.error());
  if (*got == 0) return AVERROR_EOF;
  io.at += *got;
  return static_cast<int>(*got);
}

std::int64_t seek(void* opaque, std::int64_t offset, int whence) {
  auto& io = *static_cast<FilmIo*>(opaque);
  if (whence == AVSEEK_SIZE) return static_cast<std::int64_t>(io.file.bytes());
  if (whence == SEEK_CUR) offset += static_cast<std::int64_t>(io.at);
  if (whence == SEEK_END) offset += static_cast<std::int64_t>(io.file.bytes());
  if (offset < 0) return AVERROR(EINVAL);
  io.at = static_cast<std::uint64_t>(offset);
  return offset;
}

AVIOContext* make(AnsweredOutput file, bool writes) {
  auto io = std::make_unique<FilmIo>(FilmIo{std::move(file), 0});
  auto* const buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
  if (buffer == nullptr) return nullptr;
  AVIOContext* const made = avio_alloc_context(buffer, kBufferBytes, writes ? 1 : 0, io.get(), writes ? nullptr : read,
                                               writes ? write : nullptr, seek);
  if (made == nullptr) {
    av_free(buffer);
  } else {
    static_cast<void>(io.release());  // freeFilmIo
  }
  return made;
}

}  // namespace

AVIOContext* makeFilmIo(AnsweredOutput file) {
  return make(std::move(file), true);
}

AVIOContext* makeFilmReader(AnsweredOutput file) {
  return make(std::move(file), false);
}

AnsweredOutput& fileOf(AVIOContext& io) noexcept {
  return static_cast<FilmIo*>(io.opaque)->file;
}

void freeFilmIo(AVIOContext*& io) noexcept {
  if (io == nullptr) return;
  const std::unique_ptr<FilmIo> held(static_cast<FilmIo*>(io->opaque));
  av_free(std::exchange(io->buffer, nullptr));
  avio_context_free(&io);
}

int codeOf(const Error& error) noexcept {
  if (error.code == ErrorCode::Cancelled) return AVERROR_EXIT;
  if (error.code == ErrorCode::Timeout) return AVERROR(ETIMEDOUT);
  return AVERROR(error.os_error != 0 ? error.os_error : EIO);
}

}  // namespace relievo
