// SPDX-License-Identifier: Apache-2.0
// Reads a film as pairs of a colour picture and a depth picture, whatever way the two are packed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/media/track_reader.h"
#include "app/scene/depth_calibration.h"
#include "hal/frame.h"
#include "hal/media_source.h"
#include "hal/video_decoder.h"
#include "platform/error.h"

namespace relievo {

enum class Packing : std::uint8_t {
  Auto,        // two sources or two video tracks if there are, else the shape tells; one plain picture is colour alone
  Tracks,      // colour and depth are two tracks of one file, or two files
  SideBySide,  // one picture: colour left, depth right
  TopBottom,   // one picture: colour on top, depth below
};

struct SourceOptions {
  std::string url;
  std::string depth_url;  // empty: the depth is in `url`
  Packing packing = Packing::Auto;
  DepthCode depth_code = DepthCode::Luma;
  CalibrationSettings command_line;  // --calibration KEY=VALUE,..
  CalibrationSettings side_file;     // --calibration FILE
};

// Colour always; depth where there is one. The depth is that of the same time: its pts is the newest at or before the
// colour's, and `matched` tells whether it is the right one (see PairReader).
struct FramePair {
  Frame color;
  Frame depth;  // empty: none at this time
  bool matched = true;
};

struct FilmInfo {
  int color_width = 0, color_height = 0;
  int depth_width = 0, depth_height = 0;
  bool has_depth = false;
  Packing packing = Packing::Auto;  // the one found
  Duration frame_period{0};         // from the first two timestamps
  Duration duration{0};             // 0 unknown
  CalibrationChoice calibration;
  std::string color_codec, depth_codec;
};

struct PairCounters {
  std::uint64_t pairs = 0;
  std::uint64_t mismatched = 0;     // pairs whose depth frame is missing though its track goes on
  std::uint64_t depth_skipped = 0;  // depth frames that no colour frame asked for
  std::uint64_t damaged = 0;        // packets and pictures that the decoders dropped
};

// Pairs by timestamp, never by count. A depth frame belongs to every colour frame from its own time (less half a
// millisecond, the rounding of containers) to the next depth frame's: a depth track of a lower rate is held, one of a
// higher rate is thinned. A pair is mismatched when the depth at hand is older than the depth track's own period.
//
// One thread; `interrupt` any thread. `next` blocks while it reads and decodes.
class PairReader {
 public:
  struct Backends {
    std::function<std::unique_ptr<MediaSource>()> make_source;
    std::function<std::unique_ptr<VideoDecoder>()> make_decoder;
  };
  explicit PairReader(Backends backends);
  ~PairReader();

  // Opens, decodes the first pair (so that `info` is known) and keeps it for `next`. On failure `failedThing` names
  // the source that failed.
  [[nodiscard]] Result<void> open(const SourceOptions& options);
  // Nothing at the end of the colour. Depth that ends before the colour yields pairs without depth.
  [[nodiscard]] Result<std::optional<FramePair>> next();
  // The next pair is the first one at or after `target` (frame-exact: what lies before is decoded and dropped).
  [[nodiscard]] Result<void> seek(MediaTime target);
  void close() noexcept;
  void interrupt() noexcept;

  [[nodiscard]] const FilmInfo& info() const noexcept { return info_; }
  [[nodiscard]] PairCounters counters() const noexcept;
  [[nodiscard]] const std::string& failedThing() const noexcept { return failed_thing_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  FilmInfo info_;
  std::string failed_thing_;
};

}  // namespace relievo
