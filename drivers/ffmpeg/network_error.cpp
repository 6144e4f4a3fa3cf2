// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/network_error.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include "drivers/ffmpeg/library.h"

extern "C" {
#include <libavutil/error.h>
#include <libavutil/log.h>
}

namespace relievo::ffmpeg {
namespace {

thread_local LibraryWords* words_of_thread = nullptr;
// Warnings of whole films: of tracks whose first packets come late, of rates, of times that FFmpeg then corrects.
constexpr std::array<std::string_view, 5> kHarmless{
    "Could not find codec parameters", "Estimating duration from bitrate", "not enough frames to estimate rate",
    "start time for stream", "Invalid timestamps"};

bool has(std::string_view text, std::string_view part) noexcept {
  return text.find(part) != std::string_view::npos;
}

}  // namespace

void LibraryWords::keep(void* context, int level, const char* format, va_list arguments) {
  if (words_of_thread == nullptr) return;
  const bool of_container = context != nullptr && context == words_of_thread->container_;
  const bool harmless = std::ranges::any_of(kHarmless, [&](std::string_view words) { return has(format, words); });
  if (of_container && level <= AV_LOG_WARNING && !harmless) words_of_thread->container_warned_ = true;
  if (level > AV_LOG_ERROR) return;
  std::array<char, 256> line;
  int prefixed = 1;
  av_log_format_line(context, level, format, arguments, line.data(), static_cast<int>(line.size()), &prefixed);
  words_of_thread->last_ = line.data();
}

LibraryWords::LibraryWords() noexcept {
  static const bool listening = (av_log_set_callback(keep), true);
  static_cast<void>(listening);
  words_of_thread = this;
}

LibraryWords::~LibraryWords() {
  words_of_thread = nullptr;
}

Error networkError(int code, std::string_view words) noexcept {
  switch (code) {
    case AVERROR_HTTP_NOT_FOUND:
      return {ErrorCode::NotFound, 0, "the server does not have it; check the address"};
    case AVERROR_HTTP_UNAUTHORIZED:
    case AVERROR_HTTP_FORBIDDEN:
      return {ErrorCode::PermissionDenied, 0, "the server refuses access; check user name and password in the address"};
    case AVERROR_HTTP_BAD_REQUEST:
    case AVERROR_HTTP_OTHER_4XX:
      return {ErrorCode::Io, 0, "the server refuses the request (HTTP 4xx); check the address"};
    case AVERROR_HTTP_SERVER_ERROR:
      return {ErrorCode::Io, 0, "the server fails (HTTP 5xx); try again later"};
    case AVERROR(ECONNREFUSED):
      return {ErrorCode::Io, ECONNREFUSED,
              "the server refuses the connection; check host and port, and whether the server runs"};
    case AVERROR(EHOSTUNREACH):
    case AVERROR(ENETUNREACH):
      return {ErrorCode::Io, osError(code), "the network does not reach the server; check the network"};
    case AVERROR(ECONNRESET):
    case AVERROR(EPIPE):
      return {ErrorCode::Io, osError(code), "the server broke the connection off; try again later"};
    case AVERROR_EOF:
    case AVERROR_INVALIDDATA:
    case AVERROR_DEMUXER_NOT_FOUND:
      return {ErrorCode::Corrupt, 0, "what the server sends is no film that FFmpeg knows; check the address"};
    default:
      break;
  }
  if (has(words, "Failed to resolve") || has(words, "getaddrinfo")) {
    return {ErrorCode::NotFound, 0, "no host has this name; check the address and the network"};
  }
  if (has(words, "TLS") || has(words, "tls") || has(words, "SSL")) {
    return {ErrorCode::Io, 0,
            "no secure connection: the server does not speak TLS, or not this version; check https and port"};
  }
  if (has(words, "ort missing") || has(words, "nvalid port") || code == AVERROR(EINVAL)) {
    return {ErrorCode::Unsupported, 0, "not a whole address; write it as PROTOCOL://HOST:PORT/PATH"};
  }
  if (code == AVERROR(EIO)) {
    return {ErrorCode::Io, EIO, "the server breaks off or redirects without end; check the address"};
  }
  return openError(code);
}

}  // namespace relievo::ffmpeg
