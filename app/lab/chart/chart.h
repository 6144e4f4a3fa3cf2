// SPDX-License-Identifier: Apache-2.0
// A chart: an SVG that gnuplot draws from a CSV, with a title and a line that states its result (the reading).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/failure.h"

namespace relievo {

struct ChartWords {
  std::string title, reading;
  std::string occasion;  // not drawn
};

// Draws FOLDER/NAME.svg from FOLDER/NAME.csv by the script of that name (app/lab/chart/scripts). The words are drawn,
// whatever their length, and also stored as the SVG's title, description and metadata. NotFound without gnuplot on the
// PATH.
[[nodiscard]] Outcome<void> drawChart(const std::string& folder, const std::string& name, const ChartWords& words);

// Reads the words back from an SVG's text; nullopt if it has none.
[[nodiscard]] std::optional<ChartWords> wordsOf(std::string_view svg);

// The words as they are drawn: the title, then each line of the reading.
[[nodiscard]] std::vector<std::string> drawnLines(const ChartWords& words);

// Escapes text for HTML and SVG.
[[nodiscard]] std::string escaped(std::string_view text);

// The script of a chart, app/lab/chart/scripts/NAME.gnuplot, after the lines that all scripts share.
[[nodiscard]] std::string chartScript(std::string_view name);

}  // namespace relievo
