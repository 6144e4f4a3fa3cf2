// SPDX-License-Identifier: Apache-2.0
// Packages a film: converts the pictures of its pairs for the encoders, and writes each picture once.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/author/author.h"
#include "app/author/material/material_track.h"
#include "app/author/package/depth_check.h"
#include "app/author/package/even_cut.h"
#include "app/author/package/key_frames.h"
#include "app/author/package/work_line.h"
#include "app/author/preview/preview.h"
#include "app/depth_window/shots.h"
#include "app/media/pair_reader.h"

namespace relievo {

// The number of pictures of the film, if it states it.
[[nodiscard]] std::optional<std::uint64_t> expectedFrames(const FilmInfo& info);

// Connects the reader to the writer. Pairs are written on the caller's thread, the depth is enhanced on a thread of its
// own, and so is each encoder (see FilmWriter). Arguments passed by reference must outlive it.
class Packager {
 public:
  // `info` describes the film as it is read here: with depth, either the film's own or estimated.
  Packager(PairReader& reader, const PairReader::Backends& backends, FilmInfo info, const SourceOptions& source,
           const OutputOptions& output)
      : reader_(reader), backends_(backends), info_(std::move(info)), source_(source), output_(output) {}

  // Call before the first `write`, with the pair that is written first.
  [[nodiscard]] Outcome<void> begin(const FramePair& pair);
  // All pictures of a track have one size.
  [[nodiscard]] Outcome<void> write(const FramePair& pair);
  // `whole`: see FilmWriter::finish.
  [[nodiscard]] Outcome<AuthorSummary> finish(bool whole);

 private:
  // On the depth's thread.
  [[nodiscard]] Outcome<void> takeDepth(const Frame& depth, bool key);
  [[nodiscard]] Outcome<void> writeDepth(const Frame& depth);
  [[nodiscard]] Outcome<void> writeEnhanced();
  [[nodiscard]] Outcome<void> planMaterial(const FramePair& pair);
  [[nodiscard]] Outcome<void> writeMaterial(const FramePair& pair, const ColorPicture420& color, bool key,
                                            bool begins_shot);
  [[nodiscard]] std::unique_ptr<KeptTracks> keptTracks() const;
  [[nodiscard]] const DepthCalibration& sourceCalibration() const { return info_.calibration.calibration; }
  static constexpr std::size_t kRecent = 3;
  [[nodiscard]] bool beginsShot(const Frame& depth);

  PairReader& reader_;
  const PairReader::Backends& backends_;
  FilmInfo info_;
  const SourceOptions& source_;
  const OutputOptions& output_;
  std::optional<DepthCheck> check_;  // not of a film that is sent in real time
  std::unique_ptr<FilmWriter> writer_;
  std::optional<DepthEnhancer> enhancer_;
  DepthCoder coder_{DepthCalibration{}};  // replaced in `begin` by the film's
  std::vector<std::string> code_notes_;
  FilmFormat format_;
  EvenCut cut_;
  KeyFrames key_frames_;
  std::deque<bool> depth_keys_;      // for pictures not yet written; the depth's thread
  std::deque<TimedSurface> recent_;  // depth pictures, the newest last
  ShotFinder shots_;
  std::optional<MediaTime> last_color_, last_depth_;
  std::uint64_t not_later_ = 0;  // colour pictures whose time is not after that of the one before
  std::mutex preview_mutex_;
  Preview preview_;
  std::optional<MaterialTrack> material_;  // made from a map
  ColorPicture420 kept_material_;          // the source's own
  WorkLine<Outcome<void>> depth_line_;     // the last member: it ends before what it uses
};

}  // namespace relievo
