// SPDX-License-Identifier: Apache-2.0
// The two jobs of relievo-author: package a film's colour and depth, and make the sample film.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/author/material/painting.h"
#include "app/author/package/depth_check.h"
#include "app/author/package/depth_coder.h"
#include "app/author/package/film_writer.h"
#include "app/author/sample/sample_scene.h"
#include "app/author/views/estimated_film.h"
#include "app/author/views/stereo_film.h"
#include "app/enhance/enhancer.h"
#include "app/media/lost_part.h"
#include "app/media/pair_reader.h"
#include "platform/failure.h"

namespace relievo {

struct OutputOptions {
  std::string path;    // or udp://HOST:PORT, srt://HOST:PORT: sent in real time
  bool force = false;  // replace an existing file
  int color_crf = 18;
  DepthCoding depth;
  KeptWishes keep;
  std::optional<SwapEyes> from_views;          // make the depth from a film's two views; nullopt: the film has depth
  std::optional<OneViewWishes> from_one_view;  // make the depth from one view, by a command or a network; nullopt: no
  std::optional<Enhancement> enhancement;      // nullopt: no enhancement
  std::vector<Painting> paintings;             // the material of places; empty: none
  std::string preview;                         // path of a PNG, see preview.h; empty: none
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
  EnhancementSummary enhanced;            // if it was enhanced
  std::vector<std::string> kept;          // sound, subtitles, chapters; see KeptTracks
  std::string read_as;                    // what the source's depth means, for a person; empty for the sample film
  std::vector<std::string> read_because;  // why, and what else it may be
  DepthLoss loss;                         // between the source's relief and the film's
  std::vector<std::string> notes;         // what was done to the pictures
  std::vector<LostPart> lost;             // parts of the source that the film lacks
};

// Called after every colour picture with the number done and, if known, the total.
using ProgressReport = std::function<void(std::uint64_t done, std::optional<std::uint64_t> total)>;

// Both run until they finish, fail, or find `stop` set, which makes them return Cancelled and leave no file. A live
// film ends at `stop` or when its source goes away, and is complete then; so is one that is sent over the network.
// Pictures keep their timestamps. A depth picture is written once, at its own time, however many colour pictures it
// belongs to. Colour of an odd width or height loses its last column or row, and the depth loses the same share of the
// view, so that both stay aligned.
[[nodiscard]] Outcome<AuthorSummary> authorFilm(const SourceOptions& source, const PairReader::Backends& backends,
                                                const OutputOptions& output, const std::atomic<bool>& stop,
                                                const ProgressReport& progress);
[[nodiscard]] Outcome<AuthorSummary> authorSample(const SampleOptions& sample, const OutputOptions& output,
                                                  const std::atomic<bool>& stop, const ProgressReport& progress);

}  // namespace relievo
