// SPDX-License-Identifier: Apache-2.0
// Follows the steps along each line, and remembers the last turn.
#include "app/depth_window/ripples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace relievo {
namespace {

constexpr int kLines = 32, kMostSamples = 1024;
constexpr int kSoon = 12;  // samples: a codec's block of 8, and half of the next one

struct Steps {
  std::uint64_t all = 0, ripples = 0;
};

// The middle of a line of `length` samples.
template <class Height>
void addLine(int length, Steps& steps, Height&& height_of) {
  const int count = std::min(length, kMostSamples), first = (length - count) / 2;
  int turn = first - kSoon - 1;  // place of the last one
  double last_step = 0, before = height_of(first);
  for (int i = first + 1; i < first + count; ++i) {
    const double here = height_of(i), step = here - before;
    before = here;
    if (std::abs(step) <= kRoundingMm) continue;
    if (!(std::abs(step) <= kEdgeMm)) {  // or a hole
      last_step = 0;
      continue;
    }
    ++steps.all;
    if (step * last_step < 0) {
      if (i - turn <= kSoon) ++steps.ripples;
      turn = i;
    }
    last_step = step;
  }
}

}  // namespace

double ripplesOf(std::span<const TimedSurface> frames) {
  Steps steps;
  for (const TimedSurface& frame : frames) {
    const HeightField& field = frame.field;
    for (int k = 0; k < kLines; ++k) {
      const int c = (2 * k + 1) * field.cols() / (2 * kLines), r = (2 * k + 1) * field.rows() / (2 * kLines);
      addLine(field.cols(), steps, [&](int i) { return field.heightMm(i, r); });
      addLine(field.rows(), steps, [&](int i) { return field.heightMm(c, i); });
    }
  }
  return steps.all > 0 ? static_cast<double>(steps.ripples) / static_cast<double>(steps.all) : 0;
}

}  // namespace relievo
