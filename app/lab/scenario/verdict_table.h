// SPDX-License-Identifier: Apache-2.0
// Runs challengers through all scenarios and writes their verdicts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/lab/chart/csv_table.h"
#include "app/lab/measure/measurement.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo {

class VerdictTable {
 public:
  // On all processors.
  VerdictTable(std::vector<Challenger> challengers, const MeasureOptions& options);

  [[nodiscard]] bool passes(std::size_t scenario, std::size_t challenger) const {
    return verdict(scenario, challenger).pass;
  }
  [[nodiscard]] const Verdict& verdict(std::size_t scenario, std::size_t challenger) const {
    return verdicts_[scenario * challengers_.size() + challenger];
  }
  [[nodiscard]] std::size_t passed(std::size_t challenger) const;
  // A row for each scenario and challenger; `who`: the column of the challengers' names. `more`: further columns, and
  // their cells in a row.
  struct More {
    std::vector<Cell> header;
    std::function<std::vector<Cell>(std::size_t scenario, std::size_t challenger)> cells;
  };
  [[nodiscard]] Outcome<void> write(const std::string& path, const char* who, const More& more = {}) const;

 private:
  std::vector<Challenger> challengers_;
  std::vector<Verdict> verdicts_;  // scenario by scenario
};

}  // namespace relievo
