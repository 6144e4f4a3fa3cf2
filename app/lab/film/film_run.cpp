// SPDX-License-Identifier: Apache-2.0
// Only the method is timed: frames are rendered before, and the window moves between the ticks.
#include "app/lab/film/film_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/depth_window/shots.h"
#include "app/lab/film/coded_depth.h"
#include "app/lab/film/memory_feed.h"
#include "app/lab/film/parallel.h"

namespace relievo {

Result<MemoryFilm> MemoryFilm::make(const TrueSurface& surface, const Format& format, double from_s, double until_s) {
  const DepthFormat rendering{.cols = format.cols,
                              .rows = format.rows,
                              .frames_per_s = format.frames_per_s,
                              .bits = format.depth.bits,
                              .noise_share = format.depth.noise_share};
  const int first = std::max(0, static_cast<int>(std::floor(from_s * format.frames_per_s)) - SurfaceWindow::kBefore);
  const int last = static_cast<int>(std::ceil(until_s * format.frames_per_s)) + SurfaceWindow::kAhead;
  std::vector<Frame> pictures(last - first + 1);
  inParallel(pictures.size(),
             [&](std::size_t i) { pictures[i] = renderDepth(surface, rendering, first + static_cast<int>(i)); });
  if (format.depth.crf) {
    auto coded = codeDepth(pictures, *format.depth.crf);
    if (!coded) return std::unexpected(coded.error());
    pictures = std::move(coded->frames);
  }
  return of(pictures, {.bits = format.depth.bits});
}

Result<MemoryFilm> MemoryFilm::of(std::span<const Frame> pictures, const DepthCalibration& calibration) {
  MemoryFilm film;
  for (const Frame& picture : pictures) {
    const auto field = HeightField::make(picture, calibration, TrueSurface::kVolume);
    if (!field) return std::unexpected(field.error());
    film.frames_.push_back({*field, picture.pts, picture.owner});
  }
  ShotFinder().mark(film.frames_);
  film.windows_.resize(film.frames_.size());
  MemoryFeed feed(film.frames_);
  for (std::size_t i = 0; i < film.frames_.size(); ++i) {
    static_cast<void>(feed.update(film.frames_[i].time, 0, 0, film.windows_[i]));
  }
  return film;
}

FilmRun::FilmRun(const MemoryFilm& film, TouchMethod& method) : film_(film), method_(method) {
  method_.reset();
}

PlayedTick FilmRun::tick(const HipTick& hip) {
  const MediaTime now = mediaTime(hip.t_s);
  const auto frames = film_.frames();
  while (present_ + 1 < frames.size() && frames[present_ + 1].time <= now) ++present_;
  const SurfaceWindow& window = film_.windowAt(present_);
  PlayedTick played{.t_s = hip.t_s, .hip_mm = hip.hip_mm};
  const MonotonicTime woken = clock_.now();
  method_.prefetch(window);
  const MonotonicTime begin = clock_.now();
  played.touch = method_.update(hip.hip_mm, window, now);
  const MonotonicTime out = clock_.now();
  method_.upkeep(window, now);
  played.upkeep = (clock_.now() - out) + (begin - woken);
  played.update = out - begin;
  return played;
}

std::vector<TrueTouch> truthAlong(const TrueSurface& surface, std::span<const HipTick> path) {
  Oracle oracle(surface);
  std::vector<TrueTouch> truth;
  truth.reserve(path.size());
  for (const HipTick& tick : path) truth.push_back(oracle.update(tick.hip_mm, tick.t_s));
  return truth;
}

std::vector<PlayedTick> playPath(const MemoryFilm& film, TouchMethod& method, std::span<const HipTick> path,
                                 std::span<const TrueTouch> truth) {
  FilmRun run(film, method);
  std::vector<PlayedTick> ticks;
  ticks.reserve(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    ticks.push_back(run.tick(path[i]));
    ticks.back().truth = truth[i];
  }
  return ticks;
}

}  // namespace relievo
