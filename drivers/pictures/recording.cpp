// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/recording.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <numeric>
#include <set>

#include "drivers/pictures/layouts.h"
#include "drivers/pictures/names.h"
#include "drivers/pictures/roles.h"
#include "platform/print.h"

namespace relievo::pictures {
namespace {

constexpr double kUsualRate = 30, kPhotoRate = 0.2;
constexpr std::int64_t kNearest = 20'000'000;  // ns between colour and depth
constexpr std::size_t kMostBeside = 16;        // depth pictures before or after a colour picture: 800 a second

struct Valued {
  std::int64_t value = 0;
  std::size_t place = 0;  // among the names
};
using Series = std::vector<Valued>;

Series inOrder(const std::vector<std::int64_t>& values) {
  Series series(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) series[i] = {values[i], i};
  std::ranges::sort(series, {}, &Valued::value);
  return series;
}

struct Candidate {
  std::int64_t distance = 0;
  std::size_t color = 0, depth = 0;
  auto operator<=>(const Candidate&) const = default;
};

// Moves depth to the times of the colour pictures that it belongs to; returns how many do.
std::size_t moveToNearest(const Series& color, Series& depth) {
  std::vector<Candidate> candidates;
  std::size_t first = 0;
  for (std::size_t c = 0; c < color.size(); ++c) {
    while (first < depth.size() && depth[first].value <= color[c].value - kNearest) ++first;
    const auto near = std::ranges::lower_bound(depth, color[c].value, {}, &Valued::value) - depth.begin();
    const auto middle = static_cast<std::size_t>(near);
    const std::size_t begin = std::max(first, middle - std::min(middle, kMostBeside));
    const std::size_t end = std::min(depth.size(), middle + kMostBeside);
    for (std::size_t d = begin; d < end && depth[d].value < color[c].value + kNearest; ++d) {
      candidates.push_back({std::abs(depth[d].value - color[c].value), c, d});
    }
  }
  std::ranges::sort(candidates);
  std::vector<bool> color_used(color.size()), depth_used(depth.size());
  Series moved = depth;
  std::size_t pairs = 0;
  for (const Candidate& near : candidates) {
    if (color_used[near.color] || depth_used[near.depth]) continue;
    color_used[near.color] = depth_used[near.depth] = true;
    moved[near.depth].value = color[near.color].value;
    ++pairs;
  }
  // A picture without a partner is dropped where a neighbour was moved past it.
  Series kept;
  for (std::size_t d = 0; d < moved.size(); ++d) {
    while (depth_used[d] && !kept.empty() && kept.back().value >= moved[d].value) kept.pop_back();
    if (kept.empty() || kept.back().value < moved[d].value) kept.push_back(moved[d]);
  }
  depth = std::move(kept);
  return pairs;
}

bool overlap(const Series& a, const Series& b) {
  return a.front().value <= b.back().value && b.front().value <= a.back().value;
}

void countByRank(Series& series) {
  for (std::size_t i = 0; i < series.size(); ++i) series[i].value = static_cast<std::int64_t>(i);
}

// The median of what a member of neighbours differs by; 0 for a single one.
template <class Item, class Value>
Value usualStep(const std::vector<Item>& items, Value Item::* value) {
  std::vector<Value> steps;
  for (std::size_t i = 1; i < items.size(); ++i) steps.push_back(items[i].*value - items[i - 1].*value);
  if (steps.empty()) return Value(0);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

// Both series of a recording, and the notes about them.
struct Timing {
  NameKind kind = NameKind::Ranks;
  Series color, depth;
  bool far = false;  // the names have numbers, but they count nothing
  std::vector<std::string> notes;

  void align(const FoundPictures& found, NameKind depth_kind);
  bool pairByKey(const FoundPictures& found);
  void spreadSlowDepth();
  void rankFarNumbers();
  void noteGaps();
};

// Gives depth the value of the colour that has its key (roles.h), and leaves out depth without one. False if too few
// keys are shared for that.
bool Timing::pairByKey(const FoundPictures& found) {
  std::map<std::string, std::int64_t> values;
  for (const Valued& each : color) values.emplace(keyOf(found.color.names[each.place]), each.value);
  std::set<std::string> keys;
  Series kept;
  for (const Valued& each : depth) {
    const std::string key = keyOf(found.depth.names[each.place]);
    keys.insert(key);
    if (const auto same = values.find(key); same != values.end()) kept.push_back({same->second, each.place});
  }
  const bool unique = values.size() == color.size() && keys.size() == depth.size();
  if (!unique || kept.empty() || 2 * kept.size() < std::min(color.size(), depth.size())) return false;
  std::ranges::sort(kept, {}, &Valued::value);
  if (kept.size() < color.size())
    notes.push_back(print("%zu of %zu colour pictures have no depth", color.size() - kept.size(), color.size()));
  depth = std::move(kept);
  return true;
}

void Timing::align(const FoundPictures& found, NameKind depth_kind) {
  if (color.empty() || depth.empty()) {
    if (color.empty()) kind = depth_kind;
    return;
  }
  const bool comparable = kind == depth_kind && kind != NameKind::Ranks && overlap(color, depth);
  if (!comparable) {
    if (pairByKey(found)) return;
    // In a folder of its own depth is one series.
    if (found.color.folder == found.depth.folder && 2 * depth.size() < color.size() && kind != NameKind::Seconds) {
      notes.push_back(print("the depth is left out: names such as %s fit none of the %zu pictures; give it by --depth",
                            found.depth.names[depth.front().place].c_str(), color.size()));
      depth.clear();
      return;
    }
    if (color.size() > 1 || depth.size() > 1)
      notes.emplace_back("the names of colour and depth do not correspond: they are paired in their order");
    if (kind != NameKind::Seconds || color.size() != depth.size()) countByRank(color), kind = NameKind::Ranks;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      depth[i].value = kind == NameKind::Seconds ? color[i].value : static_cast<std::int64_t>(i);
    }
    return;
  }
  if (kind != NameKind::Seconds || found.paired) return;
  const std::size_t pairs = moveToNearest(color, depth);
  if (pairs < color.size()) {
    notes.push_back(print("%zu of %zu colour pictures have no depth within 20 ms", color.size() - pairs, color.size()));
  }
}

// Whether the values have no gap.
bool isCount(const Series& series) {
  return !series.empty() && series.back().value - series.front().value + 1 == static_cast<std::int64_t>(series.size());
}

// Depth of a slower camera, each series counted from the same number on without a gap: a depth picture is of every so
// many colour pictures. Depth that ends early may look the same.
void Timing::spreadSlowDepth() {
  constexpr std::size_t kFewest = 4, kMostTimes = 10;
  if (kind != NameKind::Numbers || depth.size() < kFewest || 2 * depth.size() > color.size()) return;
  if (!isCount(color) || !isCount(depth) || color.front().value != depth.front().value) return;
  const std::size_t times = (color.size() + depth.size() / 2) / depth.size();
  const std::size_t whole = times * depth.size();
  // Counts that divide by chance do so for few depth pictures.
  const bool fits = std::max(whole, color.size()) - std::min(whole, color.size()) < times && times <= kMostTimes &&
                    depth.size() >= kFewest * times;
  notes.push_back(
      fits ? print(
                 "%zu depth pictures for %zu of colour, counted alike: one for every %zu is assumed; if the depth ends "
                 "early, give the folder of colour, and --depth with that of depth",
                 depth.size(), color.size(), times)
           : print("%zu depth pictures for %zu of colour, counted alike: the depth is taken to end early; if it is "
                   "slower, give the folder of colour, and --depth with a film that ffmpeg -framerate F -i made of the "
                   "other",
                   depth.size(), color.size()));
  if (!fits) return;
  for (Valued& each : depth) {
    each.value = color.front().value + (each.value - color.front().value) * static_cast<std::int64_t>(times);
  }
}

// Numbers of photos from a shop or a web site. Depth without its colour is left out.
void Timing::rankFarNumbers() {
  constexpr std::int64_t kFarthest = 100;
  if (kind != NameKind::Numbers || depth.empty() || usualStep(color, &Valued::value) <= kFarthest) return;
  Series kept;
  for (const Valued& each : depth) {
    const auto same = std::ranges::lower_bound(color, each.value, {}, &Valued::value);
    if (same != color.end() && same->value == each.value) kept.push_back({same - color.begin(), each.place});
  }
  if (kept.empty()) return;
  depth = std::move(kept);
  countByRank(color);
  kind = NameKind::Ranks;
  far = true;
}

void Timing::noteGaps() {
  const Series& leading = color.empty() ? depth : color;
  if (kind != NameKind::Numbers || leading.size() < 2) return;
  const std::int64_t all = leading.back().value - leading.front().value + 1;
  const std::int64_t absent = all - static_cast<std::int64_t>(leading.size());
  if (absent == 0) return;
  notes.push_back(print("%lld of the numbers %lld to %lld %s: the picture before %s is shown longer",
                        static_cast<long long>(absent), static_cast<long long>(leading.front().value),
                        static_cast<long long>(leading.back().value), absent == 1 ? "is missing" : "are missing",
                        absent == 1 ? "it" : "each"));
}

// Limited to 285 years, in case large numbers meet a slow rate.
Duration timeAfter(std::int64_t periods, double period_ns) {
  constexpr long double kLatest = 9e18L;
  return Duration(
      std::llround(std::min(static_cast<long double>(periods) * static_cast<long double>(period_ns), kLatest)));
}

std::vector<TimedPicture> timed(const PictureFiles& files, const Series& series, std::int64_t first, double period_ns) {
  std::vector<TimedPicture> pictures;
  for (const Valued& each : series) {
    if (each.value < first) continue;
    pictures.push_back({files.folder + files.names[each.place], timeAfter(each.value - first, period_ns)});
  }
  return pictures;
}

Timing timingOf(const FoundPictures& found) {
  Timing timing;
  timing.notes = found.notes;
  if (!found.color_values.empty()) {
    timing.kind = found.listed_numbers ? NameKind::Numbers : NameKind::Seconds;
    timing.color = inOrder(found.color_values);
    timing.depth = inOrder(found.depth_values);
    timing.align(found, timing.kind);
    return timing;
  }
  const NameValues color = valuesOf(found.color.names), depth = valuesOf(found.depth.names);
  timing.kind = color.kind;
  timing.color = inOrder(color.values);
  timing.depth = inOrder(depth.values);
  timing.align(found, depth.kind);
  if (!found.views) {
    timing.spreadSlowDepth();
    timing.rankFarNumbers();
  }
  return timing;
}

}  // namespace

Recording recordingOf(const FoundPictures& found, std::optional<double> frames_per_s) {
  Timing timing = timingOf(found);
  timing.noteGaps();
  const bool both = !timing.color.empty() && !timing.depth.empty();
  const bool counted = timing.kind != NameKind::Seconds;
  const auto firstOf = [](const PictureFiles& files, const Series& series) {
    return series.empty() ? "" : files.folder + files.names[series.front().place];
  };
  const double known =
      counted ? rateOf(firstOf(found.color, timing.color), firstOf(found.depth, timing.depth)).value_or(kUsualRate)
              : kUsualRate;
  const bool unrelated = both && timing.kind == NameKind::Ranks && (timing.far || areUnrelated(found.color.names));
  const bool photos = both && !found.views && (unrelated || known == 0);
  const double usual = known > 0 ? known : kUsualRate;
  const double rate = frames_per_s.value_or(photos ? kPhotoRate : usual);
  const std::int64_t first = (timing.color.empty() ? timing.depth : timing.color).front().value;
  const double period_ns = counted ? 1e9 / rate : 1;

  Recording recording;
  recording.color = timed(found.color, timing.color, first, period_ns);
  recording.depth = timed(found.depth, timing.depth, first, period_ns);
  const auto& leading = recording.color.empty() ? recording.depth : recording.color;
  recording.period = counted ? Duration(std::llround(period_ns)) : usualStep(leading, &TimedPicture::time);
  if (leading.size() < 2) recording.period = Duration(0);
  if (timing.kind != NameKind::Ranks) recording.start = timeAfter(first, period_ns);
  recording.numbered = counted;
  recording.notes = std::move(timing.notes);
  if (counted && !frames_per_s && leading.size() > 1) {
    recording.notes.push_back(
        photos ? print("the file names do not count the pictures, so these are photos: each is shown for %.0f s; give "
                       "one of them to play it alone, --fps F for a film",
                       1 / rate)
               : print("the file names give no times: %.0f pictures a second assumed; --fps F changes that", rate));
  }
  recording.views = found.views;
  if (both && !found.views)
    recording.depth_tags =
        depthTagsOf(recording.color.front().path, recording.depth.front().path, !found.color_values.empty());
  if (found.left_out > 0) recording.notes.push_back(print("%zu other pictures are left out", found.left_out));
  return recording;
}

}  // namespace relievo::pictures
