// SPDX-License-Identifier: Apache-2.0
// State guards of the sound decoder.
#include "hal/media/audio_decoder.h"

namespace relievo {
namespace {

constexpr const char* kNotOpen = "the sound decoder is not open; open it first";

}  // namespace

Result<void> AudioDecoder::open(const StreamInfo& stream, const AudioFormat& format) {
  if (state_ != State::Closed)
    return fail(ErrorCode::InvalidState, "the sound decoder is open already; close it first");
  if (stream.kind != StreamKind::Audio)
    return fail(ErrorCode::InvalidArgument, "the stream holds no sound; give an audio stream");
  damaged_ = 0;
  auto opened = openDecoder(stream, format);
  if (!opened) {
    closeDecoder();
    return opened;
  }
  state_ = State::Open;
  return {};
}

Result<AudioChunk> AudioDecoder::decode(const Packet& packet) {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, kNotOpen);
  return decodePacket(packet);
}

Result<void> AudioDecoder::flush() {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, kNotOpen);
  flushDecoder();
  return {};
}

void AudioDecoder::close() noexcept {
  if (state_ == State::Closed) return;
  closeDecoder();
  state_ = State::Closed;
}

}  // namespace relievo
