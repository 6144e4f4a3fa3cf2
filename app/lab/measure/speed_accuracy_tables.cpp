// SPDX-License-Identifier: Apache-2.0
// Each chart has a table of its own, so that a script draws all that it reads.
#include "app/lab/measure/speed_accuracy_tables.h"

#include <algorithm>
#include <limits>

#include "app/lab/chart/csv_table.h"

namespace relievo {
namespace {

using Row = SpeedAccuracyRow;
using Figures = SpeedAccuracyFigures;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

const char* caches(const Row& row) {
  return row.cold ? "cold" : "warm";
}

void addAllFigures(CsvTable& table, const Row& r, int clock_ns) {
  const ForceError e = r.error.value_or(ForceError{kNothing, kNothing, kNothing, kNothing});
  const double lost = r.error ? (e.contactLost() ? 1 : 0) : kNothing;
  const Spread none{kNothing, kNothing, kNothing};
  const TickTimes t = r.times.value_or(TickTimes{none, none, none, none, none, none, kNothing, kNothing});
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
             t.update.median,
             t.update.p99,
             t.update.p999,
             t.upkeep.median,
             t.upkeep.p99,
             t.upkeep.p999,
             t.own_update.p999,
             t.own_upkeep.p999,
             t.whole.median,
             t.whole.p99,
             t.whole.p999,
             t.own_whole.p999,
             t.frame_ms,
             t.frame_us_per_tick,
             t.update.count,
             clock_ns});
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
                  "whole_median_us",
                  "whole_p99_us",
                  "whole_p999_us",
                  "whole_own_p999_us",
                  "frame_ms",
                  "frame_us_per_tick",
                  "timed_ticks",
                  "clock_cost_ns"});
  for (const Row& r : figures.rows) addAllFigures(table, r, figures.clock_ns);
  return table.write(path);
}

Outcome<void> writeScenes(const Figures& figures, const std::string& path) {
  CsvTable table({"depth", "scene", "method", "force_rms_percent", "direction_rms_deg", "lost_ticks", "contact_lost"});
  for (const Row& r : figures.rows) {
    if (!r.isAccuracy() || r.who->fixed_choice) continue;
    table.row({r.depth->name, r.scene, r.who->label, r.error->rms_percent, r.error->direction_rms_deg,
               r.error->lost_ticks, r.error->contactLost() ? 1 : 0});
  }
  return table.write(path);
}

Outcome<void> writeParts(const Figures& figures, const std::string& path) {
  CsvTable table({"method", "update_median_us", "update_p999_us", "upkeep_median_us", "upkeep_p999_us",
                  "whole_median_us", "whole_p999_us", "frame_ms", "frame_us_per_tick", "percent_16_bit",
                  "percent_8_bit", "percent_h264", "percent_noise", "contact_lost_16_bit", "contact_lost_8_bit",
                  "contact_lost_h264", "contact_lost_noise"});
  for (const Contender& who : contenders()) {
    const TickTimes& t = *figures.find({.who = &who})->times;
    std::vector<Cell> row{who.label,      t.update.median, t.update.p999, t.upkeep.median,    t.upkeep.p999,
                          t.whole.median, t.whole.p999,    t.frame_ms,    t.frame_us_per_tick};
    std::vector<Cell> lost;
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
                  "update_p999_us", "upkeep_median_us", "upkeep_p99_us", "upkeep_p999_us", "whole_median_us",
                  "whole_p99_us", "whole_p999_us", "update_own_p999_us", "upkeep_own_p999_us", "whole_own_p999_us",
                  "frame_ms", "frame_us_per_tick"});
  for (const Row& r : figures.rows) {
    if (!r.times || r.who->fixed_choice || r.depth != &kEightBits || r.scene != kTimedScene) continue;
    const TickTimes& t = *r.times;
    table.row({r.who->label, r.size.cols, r.size.rows, r.speed_m_per_s, caches(r), t.update.median, t.update.p99,
               t.update.p999, t.upkeep.median, t.upkeep.p99, t.upkeep.p999, t.whole.median, t.whole.p99, t.whole.p999,
               t.own_update.p999, t.own_upkeep.p999, t.own_whole.p999, t.frame_ms, t.frame_us_per_tick});
  }
  return table.write(path);
}

}  // namespace

bool SpeedAccuracyRow::sameKind(const SpeedAccuracyRow& other) const {
  return who == other.who && depth == other.depth && scene == other.scene && size == other.size &&
         speed_m_per_s == other.speed_m_per_s && cold == other.cold;
}

const SpeedAccuracyRow* SpeedAccuracyFigures::find(const SpeedAccuracyRow& kind) const {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.sameKind(kind); });
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

}  // namespace relievo
