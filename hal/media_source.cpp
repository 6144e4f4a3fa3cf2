// SPDX-License-Identifier: Apache-2.0
// State guards of the media source.
#include "hal/media_source.h"

namespace relievo {

Result<void> MediaSource::open(const std::string& url) {
  if (state_ != State::Closed) return fail(ErrorCode::InvalidState, "the source is open already; close it first");
  auto description = openSource(url);
  if (!description) {
    closeSource();
    return std::unexpected(description.error());
  }
  streams_ = std::move(description->streams);
  tags_ = std::move(description->tags);
  duration_ = description->duration;
  state_ = State::Open;
  return {};
}

Result<std::optional<Packet>> MediaSource::read() {
  if (state_ == State::Closed) return fail(ErrorCode::InvalidState, "the source is closed; open it first");
  if (state_ == State::Ended) return std::nullopt;
  auto packet = readPacket();
  if (packet && !*packet) state_ = State::Ended;
  return packet;
}

Result<void> MediaSource::seek(MediaTime target) {
  if (state_ == State::Closed) return fail(ErrorCode::InvalidState, "the source is closed; open it first");
  auto sought = seekTo(target);
  if (sought) state_ = State::Open;
  return sought;
}

void MediaSource::close() noexcept {
  if (state_ == State::Closed) return;
  closeSource();
  streams_.clear();
  tags_.clear();
  duration_ = Duration(0);
  state_ = State::Closed;
}

}  // namespace relievo
