// SPDX-License-Identifier: Apache-2.0
// Reads the decoded pictures of up to three video tracks of one source, each in order, and its sound.
#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/media/tracks/sound_track.h"
#include "app/media/tracks/subtitle_track.h"
#include "hal/media/media_source.h"
#include "hal/media/video_decoder.h"
#include "platform/error.h"

namespace relievo {

// One open source, and a decoder for each selected track. Use from one thread, except `interrupt`, which any thread may
// call.
//
// Packets of the track that is not being read are queued, within bounds. The first track selected leads. When the
// leading track is read and the other's queue is full, that queue is emptied and the track resumes at its next key
// frame. When the other track is read and the leading track's queue is full, there is no picture for now: the other's
// packets are too far behind.
//
// Sound packets are collected while pictures are read; if the container stores them later than the pictures,
// `readAhead` fetches them.
class TrackReader {
 public:
  static constexpr std::size_t kMaxTracks = 3;            // colour, depth, material
  static constexpr std::size_t kMaxWaitingPackets = 768;  // 12 s at 60 frames/s
  static constexpr std::size_t kMaxWaitingBytes = std::size_t{64} << 20;
  // The largest interleaving offset that is followed: a part of an HLS film has all its pictures before its sound.
  static constexpr Duration kReadAhead = std::chrono::seconds(12);
  TrackReader(std::unique_ptr<MediaSource> source,
              std::function<std::unique_ptr<VideoDecoder>(const StreamInfo&)> make_decoder);

  // `frames_per_s`: MediaSource::setPictureRate.
  [[nodiscard]] Result<void> open(const std::string& url, std::optional<double> frames_per_s = std::nullopt);
  // Selects a stream for decoding; returns the track number for `next`. If the caller sets a frame period in `stream`,
  // pictures without timestamps are numbered by it. Exhausted when kMaxTracks are already selected.
  [[nodiscard]] Result<std::size_t> select(const StreamInfo& stream);
  // Selects the sound. Packets read before are not decoded, until a seek.
  [[nodiscard]] Result<void> listen(std::unique_ptr<AudioDecoder> decoder, const StreamInfo& stream,
                                    const AudioFormat& format) {
    return sound_.open(std::move(decoder), stream, format);
  }
  // Selects the subtitles. Packets read lately are repeated, so that a line that is already running is not missed; for
  // the same reason a seek also reads the lines of the time `before` its target.
  [[nodiscard]] Result<void> readWords(std::unique_ptr<SubtitleDecoder> decoder, const StreamInfo& stream,
                                       Duration before = Duration(0)) {
    return words_.open(std::move(decoder), stream, before);
  }
  void ignoreWords() noexcept { words_.close(); }
  // The next subtitle among the data already read. Never reads, never fails.
  [[nodiscard]] std::optional<Subtitle> nextWords() { return words_.next(); }
  // The track's next picture, upright and deinterlaced, in presentation order; nullopt at the end of the track
  // (`ended`) or if none is available now. Exhausted when the caller holds more pictures than the decoder allows.
  [[nodiscard]] Result<std::optional<Frame>> next(std::size_t track);
  // The next samples among the data already read. Never reads, never fails.
  [[nodiscard]] std::optional<AudioChunk> nextSound() { return sound_.next(); }
  // Reads one more packet, for the sound. False at the end of the source, or if picture packets would pile up because
  // they are kReadAhead ahead or have no timestamps. An error is returned by the following `next`.
  [[nodiscard]] bool readAhead();
  // No more pictures will come, except after a seek.
  [[nodiscard]] bool ended(std::size_t track) const noexcept;
  // Afterwards each track's next picture is the last key frame at or before `target`, an earlier one, or the track's
  // first. A track that begins later, or has ended before, may return a later picture or none. With `key_step` over 0
  // only key frames follow, at least `key_step` apart, each decoded by itself.
  [[nodiscard]] Result<void> seek(MediaTime target, Duration key_step = Duration(0));
  // As VideoDecoder::leaveOutUnreferenced, for the leading track.
  void leaveOutUnreferenced(bool leave_out);
  // For pictures that are decoded too late. Leaves out what lies before the leading track's last key frame at or before
  // `until`, and before the other tracks' last key frames at or before that one; packets up to `until` are read,
  // including sound. False if no key frame lies ahead: then nothing is left out.
  [[nodiscard]] Result<bool> hurryTo(MediaTime until);
  void interrupt() noexcept { source_->interrupt(); }
  // Blocked in the source's read. Any thread.
  [[nodiscard]] bool waitsForSource() const noexcept { return waits_for_source_; }
  [[nodiscard]] const MediaSource& source() const noexcept { return *source_; }
  // Packets and pictures dropped by the decoders.
  [[nodiscard]] std::uint64_t damaged() const noexcept;
  // Pictures that came interlaced.
  [[nodiscard]] std::uint64_t deinterlaced() const noexcept { return deinterlaced_; }
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
    bool awaits_keyframe = false;       // skip packets that cannot be decoded yet
    bool passed_over = false;           // packets were skipped while waiting for a key frame
    bool finished = false;              // the source has no more packets of this track
    std::optional<MediaTime> last_key;  // last key frame kept, when only key frames are read
  };
  [[nodiscard]] Result<bool> seekOnce(MediaTime from, MediaTime target, Duration key_step);
  [[nodiscard]] bool isWords(int stream) const;
  [[nodiscard]] bool isWanted(Track& track, const Packet& packet) const;
  [[nodiscard]] Result<std::optional<Frame>> decode(Track& track);
  [[nodiscard]] Result<std::optional<Frame>> receiveWhole(Track& track);
  [[nodiscard]] Result<bool> feed(Track& track);
  [[nodiscard]] Result<bool> readOnePacket();
  void keep(Track& track, Packet packet);
  [[nodiscard]] static Result<std::optional<MediaTime>> dropBeforeKey(Track& track, MediaTime until);
  [[nodiscard]] Result<void> restart(Track& track, bool await_keyframe);
  [[nodiscard]] static bool isFull(const Track& track) noexcept;

  std::unique_ptr<MediaSource> source_;
  std::function<std::unique_ptr<VideoDecoder>(const StreamInfo&)> make_decoder_;
  std::array<Track, kMaxTracks> tracks_;
  std::size_t track_count_ = 0;
  std::uint64_t deinterlaced_ = 0;
  Duration key_step_{0};
  std::atomic<bool> waits_for_source_{false};
  SoundTrack sound_;
  SubtitleTrack words_;
  std::optional<MediaTime> given_, read_;  // the leading track's newest picture and newest packet
};

}  // namespace relievo
