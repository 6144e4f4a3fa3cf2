// SPDX-License-Identifier: Apache-2.0
// Converts the error codes and time units of FFmpeg's libraries.
#include "drivers/ffmpeg/library.h"

#include <cerrno>
#include <cstddef>
#include <limits>
#include <mutex>

#include "drivers/ffmpeg/ffmpeg.h"
#include "platform/unique_fd.h"

extern "C" {
#include <libavutil/error.h>
#include <libavutil/log.h>
#include <libavutil/mathematics.h>
#include <libavutil/mem.h>
}

namespace relievo {
namespace {

std::mutex blocks;                                         // guards what follows
std::size_t usual_most = std::numeric_limits<int>::max();  // FFmpeg's own
int refusals = 0, users = 0;
bool small = false;  // the bound that is set

// An encoder may have ended the usual bound.
bool isUsualBoundEnded() noexcept {
  void* const block = av_malloc(usual_most + 1);
  const bool ended = block != nullptr;
  av_free(block);
  return ended;
}

void boundBlocks() noexcept {
  constexpr std::size_t kSmall = 1'000'000, kFfmpegs = std::numeric_limits<int>::max();
  const bool now = refusals > 0 && users == 0;
  if (now == small) return;
  if (now && usual_most < kFfmpegs && isUsualBoundEnded()) usual_most = kFfmpegs;
  small = now;
  av_max_alloc(small ? kSmall : usual_most);
}

}  // namespace

void boundFfmpegBlocks() noexcept {
  const std::scoped_lock lock(blocks);
  usual_most = 300'000'000;  // bytes; a film's largest picture, of four channels of 32 bits, has 268 MB
  if (!small) av_max_alloc(usual_most);
}

}  // namespace relievo

namespace relievo::ffmpeg {

void refuseLargeBlocks(bool refused) noexcept {
  const std::scoped_lock lock(blocks);
  refusals += refused ? 1 : -1;
  boundBlocks();
}

BlockUser::BlockUser() noexcept {
  const std::scoped_lock lock(blocks);
  ++users;
  boundBlocks();
}

BlockUser::~BlockUser() {
  const std::scoped_lock lock(blocks);
  --users;
  boundBlocks();
}

void silenceLibrary() noexcept {
  static const bool done = [] {
    av_log_set_level(AV_LOG_QUIET);
    return true;
  }();
  static_cast<void>(done);
}

Duration durationFrom(std::int64_t ticks, AVRational time_base) noexcept {
  return Duration(av_rescale_q(ticks, time_base, kNanosecond));
}

int osError(int code) noexcept {
  const int number = AVUNERROR(code);
  return number > 0 && number < 4096 ? number : 0;  // FFmpeg's own codes are far larger
}

Error openError(int code) noexcept {
  switch (code) {
    case AVERROR(ENOENT):
      return {ErrorCode::NotFound, ENOENT, "no such file; check the path"};
    case AVERROR(EACCES):
    case AVERROR(EPERM):
      return {ErrorCode::PermissionDenied, osError(code), "no permission to read it; check the file's permissions"};
    case AVERROR_PROTOCOL_NOT_FOUND:
      return {ErrorCode::Unsupported, 0, "this FFmpeg was built without this protocol; use another address"};
    case AVERROR(EISDIR):
      return {ErrorCode::Unsupported, EISDIR, "it is a folder; give a file in it"};
    case AVERROR(ETIMEDOUT):
      return kLateAnswer;
    case AVERROR(EMFILE):
    case AVERROR(ENFILE):
      return {ErrorCode::Exhausted, osError(code), kNoDescriptors};
    case AVERROR(ENOMEM):
      return {ErrorCode::Exhausted, ENOMEM, "out of memory while opening the source"};
    case AVERROR_EOF:
    case AVERROR_INVALIDDATA:
    case AVERROR_DEMUXER_NOT_FOUND:
      return {ErrorCode::Corrupt, 0,
              "not a media file that FFmpeg knows, or empty, or cut off before its index was written; check the file; "
              "depth of another program is read from .npy, 16-bit PNG, PFM, EXR or TIFF: write it as one of them"};
    default:
      return {ErrorCode::Io, osError(code), "it cannot be opened; check the path or the address"};
  }
}

}  // namespace relievo::ffmpeg
