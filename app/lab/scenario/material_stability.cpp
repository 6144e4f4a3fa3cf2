// SPDX-License-Identifier: Apache-2.0
// One challenger for each material.
#include "app/lab/scenario/material_stability.h"

#include <array>
#include <cmath>

#include "app/lab/scenario/material_theory.h"
#include "app/lab/scenario/verdict_table.h"
#include "platform/print.h"

namespace relievo {
namespace {

struct Row {
  const char* name;
  const char* material;
};
constexpr std::array kRows{
    Row{"plain", "friction=0"},    Row{"friction", "friction=.3"},  Row{"softer", "stiffness=.25"},
    Row{"stiffer", "stiffness=1"}, Row{"texture", "texture=.05@2"},
};

Challenger challengerOf(const Row& row) {
  Challenger challenger = challengerMadeOf(parseMaterial(row.material).value_or(Material{}));
  challenger.name = row.name;
  return challenger;
}

std::optional<MaterialTheory> theoryAt(const VerdictTable& table, std::size_t scenario, std::size_t row) {
  return theoryOf(kRows[row].name, scenarios()[scenario].name, table.verdict(scenario, row));
}

// Where a scenario is failed: the limit that the material's own physics gives, whether the figure is within it, and
// why.
VerdictTable::More theoryColumns(const VerdictTable& table) {
  return {.header = {"theory", "theory_at_most", "explained", "theory_origin"},
          .cells = [&table](std::size_t scenario, std::size_t row) -> std::vector<Cell> {
            const auto theory = theoryAt(table, scenario, row);
            if (!theory) return {std::nan(""), 1, 0, ""};
            return {theory->limit.value, theory->at_most ? 1 : 0, theory->explains ? 1 : 0, theory->limit.origin};
          }};
}

// "friction (friction=.3) 17 and 8", the second number only where it is not 0.
std::string passedWords(const VerdictTable& table, std::size_t row) {
  std::size_t explained = 0;
  for (std::size_t s = 0; s < scenarios().size(); ++s) {
    const auto theory = theoryAt(table, s, row);
    explained += theory && theory->explains ? 1 : 0;
  }
  std::string words = print("%s (%s) %zu", kRows[row].name, kRows[row].material, table.passed(row));
  if (explained > 0) words += print(" and %zu", explained);
  return words;
}

}  // namespace

Outcome<std::vector<ChartWords>> measureMaterialStability(const MeasureOptions& options) {
  std::vector<Challenger> challengers;
  challengers.reserve(kRows.size());
  for (const Row& row : kRows) challengers.push_back(challengerOf(row));
  const VerdictTable table(challengers, options);
  if (const auto written = table.write(options.out + "/stability-material.csv", "material", theoryColumns(table));
      !written)
    return std::unexpected(written.error());
  std::string passed;
  for (std::size_t i = 0; i < kRows.size(); ++i) passed += (i > 0 ? ", " : " ") + passedWords(table, i);
  return std::vector{ChartWords{
      "relievo on surfaces of other materials",
      print(
          "Scenarios of %zu passed, and those failed by no more than the material itself does (marked with ≤ or ≥: the "
          "limit of theory), by material:%s. Friction of .3 lays .3 of the force of a finger that slides aside, 17 "
          "degrees; at "
          "50 N/s a hole takes half the force away in half the time; 1 N/mm reaches the limit of 10 N at 10 mm.",
          scenarios().size(), passed.c_str())}};
}

}  // namespace relievo
