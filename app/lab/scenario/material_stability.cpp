// SPDX-License-Identifier: Apache-2.0
// One challenger for each material.
#include "app/lab/scenario/material_stability.h"

#include <array>

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

}  // namespace

Outcome<std::vector<ChartWords>> measureMaterialStability(const MeasureOptions& options) {
  std::vector<Challenger> challengers;
  challengers.reserve(kRows.size());
  for (const Row& row : kRows) challengers.push_back(challengerOf(row));
  const VerdictTable table(challengers, options);
  if (const auto written = table.write(options.out + "/stability-material.csv", "material"); !written)
    return std::unexpected(written.error());
  std::string passed;
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    passed += print("%s %s (%s) %zu", i > 0 ? "," : "", kRows[i].name, kRows[i].material, table.passed(i));
  }
  return std::vector{ChartWords{
      "relievo on surfaces of other materials",
      print("Scenarios of %zu passed, by material:%s. The limits are those of a surface without friction. Friction of "
            ".3 turns the force of a finger that slides by up to atan .3 = 17 degrees and makes it 4 %% larger, which "
            "limits on its direction and size do not allow; 1 N/mm reaches the limit of 10 N at 10 mm.",
            scenarios().size(), passed.c_str())}};
}

}  // namespace relievo
