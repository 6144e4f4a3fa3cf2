// SPDX-License-Identifier: Apache-2.0
// Reads a film as pairs of a colour picture and a depth picture, however the two are stored.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/media/reading/film_reading.h"
#include "app/media/reading/known_kind.h"
#include "app/media/reading/packing.h"
#include "app/media/registration/registration.h"
#include "app/media/tracks/film_tracks.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/material.h"
#include "hal/media/audio_decoder.h"
#include "hal/media/frame.h"
#include "hal/media/media_source.h"
#include "hal/media/subtitle_decoder.h"
#include "hal/media/video_decoder.h"
#include "platform/error.h"

namespace relievo {

enum class DepthFrom : std::uint8_t { Film, Views };  // Views: made from two views while they are shown

struct SourceOptions {
  std::string url;
  std::string depth_url;  // empty: the depth is in `url`
  Packing packing = Packing::Auto;
  DepthFrom depth_from = DepthFrom::Film;
  std::optional<DepthCode> depth_code;              // nullopt: guessed from the picture
  const KnownKind* as = nullptr;                    // --as KIND
  CalibrationSettings command_line;                 // --calibration KEY=VALUE,..
  CalibrationSettings side_file;                    // --calibration FILE
  std::vector<std::string> named_files;             // files that the side file and the registration were read from
  std::optional<double> frames_per_s;               // of pictures that have numbers but no times
  std::optional<Registration> registration;         // for depth from a camera of its own; not for packed depth
  Material material;                                // what --material says
  std::optional<AudioFormat> sound;                 // the format to deliver sound in; nullopt: no sound
  std::string sound_languages, subtitle_languages;  // "jpn,en": the first that is there; see film_tracks.h
  std::string desktop_language;                     // "de_DE.UTF-8", for subtitle files if no language is asked for
};

// A colour picture, and the depth picture that DepthFollower finds for its time. `matched` is false when that depth
// picture stands in for a missing one.
struct FramePair {
  Frame color;
  Frame depth;  // empty: none at this time
  bool matched = true;
  std::optional<MonotonicTime> taken;  // live films: when the colour was captured, or else received
  Frame right;                         // of a stereo film: the right eye's picture, `color` being the left one's
  Frame material;                      // of the film's material track; empty: none at this time
  Duration delay{0};                   // live films: from being captured to being read
  bool stands = false;  // only the depth is new: the colour picture was left out, `color` has only its time
  int turn = 0;         // by so many quarters it was turned with `turnTo`, clockwise
};

// Turns the pair's pictures until it is turned by `turn` quarters in all, 0 to 3. One that there is no memory for
// stays.
void turnTo(FramePair& pair, int turn) noexcept;

struct FilmInfo {
  int color_stream = 0;  // StreamInfo::index
  int color_width = 0, color_height = 0;
  int depth_width = 0, depth_height = 0;
  bool has_depth = false;
  bool depth_from_views = false;    // has_depth holds, but pairs have none: the player makes it from their views
  Packing packing = Packing::Auto;  // the packing that was found; Tracks if there is no depth
  Duration frame_period{0};         // the usual step between pictures (frame_rate.h); 0 for a single picture
  bool interlaced = false;          // the first pictures; they are deinterlaced
  std::uint8_t color_primaries = kUnspecifiedColor, color_transfer = kUnspecifiedColor;  // as in a Frame
  Duration duration{0};                                                                  // 0: unknown
  Duration container_start{0};     // of the colour: the container's time of media time 0
  CalibrationChoice calibration;   // of a film with depth
  Material material;               // what --material says, else the depth's tags
  Material material_scale;         // of the material track, without the parts that --material states; empty: none
  FilmReading reading;             // how that calibration and the packing were found
  std::vector<std::string> notes;  // what the sources report about themselves; one line each
  std::string color_codec, depth_codec;
  std::string color_decoder, depth_decoder;  // VideoDecoder::description
  std::string sound_codec;                   // if sound was asked for and the film has some
  std::vector<FilmTrack> sounds, subtitles;  // in `url`, then the subtitle files beside it
  std::optional<std::size_t> sound, words;   // chosen of those
  std::vector<Chapter> chapters;
  std::string title;  // the container's tag, of the colour's source, without control characters; may be empty
  int sound_tracks = 0, subtitle_tracks = 0, video_tracks_unused = 0;  // in `url`
  const char* sound_refused = nullptr;                                 // why the sound cannot be decoded
};

struct PairCounters {
  std::uint64_t pairs = 0;
  std::uint64_t without_depth = 0;     // pairs before the depth begins, after its end, or while it is lost
  std::uint64_t mismatched = 0;        // pairs whose depth frame is missing inside a running depth track
  std::uint64_t depth_skipped = 0;     // depth frames that no colour frame used
  std::uint64_t damaged = 0;           // packets and pictures dropped by the decoders
  std::uint64_t deinterlaced = 0;      // pictures that were interlaced, colour and depth
  std::uint64_t jumps = 0;             // discontinuities of container timestamps (ContinuousTime)
  std::uint64_t left_out = 0;          // colour pictures that were not decoded, for lack of time
  std::uint64_t missed_pictures = 0;   // pictures captured but never delivered by the sources (MediaSource)
  std::uint64_t reconnects = 0;        // times the colour source was lost and reopened
  std::uint64_t depth_reconnects = 0;  // the same for `depth_url`
  // Known at a source's end: at least this much of it could not be read (MediaSource::missing).
  Duration missing{0};
  Duration depth_missing{0};  // the same for `depth_url`

  PairCounters& operator+=(const PairCounters& other) noexcept;
};

// Pairs by timestamp, never by count (see DepthFollower). Each source's time starts at zero, so that two files begin
// together whatever start times their containers have.
//
// A failure in the colour is an error. If `isSourceLost` is true for it, `reopen` may recover the source, and the
// film's timestamps continue. A failure in the depth ends the depth with one warning; the film continues without it
// until a seek finds it again or, for a network source, DepthSource reopens it. Depth that the user named (`depth_url`)
// must be available at `open`.
//
// Two live sources are aligned by their sender's clock if they share one, else by their arrival times.
//
// Use from one thread, except `interrupt` and `waitsForSource`, which any thread may call. `next` blocks while it reads
// and decodes. A function that needs an open film returns InvalidState without one.
//
// Sound and subtitles are those of the colour's source that SourceOptions and `chooseTracks` choose. Sound and pictures
// never wait for each other.
class PairReader {
 public:
  struct Backends {
    std::function<std::unique_ptr<MediaSource>(const std::string& url)> make_source;
    std::function<std::unique_ptr<VideoDecoder>(const StreamInfo&)> make_decoder;
    // Fetches a playlist's text from an address, at most so many bytes; gives up when the flag is set.
    std::function<Result<std::string>(const std::string&, std::size_t, const std::atomic<bool>&)> read_text;
    std::function<std::unique_ptr<AudioDecoder>()> make_audio_decoder;        // only if sound is wanted
    std::function<std::unique_ptr<SubtitleDecoder>()> make_subtitle_decoder;  // only if subtitles are wanted
    Clock* clock = nullptr;    // times the retries of lost sources; null: no retries
    bool own_threads = false;  // read a separate depth source on its own thread, so that it cannot block the colour
  };
  explicit PairReader(Backends backends);
  ~PairReader();
  PairReader(const PairReader&) = delete;
  PairReader& operator=(const PairReader&) = delete;

  // Opens the film and decodes its first pictures, so that `info` is known; `next` returns them later. Closes what was
  // open before. On failure `failedThing` names the cause: a source, or "calibration".
  [[nodiscard]] Result<void> open(const SourceOptions& options);
  // nullopt at the end of the colour. If the depth ends earlier, the remaining pairs have none.
  [[nodiscard]] Result<std::optional<FramePair>> next();
  // The next pair will be the first at or after `target` (frame-exact: earlier pictures are decoded and dropped), or
  // nullopt beyond the end. Where that is more than a period after, or only sound is left, it is the last one before.
  // Unsupported if the source cannot seek; the film then continues from where it was. With `key_step` over 0, only the
  // colour's key frames follow, at least `key_step` apart, each with the depth key frame nearest before it; such pairs
  // do not count as mismatched.
  [[nodiscard]] Result<void> seek(MediaTime target, Duration key_step = Duration(0));
  // Whether this error, returned by one of the functions above, means that the colour's source is gone and may come
  // back.
  [[nodiscard]] bool isSourceLost(const Error& error) const noexcept;
  // Tries once to open the colour's source again. A file resumes where it was; a live film continues with what arrives
  // now, as if nothing had been missed. After a failure only `reopen` and `close` may be called.
  [[nodiscard]] Result<void> reopen();
  // The next samples among the data already read, in order; after a seek some may lie before its target. Never reads.
  [[nodiscard]] std::optional<AudioChunk> nextSound();
  // The next subtitle among the data already read; the film's times.
  [[nodiscard]] std::optional<Subtitle> nextSubtitle();
  // Chooses other tracks from now on, by their places in FilmInfo; nullopt for no subtitles. Packets of them that were
  // read before are skipped, until a seek. FilmInfo::sound_refused says if the sound cannot be decoded.
  void chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words);
  // Decodes the sound that is read from here on to another format.
  void setSoundFormat(const AudioFormat& format);
  // Reads one more packet, for containers that store sound later than its pictures; false when that cannot help.
  [[nodiscard]] bool readAhead();
  // For a machine that cannot decode all pictures in time. `unreferenced`: leaves out those colour pictures that no
  // other picture refers to. Depth in a track of its own keeps its own pace: where its colour was left out, the pair
  // `stands`. `until`: pictures before it are late already and are left out, as far as key frames allow.
  void leaveOut(bool unreferenced, std::optional<MediaTime> until = {});
  void close() noexcept;
  // Makes a blocked call, and all later ones until the next `open`, return Cancelled.
  void interrupt() noexcept;
  // True while blocked in a read of the colour's source. Any thread.
  [[nodiscard]] bool waitsForSource() const noexcept;

  [[nodiscard]] const FilmInfo& info() const noexcept;
  [[nodiscard]] PairCounters counters() const noexcept;
  // Why `depth_url` is lost, while it is being retried.
  [[nodiscard]] std::optional<Error> depthLoss() const noexcept;
  // A decoder's restart, each reported once; restarts from before a loss of the source are forgotten.
  [[nodiscard]] std::optional<VideoDecoder::Restart> takeRestart() noexcept;
  [[nodiscard]] const std::string& failedThing() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relievo
