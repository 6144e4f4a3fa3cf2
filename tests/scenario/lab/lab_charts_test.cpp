// SPDX-License-Identifier: Apache-2.0
// The charts as a user makes them: relievo-lab's measurements, quick. No time on a clock is judged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using CsvRow = std::map<std::string, std::string>;

std::string textOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

class Csv {
 public:
  explicit Csv(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    const auto header = cellsOf(line);
    while (std::getline(file, line)) {
      const auto cells = cellsOf(line);
      EXPECT_LE(cells.size(), header.size()) << line;
      CsvRow row;
      for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = i < cells.size() ? cells[i] : "";
      rows_.push_back(row);
    }
  }
  // The one row in which all these cells are so.
  [[nodiscard]] double value(const CsvRow& wanted, const std::string& column) const {
    const CsvRow* found = nullptr;
    int count = 0;
    for (const CsvRow& row : rows_) {
      bool same = true;
      for (const auto& [name, text] : wanted) same = same && row.count(name) == 1 && row.at(name) == text;
      if (!same) continue;
      found = &row;
      ++count;
    }
    EXPECT_EQ(count, 1) << column;
    return found == nullptr ? std::nan("") : std::strtod(found->at(column).c_str(), nullptr);
  }
  [[nodiscard]] const std::vector<CsvRow>& rows() const { return rows_; }

 private:
  std::vector<CsvRow> rows_;
};

// A machine without EGL draws no relief; every other chart is there.
bool withoutEgl(const test::ProgramResult& result) {
  const std::size_t drawing = result.err.find("relievo-lab: drawing: ");
  return drawing != std::string::npos && (result.err.find("EGL", drawing) != std::string::npos ||
                                          result.err.find("GLES", drawing) != std::string::npos);
}

// One run of everything serves all tests, those of the classes made of this one too.
class LabCharts : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (folder_) return;
    folder_ = std::make_unique<test::TemporaryFolder>();
    result_ = test::runProgram("relievo-lab report --quick --out " + out(), *folder_ / ".");
  }
  void SetUp() override {
    if (result_.err.find("gnuplot-nox") != std::string::npos) GTEST_SKIP() << result_.err;
    ASSERT_EQ(result_.exit_code, withoutEgl(result_) ? 1 : 0) << result_.err;
  }
  static std::string out() { return *folder_ / "charts"; }
  static std::string out(const std::string& file) { return out() + "/" + file; }

  static inline std::unique_ptr<test::TemporaryFolder> folder_;
  static inline test::ProgramResult result_;
};

TEST_F(LabCharts, SaysHowFarItIsAndWhereThePageLies) {
  std::istringstream lines(result_.err);  // of a machine so slow that there are any
  for (std::string line; std::getline(lines, line);) EXPECT_TRUE(line.starts_with("relievo-lab: progress: ")) << line;
  EXPECT_EQ(result_.out.substr(0, result_.out.find(' ')), out("index.html"));
}

TEST_F(LabCharts, WhereContactWasLostItIsMarkedSo) {
  const Csv all(out("speed-accuracy.csv")), parts(out("parts.csv"));
  int lost = 0;
  for (const CsvRow& row : all.rows()) {
    if (row.at("lost_ticks").empty() || row.at("contact_lost").empty()) continue;
    const auto number = [&](const char* name) { return std::strtod(row.at(name).c_str(), nullptr); };
    EXPECT_EQ(row.at("contact_lost") == "1", number("lost_ticks") > std::floor(number("judged_ticks") / 100));
    lost += row.at("contact_lost") == "1" ? 1 : 0;
    if (row.at("scene") != "all" || row.at("depth") != "8-bit") continue;
    EXPECT_EQ(parts.value({{"method", row.at("method")}}, "contact_lost_8_bit"), number("contact_lost"));
  }
  EXPECT_GT(lost, 0) << "a still-map method loses a moving surface";
  EXPECT_NE(textOf(out("speed-accuracy.svg")).find("hollow: contact lost"), std::string::npos);
}

TEST_F(LabCharts, RelievoIsManyTimesAsExactOnEightBitsAsThePapersMethod) {
  const Csv csv(out("speed-accuracy.csv"));
  const auto percent = [&](const char* method, const char* depth) {
    return csv.value({{"method", method}, {"depth", depth}, {"scene", "all"}}, "force_rms_percent");
  };
  EXPECT_LT(percent("relievo", "8-bit"), percent("modified-proxy-graph", "8-bit") / 5);
  EXPECT_LT(percent("relievo", "H.264 crf 23"), percent("modified-proxy-graph", "H.264 crf 23") / 2);
  // Terraces of 0.157 mm turn a correct proxy on triangles by ten degrees and more; 16 bits do not.
  EXPECT_GT(percent("god-object", "8-bit"), 15);
  EXPECT_LT(percent("god-object", "16-bit"), 1);
  EXPECT_LT(percent("relievo", "16-bit"), 1);
  for (const char* depth : {"16-bit", "8-bit", "H.264 crf 23", "noise 1 %"}) {
    EXPECT_EQ(csv.value({{"method", "relievo"}, {"depth", depth}, {"scene", "all"}}, "lost_ticks"), 0) << depth;
  }
}

// What smoothing every frame buys and costs.
TEST_F(LabCharts, TheSmoothedGodObjectIsExactOnSmoothScenesAndPaysForEveryFrame) {
  const Csv csv(out("speed-accuracy.csv"));
  const auto value = [&](const char* method, const char* depth, const char* column) {
    return csv.value({{"method", method}, {"depth", depth}, {"scene", "all"}}, column);
  };
  EXPECT_LT(value("god-object-smoothed", "8-bit", "force_rms_percent"),
            value("god-object", "8-bit", "force_rms_percent") / 10);
  EXPECT_LT(value("god-object-smoothed", "noise 1 %", "force_rms_percent"), 5);
  EXPECT_GT(value("god-object-smoothed", "8-bit", "frame_ms"), 0);
  for (const char* method : {"relievo", "god-object", "penalty"}) EXPECT_EQ(value(method, "8-bit", "frame_ms"), 0);
  const Csv edges(out("edges.csv"));
  const auto corner = [&](const char* method) {
    return edges.value({{"method", method}, {"depth", "8-bit"}, {"edge_mm_per_s", "0"}, {"finger_deep_mm", "2"}},
                       "corner_mean_mm");
  };
  EXPECT_GT(corner("god-object-smoothed"), 2 * corner("relievo"));
  EXPECT_LT(
      Csv(out("enhance.csv"))
          .value({{"figure", "force"}, {"faults", "0"}, {"enhancement", "none"}, {"method", "god-object-smoothed"}},
                 "force_rms_percent"),
      5);
}

TEST_F(LabCharts, NoOneWidthForTheWholePictureIsAsExact) {
  std::map<std::string, double> own, best;
  const Csv widths(out("widths.csv"));
  for (const CsvRow& row : widths.rows()) {
    const double percent = std::strtod(row.at("worst_percent").c_str(), nullptr);
    double& least = (row.at("order") == "0" ? own : best).try_emplace(row.at("depth"), percent).first->second;
    least = std::min(least, percent);
  }
  ASSERT_EQ(own.size(), 4U);
  for (const auto& [depth, percent] : own) EXPECT_LT(percent, best.at(depth)) << depth;
  EXPECT_LT(best.at("8-bit"), 5) << "the rival is no straw man";
}

TEST_F(LabCharts, TheMapHoldsEveryMethodInEveryScenario) {
  std::map<std::string, int> methods;
  const Csv map(out("stability.csv"));
  for (const CsvRow& row : map.rows()) ++methods[row.at("method")];
  EXPECT_EQ(methods.size(), 7u);
  for (const char* method : {"relievo", "god-object", "god-object-smoothed", "modified-proxy-graph"}) {
    EXPECT_EQ(methods[method], static_cast<int>(map.rows().size() / 7)) << method;
    EXPECT_NE(textOf(out("stability.svg")).find(">" + std::string(method) + "<"), std::string::npos) << method;
  }
}

// A legend is of what is drawn: these lose the moving face, and have no spectrum.
TEST_F(LabCharts, AMethodWithoutACurveIsNotInTheLegend) {
  const std::string svg = textOf(out("smoothness.svg"));
  EXPECT_NE(svg.find(">god-object-smoothed, 1 ahead<"), std::string::npos);
  EXPECT_EQ(svg.find(">proxy-graph<"), std::string::npos);
  EXPECT_EQ(textOf(out("bitrate.svg")).find(">HEVC 12 bits<"), std::string::npos) << "not in a quick run";
}

TEST_F(LabCharts, EveryTimedRowHasItsTimesInOrder) {
  const Csv csv(out("tick-time.csv"));
  ASSERT_FALSE(csv.rows().empty());
  for (const CsvRow& row : csv.rows()) {
    const auto number = [&](const char* name) { return std::strtod(row.at(name).c_str(), nullptr); };
    EXPECT_GT(number("update_median_us"), 0) << row.at("method");
    EXPECT_LE(number("update_median_us"), number("update_p99_us"));
    EXPECT_LE(number("update_p99_us"), number("update_p999_us"));
    EXPECT_GE(number("whole_median_us"), number("update_median_us"));
    EXPECT_GT(number("whole_own_p999_us"), 0) << "for all or for none";
  }
  EXPECT_GT(csv.value({{"method", "relievo"}, {"speed_m_per_s", "0.1"}, {"caches", "cold"}}, "update_median_us"), 0);
}

// Of a movement of 0.7 Hz in 15 frames/s holding leaves an image of 0.7/15 beside the frame rate, and interpolating in
// a line the square of that: 26 dB less.
TEST_F(LabCharts, HoldingTheFramePeaksAtTheFrameRateFarOverInterpolation) {
  const Csv csv(out("smoothness-peaks.csv"));
  const auto value = [&](const char* method, const char* finger, const char* rate, const char* column) {
    return csv.value({{"method", method}, {"finger", finger}, {"frames_per_s", rate}, {"depth", "8-bit"}}, column);
  };
  for (const char* finger : {"fixed point", "resting hand"}) {
    for (const char* rate : {"15", "30"}) {
      EXPECT_GT(value("relievo linear", finger, rate, "under_hold_db"), 15) << finger << rate;
      EXPECT_GT(value("modified-proxy-graph", finger, rate, "under_hold_db"), 15) << finger << rate;
      EXPECT_GT(value("relievo", finger, rate, "under_hold_db"), 50) << finger << rate;
      // At 30 frames/s the plan takes the B-spline, for what a codec leaves: without a codec it flattens a little.
      EXPECT_LE(
          value("relievo", finger, rate, "force_rms_percent"),
          (rate == std::string_view("30") ? 1.2 : 1.05) * value("relievo linear", finger, rate, "force_rms_percent"))
          << finger << rate;
      EXPECT_EQ(value("relievo hold", finger, rate, "under_hold_db"), 0);
    }
  }
  EXPECT_NEAR(value("relievo linear", "fixed point", "15", "under_hold_db"), 26, 3);
  EXPECT_NEAR(value("modified-proxy-graph", "fixed point", "15", "added_latency_ms"), 1000.0 / 15, 0.01);
}

// Waiting for L frames makes the surface L periods older, and up to 12 ms for a frame that comes late; what is carried
// forward by a period is that much younger.
TEST_F(LabCharts, ALiveSurfaceIsAsOldAsItWaitsAndNoOlderThanFiftyMilliseconds) {
  const Csv csv(out("latency.csv"));
  const auto value = [&](const char* rate, const char* depth, const char* surface, const char* column) {
    return csv.value({{"frames_per_s", rate}, {"depth", depth}, {"surface", surface}}, column);
  };
  for (const char* rate : {"30", "60"}) {
    const double period = 1000 / std::strtod(rate, nullptr);
    for (const int frames : {1, 2, 3}) {
      const double age = value(rate, "16-bit", (std::to_string(frames) + " ahead").c_str(), "age_median_ms");
      EXPECT_GT(age, frames * period + 8) << rate << frames;
      EXPECT_LT(age, frames * period + 15) << rate << frames;
    }
    EXPECT_NEAR(value(rate, "16-bit", "carried", "age_median_ms"),
                value(rate, "16-bit", "1 ahead", "age_median_ms") - period, 1);
  }
  for (const char* rate : {"15", "30", "60"}) {
    for (const char* depth : {"16-bit", "8-bit", "noise 1 %"}) {
      EXPECT_LE(value(rate, depth, "chosen", "age_p99_ms"), 50.5) << rate << depth;
      EXPECT_LT(value(rate, depth, "chosen", "own_rms_percent"), value(rate, depth, "hold", "own_rms_percent"));
    }
  }
  EXPECT_GE(value("30", "16-bit", "chosen", "under_hold_db"), 30);
  EXPECT_GE(value("30", "8-bit", "chosen", "under_hold_db"), 20);
}

TEST_F(LabCharts, AnEdgeIsWithinAMillimetreAndLetsGoBeyondIt) {
  const Csv csv(out("edges.csv"));
  const auto value = [&](const char* method, const char* depth, const char* speed, const char* deep,
                         const char* column) {
    return csv.value({{"method", method}, {"depth", depth}, {"edge_mm_per_s", speed}, {"finger_deep_mm", deep}},
                     column);
  };
  for (const char* depth : {"16-bit", "8-bit", "noise 1 %"}) {
    for (const char* speed : {"0", "50", "-50"}) {
      for (const char* deep : {"2", "5"}) {
        const auto of = [&](const char* column) { return value("relievo", depth, speed, deep, column); };
        const std::string where = std::string(depth) + ", " + speed + " mm/s, " + deep + " mm deep";
        EXPECT_LE(of("corner_mean_mm"), 0.9) << where;
        EXPECT_LE(of("fall_off_rms_mm"), 1) << where;
        EXPECT_LE(of("fall_off_worst_mm"), 1.5) << where;
      }
    }
  }
  EXPECT_GT(value("god-object", "noise 1 %", "0", "5", "held"), 20) << "of 40 places";
  EXPECT_GT(value("relievo 0.72", "8-bit", "0", "5", "fall_off_rms_mm"), 1.5) << "what one width costs";
}

// What is coded finer costs more and is truer, whatever the codec; bits that are not there cannot be felt.
TEST_F(LabCharts, FinerDepthCostsMoreAndIsTruer) {
  const Csv csv(out("bitrate.csv"));
  const auto value = [&](const char* codec, const char* bits, const char* crf, const char* column) {
    return csv.value({{"codec", codec}, {"bits", bits}, {"steps", "even"}, {"crf", crf}}, column);
  };
  for (const auto& [codec, bits] : {std::pair{"H.264", "8"}, {"H.264", "10"}, {"HEVC", "10"}}) {
    EXPECT_GT(value(codec, bits, "8", "kbit_s"), 2 * value(codec, bits, "20", "kbit_s")) << codec << bits;
    EXPECT_LT(value(codec, bits, "8", "height_rms_mm"), value(codec, bits, "20", "height_rms_mm")) << codec << bits;
  }
  // Rounding alone: a step of 40/255 mm over the square root of 12.
  EXPECT_NEAR(value("FFV1", "8", "0", "height_rms_mm"), 40.0 / 255 / std::sqrt(12.0), 0.0045);
  EXPECT_NEAR(value("FFV1", "10", "0", "height_rms_mm"), 40.0 / 1023 / std::sqrt(12.0), 0.001);
  EXPECT_EQ(value("FFV1", "16", "0", "height_max_mm"), 0);
  EXPECT_EQ(value("H.264", "8", "0", "height_rms_mm"), value("FFV1", "8", "0", "height_rms_mm"));
  EXPECT_LT(value("FFV1", "16", "0", "force_rms_percent"), value("FFV1", "8", "0", "force_rms_percent"));
  EXPECT_NE(textOf(out("bitrate.svg")).find("default"), std::string::npos);
  for (const char* steps : {"hue", "hue-disparity", "turbo"}) {
    for (const char* crf : {"18", "23"}) {
      const double off =
          csv.value({{"codec", "H.264"}, {"bits", "8"}, {"steps", steps}, {"crf", crf}}, "height_rms_mm");
      EXPECT_GT(off, 0.005) << steps << crf;
      EXPECT_LT(off, 0.4) << steps << crf << ": a hundredth of the box";
    }
  }
}

// Every matcher is beside the truth, and the settings that people get are marked on every film.
TEST_F(LabCharts, DepthFromTwoViewsIsTruerWithTextureAndWithoutACodec) {
  const Csv csv(out("stereo.csv"));
  const auto percent = [&](const char* axis, const char* value, const char* matcher) {
    return csv.value({{"axis", axis}, {"value", value}, {"matcher", matcher}}, "force_rms_percent");
  };
  for (const char* matcher : {"author", "SGBM", "quick 320"}) {
    EXPECT_LT(percent("texture", "rich", matcher), percent("texture", "weak", matcher)) << matcher;
    EXPECT_LT(percent("codec", "none", matcher), percent("codec", "crf 28", matcher)) << matcher;
  }
  EXPECT_LT(percent("size", "320", "author"), 10);
  EXPECT_LT(percent("size", "320", "exact"), 1);
  int author = 0, player = 0;
  for (const CsvRow& row : csv.rows()) {
    author += row.at("marked") == "author" ? 1 : 0;
    player += row.at("marked") == "player" ? 1 : 0;
  }
  EXPECT_EQ(author, 8) << "two places on each of four axes";
  EXPECT_EQ(player, 8);
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
  // Nor does the grid of all samples, with twenty times as many.
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
    EXPECT_EQ(guard.value({{"scenario", row.at("scenario")}, {"threshold_n", "8"}}, "pass"),
              std::strtod(row.at("pass").c_str(), nullptr));
  }
  EXPECT_NE(textOf(out("guard-sensitivity.svg")).find("uses 8 N"), std::string::npos);
}

TEST_F(LabCharts, AReportRunsOnlyWhatIsMissing) {
  const auto kept = std::filesystem::last_write_time(out("speed-accuracy.csv"));
  const auto old_page = std::filesystem::last_write_time(out("index.html"));
  std::filesystem::remove(out("stability-material.svg"));  // of the measurement that is made most quickly
  const auto again = test::runProgram("relievo-lab report --quick --out " + out(), *folder_ / ".");
  ASSERT_EQ(again.exit_code, result_.exit_code) << again.err;
  EXPECT_TRUE(std::filesystem::exists(out("stability-material.svg")));
  EXPECT_EQ(std::filesystem::last_write_time(out("speed-accuracy.csv")), kept);
  EXPECT_GT(std::filesystem::last_write_time(out("index.html")), old_page);
}

TEST(LabChartsWords, WrongUseAndAFolderThatCannotBeMadeAreOneLineEach) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  for (const char* command : {"speed-accuracy", "widths", "edges", "smoothness", "latency", "stability", "detail",
                              "bitrate", "stereo", "report"}) {
    const auto without = test::runProgram(std::string("relievo-lab ") + command, folder / ".");
    EXPECT_EQ(without.exit_code, 2) << command;
    EXPECT_NE(without.err.find("--out"), std::string::npos) << without.err;
    const auto blocked =
        test::runProgram(std::string("relievo-lab ") + command + " --quick --out " + (folder / "file/x"), folder / ".");
    EXPECT_EQ(blocked.exit_code, 1) << command;
    EXPECT_NE(blocked.err.find("file/x"), std::string::npos) << blocked.err;
    EXPECT_EQ(std::count(blocked.err.begin(), blocked.err.end(), '\n'), 1) << blocked.err;
  }
}

}  // namespace
}  // namespace relievo
