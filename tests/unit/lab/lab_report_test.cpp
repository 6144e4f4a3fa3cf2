// SPDX-License-Identifier: Apache-2.0
// The report of all measurements where its folder cannot be written.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "app/lab/chart/report.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

// Two measurements are missing; the table of the first one cannot be written. That takes less time than the others.
TEST(LabReport, EndsWhereAChartCannotBeWritten) {
  const test::TemporaryFolder folder;
  for (const Measurement& measurement : measurements()) {
    const std::string name = measurement.name;
    for (const ChartEntry& chart : measurement.charts) {
      if (name == "stability-material" || name == "stereo") continue;
      for (const char* ending : {".csv", ".svg"}) std::ofstream(folder / (chart.name + std::string(ending))) << "made";
    }
  }
  std::filesystem::create_directory(folder / "stability-material.csv");
  std::set<std::string> parts;
  MeasureOptions options{.out = folder / "", .quick = true};
  options.out.pop_back();
  options.tell = [&](const std::string& what) { parts.insert(what.substr(0, what.find(':'))); };
  const auto done = writeReport(options);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().thing, folder / "stability-material.csv");
  EXPECT_EQ(parts.size(), 1U) << "the other one that is missing was measured as well";
}

}  // namespace
}  // namespace relievo
