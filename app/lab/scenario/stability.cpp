// SPDX-License-Identifier: Apache-2.0
// Runs the scenarios on all processors and writes the tables.
#include "app/lab/scenario/stability.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/lab/chart/csv_table.h"
#include "app/lab/film/parallel.h"
#include "app/lab/scenario/loop_onset.h"
#include "app/lab/scenario/scenarios.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::array kMethods{"relievo", "modified-proxy-graph", "proxy-graph", "proxy-blend", "penalty"};

struct Onset {
  const char* method;
  const char* profile;
  DeviceProfile loop;
  double bound = 0;
  std::optional<double> found;
};

std::vector<Verdict> judgeAll(const MeasureOptions& options) {
  const auto all = scenarios();
  std::vector<Verdict> verdicts(all.size() * kMethods.size());
  const auto judge = [&](std::size_t i) {
    verdicts[i] = all[i / kMethods.size()].judge(challengerNamed(kMethods[i % kMethods.size()]), options.quick);
  };
  inParallel(verdicts.size(), judge,
             [&](std::size_t done) { options.tell(print("methods in scenarios, %zu of %zu", done, verdicts.size())); });
  return verdicts;
}

std::vector<Onset> findOnsets(const MeasureOptions& options) {
  std::vector<Onset> onsets;
  for (const char* method : kMethods) {
    for (int delay = 0; delay <= 3; ++delay) {
      const auto alone = deviceAlone(delay);
      onsets.push_back({method, "viscous", alone, alone.viscousBound(), {}});
      DeviceProfile full = alone;
      full.coulomb_friction_n = DeviceProfile{}.coulomb_friction_n;
      full.encoder_step_mm = DeviceProfile{}.encoder_step_mm;
      onsets.push_back({method, "full", full, std::min(full.viscousBound(), full.frictionBound()), {}});
    }
  }
  const auto find = [&](std::size_t i) {
    Onset& o = onsets[i];
    o.found = loopOnset(challengerNamed(o.method), o.loop, 4 * o.bound);
  };
  inParallel(onsets.size(), find,
             [&](std::size_t done) { options.tell(print("closed loops, %zu of %zu", done, onsets.size())); });
  return onsets;
}

Outcome<void> writeMap(const std::string& folder, const std::vector<Verdict>& verdicts) {
  CsvTable table({"scenario", "method", "pass", "figure", "unit", "limit", "why"});
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const Verdict& v = verdicts[i];
    table.row({scenarios()[i / kMethods.size()].name, kMethods[i % kMethods.size()], v.pass ? 1 : 0, v.figure, v.unit,
               v.limit, v.why});
  }
  return table.write(folder + "/stability.csv");
}

Outcome<void> writeOnsets(const std::string& folder, const std::vector<Onset>& onsets) {
  CsvTable table({"method", "profile", "delay_ticks", "bound_n_per_mm", "onset_n_per_mm"});
  for (const Onset& o : onsets) {
    table.row({o.method, o.profile, o.loop.delay_ticks, o.bound, o.found.value_or(std::nan(""))});
  }
  return table.write(folder + "/stability-onset.csv");
}

ChartWords mapWords(const std::vector<Verdict>& verdicts) {
  std::string reading = "Scenarios passed:";
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    std::size_t passed = 0;
    for (std::size_t i = m; i < verdicts.size(); i += kMethods.size()) passed += verdicts[i].pass ? 1 : 0;
    reading += print("%s %s %zu of %zu", m > 0 ? "," : "", kMethods[m], passed, scenarios().size());
  }
  return {"Where methods of touch fail",
          reading + ". A cell holds the figure that decided, whatever the limits did to the force."};
}

ChartWords onsetWords(const std::vector<Onset>& onsets) {
  double furthest = 0, least = 1e9;
  for (const Onset& o : onsets) {
    if (o.method != kMethods[0]) continue;
    const double share = o.found.value_or(4 * o.bound) / o.bound;
    if (std::string_view(o.profile) == "viscous") furthest = std::max(furthest, std::abs(share - 1));
    else least = std::min(least, share);
  }
  return {"Stiffness from which a device swings on a wall",
          print("relievo: without dry friction within %.0f %% of 2b/((1+2n)T); with friction and encoder from %.2f "
                "times the lesser of that and 2fc/step on.",
                100 * furthest, least)};
}

}  // namespace

Outcome<std::vector<ChartWords>> measureStability(const MeasureOptions& options) {
  options.tell("methods in scenarios");
  const auto verdicts = judgeAll(options);
  if (const auto written = writeMap(options.out, verdicts); !written) return std::unexpected(written.error());
  options.tell("closed loops");
  const auto onsets = findOnsets(options);
  if (const auto written = writeOnsets(options.out, onsets); !written) return std::unexpected(written.error());
  return std::vector{mapWords(verdicts), onsetWords(onsets)};
}

}  // namespace relievo
