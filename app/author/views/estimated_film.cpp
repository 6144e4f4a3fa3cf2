// SPDX-License-Identifier: Apache-2.0
#include "app/author/views/estimated_film.h"

#include <filesystem>
#include <utility>

#include "app/estimate/depth_command.h"
#include "app/estimate/depth_network.h"
#include "app/estimate/raw_picture.h"
#include "app/media/reading/depth_doubts.h"
#include "app/media/reading/picture_look.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Error kHasDepth{ErrorCode::InvalidArgument, 0,
                          "has depth, in it or in a file beside it, which relievo probe names; leave --depth-from out"};
constexpr Error kTooSmall{ErrorCode::Unsupported, 0, "its pictures are too small to guess depth from"};
constexpr int kLeastSide = 16;

// "python3 run.py model.onnx" is a command; "my model.onnx" is a network if that file exists.
bool isNetwork(const std::string& how) {
  std::error_code none;
  return how.ends_with(".onnx") && (how.find(' ') == std::string::npos || std::filesystem::is_regular_file(how, none));
}

// A film that begins in black says nothing.
std::vector<std::string> doubtsOfMade(const FramePair& first) {
  if (isBlank(first.color)) return {};
  const DepthCalibration calibration = SteadyRelief::calibration();
  std::vector<std::string> doubts = doubtsOf(first.depth, calibration, &first.color);
  if (!isLevel(first.depth, calibration) && nearerBelow(first.depth, calibration) < -kClearlyNearer) {
    doubts.emplace_back(
        "the depth that was made is nearer above than below, as few views are: if larger is farther in it, as in "
        "distances, play the film with --calibration polarity=near-low");
  }
  return doubts;
}

}  // namespace

Outcome<EstimatedFilm> EstimatedFilm::of(const SourceOptions& source, const FilmInfo& info, OneViewWishes wishes,
                                         const std::atomic<bool>& stop) {
  if (info.has_depth) return failOn(source.url, kHasDepth);
  return EstimatedFilm(std::move(wishes), stop);
}

Outcome<void> EstimatedFilm::start(const Frame& color) {
  color_ = {color.width, color.height};
  if (std::min(color_.cols, color_.rows) < kLeastSide) return failOn("colour", kTooSmall);
  if (isNetwork(wishes_.how)) {
    std::optional<std::pair<int, int>> input;
    if (wishes_.size) input.emplace(wishes_.size->cols, wishes_.size->rows);
    auto network = DepthNetwork::open(wishes_.how, color_.cols, color_.rows, input);
    if (!network) return std::unexpected(network.error());
    estimator_ = std::move(*network);
    return {};
  }
  const DepthSize depth = wishes_.size.value_or(color_);
  auto command = DepthCommand::start({.command = wishes_.how,
                                      .cols = color_.cols,
                                      .rows = color_.rows,
                                      .depth_cols = depth.cols,
                                      .depth_rows = depth.rows},
                                     *stop_);
  if (!command) return std::unexpected(command.error());
  estimator_ = std::move(*command);
  return {};
}

// Gives the estimator the next picture; false at the film's end.
Outcome<bool> EstimatedFilm::readOne(const ReadPair& read) {
  auto pair = read();
  if (!pair) return std::unexpected(pair.error());
  if (!*pair) {
    at_end_ = true;
    if (estimator_) estimator_->end();
    return false;
  }
  const Frame& color = (*pair)->color;
  if (!estimator_) {
    if (auto started = start(color); !started) return std::unexpected(started.error());
  }
  RawPicture picture = rawOf(color);
  waiting_.push_back({std::move(**pair), picture});
  if (auto given = estimator_->give(std::move(picture)); !given) return std::unexpected(given.error());
  return true;
}

Outcome<std::optional<FramePair>> EstimatedFilm::next(const ReadPair& read) {
  for (;;) {
    if (estimator_) {
      auto estimate = estimator_->take();
      if (!estimate) return std::unexpected(estimate.error());
      if (*estimate) return withDepth(**estimate);
    }
    if (at_end_) return std::nullopt;
    if (auto given = readOne(read); !given) return std::unexpected(given.error());
  }
}

FramePair EstimatedFilm::withDepth(const DepthEstimate& estimate) {
  auto [pair, picture] = std::move(waiting_.front());
  waiting_.pop_front();
  Frame depth = relief_.add(picture, estimate);
  const Frame& color = pair.color;
  depth.pts = color.pts;
  depth.duration = color.duration;
  depth.sample_aspect =
      color.sample_aspect * color.width * depth.height / (static_cast<double>(color.height) * depth.width);
  pair.depth = std::move(depth);
  pair.matched = true;
  pair.right = {};
  return std::move(pair);
}

FilmInfo EstimatedFilm::described(FilmInfo info, const FramePair& first) {
  info.has_depth = true;
  info.depth_width = first.depth.width;
  info.depth_height = first.depth.height;
  info.calibration = {};
  info.calibration.calibration = SteadyRelief::calibration();
  // In place of those that it has no depth, or is depth itself.
  info.reading.doubts = doubtsOfMade(first);
  std::erase_if(info.notes, [](const std::string& note) { return note.ends_with("--packing depth-alone"); });
  info.reading.parts = {{"kind", "guessed from one view", CalibrationOrigin::CommandLine},
                        {"polarity", "near-high", CalibrationOrigin::FirstPicture}};
  info.reading.why.emplace_back("relative depth: heights are linear in inverse distance, of unknown scale");
  return info;
}

std::vector<std::string> EstimatedFilm::notes() const {
  const std::size_t shots = relief_.shots();
  return {print(
      "the depth is a guess, made steady over %zu %s; before that, its scale changed within a shot by up to %.0f %%",
      shots, shots == 1 ? "shot" : "shots", 100 * relief_.wandered())};
}

}  // namespace relievo
