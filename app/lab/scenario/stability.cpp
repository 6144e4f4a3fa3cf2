// SPDX-License-Identifier: Apache-2.0
// Three charts of one measurement.
#include "app/lab/scenario/stability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "app/lab/chart/csv_table.h"
#include "app/lab/film/parallel.h"
#include "app/lab/scenario/guard_sensitivity.h"
#include "app/lab/scenario/loop_onset.h"
#include "app/lab/scenario/verdict_table.h"
#include "hal/haptic_rate.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::array kMethods{"relievo",     "god-object", "god-object-smoothed", "modified-proxy-graph", "proxy-graph",
                              "proxy-blend", "penalty"};

constexpr double kUsualHz = 1000;
constexpr int kUsualDelay = 1;          // ticks
constexpr double kQuickBelowHz = 4000;  // loops of a quick run

struct Onset {
  const char* method;
  const char* profile;
  DeviceProfile loop;
  double bound = 0;
  std::optional<double> found;

  // Dry friction and encoder also keep a device from swinging above its viscous bound.
  [[nodiscard]] double highestTried() const { return 4 * loop.viscousBound(); }
  [[nodiscard]] double shareOfBound() const { return found.value_or(highestTried()) / bound; }
};

std::vector<Challenger> challengers() {
  std::vector<Challenger> all;
  all.reserve(kMethods.size());
  for (const char* method : kMethods) all.push_back(challengerNamed(method));
  return all;
}

// The device alone, and with its dry friction and encoder.
void addLoops(std::vector<Onset>& onsets, int delay_ticks, double rate_hz) {
  DeviceProfile alone = deviceAlone(delay_ticks);
  alone.rate_hz = rate_hz;
  DeviceProfile full = alone;
  full.coulomb_friction_n = DeviceProfile{}.coulomb_friction_n;
  full.encoder_step_mm = DeviceProfile{}.encoder_step_mm;
  for (const char* method : kMethods) {
    onsets.push_back({method, "viscous", alone, alone.viscousBound(), {}});
    onsets.push_back({method, "full", full, std::min(full.viscousBound(), full.frictionBound()), {}});
  }
}

std::vector<Onset> findOnsets(const MeasureOptions& options) {
  std::vector<Onset> onsets;
  for (int delay = 0; delay <= 3; ++delay) addLoops(onsets, delay, kUsualHz);
  for (const double rate_hz : {500.0, 2000.0, 4000.0, 8000.0}) {
    if (!options.quick || rate_hz < kQuickBelowHz) addLoops(onsets, kUsualDelay, rate_hz);
  }
  const auto find = [&](std::size_t i) {
    Onset& o = onsets[i];
    o.found = loopOnset(challengerNamed(o.method), o.loop, o.highestTried());
  };
  inParallel(onsets.size(), find,
             [&](std::size_t done) { options.tell(print("closed loops, %zu of %zu", done, onsets.size())); });
  return onsets;
}

Outcome<void> writeOnsets(const std::string& folder, const std::vector<Onset>& onsets) {
  CsvTable table(
      {"method", "profile", "rate_hz", "delay_ticks", "bound_n_per_mm", "choi_tan_n_per_mm", "onset_n_per_mm"});
  for (const Onset& o : onsets) {
    table.row({o.method, o.profile, o.loop.rate_hz, o.loop.delay_ticks, o.bound, perceivedOnset(o.loop.rate_hz),
               o.found.value_or(std::nan(""))});
  }
  return table.write(folder + "/stability-onset.csv");
}

// States which failures of the god-object smoothing every frame repairs, and which it causes.
std::string smoothedWords(const VerdictTable& map) {
  const auto column = [](std::string_view method) {
    return static_cast<std::size_t>(std::find(kMethods.begin(), kMethods.end(), method) - kMethods.begin());
  };
  std::string mended, spoiled;
  for (std::size_t s = 0; s < scenarios().size(); ++s) {
    const bool raw = map.passes(s, column("god-object")), smoothed = map.passes(s, column("god-object-smoothed"));
    if (raw == smoothed) continue;
    std::string& list = smoothed ? mended : spoiled;
    list += (list.empty() ? "" : ", ") + std::string(scenarios()[s].name);
  }
  return " Smoothing every frame lets the god-object pass " + (mended.empty() ? "nothing more" : mended) +
         " and makes it fail " + (spoiled.empty() ? "nothing more" : spoiled) + ".";
}

ChartWords mapWords(const VerdictTable& map) {
  std::string reading = "Scenarios passed:";
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    reading += print("%s %s %zu of %zu", m > 0 ? "," : "", kMethods[m], map.passed(m), scenarios().size());
  }
  return {"Where methods of touch fail",
          reading +
              ". A cell holds the figure that decided. The last five scenarios were written down before any method was "
              "run on them; the others were made harder until a method failed." +
              smoothedWords(map)};
}

ChartWords onsetWords(const std::vector<Onset>& onsets) {
  double furthest = 0, least = 1e9;
  std::map<double, double> by_rate;  // with friction and encoder
  for (const Onset& o : onsets) {
    if (o.method != kMethods[0]) continue;
    const bool viscous = std::string_view(o.profile) == "viscous";
    if (viscous) furthest = std::max(furthest, std::abs(o.shareOfBound() - 1));
    else least = std::min(least, o.shareOfBound());
    if (!viscous && o.loop.delay_ticks == kUsualDelay) by_rate[o.loop.rate_hz] = o.shareOfBound() * o.bound;
  }
  const auto& [low_hz, low] = *by_rate.begin();
  const auto& [high_hz, high] = *by_rate.rbegin();
  return {
      "Stiffness from which a device swings on a wall",
      print("relievo: without dry friction the device swings from a stiffness within %.0f %% of 2b/((1+2n)T); with "
            "friction and an encoder, from %.2f times the lesser of that and 2fc/step. From %.0f Hz to %.0f Hz this "
            "stiffness grows from %.2f to %.2f N/mm, %.1f times; the stiffness that people feel as unstable grew %.1f "
            "times (Choi and Tan 2004).",
            100 * furthest, least, low_hz, high_hz, low, high, high / low,
            perceivedOnset(high_hz) / perceivedOnset(low_hz))};
}

}  // namespace

Outcome<std::vector<ChartWords>> measureStability(const MeasureOptions& options) {
  options.tell("methods in scenarios");
  const VerdictTable map(challengers(), options);
  if (const auto written = map.write(options.out + "/stability.csv", "method"); !written)
    return std::unexpected(written.error());
  options.tell("thresholds of the guard");
  const auto guard = measureGuardSensitivity(options);
  if (!guard) return std::unexpected(guard.error());
  options.tell("closed loops");
  const auto onsets = findOnsets(options);
  if (const auto written = writeOnsets(options.out, onsets); !written) return std::unexpected(written.error());
  return std::vector{mapWords(map), *guard, onsetWords(onsets)};
}

}  // namespace relievo
