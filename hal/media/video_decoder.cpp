// SPDX-License-Identifier: Apache-2.0
// State guards of the video decoder.
#include "hal/media/video_decoder.h"

namespace relievo {
Result<void> VideoDecoder::open(const StreamInfo& stream) {
  if (state_ != State::Closed) return fail(ErrorCode::InvalidState, "the decoder is open already; close it first");
  if (stream.kind != StreamKind::Video) {
    return fail(ErrorCode::InvalidArgument, "the stream holds no video; give a video stream");
  }
  if (std::int64_t{stream.width} * stream.height > kMostSamples) return fail(ErrorCode::Unsupported, kTooLarge);
  damaged_ = 0;
  restart_.reset();
  auto opened = openDecoder(stream);
  if (!opened) {
    closeDecoder();
    return opened;
  }
  state_ = State::Open;
  return {};
}

Result<Feed> VideoDecoder::feed(const Packet& packet) {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, "the decoder accepts packets only while open");
  return feedPacket(packet);
}

Result<std::optional<Frame>> VideoDecoder::receive() {
  if (state_ == State::Closed) return fail(ErrorCode::InvalidState, "the decoder is closed; open it first");
  if (state_ == State::Ended) return std::nullopt;
  Frame frame;
  const auto progress = receiveFrame(frame);
  if (!progress) return std::unexpected(progress.error());
  if (*progress == Progress::Picture) return frame;
  if (*progress == Progress::EndOfStream) state_ = State::Ended;
  return std::nullopt;
}

Result<void> VideoDecoder::drain() {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, "the decoder can drain only while open");
  auto started = startDrain();
  if (started) state_ = State::Draining;
  return started;
}

Result<void> VideoDecoder::flush() {
  if (state_ == State::Closed) return fail(ErrorCode::InvalidState, "the decoder is closed; open it first");
  auto flushed = flushDecoder();
  if (flushed) state_ = State::Open;
  return flushed;
}

Result<void> VideoDecoder::leaveOutUnreferenced(bool leave_out) {
  if (state_ == State::Closed) return fail(ErrorCode::InvalidState, "the decoder is closed; open it first");
  leaveOut(leave_out);
  return {};
}

void VideoDecoder::close() noexcept {
  if (state_ == State::Closed) return;
  closeDecoder();
  state_ = State::Closed;
}

}  // namespace relievo
