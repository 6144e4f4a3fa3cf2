// SPDX-License-Identifier: Apache-2.0
// Reads the decoded pictures of one or two video tracks of one source, each in order, and the sound beside them.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/media/sound_track.h"
#include "hal/media_source.h"
#include "hal/video_decoder.h"
#include "platform/error.h"

namespace relievo {

// One open source and a decoder for each chosen track. One thread, but `interrupt`, which any thread may call.
//
// Packets of the track that is not asked for at the moment are kept, within bounds. The first track chosen leads: while
// it is read and the other's queue is full, that one is emptied, and goes on from its next key frame. While the other
// is read and the leading track's queue is full, there is nothing for now: its packets are too far behind.
//
// Sound is what comes along while pictures are read; where the container has it later than its pictures, `readAhead`
// fetches it.
class TrackReader {
 public:
  static constexpr std::size_t kMaxTracks = 2;
  static constexpr std::size_t kMaxWaitingPackets = 512;  // 8 s of 60 frames/s
  static constexpr std::size_t kMaxWaitingBytes = std::size_t{64} << 20;
  static constexpr Duration kReadAhead = std::chrono::seconds(2);  // what interleaving is off by at most
  TrackReader(std::unique_ptr<MediaSource> source,
              std::function<std::unique_ptr<VideoDecoder>(const StreamInfo&)> make_decoder);

  [[nodiscard]] Result<void> open(const std::string& url);
  // Chooses a stream to be decoded; returns the track's number for `next`. A frame period of the caller's in `stream`
  // is what pictures without times are numbered by. Exhausted when two are chosen already.
  [[nodiscard]] Result<std::size_t> select(const StreamInfo& stream);
  // Chooses the sound, once; before the first `next`, so that none is missed.
  [[nodiscard]] Result<void> listen(std::unique_ptr<AudioDecoder> decoder, const StreamInfo& stream,
                                    const AudioFormat& format) {
    return sound_.open(std::move(decoder), stream, format);
  }
  // The track's next picture, upright, in presentation order, or nothing: at its end (`ended`), or for now. Exhausted
  // when the caller holds more pictures than the decoder allows.
  [[nodiscard]] Result<std::optional<Frame>> next(std::size_t track);
  // The next samples among what has been read. Never reads, never fails.
  [[nodiscard]] std::optional<AudioChunk> nextSound() { return sound_.next(); }
  // Reads one packet more, for the sound's sake. False when there is none, or the pictures' packets would pile up: they
  // are kReadAhead ahead, or have no times. What fails is told by the next `next`.
  [[nodiscard]] bool readAhead();
  // No more pictures will come, unless after a seek.
  [[nodiscard]] bool ended(std::size_t track) const noexcept;
  // Afterwards each track's next picture is the last key frame at or before `target`, or one before that, or the
  // track's first; a track that has no picture so early or goes on no longer may have a later one or none.
  // `key_step` over 0: from there on key frames alone, at least so far apart; each is decoded by itself.
  [[nodiscard]] Result<void> seek(MediaTime target, Duration key_step = Duration(0));
  void interrupt() noexcept { source_->interrupt(); }
  [[nodiscard]] const MediaSource& source() const noexcept { return *source_; }
  // Packets and pictures that the decoders dropped.
  [[nodiscard]] std::uint64_t damaged() const noexcept;
  [[nodiscard]] std::optional<VideoDecoder::Restart> takeRestart() noexcept;
  [[nodiscard]] std::string decoder(std::size_t track) const { return tracks_[track].decoder->description(); }

 private:
  struct Track {
    int stream = -1;
    int rotation = 0;  // StreamInfo::rotation
    std::unique_ptr<VideoDecoder> decoder;
    std::deque<Packet> waiting;
    std::size_t waiting_bytes = 0;
    std::optional<Frame> found;         // by the last seek
    bool awaits_keyframe = false;       // what cannot be decoded is not tried
    bool passed_over = false;           // packets were, for want of a key frame
    bool finished = false;              // the source has no more of it
    std::optional<MediaTime> last_key;  // kept, of key frames alone
  };
  [[nodiscard]] Result<bool> seekOnce(MediaTime from, MediaTime target, Duration key_step);
  [[nodiscard]] bool isWanted(Track& track, const Packet& packet) const;
  [[nodiscard]] Result<std::optional<Frame>> decode(Track& track);
  [[nodiscard]] static Result<std::optional<Frame>> receiveUpright(Track& track);
  [[nodiscard]] Result<bool> feed(Track& track);
  [[nodiscard]] Result<bool> readOnePacket();
  void keep(Track& track, Packet packet);
  [[nodiscard]] Result<void> restart(Track& track, bool await_keyframe);
  [[nodiscard]] static bool isFull(const Track& track) noexcept;

  std::unique_ptr<MediaSource> source_;
  std::function<std::unique_ptr<VideoDecoder>(const StreamInfo&)> make_decoder_;
  std::array<Track, kMaxTracks> tracks_;
  std::size_t track_count_ = 0;
  Duration key_step_{0};
  SoundTrack sound_;
  std::optional<MediaTime> given_, read_;  // the leading track's newest picture, and its newest packet
};

}  // namespace relievo
