// SPDX-License-Identifier: Apache-2.0
// The tracks and chapters of a source, for `relievo probe`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/media/frame_rate.h"
#include "app/media/pair_reader.h"
#include "hal/media/media_source.h"
#include "platform/failure.h"

namespace relievo {

struct ProbedTrack {
  std::string source;
  StreamInfo stream;
  FrameRate rate;  // of video
};
struct ProbedSource {
  std::vector<ProbedTrack> tracks;
  std::vector<Chapter> chapters;
};

// Opens the source, and reads timestamps of a file: at most 4096 pictures of each track or 64 MiB.
[[nodiscard]] Outcome<ProbedSource> readTracks(const std::string& url, std::optional<double> frames_per_s,
                                               const PairReader::Backends& backends);

[[nodiscard]] std::string trackText(const ProbedTrack& track);
[[nodiscard]] std::string chapterText(const Chapter& chapter);
[[nodiscard]] nlohmann::ordered_json trackJson(const ProbedTrack& track);
[[nodiscard]] nlohmann::ordered_json rateJson(const FrameRate& rate);

}  // namespace relievo
