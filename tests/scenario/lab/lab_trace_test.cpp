// SPDX-License-Identifier: Apache-2.0
// The paper's claims about its method, on depth films with a known surface, through relievo-lab trace.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "app/scene/display_volume.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

constexpr double kTick = 0.001;
constexpr DisplayVolume kVolume{160, 108, 40};

struct Row {
  double t = 0;
  glm::dvec3 hip{0}, proxy{0}, force{0};
  bool contact = false;
};

using Height = std::function<double(double x, double y, double t)>;  // mm, mm, s -> mm
using Finger = std::function<glm::dvec3(double t)>;

class LabTrace : public testing::Test {
 protected:
  // A lossless 16-bit film of a surface; a code's step is 0.0006 mm.
  void makeFilm(int cols, int rows, int fps, int frames, const Height& height) {
    const GridMapping grid(kVolume, cols, rows);
    test::ClipTrack track;
    track.width = cols;
    track.height = rows;
    track.fps_num = fps;
    track.frames = frames;
    track.sample = [=](int, int c, int r, int k) {
      const double z = height(grid.x(c), grid.y(r), static_cast<double>(k) / fps) / 40;
      return static_cast<std::uint32_t>(std::clamp(z, 0.0, 1.0) * 65535 + 0.5);
    };
    test::makeClip(folder_ / "film.mkv", {track});
  }

  std::vector<Row> trace(const Finger& finger, double seconds, const std::string& options) {
    std::ofstream path(folder_ / "hip.csv");
    path << "t_s,x_mm,y_mm,z_mm\n";
    for (int i = 0; i * kTick < seconds; ++i) {
      const glm::dvec3 p = finger(i * kTick);
      char row[160];
      std::snprintf(row, sizeof row, "%.4f,%.9g,%.9g,%.9g\n", i * kTick, p.x, p.y, p.z);
      path << row;
    }
    path.close();
    const auto result =
        test::runProgram("relievo-lab trace --box 160x108x40 --depth " + (folder_ / "film.mkv") + " --hip " +
                             (folder_ / "hip.csv") + " --out " + (folder_ / "out.csv") + " " + options,
                         folder_ / ".");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return readOut();
  }

  std::vector<Row> readOut() {
    std::ifstream file(folder_ / "out.csv");
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line,
              "t_s,hip_x_mm,hip_y_mm,hip_z_mm,proxy_x_mm,proxy_y_mm,proxy_z_mm,force_x_n,force_y_n,force_z_n,contact,"
              "update_ns");
    std::vector<Row> rows;
    double all_updates_ns = 0;  // summed, because a single one may be shorter than the clock's resolution
    while (std::getline(file, line)) {
      Row r;
      int contact = 0;
      double update_ns = -1;
      const int fields = std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%d,%lf", &r.t, &r.hip.x,
                                     &r.hip.y, &r.hip.z, &r.proxy.x, &r.proxy.y, &r.proxy.z, &r.force.x, &r.force.y,
                                     &r.force.z, &contact, &update_ns);
      EXPECT_EQ(fields, 12) << line;
      all_updates_ns += update_ns;
      r.contact = contact == 1;
      rows.push_back(r);
    }
    EXPECT_GT(all_updates_ns, 0);
    return rows;
  }

  test::TemporaryFolder folder_;
};

// z = 20 + 0.3 x + 0.15 y. The finger comes in along the normal to 3 mm below the surface, then slides at 60 mm/s.
TEST_F(LabTrace, TheForceOnATiltedPlaneIsStiffnessTimesTheDistanceAlongTheNormal) {
  makeFilm(720, 486, 30, 30, [](double x, double y, double) { return 20 + 0.3 * x + 0.15 * y; });
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.3, -0.15, 1));
  const Finger finger = [&](double t) {
    const double x = -20 + 60 * 0.8 * t, y = -12 + 60 * 0.6 * t;
    const double depth = std::min(3.0, -1.0 + 40 * t);
    return glm::dvec3(x, y, 20 + 0.3 * x + 0.15 * y) - depth * normal;
  };
  const auto rows = trace(finger, 0.9, "--method modified-proxy-graph --stiffness 0.7 --guard off");
  ASSERT_EQ(rows.size(), 900u);
  double squares = 0;
  int ticks = 0;
  for (const Row& row : rows) {
    if (row.t < 0.11) continue;
    ASSERT_TRUE(row.contact) << row.t;
    squares += std::pow(glm::length(row.force - 0.7 * 3.0 * normal) / (0.7 * 3.0), 2);
    ++ticks;
  }
  ASSERT_GT(ticks, 700);
  const double rms = std::sqrt(squares / ticks);
  RecordProperty("rms_percent", std::to_string(100 * rms));
  EXPECT_LE(rms, 0.05);
  EXPECT_GT(rms, 0.001) << "the proxy rests on edges and vertices: an error of nothing would be another method";
}

class Rise : public LabTrace, public testing::WithParamInterface<int> {};

// The plane rises from 2 to 38 mm through a finger that rests at 20.3 mm.
TEST_P(Rise, ModifiedProxyGraphKeepsContactWhereProxyGraphMissesIt) {
  const double speed = GetParam(), seconds = 36 / speed;
  constexpr int kFps = 120;
  const auto surface = [&](double t) { return std::min(2 + speed * t, 38.0); };
  const int frames = std::max(3, static_cast<int>(std::ceil(seconds * kFps)) + 1);
  makeFilm(90, 61, kFps, frames, [&](double, double, double t) { return surface(t); });
  const glm::dvec3 rest(3.1, -4.7, 20.3);
  const auto count = [&](const std::string& method) {
    int above = 0, touched = 0;
    // Between frames the film's surface is interpolated linearly.
    const auto between = [&](double t) {
      const double k = std::floor(t * kFps + 1e-9);
      const double w = t * kFps - k;
      return surface(k / kFps) * (1 - w) + surface((k + 1) / kFps) * w;
    };
    for (const Row& row : trace([&](double) { return rest; }, seconds, "--guard off --method " + method)) {
      if (between(row.t) < rest.z + 0.002) continue;
      ++above;
      touched += row.contact ? 1 : 0;
    }
    return std::pair(above, touched);
  };
  const auto [above, touched] = count("modified-proxy-graph");
  EXPECT_GT(above, 10);
  EXPECT_EQ(touched, above);
  const auto [above_static, touched_static] = count("proxy-graph");
  EXPECT_EQ(above_static, above);
  EXPECT_LE(touched_static, above / 10) << "the still-map method has to lose a rising surface (paper, Fig. 5)";
}
INSTANTIATE_TEST_SUITE_P(MmPerSecond, Rise, testing::Values(10, 100, 1000));

// Power spectral density of the force at the frame rate, dB: segments of 10 s, Hann window, averaged (paper, VI, which
// has ten).
double peakDensityDb(const std::vector<double>& force, double at_hz) {
  constexpr std::size_t kSegment = 10000;
  constexpr double kHannPower = 0.375;
  double peak = 0;
  for (double hz = at_hz - 0.5; hz <= at_hz + 0.5; hz += 0.1) {
    double power = 0;
    for (std::size_t s = 0; s + kSegment <= force.size(); s += kSegment) {
      double mean = 0;
      for (std::size_t i = 0; i < kSegment; ++i) mean += force[s + i] / kSegment;
      double re = 0, im = 0;
      for (std::size_t i = 0; i < kSegment; ++i) {
        const double phase = 2 * std::numbers::pi * static_cast<double>(i);
        const double window = 0.5 - 0.5 * std::cos(phase / kSegment);
        re += window * (force[s + i] - mean) * std::cos(phase * hz * kTick);
        im += window * (force[s + i] - mean) * std::sin(phase * hz * kTick);
      }
      power += 2 * (re * re + im * im) * kTick / (kHannPower * kSegment);
    }
    peak = std::max(peak, power / (static_cast<double>(force.size()) / kSegment));
  }
  return 10 * std::log10(peak);
}

TEST_F(LabTrace, InterpolationTakesFifteenDecibelsOffTheTremorAtTheFrameRate) {
  constexpr int kFps = 15;
  // A face-like bulge that nods by 3 mm at 0.71 Hz and sways a little.
  constexpr int kMeasuredS = 40;
  makeFilm(90, 61, kFps, (kMeasuredS + 2) * kFps, [](double x, double y, double t) {
    const double sway = 2 * std::sin(2 * std::numbers::pi * 0.53 * t);
    const double r2 = (x - sway) * (x - sway) + y * y;
    return 8 + 20 * std::exp(-r2 / (2 * 30 * 30)) + (y / 30) * 3 * std::sin(2 * std::numbers::pi * 0.71 * t);
  });
  const Finger finger = [](double t) { return glm::dvec3(5, 14, std::max(20.0, 40 - 40 * t)); };
  const auto spectrum = [&](const std::string& time) {
    std::vector<double> force;
    for (const Row& row : trace(finger, kMeasuredS + 1, "--method modified-proxy-graph --guard off --time " + time)) {
      if (row.t < 0.9995) continue;
      EXPECT_TRUE(row.contact) << row.t;
      force.push_back(glm::length(row.force));
    }
    EXPECT_EQ(force.size(), 1000u * kMeasuredS);
    return peakDensityDb(force, kFps);
  };
  const double hold = spectrum("hold"), linear = spectrum("linear");
  RecordProperty("hold_db", std::to_string(hold));
  RecordProperty("linear_db", std::to_string(linear));
  EXPECT_GE(hold - linear, 15) << "hold " << hold << " dB, linear " << linear << " dB";
}

TEST_F(LabTrace, SaysWhichLineIsWrongAndLeavesNoHalfOfAnOutput) {
  makeFilm(8, 8, 30, 3, [](double, double, double) { return 20.0; });
  const auto run = [&](const std::string& hip, const std::string& depth, const std::string& method) {
    std::ofstream(folder_ / "bad.csv") << hip;
    return test::runProgram("relievo-lab trace --depth " + depth + " --hip " + (folder_ / "bad.csv") + " --out " +
                                (folder_ / "out.csv") + " --method " + method,
                            folder_ / ".");
  };
  struct Case {
    std::string hip, depth, method, words;
    int exit_code;
  };
  const std::string good = "t_s,x_mm,y_mm,z_mm\n0,0,0,30\n", film = folder_ / "film.mkv";
  const std::vector<Case> cases{
      {"t_s,x_mm,y_mm\n0,0,0\n", film, "proxy-graph", "line 1", 1},
      {good + "0.001,0,zero,30\n", film, "proxy-graph", "line 3", 1},
      {good + "0.001,0,nan,30\n", film, "proxy-graph", "line 3", 1},
      {good + "-1,0,0,30\n", film, "proxy-graph", "line 3", 1},
      {good + "0.001,0,0,30,7\n", film, "proxy-graph", "line 3", 1},
      {good, folder_ / "none.mkv", "proxy-graph", "none.mkv", 1},
      {good, film, "finger-painting", "finger-painting", 2},
  };
  for (const Case& c : cases) {
    const auto result = run(c.hip, c.depth, c.method);
    EXPECT_EQ(result.exit_code, c.exit_code) << c.words << ": " << result.err;
    EXPECT_NE(result.err.find(c.words), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(std::ifstream(folder_ / "out.csv").good()) << c.words;
  }
  EXPECT_EQ(run(good, film, "proxy-graph").exit_code, 0);
  EXPECT_EQ(readOut().size(), 1u);
}

TEST_F(LabTrace, TellsWhyTheDepthMayBeReadWrongly) {
  std::ofstream(folder_ / "hip.csv") << "t_s,x_mm,y_mm,z_mm\n0,0,0,30\n";
  const auto tells = [&](const char* words, const char* doubt) {
    const std::string said =
        test::runProgram("relievo-lab trace --depth " + (folder_ / "film.mkv") + " --hip " + (folder_ / "hip.csv") +
                             " --out " + (folder_ / "out.csv") + " --method relievo " + words,
                         folder_ / ".")
            .out;
    return said.find("doubt: " + std::string(doubt)) != std::string::npos;
  };
  makeFilm(32, 24, 30, 6, [](double x, double, double) { return 20 + 0.2 * x; });
  EXPECT_TRUE(tells("", "nothing says which end of the depth is near"));
  EXPECT_FALSE(tells("--calibration polarity=near-high", ""));
  test::ClipTrack colors{.pix_fmt = "yuv444p", .width = 64, .height = 48, .frames = 2};
  colors.sample = [](int k, int c, int, int) {
    return static_cast<std::uint32_t>(k == 0 ? 60 + 2 * c : k == 1 ? 60 : 200);
  };
  test::makeClip(folder_ / "film.mkv", {colors});
  EXPECT_TRUE(tells("--calibration polarity=near-high", "100 % of the depth is coloured"));
}

TEST_F(LabTrace, TellsThePartsThatItReallyUsed) {
  makeFilm(32, 24, 30, 6, [](double x, double, double) { return 20 + 0.1 * x; });
  std::ofstream(folder_ / "hip.csv") << "t_s,x_mm,y_mm,z_mm\n0,0,0,30\n";
  const auto said = [&](const std::string& words) {
    return test::runProgram("relievo-lab trace --depth " + (folder_ / "film.mkv") + " --hip " + (folder_ / "hip.csv") +
                                " --out " + (folder_ / "out.csv") + " --method " + words,
                            folder_ / ".")
        .out;
  };
  const auto holds = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  const std::string own = said("relievo");
  EXPECT_TRUE(holds(own, "parts: bspline in space, levels of ")) << own;
  EXPECT_TRUE(holds(own, "plan: steps of ")) << own;
  const std::string held = said("relievo --time hold");
  EXPECT_TRUE(holds(held, " mm, hold in time")) << held;
  EXPECT_FALSE(holds(held, "fitted")) << "the plan's, not what was used: " << held;
  const std::string quadratic = said("relievo --space quadratic");
  EXPECT_TRUE(holds(quadratic, "parts: quadratic in space, levels of ")) << quadratic;
  for (const auto& [words, parts] :
       {std::pair{"relievo --space triangles", "parts: triangles in space, linear in time\n"},
        {"proxy-graph", "parts: triangles in space, hold in time\n"},
        {"proxy-graph --time linear", "parts: triangles in space, linear in time\n"}}) {
    const std::string text = said(words);
    EXPECT_TRUE(holds(text, parts)) << text;
    EXPECT_FALSE(holds(text, "levels")) << text;
  }
}

// The upper quarter of the depth stands at 30 mm. The player's box is as wide as the colour's 16:9, so that this
// quarter begins at y = 22.5 mm; by the square depth it would begin at 40 mm.
TEST_F(LabTrace, TheBoxHasTheShapeOfTheColour) {
  test::ClipTrack color{.width = 64, .height = 36}, depth{.width = 48, .height = 48};
  depth.sample = [](int, int, int r, int) { return r < 12 ? 49151u : 0u; };
  test::makeClip(folder_ / "film.mkv", {color, depth});
  std::ofstream(folder_ / "hip.csv") << "t_s,x_mm,y_mm,z_mm\n0,0,30,31\n0.01,0,30,28\n0.02,0,30,28\n";
  const auto result =
      test::runProgram("relievo-lab trace --depth " + (folder_ / "film.mkv") + " --hip " + (folder_ / "hip.csv") +
                           " --out " + (folder_ / "out.csv") + " --method relievo",
                       folder_ / ".");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(readOut().back().contact);
}

TEST_F(LabTrace, OptionsThatDoNotGoTogetherAreNamedBoth) {
  struct Case {
    const char *words, *named;
  };
  for (const Case& c : {Case{"proxy-graph --space bspline", "--space bspline with --method proxy-graph: "},
                        Case{"penalty --time fitted", "--time fitted with --method penalty: "},
                        Case{"penalty --time adapted", "--time adapted with --method penalty: "},
                        Case{"proxy-blend --time linear", "--time linear with --method proxy-blend: "},
                        Case{"relievo --space triangles --time bspline", "--time bspline with --space triangles: "}}) {
    const auto result = test::runProgram(
        std::string("relievo-lab trace --depth none.mkv --hip none.csv --out out.csv --method ") + c.words,
        folder_ / ".");
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(result.err.starts_with(std::string("relievo-lab: ") + c.named)) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

TEST_F(LabTrace, WrongWordsAreOneLineAndCodeTwo) {
  const std::string whole = "relievo-lab trace --depth none.mkv --hip none.csv --out none.csv --method proxy-graph ";
  for (const char* words : {"--packing diagonal", "--depth-code smell", "--time later", "--guard dog", "--box 160x108",
                            "--box 1e9x1x1", "--calibration law=steep", "--spin"}) {
    const auto result = test::runProgram(whole + words, folder_ / ".");
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(result.err.starts_with("relievo-lab: ")) << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.err.find("->"), std::string::npos) << "a list that only a parser reads: " << result.err;
  }
  EXPECT_EQ(test::runProgram(whole + "--calibration none.txt", folder_ / ".").exit_code, 1);
}

}  // namespace
}  // namespace relievo
