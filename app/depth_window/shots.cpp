// SPDX-License-Identifier: Apache-2.0
// Cuts, by a vote of the sampled places; repeated frames, by a comparison of all samples.
#include "app/depth_window/shots.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace relievo {
namespace {

constexpr double kLeastJumpMm = 2.0;
constexpr double kTimesTheMotion = 3.0;
constexpr double kLeastShare = 0.25;

}  // namespace

void ShotFinder::look(const TimedSurface& frame) {
  const auto [at, is_new] = seen_.try_emplace(frame.time);
  if (!is_new) return;
  const HeightField& field = frame.field;
  std::size_t i = 0;
  for (int r = 0; r < kDown; ++r) {
    for (int c = 0; c < kAcross; ++c) {
      at->second.heights[i++] =
          field.heightMm((2 * c + 1) * field.cols() / (2 * kAcross), (2 * r + 1) * field.rows() / (2 * kDown));
    }
  }
}

bool ShotFinder::beginsShot(const TimedSurface* before, const TimedSurface& last, const TimedSurface& next,
                            const TimedSurface* after) {
  Seen& seen = seen_.at(next.time);
  if (seen.judged && seen.last == last.time) return seen.cut;
  seen.cut = isCut(before, last, next, after);
  seen.judged = after != nullptr;
  seen.last = last.time;
  return seen.cut;
}

bool ShotFinder::isCut(const TimedSurface* before, const TimedSurface& last, const TimedSurface& next,
                       const TimedSurface* after) const {
  const Places& z = seen_.at(last.time).heights;
  const Places& next_z = seen_.at(next.time).heights;
  const Places* before_z = before != nullptr ? &seen_.at(before->time).heights : nullptr;
  const Places* after_z = after != nullptr ? &seen_.at(after->time).heights : nullptr;
  int votes = 0, readable = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double jump = std::abs(next_z[i] - z[i]);
    if (std::isnan(jump)) continue;
    ++readable;
    // A neighbouring frame's hole carries no information: fmax ignores its NaN.
    double motion = 0;
    if (before_z != nullptr) motion = std::fmax(motion, std::abs(z[i] - (*before_z)[i]));
    if (after_z != nullptr) motion = std::fmax(motion, std::abs((*after_z)[i] - next_z[i]));
    if (jump > std::max(kLeastJumpMm, kTimesTheMotion * motion)) ++votes;
  }
  return readable > 0 && votes >= kLeastShare * readable;
}

bool ShotFinder::repeats(const TimedSurface& last, const TimedSurface& next) {
  Seen& seen = seen_.at(next.time);
  if (seen.compared != last.time) {
    // Compare bit patterns, so that two holes (NaN) are equal.
    const auto bits = [](double height) { return std::bit_cast<std::uint64_t>(height); };
    seen.repeats = std::ranges::equal(seen_.at(last.time).heights, seen.heights, {}, bits, bits) &&
                   next.field.sameSamples(last.field);
    seen.compared = last.time;
  }
  return seen.repeats;
}

}  // namespace relievo
