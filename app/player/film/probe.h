// SPDX-License-Identifier: Apache-2.0
// Examines a source: its contents, the meaning of its depth, and what playing it needs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/depth_window/touch_plan.h"
#include "app/media/frame_rate.h"
#include "app/media/pair_reader.h"
#include "app/player/film/probe_tracks.h"
#include "app/scene/display_volume.h"
#include "hal/media/media_source.h"
#include "platform/failure.h"

namespace relievo {

// Statistics of the first pairs.
struct DepthUse {
  int pairs = 0;
  std::uint32_t lowest_code = 0, highest_code = 0;
  double lowest_mm = 0, highest_mm = 0;
  double holes = 0;  // share of the samples
};

struct ProbeResult {
  std::vector<ProbedTrack> tracks;
  std::vector<Chapter> chapters;   // of the colour's source
  std::optional<Failure> failure;  // the source has tracks, but no film was found in them; the rest is empty
  FilmInfo film;
  FrameRate rate;      // of the colour
  PairCounters pairs;  // of the first ones
  DisplayVolume volume;
  DepthUse depth;
  std::optional<TouchPlan> touch;  // the touch plan; nullopt without depth
  std::string decoder;             // VideoDecoder::description
  std::vector<std::string> needs;  // one line each
};

// Fails where a source does not open.
[[nodiscard]] Outcome<ProbeResult> probe(const SourceOptions& options, const PairReader::Backends& backends);
[[nodiscard]] std::string probeToText(const ProbeResult& result);
[[nodiscard]] std::string probeToJson(const ProbeResult& result);

}  // namespace relievo
