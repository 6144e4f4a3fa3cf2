// SPDX-License-Identifier: Apache-2.0
// What the charts of relievo-lab show: each claim is read from the table behind a chart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tests/scenario/lab/lab_charts.h"

namespace relievo::test {
namespace {

TEST_F(LabCharts, WhereContactWasLostItIsMarkedSo) {
  const Csv all(out("speed-accuracy.csv")), parts(out("parts.csv"));
  int lost = 0;
  for (const CsvRow& row : all.rows()) {
    if (row.at("lost_ticks").empty() || row.at("contact_lost").empty()) continue;
    const auto number = [&](const char* name) { return numberIn(row, name); };
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
    const double percent = numberIn(row, "worst_percent");
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

// The legend lists only curves that are drawn. A method that loses the moving face has no spectrum.
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
    const auto number = [&](const char* name) { return numberIn(row, name); };
    EXPECT_GT(number("update_median_us"), 0) << row.at("method");
    EXPECT_LE(number("update_median_us"), number("update_p99_us"));
    EXPECT_LE(number("update_p99_us"), number("update_p999_us"));
    EXPECT_GE(number("whole_median_us"), number("update_median_us"));
    EXPECT_GT(number("whole_own_p999_us"), 0) << "for all or for none";
  }
  EXPECT_GT(csv.value({{"method", "relievo"}, {"speed_m_per_s", "0.1"}, {"caches", "cold"}}, "update_median_us"), 0);
}

// Holding the frames of a movement of 0.7 Hz at 15 frames/s leaves an image of 0.7/15 of it beside the frame rate.
// Linear interpolation leaves the square of that share: 26 dB less.
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
      // At 30 frames/s the plan chooses the B-spline, because of the noise that a codec leaves. On depth without a
      // codec it flattens a little.
      EXPECT_LE(
          value("relievo", finger, rate, "force_rms_percent"),
          (rate == std::string_view("30") ? 1.2 : 1.05) * value("relievo linear", finger, rate, "force_rms_percent"))
          << finger << rate;
      EXPECT_EQ(value("relievo hold", finger, rate, "under_hold_db"), 0);
      EXPECT_NEAR(value("god-object", finger, rate, "under_hold_db"),
                  value("god-object hold", finger, rate, "peak_db") - value("god-object", finger, rate, "peak_db"),
                  1e-3);
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
  EXPECT_GT(value("god-object", "noise 1 %", "0", "5", "held"),
            value("god-object", "noise 1 %", "0", "5", "places") / 2);
  EXPECT_GT(value("relievo 0.72", "8-bit", "0", "5", "fall_off_rms_mm"), 1.5) << "what one width costs";
}

// Finer coding of the depth costs more kbit/s and brings a smaller error, with every codec.
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

// The chart compares every matcher with the true depth, and marks the settings that users get on every film.
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

}  // namespace
}  // namespace relievo::test
