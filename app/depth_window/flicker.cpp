// SPDX-License-Identifier: Apache-2.0
// The common change of two frames as a line over the heights, fitted to the places that follow it.
#include "app/depth_window/flicker.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "app/depth_window/lattice.h"

namespace relievo {
namespace {

constexpr int kLeastPlaces = Lattice::kPlaces / 16;
constexpr int kFits = 2;
// A place farther from the line than this many medians moves by itself: 2.5 standard deviations of normal noise.
constexpr double kOffTheLine = 2.5 / 0.6745;

struct Change {
  double height_mm, change_mm;
};

struct Moments {
  double mean_mm = 0, variance_mm2 = 0;  // of the heights
};

// change = shift + slope (height - mean height)
struct Line {
  double shift_mm = 0, slope = 0;
  Moments heights;
  [[nodiscard]] double at(double height_mm) const { return shift_mm + slope * (height_mm - heights.mean_mm); }
};

Line fit(const std::vector<Change>& changes) {
  Line line;
  const auto n = static_cast<double>(changes.size());
  for (const Change& c : changes) line.heights.mean_mm += c.height_mm / n, line.shift_mm += c.change_mm / n;
  double together = 0;
  for (const Change& c : changes) {
    const double off = c.height_mm - line.heights.mean_mm;
    line.heights.variance_mm2 += off * off / n;
    together += off * (c.change_mm - line.shift_mm) / n;
  }
  if (line.heights.variance_mm2 > 0) line.slope = together / line.heights.variance_mm2;
  return line;
}

template <class Value>
double median(const std::vector<Change>& changes, Value&& value) {
  std::vector<double> values;
  values.reserve(changes.size());
  for (const Change& c : changes) values.push_back(value(c));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Nullopt if too few places can be compared, or follow the line.
std::optional<Line> commonChange(const HeightField& from, const HeightField& to) {
  std::vector<Change> changes;
  changes.reserve(Lattice::kPlaces);
  Lattice::forPlaces(from, [&](int c, int r) {
    const double before = from.heightMm(c, r), after = to.heightMm(c, r);
    // Values painted or clipped at either end of the range do not follow. A hole fails every comparison.
    if (std::min(before, after) > 0 && std::max(before, after) < from.depthMm()) {
      changes.push_back({before, after - before});
    }
  });
  if (static_cast<int>(changes.size()) < kLeastPlaces) return {};
  // The first line is level at the median of all places: a fit would follow places that move by themselves.
  Line line{.shift_mm = median(changes, [](const Change& c) { return c.change_mm; })};
  for (int round = 0; round < kFits; ++round) {
    const auto off = [&](const Change& c) { return std::abs(c.change_mm - line.at(c.height_mm)); };
    const double most = std::max(kOffTheLine * median(changes, off), from.stepMm());
    std::erase_if(changes, [&](const Change& c) { return off(c) > most; });
    if (static_cast<int>(changes.size()) < kLeastPlaces) return {};
    line = fit(changes);
  }
  return line;
}

// The difference of two changes: at the mean height, and from there to one standard deviation of the heights.
struct Turn {
  double shift_mm, tilt_mm;
};

Turn turn(const Line& from, const Line& to) {
  const double deviation = std::sqrt(from.heights.variance_mm2);
  return {to.at(from.heights.mean_mm) - from.shift_mm, (to.slope - from.slope) * deviation};
}

}  // namespace

double flickerMm(std::span<const TimedSurface> frames) {
  std::vector<Turn> turns;
  std::optional<Line> last;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const bool same_shot = frames[i].shot == frames[i - 1].shot && !frames[i].repeats;
    const auto line = same_shot ? commonChange(frames[i - 1].field, frames[i].field) : std::nullopt;
    if (line && last) turns.push_back(turn(*last, *line));
    last = line;
  }
  if (turns.empty()) return 0;
  double square = 0, in_a_row = 0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    square += turns[i].shift_mm * turns[i].shift_mm + turns[i].tilt_mm * turns[i].tilt_mm;
    if (i > 0) in_a_row += turns[i].shift_mm * turns[i - 1].shift_mm + turns[i].tilt_mm * turns[i - 1].tilt_mm;
  }
  if (in_a_row > 0) return 0;
  return std::sqrt(square / (6 * static_cast<double>(turns.size())));
}

}  // namespace relievo
