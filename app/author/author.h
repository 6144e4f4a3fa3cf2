// SPDX-License-Identifier: Apache-2.0
// The two jobs of the author's program: to package a film's colour and depth, and to make the project's sample film.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/author/package/depth_coder.h"
#include "app/author/package/film_writer.h"
#include "app/author/sample/sample_scene.h"
#include "app/enhance/enhancer.h"
#include "app/media/pair_reader.h"
#include "platform/failure.h"

namespace relievo {

struct OutputOptions {
  std::string path;    // or udp://HOST:PORT: sent at the film's own pace
  bool force = false;  // to replace a file that is there
  int color_crf = 18;
  DepthCoding depth;
  std::optional<Enhancement> enhancement;  // nothing: the depth as it comes
  std::string preview;                     // a PNG, see preview.h; empty: none
};

struct SampleOptions {
  int cols = SampleFilm::kCols, rows = SampleFilm::kRows;  // even
  int frames = SampleFilm::kFrames;
  int threads = 1;
};

struct AuthorSummary {
  FilmFormat format;
  FilmTotals totals;
  Duration frame_period{0};
  DepthCoder::Counts codes;
  std::optional<Enhancement> enhancement;
  EnhancementSummary enhanced;     // where it was enhanced
  std::vector<std::string> notes;  // what was done to the pictures
};

// Called after every picture of the colour, with the number of them that are done and, where known, that there will be.
using ProgressReport = std::function<void(std::uint64_t done, std::optional<std::uint64_t> total)>;

// Both run until they are done, fail, or find `stop` set, which makes them return Cancelled; nothing is left then.
// A live film ends at `stop`, and when its source goes away: it is whole then. What goes out on a line may be stopped
// at any time: it is done then. The film's pictures keep their times. A depth picture is written once, at its own time,
// however many pictures of the colour it belongs to. Colour of an odd width or height loses its last column or row, and
// the depth as much of its own as keeps the two in register.
[[nodiscard]] Outcome<AuthorSummary> authorFilm(const SourceOptions& source, const PairReader::Backends& backends,
                                                const OutputOptions& output, const std::atomic<bool>& stop,
                                                const ProgressReport& progress);
[[nodiscard]] Outcome<AuthorSummary> authorSample(const SampleOptions& sample, const OutputOptions& output,
                                                  const std::atomic<bool>& stop, const ProgressReport& progress);

}  // namespace relievo
