// SPDX-License-Identifier: Apache-2.0
// Shared by the source and the decoders: owners of FFmpeg's objects, time units, errors.
#pragma once

#include <cerrno>
#include <memory>
#include <optional>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/avutil.h>
#include <libavutil/frame.h>
}

#include "hal/media/media_time.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

inline constexpr AVRational kNanosecond{1, 1'000'000'000};
inline constexpr Error kLateAnswer{ErrorCode::Timeout, ETIMEDOUT,
                                   "no answer from the source in time; check the network"};

// The deleters' types identify this back end's objects behind a shared_ptr<const void>.
struct PacketDeleter {
  void operator()(AVPacket* packet) const noexcept { av_packet_free(&packet); }
};
struct FrameDeleter {
  void operator()(AVFrame* frame) const noexcept { av_frame_free(&frame); }
};
struct CodecContextDeleter {
  void operator()(AVCodecContext* context) const noexcept { avcodec_free_context(&context); }
};
struct ParametersDeleter {
  void operator()(AVCodecParameters* parameters) const noexcept { avcodec_parameters_free(&parameters); }
};
using PacketPtr = std::unique_ptr<AVPacket, PacketDeleter>;
using FramePtr = std::unique_ptr<AVFrame, FrameDeleter>;
using CodecContextPtr = std::unique_ptr<AVCodecContext, CodecContextDeleter>;
using ParametersPtr = std::unique_ptr<AVCodecParameters, ParametersDeleter>;

// The object behind StreamInfo::native.
struct NativeStream {
  ParametersPtr parameters;
  AVRational time_base{0, 1};
  AVRational sample_aspect{0, 1};  // the container's, which overrides the codec's; 0/1 if unspecified
  bool photo = false;              // of a picture's file
};
struct NativeStreamDeleter {
  void operator()(NativeStream* stream) const noexcept { delete stream; }
};

// The object behind `owner`, if it was made by this back end with `Deleter`; null otherwise.
template <class T, class Deleter>
[[nodiscard]] const T* native(const std::shared_ptr<const void>& owner) noexcept {
  return std::get_deleter<Deleter>(owner) == nullptr ? nullptr : static_cast<const T*>(owner.get());
}

// Stops FFmpeg from printing to stderr, since the program prints its own messages.
void silenceLibrary() noexcept;

// While it is refused more often than allowed again, and nobody uses them, FFmpeg gets no block over 1 MB in the whole
// process. Any thread.
void refuseLargeBlocks(bool refused) noexcept;

// Of a source that is open, or a decoder: it needs large blocks. Any thread.
class BlockUser {
 public:
  BlockUser() noexcept;
  ~BlockUser();
  BlockUser(const BlockUser&) = delete;
  BlockUser& operator=(const BlockUser&) = delete;
};

[[nodiscard]] Duration durationFrom(std::int64_t ticks, AVRational time_base) noexcept;

// The errno in an FFmpeg error code, or 0 if the code is FFmpeg's own.
[[nodiscard]] int osError(int code) noexcept;

// Why a source could not be opened, as a message for the user.
[[nodiscard]] Error openError(int code) noexcept;

}  // namespace relievo::ffmpeg
