// SPDX-License-Identifier: Apache-2.0
// A cell for each scenario and challenger.
#include "app/lab/scenario/verdict_table.h"

#include "app/lab/film/parallel.h"
#include "platform/print.h"

namespace relievo {

VerdictTable::VerdictTable(std::vector<Challenger> challengers, const MeasureOptions& options)
    : challengers_(std::move(challengers)), verdicts_(scenarios().size() * challengers_.size()) {
  const auto judge = [&](std::size_t i) {
    verdicts_[i] = scenarios()[i / challengers_.size()].judge(challengers_[i % challengers_.size()], options.quick);
  };
  inParallel(verdicts_.size(), judge, [&](std::size_t done) {
    options.tell(print("methods in scenarios, %zu of %zu", done, verdicts_.size()));
  });
}

std::size_t VerdictTable::passed(std::size_t challenger) const {
  std::size_t passed = 0;
  for (std::size_t i = challenger; i < verdicts_.size(); i += challengers_.size()) passed += verdicts_[i].pass ? 1 : 0;
  return passed;
}

Outcome<void> VerdictTable::write(const std::string& path, const char* who, const More& more) const {
  std::vector<Cell> header{"scenario", who, "pass", "figure", "unit", "limit", "why", "origin"};
  header.insert(header.end(), more.header.begin(), more.header.end());
  CsvTable table(header);
  for (std::size_t i = 0; i < verdicts_.size(); ++i) {
    const std::size_t scenario = i / challengers_.size(), challenger = i % challengers_.size();
    const Verdict& v = verdicts_[i];
    std::vector<Cell> row{scenarios()[scenario].name,
                          challengers_[challenger].name,
                          v.pass ? 1 : 0,
                          v.figure,
                          v.limit.unit,
                          v.limit.value,
                          v.why,
                          v.limit.origin};
    if (more.cells) {
      for (const Cell& cell : more.cells(scenario, challenger)) row.push_back(cell);
    }
    table.row(row);
  }
  return table.write(path);
}

}  // namespace relievo
