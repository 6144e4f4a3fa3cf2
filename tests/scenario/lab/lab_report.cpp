// SPDX-License-Identifier: Apache-2.0
// The page of relievo-lab's report, the chart of detail, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "tests/scenario/lab/lab_charts.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo::test {
namespace {

TEST_F(LabCharts, SaysHowFarItIsAndWhereThePageLies) {
  std::istringstream lines(result_.err);  // empty, except on a slow machine
  for (std::string line; std::getline(lines, line);) EXPECT_TRUE(line.starts_with("relievo-lab: progress: ")) << line;
  EXPECT_EQ(result_.out.substr(0, result_.out.find(' ')), out("index.html"));
}

class LabDetail : public LabCharts {
 protected:
  void SetUp() override {
    LabCharts::SetUp();
    if (withoutEgl(result_)) GTEST_SKIP() << result_.err;
  }
  static double of(const char* column, const char* model, const char* level) {
    const std::string key = model == std::string("grid") ? "grid_step" : "error_px";
    return Csv(out("detail.csv")).value({{"depth", "8-bit"}, {"model", model}, {key, level}}, column);
  }
  static constexpr const char* kErrors[] = {"0.125", "0.25", "0.5", "1", "2", "4"};
  static constexpr const char* kSteps[] = {"12", "8", "6", "4", "3", "2", "1"};
};

TEST_F(LabDetail, ThePlayersLevelIsMarkedAndHasAFifthOfTheTrianglesAtMost) {
  EXPECT_EQ(Csv(out("detail.csv")).value({{"depth", "8-bit"}, {"players", "1"}}, "error_px"), 0.5);
  EXPECT_EQ(of("triangles", "grid", "1"), 2 * 719 * 485);
  EXPECT_LE(of("triangles", "network", "0.5"), of("triangles", "grid", "1") / 5);
  EXPECT_NE(textOf(out("detail.svg")).find("the player's level"), std::string::npos);
}

TEST_F(LabDetail, PictureAndTouchGetNoBetterWithALargerErrorOrStep) {
  for (std::size_t i = 1; i < std::size(kErrors); ++i) {
    EXPECT_LE(of("triangles", "network", kErrors[i]), of("triangles", "network", kErrors[i - 1])) << kErrors[i];
    for (const char* psnr : {"away_psnr_db", "truth_psnr_db"}) {
      EXPECT_LE(of(psnr, "network", kErrors[i]), of(psnr, "network", kErrors[i - 1]) + 0.3) << psnr << kErrors[i];
    }
  }
  for (std::size_t i = 1; i < std::size(kSteps); ++i) {
    for (const char* psnr : {"away_psnr_db", "truth_psnr_db"}) {
      EXPECT_GE(of(psnr, "grid", kSteps[i]), of(psnr, "grid", kSteps[i - 1]) - 0.3) << psnr << kSteps[i];
    }
  }
  EXPECT_GT(of("force_rms_percent", "network", "1"), 2 * of("force_rms_percent", "network", "0.125"));
  EXPECT_GT(of("force_rms_percent", "network", "0.125"), of("force_rms_percent", "grid", "1"));
  // A proxy on the triangles of all samples feels the terraces of 8 bits, unless every frame is smoothed.
  EXPECT_GT(of("god_object_rms_percent", "grid", "1"), 15);
  EXPECT_LT(of("god_object_smoothed_rms_percent", "grid", "1"), 2);
}

// The network cuts the relief at silhouettes: its whole picture is nearer to what the eyes would see than that of any
// grid with up to twice as many triangles.
TEST_F(LabDetail, TheNetworkIsNearerToTheTruthThanAGridOfMoreTriangles) {
  for (const char* error : {"0.125", "0.25", "0.5", "1"}) {
    const double triangles = of("triangles", "network", error);
    int compared = 0;
    for (const char* step : kSteps) {
      if (of("triangles", "grid", step) > 2 * triangles) continue;
      ++compared;
      EXPECT_GT(of("truth_psnr_db", "network", error), of("truth_psnr_db", "grid", step) + 1) << error << " " << step;
      EXPECT_GT(of("truth_ssim", "network", error), of("truth_ssim", "grid", step)) << error << " " << step;
    }
    EXPECT_GE(compared, 4) << error;
  }
  // The grid of all samples, with twenty times as many triangles, is no nearer either.
  EXPECT_GT(of("truth_psnr_db", "network", "0.5"), of("truth_psnr_db", "grid", "1"));
}

TEST_F(LabCharts, ThePageHoldsEveryChartWithItsWordsAndItsFigures) {
  const std::string page = textOf(out("index.html"));
  int charts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(out())) {
    if (entry.path().extension() != ".svg") continue;
    ++charts;
    const std::string name = entry.path().stem(), svg = textOf(entry.path());
    EXPECT_EQ(svg.find("Produced by GNUPLOT"), std::string::npos) << name;
    // The reading's last words are drawn as well, however long it is.
    const std::size_t reading = svg.find("<desc>") + 6;
    const std::string words = svg.substr(reading, svg.find("</desc>") - reading);
    const std::string last = words.substr(words.rfind(' ') + 1);
    EXPECT_NE(svg.find(last + "<", svg.find("</desc>") + 7), std::string::npos) << name << ": " << last;
    const std::size_t title = svg.find("<title>") + 7;
    EXPECT_NE(page.find("<h2>" + svg.substr(title, svg.find("</title>") - title) + "</h2>"), std::string::npos) << name;
    EXPECT_NE(page.find("href=\"" + name + ".csv\""), std::string::npos) << name;
    EXPECT_NE(page.find("<li><a href=\"#" + name + "\">"), std::string::npos) << name;
    EXPECT_NE(words.find(" Better: "), std::string::npos) << name;
    const std::size_t section = page.find("<section id=\"" + name + "\""), drawing = page.find("</desc>", section);
    EXPECT_EQ(page.substr(drawing, page.find("</section>", drawing) - drawing).find(last + "<"), std::string::npos)
        << name << ": the page prints the reading as text already";
    EXPECT_TRUE(std::filesystem::exists(out(name + ".csv"))) << name;
  }
  EXPECT_EQ(charts, withoutEgl(result_) ? 18 : 19);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST_F(LabCharts, TheMapSaysWhereEachLimitIsFromAndTheGuardsThresholdThatItUses) {
  const Csv map(out("stability.csv")), guard(out("guard-sensitivity.csv"));
  for (const CsvRow& row : map.rows()) {
    const std::string origin = row.at("origin").substr(0, row.at("origin").find(':'));
    EXPECT_TRUE(origin == "derived" || origin == "cited" || origin == "chosen") << row.at("scenario");
    if (row.at("method") != "modified-proxy-graph") continue;
    EXPECT_EQ(guard.value({{"scenario", row.at("scenario")}, {"threshold_n", "8"}}, "pass"), numberIn(row, "pass"));
  }
  EXPECT_NE(textOf(out("guard-sensitivity.svg")).find("uses 8 N"), std::string::npos);
}

TEST_F(LabCharts, AReportRunsOnlyWhatIsMissing) {
  const auto kept = std::filesystem::last_write_time(out("speed-accuracy.csv"));
  const auto old_page = std::filesystem::last_write_time(out("index.html"));
  std::filesystem::remove(out("stability-material.svg"));  // of the measurement that is made most quickly
  const auto again = runProgram("relievo-lab report --quick --out " + out(), *folder_ / ".");
  ASSERT_EQ(again.exit_code, result_.exit_code) << again.err;
  EXPECT_TRUE(std::filesystem::exists(out("stability-material.svg")));
  EXPECT_EQ(std::filesystem::last_write_time(out("speed-accuracy.csv")), kept);
  EXPECT_GT(std::filesystem::last_write_time(out("index.html")), old_page);
}

TEST(LabChartsWords, WrongUseAndAFolderThatCannotBeMadeAreOneLineEach) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  for (const char* command : {"speed-accuracy", "widths", "edges", "smoothness", "latency", "stability", "detail",
                              "bitrate", "stereo", "report"}) {
    const auto without = runProgram(std::string("relievo-lab ") + command, folder / ".");
    EXPECT_EQ(without.exit_code, 2) << command;
    EXPECT_NE(without.err.find("--out"), std::string::npos) << without.err;
    const auto blocked =
        runProgram(std::string("relievo-lab ") + command + " --quick --out " + (folder / "file/x"), folder / ".");
    EXPECT_EQ(blocked.exit_code, 1) << command;
    EXPECT_NE(blocked.err.find("file/x"), std::string::npos) << blocked.err;
    EXPECT_EQ(std::count(blocked.err.begin(), blocked.err.end(), '\n'), 1) << blocked.err;
  }
}

}  // namespace
}  // namespace relievo::test
