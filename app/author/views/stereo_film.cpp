// SPDX-License-Identifier: Apache-2.0
#include "app/author/views/stereo_film.h"

#include <cmath>
#include <utility>

#include "app/media/pairs/long_wait.h"
#include "app/media/reading/stereo/stereo_pair.h"
#include "app/stereo/stereo_survey.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Error kNotTwoViews{ErrorCode::Unsupported, 0,
                             "not a film of two views; if it is one, state their layout with --packing stereo-sbs or "
                             "stereo-tb"};
constexpr Error kCancelled{ErrorCode::Cancelled, 0, "interrupted; nothing was written"};

// The user states that the film has two views, so halves that may be views are taken as views.
Outcome<SourceOptions> withLayout(SourceOptions source, const PairReader::Backends& backends) {
  PairReader reader(backends);
  if (auto opened = openTelling(reader, source); !opened) return failOn(reader.failedThing(), opened.error());
  const Packing packing = reader.info().packing;
  if (hasTwoViews(packing)) return source;
  if (source.packing != Packing::Auto || reader.info().has_depth) return failOn(source.url, kNotTwoViews);
  const auto first = reader.next();
  if (!first) return failOn(reader.failedThing(), first.error());
  const auto views = *first ? findViews((*first)->color) : std::nullopt;
  if (!views) return failOn(source.url, kNotTwoViews);
  source.packing = *views;
  return source;
}

Outcome<StereoPlan> planOf(const SourceOptions& source, const PairReader::Backends& backends, bool swapped,
                           const std::atomic<bool>& stop, const StereoFilm::Progress& progress) {
  PairReader reader(backends);
  if (auto opened = reader.open(source); !opened) return failOn(reader.failedThing(), opened.error());
  const FilmInfo& info = reader.info();
  std::optional<std::uint64_t> total;
  if (info.duration > Duration(0) && info.frame_period > Duration(0)) {
    total = static_cast<std::uint64_t>(std::llround(toSeconds(info.duration) / toSeconds(info.frame_period)));
  }
  StereoSurvey survey;
  for (std::uint64_t done = 1;; ++done) {
    if (stop.load(std::memory_order_relaxed)) return failOn(source.url, kCancelled);
    auto pair = reader.next();
    if (!pair) return failOn(reader.failedThing(), pair.error());
    if (!*pair) break;
    const FramePair& views = **pair;
    if (views.right.empty()) continue;
    auto added = swapped ? survey.add(views.right, views.color) : survey.add(views.color, views.right);
    if (!added) return failOn(source.url, added.error());
    progress(done, total);
  }
  auto plan = survey.finish();
  if (!plan) return failOn(source.url, plan.error());
  return std::move(*plan);
}

}  // namespace

StereoFilm::StereoFilm(SourceOptions source, StereoPlan plan, bool swapped)
    : source_(std::move(source)), depth_(std::move(plan)), swapped_(swapped) {
  notes_ = depth_.plan().notes;
}

Outcome<StereoFilm> StereoFilm::survey(const SourceOptions& source, const PairReader::Backends& backends, SwapEyes swap,
                                       const std::atomic<bool>& stop, const Progress& progress) {
  auto told = withLayout(source, backends);
  if (!told) return std::unexpected(told.error());
  bool swapped = swap == SwapEyes::Yes;
  auto plan = planOf(*told, backends, swapped, stop, progress);
  if (!plan) return std::unexpected(plan.error());
  const bool looks_swapped = plan->views_swapped, order_known = plan->order_known;
  if (looks_swapped && swap == SwapEyes::Auto) {
    swapped = true;
    plan = planOf(*told, backends, swapped, stop, progress);
    if (!plan) return std::unexpected(plan.error());
  }
  StereoFilm film(std::move(*told), std::move(*plan), swapped);
  film.order_told_ = order_known || swap != SwapEyes::Auto;
  if (looks_swapped && swap == SwapEyes::Auto) {
    film.notes_.insert(
        film.notes_.begin(),
        "the right eye's view came first: the views were swapped; --swap-eyes no leaves them as they are");
  } else if (looks_swapped) {
    film.notes_.insert(film.notes_.begin(), print("the views look swapped, near and far exchanged; try --swap-eyes %s",
                                                  swapped ? "no" : "yes"));
  } else if (!order_known && swap == SwapEyes::Auto) {
    film.notes_.emplace_back(
        "the pictures do not show which eye's view comes first; it is taken for the left eye's: if near feels far, "
        "make it again with --swap-eyes yes");
  }
  return film;
}

FilmInfo StereoFilm::described(FilmInfo info) const {
  info.has_depth = true;
  info.depth_width = depth_.plan().cols;
  info.depth_height = depth_.plan().rows;
  info.calibration = {};
  info.calibration.calibration = StereoDepth::calibration();
  info.reading.doubts.clear();  // that it has two views and no depth
  info.reading.parts = {
      {"kind", "made from its two views", CalibrationOrigin::CommandLine},
      {"polarity", "near-high", order_told_ ? CalibrationOrigin::CommandLine : CalibrationOrigin::FirstPicture}};
  info.reading.why.push_back(print("linear in disparity, %zu %s", depth_.plan().shots.size(),
                                   depth_.plan().shots.size() == 1 ? "shot" : "shots, each over its own range"));
  return info;
}

Result<FramePair> StereoFilm::withDepth(FramePair views) {
  if (swapped_) std::swap(views.color, views.right);
  auto depth = depth_.depthOf(views.color, views.right);
  if (!depth) return std::unexpected(depth.error());
  views.depth = std::move(*depth);
  views.right = {};
  return views;
}

}  // namespace relievo
