// SPDX-License-Identifier: Apache-2.0
// A chart: an SVG that gnuplot draws from a CSV, with its title and one line that says what is to be read off it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/failure.h"

namespace relievo {

struct ChartWords {
  std::string title, reading;
};

// Draws FOLDER/NAME.svg from FOLDER/NAME.csv by the script of that name (app/lab/chart/scripts). The words are drawn,
// whatever their length, and are the SVG's own title and description. NotFound without gnuplot on the PATH.
[[nodiscard]] Outcome<void> drawChart(const std::string& folder, const std::string& name, const ChartWords& words);

// Read back from an SVG's text; nothing when it has none.
[[nodiscard]] std::optional<ChartWords> wordsOf(std::string_view svg);

// As they are drawn: the title, then each line of the reading.
[[nodiscard]] std::vector<std::string> drawnLines(const ChartWords& words);

// Text in HTML and SVG.
[[nodiscard]] std::string escaped(std::string_view text);

// The script of a chart, app/lab/chart/scripts/NAME.gnuplot, after the lines that all scripts have in common.
[[nodiscard]] std::string chartScript(std::string_view name);

}  // namespace relievo
