// SPDX-License-Identifier: Apache-2.0
// Turns a film of one view into one of colour and depth: a command or a network estimates the depth, which is then made
// steady over time.
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/estimate/depth_estimator.h"
#include "app/estimate/steady_relief.h"
#include "app/media/pair_reader.h"
#include "platform/failure.h"

namespace relievo {

struct DepthSize {
  int cols = 0, rows = 0;
};

struct OneViewWishes {
  std::string how;                // a command for /bin/sh, or the path of a network, which ends with .onnx
  std::optional<DepthSize> size;  // of the depth that the command writes, or of what the network takes
};

// Use from one thread. It holds the pictures that the estimator has not answered, up to DepthCommand::kMostLate.
class EstimatedFilm {
 public:
  // Fails if the film has depth of its own.
  [[nodiscard]] static Outcome<EstimatedFilm> of(const SourceOptions& source, const FilmInfo& info,
                                                 OneViewWishes wishes, const std::atomic<bool>& stop);

  // Returns the film's next pair, with pictures of one size; nullopt after the last one.
  using ReadPair = std::function<Outcome<std::optional<FramePair>>()>;
  // The next pair with its depth; nullopt after the last one. Starts the estimator at the first.
  [[nodiscard]] Outcome<std::optional<FramePair>> next(const ReadPair& read);
  // Describes the film with its estimated depth.
  [[nodiscard]] static FilmInfo described(FilmInfo info, const FramePair& first);
  // What was done, one line each. Call once all pairs have been taken.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Waiting {
    FramePair pair;
    RawPicture picture;  // for the motion estimation
  };

  EstimatedFilm(OneViewWishes wishes, const std::atomic<bool>& stop) : wishes_(std::move(wishes)), stop_(&stop) {}
  [[nodiscard]] Outcome<void> start(const Frame& color);
  [[nodiscard]] Outcome<bool> readOne(const ReadPair& read);
  [[nodiscard]] FramePair withDepth(const DepthEstimate& estimate);

  OneViewWishes wishes_;
  const std::atomic<bool>* stop_;
  std::unique_ptr<DepthEstimator> estimator_;
  DepthSize color_;
  std::deque<Waiting> waiting_;  // given to the estimator, not answered yet
  SteadyRelief relief_;
  bool at_end_ = false;
};

}  // namespace relievo
