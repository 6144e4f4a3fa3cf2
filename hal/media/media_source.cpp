// SPDX-License-Identifier: Apache-2.0
// State guards of the media source.
#include "hal/media/media_source.h"

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
  chapters_ = std::move(description->chapters);
  notes_ = std::move(description->notes);
  duration_ = description->duration;
  origin_ = description->origin;
  times_.begin(origin_.longest_gap);
  state_ = State::Open;
  return {};
}

Result<std::optional<Packet>> MediaSource::read() {
  if (state_ == State::Closed) return fail(ErrorCode::InvalidState, "the source is closed; open it first");
  if (state_ == State::Ended) return std::nullopt;
  auto packet = readPacket();
  if (!packet) return packet;
  if (!*packet) {
    state_ = State::Ended;
  } else {
    retime(**packet);
  }
  return packet;
}

void MediaSource::retime(Packet& packet) {
  const auto& time = packet.dts ? packet.dts : packet.pts;
  if (!time) return;
  const Duration offset = times_.offsetFor(packet.stream, *time);
  if (packet.pts) *packet.pts += offset;
  if (packet.dts) *packet.dts += offset;
}

Result<void> MediaSource::seek(MediaTime target) {
  if (state_ == State::Closed) return fail(ErrorCode::InvalidState, "the source is closed; open it first");
  auto sought = seekTo(target);
  if (!sought) return sought;
  state_ = State::Open;
  times_.begin(origin_.longest_gap);
  return sought;
}

void MediaSource::close() noexcept {
  if (state_ == State::Closed) return;
  closeSource();
  streams_.clear();
  tags_.clear();
  chapters_.clear();
  notes_.clear();
  duration_ = Duration(0);
  origin_ = {};
  state_ = State::Closed;
}

}  // namespace relievo
