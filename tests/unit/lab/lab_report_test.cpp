// SPDX-License-Identifier: Apache-2.0
// The report of all measurements: what is measured again, what the page says, and a folder that cannot be written.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "app/lab/chart/report.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

// As drawn on another day.
std::string drawnIn(const std::string& run) {
  return "<svg>\n<title>A chart</title>\n<desc>Its reading.</desc>\n<metadata>A processor, 1999-12-31" + run +
         "</metadata>\n</svg>\n";
}

// A folder in which all measurements but those named were made in a quick run.
struct MadeQuickly {
  explicit MadeQuickly(const std::set<std::string>& but) {
    for (const Measurement& measurement : measurements()) {
      if (but.contains(measurement.name)) continue;
      for (const ChartEntry& chart : measurement.charts) {
        std::ofstream(folder / (chart.name + std::string(".csv"))) << "made";
        std::ofstream(folder / (chart.name + std::string(".svg"))) << drawnIn(", quick run");
      }
    }
    options.out.pop_back();
    options.tell = [this](const std::string& what) { parts.insert(what.substr(0, what.find(':'))); };
  }
  test::TemporaryFolder folder;
  std::set<std::string> parts;  // that were measured
  MeasureOptions options{.out = folder / "", .quick = true};
};

// Two measurements are missing; the table of the first one cannot be written. That takes less time than the others.
TEST(LabReport, EndsWhereAChartCannotBeWritten) {
  MadeQuickly made({"stability-material", "stereo"});
  std::filesystem::create_directory(made.folder / "stability-material.csv");
  const auto done = writeReport(made.options);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().thing, made.folder / "stability-material.csv");
  EXPECT_EQ(made.parts.size(), 1U) << "the other one that is missing was measured as well";
}

TEST(LabReport, OfAQuickRunIsMeasuredAgainForALongOneAndTheOtherWayRound) {
  MadeQuickly made({"stability-material"});
  std::ofstream(made.folder / "stability-material.svg") << drawnIn("");
  std::filesystem::create_directory(made.folder / "stability-material.csv");  // it cannot be written
  const auto done = writeReport(made.options);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().thing, made.folder / "stability-material.csv");
}

TEST(LabReport, SaysOnWhichDayAndMachineEachChartWasMeasured) {
  MadeQuickly made({});
  ASSERT_TRUE(writeReport(made.options));
  EXPECT_TRUE(made.parts.empty());
  std::ifstream page(made.folder / "index.html");
  const std::string text(std::istreambuf_iterator<char>(page), {});
  std::size_t charts = 0, told = 0;
  for (const Measurement& measurement : measurements()) charts += measurement.charts.size();
  for (std::size_t at = 0;
       (at = text.find("<p class=\"occasion\">A processor, 1999-12-31, quick run</p>", at)) != std::string::npos;
       ++at) {
    ++told;
  }
  EXPECT_EQ(told, charts);
}

}  // namespace
}  // namespace relievo
