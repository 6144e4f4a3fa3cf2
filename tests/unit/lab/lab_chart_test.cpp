// SPDX-License-Identifier: Apache-2.0
// Charts: gnuplot as a child, its failures in one line, and the words that an SVG carries.
#include "app/lab/chart/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "app/lab/chart/csv_table.h"
#include "app/lab/chart/gnuplot.h"
#include "app/lab/measure/measurement.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

bool haveGnuplot() {
  return runGnuplot("set terminal dumb\nplot x\n", {}).has_value();
}

TEST(Gnuplot, DrawsWhatTheScriptSaysWithItsArguments) {
  if (!haveGnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const auto drawing = runGnuplot("set terminal svg\nset title ARG1\nplot x\n", {"a title of two words"});
  ASSERT_TRUE(drawing);
  EXPECT_NE(drawing->find("a title of two words"), std::string::npos);
}

TEST(Gnuplot, ThatFailsIsOneLine) {
  if (!haveGnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const auto drawing = runGnuplot("set terminal svg\nplot nonsense(x)\n", {});
  ASSERT_FALSE(drawing);
  EXPECT_EQ(drawing.error().error.code, ErrorCode::Io);
  EXPECT_NE(drawing.error().thing.find("nonsense"), std::string::npos) << drawing.error().thing;
  EXPECT_EQ(drawing.error().thing.find('\n'), std::string::npos);
}

TEST(Gnuplot, ThatIsMissingIsNamedWithItsPackage) {
  const char* const path = std::getenv("PATH");
  const std::string before = path == nullptr ? "" : path;
  ::setenv("PATH", "/nonexistent", 1);
  const auto drawing = runGnuplot("plot x\n", {});
  ::setenv("PATH", before.c_str(), 1);
  ASSERT_FALSE(drawing);
  EXPECT_EQ(drawing.error().error.code, ErrorCode::NotFound);
  EXPECT_NE(std::string(drawing.error().error.message).find("gnuplot-nox"), std::string::npos);
}

TEST(Chart, CarriesItsTitleAndReading) {
  if (!haveGnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const test::TemporaryFolder folder;
  std::ofstream(folder / "parts.csv")
      << "method,update_median_us,update_p999_us,percent_16_bit,percent_8_bit,percent_h264,percent_noise\n"
         "relievo,0.2,1,0.1,1,2,3\npenalty,0.1,0.3,7,30,33,80\n";
  const ChartWords words{"A < B & \"C\"", std::string(200, 'x') + " and so on, in 5 \xc2\xb5s", "R & D, 1999-12-31"};
  const auto drawn = drawChart(folder / ".", "parts", words);
  ASSERT_TRUE(drawn) << drawn.error().thing;
  const auto read = wordsOf(test::contentOf(folder / "parts.svg"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->title, words.title);
  EXPECT_EQ(read->reading, words.reading);
  EXPECT_EQ(read->occasion, words.occasion);
  EXPECT_FALSE(wordsOf("<svg></svg>"));
}

TEST(Chart, EachMeasurementsChartHasAScript) {
  const std::string common = chartScript("no such chart");
  EXPECT_FALSE(common.empty());
  for (const Measurement& m : measurements()) {
    for (const ChartEntry& chart : m.charts) EXPECT_GT(chartScript(chart.name).size(), common.size()) << chart.name;
  }
}

TEST(CsvTable, WritesNumbersTextAndNothing) {
  const test::TemporaryFolder folder;
  CsvTable table({"name", "a", "b"});
  table.row({"x y", 1.0 / 3, 4});
  table.row({"z", std::nan(""), std::size_t{7}});
  ASSERT_TRUE(table.write(folder / "t.csv"));
  EXPECT_EQ(test::contentOf(folder / "t.csv"), "name,a,b\nx y,0.333333,4\nz,,7\n");
  EXPECT_FALSE(table.write(folder / "missing/t.csv"));
}

}  // namespace
}  // namespace relievo
