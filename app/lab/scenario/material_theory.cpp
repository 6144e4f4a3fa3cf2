// SPDX-License-Identifier: Apache-2.0
// A row for each scenario that a material changes.
#include "app/lab/scenario/material_theory.h"

#include <algorithm>
#include <array>

namespace relievo {
namespace {

struct Row {
  std::string_view material, scenario;
  Limit added;  // to the scenario's own limit
  bool at_most = true;
};

constexpr double kAside = 30, kTurned = 16.7;  // a friction of .3: percent, and atan .3 in degrees
constexpr Limit kFriction{kAside, "%",
                          "derived: friction of .3 adds .3 of the force aside to what the scenario allows"};
constexpr Limit kFrictionTurns{kTurned, "deg", "derived: friction of .3 turns the force by atan .3 = 16.7 degrees"};
constexpr Limit kHalfTheForce{6, "%", "derived: at 50 N/s a hole takes twice the share of half the force"};
// 11 mm deep: 10 N of 11 are 90.9 %, less half a percent for the mean; the scenario asks for 95.
constexpr Limit kPeak{-4.6, "%", "derived: 10 of the 11 N that 11 mm of 1 N/mm would need"};

constexpr std::array kRows{
    Row{"friction", "rise-free", kFriction},
    Row{"friction", "rise-fast", kFriction},
    Row{"friction", "cut-up", kFriction},
    Row{"friction", "cut-down", kFriction},
    Row{"friction", "noise", kFriction},
    Row{"friction", "pause", kFriction},
    Row{"friction", "coarse-steps", kFrictionTurns},
    Row{"friction", "camera-move", kFriction},
    Row{"softer", "dropout", kHalfTheForce},
    Row{"stiffer", "fast-hip", kPeak, false},
};

}  // namespace

std::optional<MaterialTheory> theoryOf(std::string_view material, std::string_view scenario, const Verdict& verdict) {
  const auto* const row = std::ranges::find_if(
      kRows, [&](const Row& each) { return each.material == material && each.scenario == scenario; });
  if (row == kRows.end() || verdict.pass || std::string_view(row->added.unit) != verdict.limit.unit)
    return std::nullopt;
  const double limit = verdict.limit.value + row->added.value;
  return MaterialTheory{.limit = {limit, row->added.unit, row->added.origin},
                        .at_most = row->at_most,
                        .explains = row->at_most ? verdict.figure <= limit : verdict.figure >= limit};
}

}  // namespace relievo
