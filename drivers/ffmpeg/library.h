// SPDX-License-Identifier: Apache-2.0
// What the source and the decoder share: owners of the library's objects, time units, errors.
#pragma once

#include <memory>
#include <optional>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/avutil.h>
#include <libavutil/frame.h>
}

#include "hal/media_time.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

inline constexpr AVRational kNanosecond{1, 1'000'000'000};

// The types of the deleters tell this back end's objects from those of others behind a shared_ptr<const void>.
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

// Behind StreamInfo::native.
struct NativeStream {
  ParametersPtr parameters;
  AVRational time_base{0, 1};
  AVRational sample_aspect{0, 1};  // the container's word, which goes before the codec's; 0/1 where it says nothing
};
struct NativeStreamDeleter {
  void operator()(NativeStream* stream) const noexcept { delete stream; }
};

// The object behind `owner`, if it was made by this back end with `Deleter`; null otherwise.
template <class T, class Deleter>
[[nodiscard]] const T* native(const std::shared_ptr<const void>& owner) noexcept {
  return std::get_deleter<Deleter>(owner) == nullptr ? nullptr : static_cast<const T*>(owner.get());
}

// The libraries print to stderr by themselves unless told once; the program prints its own line.
void silenceLibrary() noexcept;

[[nodiscard]] Duration durationFrom(std::int64_t ticks, AVRational time_base) noexcept;

// 0 where a code of the library is not one of the system's.
[[nodiscard]] int osError(int code) noexcept;

// Why a source could not be opened, in words for the one who named it.
[[nodiscard]] Error openError(int code) noexcept;

}  // namespace relievo::ffmpeg
