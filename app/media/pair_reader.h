// SPDX-License-Identifier: Apache-2.0
// Reads a film as pairs of a colour picture and a depth picture, whatever way the two are packed.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/media/reading/packing.h"
#include "app/media/registration.h"
#include "app/scene/depth_calibration.h"
#include "hal/audio_decoder.h"
#include "hal/frame.h"
#include "hal/media_source.h"
#include "hal/video_decoder.h"
#include "platform/error.h"

namespace relievo {

struct SourceOptions {
  std::string url;
  std::string depth_url;  // empty: the depth is in `url`
  Packing packing = Packing::Auto;
  std::optional<DepthCode> depth_code;       // nothing: as the picture looks
  CalibrationSettings command_line;          // --calibration KEY=VALUE,..
  CalibrationSettings side_file;             // --calibration FILE
  std::vector<std::string> named_files;      // that side file and registration were read from
  std::optional<double> frames_per_s;        // of pictures without times, such as numbered files
  std::optional<Registration> registration;  // of depth that another camera sees than the colour's; not of packed depth
  std::optional<AudioFormat> sound;          // that the film's sound is wanted in; nothing: it is left out
};

// Colour always; depth where there is one: the one that DepthFollower finds for the colour's time. `matched` tells
// whether it is the right one, or a stand-in for one that is missing.
struct FramePair {
  Frame color;
  Frame depth;  // empty: none at this time
  bool matched = true;
  std::optional<MonotonicTime> taken;  // of a live film: when the colour was taken, or came here
};

struct FilmInfo {
  int color_width = 0, color_height = 0;
  int depth_width = 0, depth_height = 0;
  bool has_depth = false;
  Packing packing = Packing::Auto;   // the one found; Tracks where there is no depth
  Duration frame_period{0};          // between the first two times, without their rounding; 0 of a single picture
  Duration duration{0};              // 0 unknown
  CalibrationChoice calibration;     // of a film with depth
  std::vector<std::string> reading;  // what was read off the first pictures, and why; one line each
  std::vector<std::string> doubts;   // what makes that unlikely, and what to type; one line each
  std::string color_codec, depth_codec;
  std::string color_decoder, depth_decoder;  // VideoDecoder::description
  std::string sound_codec;                   // of the film's sound, where it was wanted and there is some
  int sound_tracks = 0, subtitle_tracks = 0, video_tracks_unused = 0;  // of `url`
  const char* sound_refused = nullptr;                                 // why it cannot be decoded
};

struct PairCounters {
  std::uint64_t pairs = 0;
  std::uint64_t without_depth = 0;     // pairs before the depth begins, after it has ended, or where it was lost
  std::uint64_t mismatched = 0;        // pairs whose depth frame is missing though its track goes on
  std::uint64_t depth_skipped = 0;     // depth frames that no colour frame asked for
  std::uint64_t damaged = 0;           // packets and pictures that the decoders dropped
  std::uint64_t jumps = 0;             // of the containers' times (ContinuousTime)
  std::uint64_t missed_pictures = 0;   // that the sources took and never handed out (MediaSource)
  std::uint64_t reconnects = 0;        // how often the colour's source was lost and found again
  std::uint64_t depth_reconnects = 0;  // of `depth_url`
  // Once a source has been read to its end: how much of its length was not there (MediaSource::missing).
  Duration missing{0};
  Duration depth_missing{0};  // of `depth_url`

  PairCounters& operator+=(const PairCounters& other) noexcept;
};

// Pairs by timestamp, never by count, as DepthFollower says. Each source's time begins at its own zero, so that two
// files begin together, whatever start times their containers hold.
//
// What fails in the colour is an error; where `isSourceLost` says so, `reopen` may find the source again, and the
// film's times go on. What fails in the depth ends the depth, with one warning: the film goes on without, until a seek
// finds it again, or, where it comes over a network, DepthSource does. Depth that was asked for by name (`depth_url`)
// has to be there at `open`.
//
// Two live sources are brought together by their sender's clock, where that is one; else by their arrival here.
//
// One thread; `interrupt` any thread. `next` blocks while it reads and decodes. A verb that needs an open film returns
// InvalidState without one.
//
// The sound is the first one of the source that holds the colour. It neither waits for pictures nor makes them wait.
class PairReader {
 public:
  struct Backends {
    std::function<std::unique_ptr<MediaSource>(const std::string& url)> make_source;
    std::function<std::unique_ptr<VideoDecoder>(const StreamInfo&)> make_decoder;
    // The text at an address, at most so many bytes of it; gives up when the flag is set. Of lists of films.
    std::function<Result<std::string>(const std::string&, std::size_t, const std::atomic<bool>&)> read_text;
    std::function<std::unique_ptr<AudioDecoder>()> make_audio_decoder;  // of who wants sound
    Clock* clock = nullptr;    // for what is lost and tried again; null: it stays lost
    bool own_threads = false;  // for a depth source that must not hold the colour up
  };
  explicit PairReader(Backends backends);
  ~PairReader();
  PairReader(const PairReader&) = delete;
  PairReader& operator=(const PairReader&) = delete;

  // Opens, decodes the first pictures (so that `info` is known) and keeps them for `next`. What was open is closed
  // before. On failure `failedThing` names what failed: a source, or "calibration".
  [[nodiscard]] Result<void> open(const SourceOptions& options);
  // Nothing at the end of the colour. Depth that ends before the colour yields pairs without depth.
  [[nodiscard]] Result<std::optional<FramePair>> next();
  // The next pair is the first one at or after `target` (frame-exact: what lies before is decoded and dropped), or
  // nothing beyond the end. Unsupported where the source cannot seek; the film then goes on where it was.
  // `key_step` over 0: from there on the colour's key frames alone, at least so far apart, with whatever key frame of
  // the depth is nearest before each; such pairs are not counted as mismatched.
  [[nodiscard]] Result<void> seek(MediaTime target, Duration key_step = Duration(0));
  // After an error of a verb above: the colour's source has gone away and may come back.
  [[nodiscard]] bool isSourceLost(const Error& error) const noexcept;
  // Opens the colour's source anew, once. A film goes on where it was; a live one from what comes now, as if nothing
  // had been missed. After a failure only `reopen` and `close` are of use.
  [[nodiscard]] Result<void> reopen();
  // The next samples among what has been read, in order; after a seek some may lie before its target. Never reads.
  [[nodiscard]] std::optional<AudioChunk> nextSound();
  // Reads one packet more, where sound comes later in the source than its pictures; false when that helps no more.
  [[nodiscard]] bool readAhead();
  void close() noexcept;
  // Makes a blocked verb return Cancelled, and those to come until the next `open`.
  void interrupt() noexcept;

  [[nodiscard]] const FilmInfo& info() const noexcept;
  [[nodiscard]] PairCounters counters() const noexcept;
  // Why the depth of `depth_url` is away, while it is looked for.
  [[nodiscard]] std::optional<Error> depthLoss() const noexcept;
  // Of a decoder, each once; after a loss of the source none of before.
  [[nodiscard]] std::optional<VideoDecoder::Restart> takeRestart() noexcept;
  [[nodiscard]] const std::string& failedThing() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relievo
