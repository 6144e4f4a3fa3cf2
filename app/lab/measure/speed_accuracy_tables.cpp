// SPDX-License-Identifier: Apache-2.0
// Each chart has a table of its own, so that a script draws all that it reads.
#include "app/lab/measure/speed_accuracy_tables.h"

#include <algorithm>
#include <limits>

#include "app/lab/chart/csv_table.h"
#include "platform/print.h"

namespace relievo {
namespace {

using Row = SpeedAccuracyRow;
using Figures = SpeedAccuracyFigures;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

bool sameKind(const Row& a, const Row& b) {
  return a.who == b.who && a.depth == b.depth && a.scene == b.scene && a.size == b.size &&
         a.speed_m_per_s == b.speed_m_per_s && a.cold == b.cold;
}

bool isAccuracy(const Row& row) {
  return sameKind(row, Row{.who = row.who, .depth = row.depth, .scene = row.scene});
}

const char* caches(const Row& row) {
  return row.cold ? "cold" : "warm";
}

Outcome<void> writeAll(const Figures& figures, const std::string& path) {
  CsvTable table({"method",
                  "of",
                  "space",
                  "time",
                  "narrow_mm",
                  "wide_mm",
                  "depth",
                  "scene",
                  "cols",
                  "rows",
                  "speed_m_per_s",
                  "caches",
                  "force_rms_n",
                  "force_rms_percent",
                  "direction_rms_deg",
                  "magnitude_rms_percent",
                  "judged_ticks",
                  "lost_ticks",
                  "contact_lost",
                  "update_median_us",
                  "update_p99_us",
                  "update_p999_us",
                  "upkeep_median_us",
                  "upkeep_p99_us",
                  "upkeep_p999_us",
                  "update_own_p999_us",
                  "upkeep_own_p999_us",
                  "timed_ticks",
                  "clock_cost_ns"});
  for (const Row& r : figures.rows) {
    const ForceError e = r.error.value_or(ForceError{kNothing, kNothing, kNothing, kNothing});
    const double lost = r.error ? (e.contactLost() ? 1 : 0) : kNothing;
    const Spread none{kNothing, kNothing, kNothing};
    const auto [update, upkeep, own_update, own_upkeep] = r.times.value_or(TickTimes{none, none, none, none});
    table.row({r.who->label,
               r.who->method,
               r.parts.space,
               r.parts.time,
               r.parts.narrow_mm,
               r.parts.wide_mm,
               r.depth->name,
               r.scene,
               r.size.cols,
               r.size.rows,
               r.speed_m_per_s,
               caches(r),
               e.rms_n,
               e.rms_percent,
               e.direction_rms_deg,
               e.magnitude_rms_percent,
               e.ticks,
               e.lost_ticks,
               lost,
               update.median,
               update.p99,
               update.p999,
               upkeep.median,
               upkeep.p99,
               upkeep.p999,
               own_update.p999,
               own_upkeep.p999,
               update.count,
               figures.clock_ns});
  }
  return table.write(path);
}

Outcome<void> writeScenes(const Figures& figures, const std::string& path) {
  CsvTable table({"depth", "scene", "method", "force_rms_percent", "direction_rms_deg", "lost_ticks", "contact_lost"});
  for (const Row& r : figures.rows) {
    if (!isAccuracy(r) || r.who->fixed_choice) continue;
    table.row({r.depth->name, r.scene, r.who->label, r.error->rms_percent, r.error->direction_rms_deg,
               r.error->lost_ticks, r.error->contactLost() ? 1 : 0});
  }
  return table.write(path);
}

Outcome<void> writeParts(const Figures& figures, const std::string& path) {
  CsvTable table({"method", "update_median_us", "update_p999_us", "upkeep_median_us", "upkeep_p999_us",
                  "percent_16_bit", "percent_8_bit", "percent_h264", "percent_noise", "contact_lost_16_bit",
                  "contact_lost_8_bit", "contact_lost_h264", "contact_lost_noise"});
  for (const Contender& who : contenders()) {
    const TickTimes& t = *figures.find({.who = &who})->times;
    std::vector<Cell> row{who.label, t.update.median, t.update.p999, t.upkeep.median, t.upkeep.p999}, lost;
    for (const DepthKind& depth : kDepthKinds) {
      const ForceError& error = *figures.find({.who = &who, .depth = &depth, .scene = kAllScenes})->error;
      row.emplace_back(error.rms_percent);
      lost.emplace_back(error.contactLost() ? 1 : 0);
    }
    row.insert(row.end(), lost.begin(), lost.end());
    table.row(row);
  }
  return table.write(path);
}

Outcome<void> writeTimes(const Figures& figures, const std::string& path) {
  CsvTable table({"method", "cols", "rows", "speed_m_per_s", "caches", "update_median_us", "update_p99_us",
                  "update_p999_us", "upkeep_median_us", "upkeep_p99_us", "upkeep_p999_us", "update_own_p999_us",
                  "upkeep_own_p999_us"});
  for (const Row& r : figures.rows) {
    if (!r.times || r.who->fixed_choice || r.depth != &kEightBits || r.scene != kTimedScene) continue;
    const auto& [update, upkeep, own_update, own_upkeep] = *r.times;
    table.row({r.who->label, r.size.cols, r.size.rows, r.speed_m_per_s, caches(r), update.median, update.p99,
               update.p999, upkeep.median, upkeep.p99, upkeep.p999, own_update.p999, own_upkeep.p999});
  }
  return table.write(path);
}

// Over all scenes.
const Row& overall(const Figures& figures, const char* label, const DepthKind& depth) {
  return *figures.find({.who = contender(label), .depth = &depth, .scene = kAllScenes});
}

ChartWords mainWords(const Figures& figures) {
  std::string reading = "On 8-bit moving depth, error at the median tick: ";
  for (const char* label : {"relievo", "god-object", "modified-proxy-graph"}) {
    const Row& row = overall(figures, label, kEightBits);
    reading += print("%s%s %.2g %% (%.2g°) at %.2g µs", label == std::string_view("relievo") ? "" : "; ", label,
                     row.error->rms_percent, row.error->direction_rms_deg, row.times->update.median);
  }
  return {"Speed against accuracy: what a tick takes, and the error of the force", reading + "."};
}

ChartWords sceneWords(const Figures& figures) {
  std::string worst;
  double worst_percent = 0, least_gain = std::numeric_limits<double>::infinity();
  for (const Row& r : figures.rows) {
    if (r.who != contender("relievo") || !isAccuracy(r) || r.depth != &kEightBits || r.scene == kAllScenes) continue;
    const double percent = r.error->rms_percent;
    if (percent > worst_percent) {
      worst = r.scene;
      worst_percent = percent;
    }
    const Row* paper = figures.find({.who = contender("modified-proxy-graph"), .depth = r.depth, .scene = r.scene});
    least_gain = std::min(least_gain, paper->error->rms_percent / percent);
  }
  return {"Error of the force by scene and kind of depth",
          print("On 8-bit depth relievo is worst on %s, with %.2g %%; on every scene its error is at least %.2g times "
                "smaller than that of the paper's method.",
                worst.c_str(), worst_percent, least_gain)};
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
  const TickTimes own = times("relievo", sd), god = times("god-object", sd), big = times("relievo", largest);
  std::string reading = print(
      "Finger at 1 m/s, %dx%d: relievo %.2g µs and %.2g at p99.9, %.2g and %.2g times the god-object's; its upkeep "
      "%.2g and %.2g µs (%.2g without interruptions).",
      sd.cols, sd.rows, own.update.median, own.update.p999, own.update.median / god.update.median,
      own.update.p999 / god.update.p999, own.upkeep.median, own.upkeep.p999, own.own_upkeep.p999);
  if (largest != sd) {
    reading += print(" At %dx%d it takes %.2g and %.2g times as long.", largest.cols, largest.rows,
                     big.update.median / own.update.median, big.update.p999 / own.update.p999);
  }
  return {"What a tick takes by finger speed and picture size, 8-bit moving depth",
          reading + print(" The clock's own %d ns are taken off.", figures.clock_ns)};
}

}  // namespace

const SpeedAccuracyRow* SpeedAccuracyFigures::find(const SpeedAccuracyRow& kind) const {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return sameKind(r, kind); });
  return found == rows.end() ? nullptr : &*found;
}

SpeedAccuracyRow* SpeedAccuracyFigures::find(const SpeedAccuracyRow& kind) {
  return const_cast<Row*>(std::as_const(*this).find(kind));
}

Outcome<void> writeTables(const SpeedAccuracyFigures& figures, const std::string& folder) {
  if (auto done = writeAll(figures, folder + "/speed-accuracy.csv"); !done) return done;
  if (auto done = writeScenes(figures, folder + "/accuracy-by-scene.csv"); !done) return done;
  if (auto done = writeParts(figures, folder + "/parts.csv"); !done) return done;
  return writeTimes(figures, folder + "/tick-time.csv");
}

std::vector<ChartWords> chartWords(const SpeedAccuracyFigures& figures) {
  return {mainWords(figures), sceneWords(figures), partWords(figures), timeWords(figures)};
}

}  // namespace relievo
