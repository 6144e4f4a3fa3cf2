// SPDX-License-Identifier: Apache-2.0
// The conclusions of the charts of speed and accuracy, with the figures of this run.
#include <algorithm>
#include <limits>

#include "app/lab/measure/speed_accuracy_tables.h"
#include "platform/print.h"

namespace relievo {
namespace {

using Row = SpeedAccuracyRow;
using Figures = SpeedAccuracyFigures;

// Over all scenes.
const Row& overall(const Figures& figures, const char* label, const DepthKind& depth) {
  return *figures.find({.who = contender(label), .depth = &depth, .scene = kAllScenes});
}

std::string listed(std::string list, const std::string& item) {
  return std::move(list) + (list.empty() ? "" : "; ") + item;
}

// Two digits, without an exponent even for long times.
std::string told(double us) {
  return us < 100 ? print("%.2g", us) : print("%.0f", us);
}

// States where smoothing every frame is as exact as relievo, and where it is not: errors over all scenes.
std::string smoothingWords(const Figures& figures) {
  std::string as_exact, less_exact;
  for (const DepthKind& depth : kDepthKinds) {
    const double own = overall(figures, "relievo", depth).error->rms_percent;
    const double smoothed = overall(figures, "god-object-smoothed", depth).error->rms_percent;
    std::string& where = smoothed <= own ? as_exact : less_exact;
    where = listed(where, print("%s (%.2g %%, relievo %.2g %%)", depth.name, smoothed, own));
  }
  if (as_exact.empty())
    return " Smoothing every frame is less exact than relievo on each kind of depth: " + less_exact + ".";
  return " Smoothing every frame is as exact as relievo or more on " + as_exact +
         (less_exact.empty() ? "" : "; less on " + less_exact) + ".";
}

std::string bulletWords() {
  return contender("bullet") != nullptr
             ? " bullet is Bullet's height field with a god-object on its rays, linear in time."
             : " Bullet was not there when relievo-lab was built, and has no mark.";
}

ChartWords mainWords(const Figures& figures) {
  std::string reading;
  for (const char* label : {"relievo", "god-object", "god-object-smoothed", "modified-proxy-graph"}) {
    const Row& row = overall(figures, label, kEightBits);
    reading = listed(reading, print("%s %.2g %% (%.2g°) at %s and %s µs", label, row.error->rms_percent,
                                    row.error->direction_rms_deg, told(row.times->update.median).c_str(),
                                    told(row.times->medianUs()).c_str()));
  }
  const TickTimes& smoothed = *overall(figures, "god-object-smoothed", kEightBits).times;
  return {"Speed against accuracy: what a tick takes, and the error of the force",
          "On 8-bit moving depth: error, and the median of the time to force and of the whole tick: " + reading +
              print(". The whole tick has the upkeep in it, and the blur of a frame (%.2g ms) spread over its ticks; "
                    "without the blur god-object-smoothed's takes %s µs.",
                    smoothed.frame_ms, told(smoothed.whole.median).c_str()) +
              smoothingWords(figures) + bulletWords()};
}

ChartWords sceneWords(const Figures& figures) {
  std::string worst;
  double worst_percent = 0, least_gain = std::numeric_limits<double>::infinity();
  int scenes = 0, smoothed_better = 0;
  for (const Row& r : figures.rows) {
    if (r.who != contender("relievo") || !r.isAccuracy() || r.depth != &kEightBits || r.scene == kAllScenes) continue;
    const double percent = r.error->rms_percent;
    if (percent > worst_percent) {
      worst = r.scene;
      worst_percent = percent;
    }
    const Row* paper = figures.find({.who = contender("modified-proxy-graph"), .depth = r.depth, .scene = r.scene});
    least_gain = std::min(least_gain, paper->error->rms_percent / percent);
    const Row* smoothed = figures.find({.who = contender("god-object-smoothed"), .depth = r.depth, .scene = r.scene});
    smoothed_better += smoothed->error->rms_percent < percent ? 1 : 0;
    ++scenes;
  }
  return {
      "Error of the force by scene and kind of depth",
      print("On 8-bit depth relievo is worst on %s, with %.2g %%; on every scene its error is at least %.2g times "
            "smaller than that of the paper's method. On %d of the %d scenes god-object-smoothed is more exact than "
            "relievo.",
            worst.c_str(), worst_percent, least_gain, smoothed_better, scenes)};
}

ChartWords partWords(const Figures& figures) {
  const auto best = [&](const DepthKind& depth) {
    const char* found = "relievo";
    for (const Contender& c : contenders()) {
      if (overall(figures, c.label, depth).error->rms_percent < overall(figures, found, depth).error->rms_percent) {
        found = c.label;
      }
    }
    return print("%s: %s (%.3g %%, relievo %.3g %%)", depth.name, found,
                 overall(figures, found, depth).error->rms_percent,
                 overall(figures, "relievo", depth).error->rms_percent);
  };
  std::string reading = "Least error on ";
  for (const DepthKind& depth : kDepthKinds) reading += (&depth == kDepthKinds.data() ? "" : "; ") + best(depth);
  return {"What each part costs and buys: the methods, and the same with one part swapped", reading + "."};
}

ChartWords timeWords(const Figures& figures) {
  const auto times = [&](const char* label, const PictureSize& size) {
    return *figures.find({.who = contender(label), .size = size, .speed_m_per_s = 1})->times;
  };
  const PictureSize sd{}, largest = std::max_element(figures.rows.begin(), figures.rows.end(), [](auto& a, auto& b) {
                                      return a.size.cols < b.size.cols;
                                    })->size;
  const TickTimes own = times("relievo", sd), big = times("relievo", largest);
  std::string force, whole;
  for (const char* label : {"relievo", "god-object", "god-object-smoothed"}) {
    const TickTimes t = times(label, sd);
    force = listed(force, print("%s %s and %s", label, told(t.update.median).c_str(), told(t.update.p999).c_str()));
    whole = listed(whole, print("%s %s and %s (%s)", label, told(t.medianUs()).c_str(), told(t.p999Us()).c_str(),
                                told(t.own_whole.p999 + t.frame_us_per_tick).c_str()));
  }
  std::string reading = print(
      "Finger at 1 m/s, %dx%d, median and p99.9 in µs, from position to force: %s. The whole "
      "tick, with the upkeep and a frame's work spread over its ticks (p99.9 without "
      "interruptions): %s.",
      sd.cols, sd.rows, force.c_str(), whole.c_str());
  if (largest != sd) {
    reading += print(" At %dx%d relievo's whole tick takes %.2g and %.2g times as long.", largest.cols, largest.rows,
                     big.whole.median / own.whole.median, big.whole.p999 / own.whole.p999);
  }
  return {"What a tick takes by finger speed and picture size, 8-bit moving depth",
          reading + print(" The clock's own %d ns are taken off.", figures.clock_ns)};
}

}  // namespace

std::vector<ChartWords> chartWords(const SpeedAccuracyFigures& figures) {
  return {mainWords(figures), sceneWords(figures), partWords(figures), timeWords(figures)};
}

}  // namespace relievo
