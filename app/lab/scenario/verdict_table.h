// SPDX-License-Identifier: Apache-2.0
// Runs challengers through all scenarios and writes their verdicts.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/lab/measure/measurement.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo {

class VerdictTable {
 public:
  // On all processors.
  VerdictTable(std::vector<Challenger> challengers, const MeasureOptions& options);

  [[nodiscard]] bool passes(std::size_t scenario, std::size_t challenger) const {
    return verdicts_[scenario * challengers_.size() + challenger].pass;
  }
  [[nodiscard]] std::size_t passed(std::size_t challenger) const;
  // A row for each scenario and challenger; `who`: the column of the challengers' names.
  [[nodiscard]] Outcome<void> write(const std::string& path, const char* who) const;

 private:
  std::vector<Challenger> challengers_;
  std::vector<Verdict> verdicts_;  // scenario by scenario
};

}  // namespace relievo
